#include <string>

#include <pybind11/stl.h>

#include <crashsim/pulse.hpp>
#include <crashsim/signal.hpp>

#include "arrays.hpp"
#include "bindings.hpp"
#include "keywords.hpp"
#include "long_call.hpp"
#include "paths.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

CfcStandard cfc_standard(const std::string& name) { return from_python<CfcStandard>(py::str(name), "standard"); }

void bind_signal(py::module_& module) {
  module.def(
      "cfc_filter",
      [](const py::object& values, double dt_s, double cfc, const std::string& standard) {
        const Doubles samples(values, "values");
        const CfcStandard definition = cfc_standard(standard);
        check_finite(samples);
        return array_of(unlocked([&] { return cfc_filter(samples.view(), dt_s, cfc, definition); }));
      },
      py::arg("values"), py::arg("dt_s"), py::arg("cfc"), py::kw_only(), py::arg("standard") = "j211",
      R"(Phaseless channel frequency class filter, SAE J211-1 appendix C or ISO 6487 annex A.

Parameters
----------
values : array_like of shape (n,)
    Uniform samples, any unit.
dt_s : float
    Sampling interval [s]; ``1 / dt_s`` must be at least 10 `cfc`.
cfc : float
    Channel frequency class [Hz]: 60, 180, 600, 1000.
standard : {'j211', 'iso6487'}
    Definition of the filter.

Returns
-------
numpy.ndarray of shape (n,)

Raises
------
InvalidInput
    When the rate is too low for the class, a value is not finite or there are fewer than 3 samples.
)");
  module.def(
      "integrate",
      [](const py::object& time_s, const py::object& values, double initial) {
        const Doubles times(time_s, "time_s"), samples(values, "values");
        check_series(times.view(), samples.view(), "integrate", 1);
        check_finite(initial, "initial");
        return array_of(integrate(times.view(), samples.view(), initial));
      },
      py::arg("time_s"), py::arg("values"), py::arg("initial") = 0.0,
      R"(Running integral by trapezoids.

Parameters
----------
time_s : array_like of shape (n,)
    Strictly increasing times [s].
values : array_like of shape (n,)
    Samples, any unit.
initial : float
    Value at the first time.

Returns
-------
numpy.ndarray of shape (n,)

Raises
------
InvalidInput
    When lengths differ, times do not increase, a value is not finite or there are no samples.
)");
  module.def(
      "differentiate",
      [](const py::object& time_s, const py::object& values) {
        const Doubles times(time_s, "time_s"), samples(values, "values");
        check_series(times.view(), samples.view(), "differentiate", 2);
        return array_of(differentiate(times.view(), samples.view()));
      },
      py::arg("time_s"), py::arg("values"),
      R"(Derivative by central differences on any grid, one-sided at the ends; exact for parabolas inside.

Parameters
----------
time_s : array_like of shape (n,)
    Strictly increasing times [s].
values : array_like of shape (n,)
    Samples, any unit.

Returns
-------
numpy.ndarray of shape (n,)

Raises
------
InvalidInput
    When lengths differ, times do not increase, a value is not finite or there are fewer than 2 samples.
)");
  module.def(
      "find_time_zero",
      [](const py::object& time_s, const py::object& accel_mps2) {
        const Doubles times(time_s, "time_s"), accel(accel_mps2, "accel_mps2");
        check_series(times.view(), accel.view(), "find_time_zero");
        return find_time_zero(times.view(), accel.view());
      },
      py::arg("time_s"), py::arg("accel_mps2"),
      R"(Time zero [s]: the first sample of at least 5 g, walked back to the last one below 0.5 g.

Parameters
----------
time_s : array_like of shape (n,)
    Strictly increasing times [s].
accel_mps2 : array_like of shape (n,)
    Acceleration [m/s^2].

Returns
-------
float

Raises
------
InvalidInput
    When the trace never reaches 5 g, or is no series.
)");
}

void bind_pulse_class(py::module_& module) {
  ValueClass<Pulse>(module, "Pulse",
                    "Longitudinal motion from time zero on: crush positive, acceleration negative while the vehicle "
                    "decelerates. The arrays are read-only, of n samples each.")
      .field("time_s", &Pulse::time_s, "Times from 0, uniform [s].")
      .field("accel_mps2", &Pulse::accel_mps2, "dv/dt [m/s^2].")
      .field("velocity_mps", &Pulse::velocity_mps, "Starts at the impact speed [m/s].")
      .field("displacement_m", &Pulse::displacement_m, "Starts at 0 [m].")
      .field("mass_kg", &Pulse::mass_kg, "Test mass [kg], NaN when unknown.")
      .field("impact_speed_mps", &Pulse::impact_speed_mps, "Speed at time zero [m/s].")
      .field("t_m_s", &Pulse::t_m_s, "Time of maximum crush, between samples [s]; NaN when there is none.")
      .field("max_crush_m", &Pulse::max_crush_m, "Displacement at t_m [m].")
      .field("time_zero_s", &Pulse::time_zero_s, "Time zero on the clock of the trace [s].")
      .field("channels", &Pulse::channels, "What it was made from.")
      .field("steps", &Pulse::steps, "What was done, in order.")
      .field("warnings", &Pulse::warnings, "What looked unusual.")
      .field("input_files", &Pulse::input_files, "Every file read.");
}

Pulse told(Pulse pulse) {
  log_warnings(pulse.warnings);
  return pulse;
}

Pulse pulse_of_traces(const py::object& traces, const py::object& accel_mps2, const py::kwargs& keywords) {
  if (!accel_mps2.is_none()) throw py::type_error("make_pulse() of a TraceSet takes keywords only");
  const TraceSet& set = traces.cast<const TraceSet&>();
  const auto options = options_from<PulseOptions>(keywords, "make_pulse");
  return told(unlocked([&] { return make_pulse(set, options); }));
}

Pulse pulse_of_arrays(const py::object& time_s, const py::object& accel_mps2, const py::kwargs& keywords) {
  const Doubles times(time_s, "time_s"), accel(accel_mps2, "accel_mps2");
  for (const auto& [key, value] : keywords)
    if (const auto name = py::cast<std::string>(key); name != "impact_speed_mps" && name != "mass_kg" && name != "cfc")
      throw_unexpected_keyword("make_pulse", name, {"impact_speed_mps", "mass_kg", "cfc"});
  PulseOptions options;
  options.cfc = 0.0;
  options = with_keywords(options, keywords, "make_pulse");
  require_set(options, &PulseOptions::impact_speed_mps, "make_pulse");
  return unlocked(
      [&] { return make_pulse(times.view(), accel.view(), options.impact_speed_mps, options.mass_kg, options.cfc); });
}

}  // namespace

void bind_pulse(py::module_& module) {
  bind_signal(module);
  bind_pulse_class(module);
  const std::string options = with_options_doc<PulseOptions>("");
  module.def(
      "read_pulse",
      [](const py::object& path, const py::kwargs& keywords) {
        const std::string file = path_text(path);
        const auto chosen = options_from<PulseOptions>(keywords, "read_pulse");
        return told(unlocked([&] { return read_pulse(file, chosen); }));
      },
      py::arg("path"),
      (R"(Reads a trace and makes a crash pulse of it; a ``pulse.csv`` of crashsim comes back as written.

Parameters
----------
path : str or os.PathLike
    Trace file or folder of any format that read_traces reads.
**options
    See below.

Returns
-------
Pulse

Raises
------
InvalidInput
    Names file, channel and the rule it breaks.)" +
       options)
          .c_str());
  module.def(
      "make_pulse",
      [](const py::object& time_s, const py::object& accel_mps2, const py::kwargs& keywords) {
        return py::isinstance<TraceSet>(time_s) ? pulse_of_traces(time_s, accel_mps2, keywords)
                                                : pulse_of_arrays(time_s, accel_mps2, keywords);
      },
      py::arg("time_s"), py::arg("accel_mps2") = py::none(),
      (R"(Makes a crash pulse, ``make_pulse(traces, **options)`` from a TraceSet, or from arrays that start at impact.

Velocity and displacement are running integrals by trapezoids.

Parameters
----------
time_s : TraceSet or array_like of shape (n,)
    Channels read, or times [s], uniform when `cfc` is given.
accel_mps2 : array_like of shape (n,), optional
    Acceleration [m/s^2], negative while decelerating; not with a TraceSet.
**options
    See below. Arrays take `impact_speed_mps`, which they need, `mass_kg` and `cfc`, by default no filter.

Returns
-------
Pulse

Raises
------
InvalidInput
    Names the series or channel and the rule it breaks.)" +
       options)
          .c_str());
}

}  // namespace crashsim::python
