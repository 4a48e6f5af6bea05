#include <string>
#include <vector>

#include <pybind11/stl.h>

#include <crashsim/identify.hpp>

#include "bindings.hpp"
#include "long_call.hpp"
#include "pulse_argument.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

void bind_reports(py::module_& module) {
  ValueClass<FitError>(module, "FitError", "Sum of the channels' errors, [Noorsumar2021] eq. (4).")
      .field("total", &FitError::total, "E: the sum.")
      .field("accel", &FitError::accel, "Its part of acceleration.")
      .field("velocity", &FitError::velocity, "Its part of velocity.")
      .field("displacement", &FitError::displacement, "Its part of displacement.");
  ValueClass<Verdict>(module, "Verdict", "How far the ordinates can be believed.")
      .field("identifiable", &Verdict::identifiable, "True when every ordinate is determined.")
      .field("rank", &Verdict::rank, "Numerical rank of the sensitivity matrix.")
      .field("condition", &Verdict::condition, "Condition number with columns scaled to unit length.")
      .field("spring_damper_cosine", &Verdict::spring_damper_cosine,
             "Largest cosine between the spring's and the damper's columns.")
      .field("message", &Verdict::message, "In words.");
  ValueClass<OrdinateReport>(module, "OrdinateReport",
                             "One identified number: an ordinate, r of law 'rate', a free knot.")
      .field("name", &OrdinateReport::name,
             "'k1'.. of the spring, 'c1'.. of the damper, 'r', 'x2'.. of the spring's knots, 'v2'.. (law "
             "'crush_damping': 'd2'..) of the damper's.")
      .field("part", &OrdinateReport::part, "'spring', 'damper', 'rate', 'spring_knot' or 'damper_knot'.")
      .field("value", &OrdinateReport::value, "[N/m], [N], [N s/m], [-], [m] or [m/s].")
      .field("standard_error", &OrdinateReport::standard_error, "[as value]; NaN when the data say nothing about it.")
      .field("upper_bound", &OrdinateReport::upper_bound, "[as value]")
      .field("untouched", &OrdinateReport::untouched, "No sample depends on it: held as the nearest fitted one.")
      .field("at_bound", &OrdinateReport::at_bound, "At a bound, 0 or the upper.");
  ValueClass<TestReport>(module, "TestReport",
                         "One test of a fit; measured(t) = gain * true(t - time_shift) + bias where that is sought.")
      .field("impact_speed_mps", &TestReport::impact_speed_mps, "[m/s]")
      .field("mass_kg", &TestReport::mass_kg, "[kg]")
      .field("max_crush_m", &TestReport::max_crush_m, "Measured [m].")
      .field("t_m_s", &TestReport::t_m_s, "Measured time of maximum crush [s].")
      .field("weight", &TestReport::weight, "In E; their mean is 1.")
      .field("error", &TestReport::error, "FitError of this test, with its weight.")
      .field("time_shift_s", &TestReport::time_shift_s, "[s]; NaN where not sought, as all that follows.")
      .field("gain", &TestReport::gain, "[-]")
      .field("bias_mps2", &TestReport::bias_mps2, "[m/s^2]")
      .field("time_shift_error_s", &TestReport::time_shift_error_s, "Standard error [s].")
      .field("gain_error", &TestReport::gain_error, "Standard error.")
      .field("bias_error_mps2", &TestReport::bias_error_mps2, "Standard error [m/s^2].");
  ValueClass<ParameterReport>(module, "ParameterReport", "One number of a model that is identified as it is.")
      .field("name", &ParameterReport::name, "Of the model's field.")
      .field("unit", &ParameterReport::unit, "SI symbol.")
      .field("value", &ParameterReport::value, "[unit]")
      .field("standard_error", &ParameterReport::standard_error, "[unit]; NaN when the data say nothing about it.")
      .field("lower_bound", &ParameterReport::lower_bound, "[unit]")
      .field("upper_bound", &ParameterReport::upper_bound, "[unit]")
      .field("untouched", &ParameterReport::untouched, "No sample depends on it.")
      .field("at_bound", &ParameterReport::at_bound, "At one of its bounds.");
  ValueClass<StartReport>(module, "StartReport", "One start of the optimisation.")
      .field("error", &StartReport::error, "E reached; infinite when it failed.")
      .field("evaluations", &StartReport::evaluations, "Of the objective.")
      .field("failed", &StartReport::failed, "True when it gave nothing.");
}

void bind_identification(py::module_& module) {
  ValueClass<Identification>(module, "Identification", "What an identification gives.")
      .field("outcome", &Identification::outcome,
             "'completed', 'no_max_crush', 'interrupted', 'every_start_failed' or 'engines_disagree'.")
      .field("message", &Identification::message, "Why it is not usable, or ''.")
      .field("model", &Identification::model, "The best CrushModel.")
      .field("error", &Identification::error, "FitError of the model as CVODE simulates it.")
      .field("verdict", &Identification::verdict, "Verdict: how far the ordinates can be believed.")
      .field("ordinates", &Identification::ordinates, "An OrdinateReport each, spring first.")
      .field("tests", &Identification::tests, "A TestReport each.")
      .field("smooth", &Identification::smooth, "Weight of the smoothing, as given or as chosen.")
      .field("correlation", &Identification::correlation, "Between ordinates, array of (n, n); NaN where meaningless.")
      .field("starts", &Identification::starts, "A StartReport each.")
      .field("starts_at_best", &Identification::starts_at_best, "Starts with E within 0.1 % of the best.")
      .field("evaluations", &Identification::evaluations, "Of the objective, with gradient.")
      .field("seconds", &Identification::seconds, "Wall time [s].")
      .field("seed", &Identification::seed, "Of the random starts.")
      .field("warnings", &Identification::warnings, "What a careful reader should know.")
      .result();
}

}  // namespace

std::vector<Pulse> pulses_of(const py::object& given) {
  if (py::isinstance<Pulse>(given)) return {given.cast<Pulse>()};
  if (py::isinstance<py::str>(given) || !py::isinstance<py::iterable>(given))
    throw py::type_error("pulses: must be a Pulse or a list of them, is " + std::string(py::str(py::type::of(given))));
  return from_python<std::vector<Pulse>>(given, "pulses");
}

void bind_identify(py::module_& module) {
  bind_reports(module);
  bind_identification(module);
  module.def(
      "identify",
      [](const py::object& pulses, const py::object& progress, const py::kwargs& keywords) {
        const std::vector<Pulse> tests = pulses_of(pulses);
        const auto options = options_from<IdentifyOptions>(keywords, "identify");
        Identification fit = watched(
            progress, [&](const Progress& told) { return identify(std::span<const Pulse>(tests), options, told); });
        log_warnings(fit.warnings);
        return fit;
      },
      py::arg("pulses"), py::kw_only(), py::arg("progress") = py::none(),
      with_options_doc<IdentifyOptions>(
          R"(Identifies spring and damper from pulses of one structure, [Noorsumar2021] eq. (4).

Parameters
----------
pulses : Pulse or sequence of Pulse
    Tests of one structure, fitted together.
progress : callable or tqdm bar, optional
    ``progress(done, total)`` is called now and then with the starts done; return False to stop. A tqdm bar is moved.
**options
    See below.

Returns
-------
Identification
    A pulse without t_m gives the outcome 'no_max_crush'.

Raises
------
InvalidInput
    On bad options, or a pulse without mass.
KeyboardInterrupt
    On Ctrl-C.)")
          .c_str());
  module.def(
      "equation_error",
      [](const py::object& pulses, const py::kwargs& keywords) {
        const std::vector<Pulse> tests = pulses_of(pulses);
        const auto options = options_from<IdentifyOptions>(keywords, "equation_error");
        return unlocked([&] { return equation_error(std::span<const Pulse>(tests), options); });
      },
      py::arg("pulses"),
      with_options_doc<IdentifyOptions>(
          R"(Identifies by the equation error alone: least squares in the force with the measured motion inserted.

Takes microseconds, and for ordinates between given knots the solution is the one best.

Parameters
----------
pulses : Pulse or sequence of Pulse
    Tests of one structure, fitted together.
**options
    Those of identify; ``method`` is 'equation-error'.

Returns
-------
Identification

Raises
------
InvalidInput
    On bad options, or a pulse without mass.)")
          .c_str());
  module.def(
      "fit_error",
      [](const CrushModel& model, const Pulse& pulse, const py::object& weights, const std::string& loss) {
        const auto chosen = from_python<Setting<Weights>>(weights, "weights");
        const auto penalty = from_python<Loss>(py::str(loss), "loss");
        return unlocked([&] { return fit_error(model, pulse, chosen, penalty); });
      },
      py::arg("model"), py::arg("pulse"), py::kw_only(), py::arg("weights") = "normalised", py::arg("loss") = "l1",
      R"(E of a model against a pulse over the pulse's own samples 0..t_m, simulated by CVODE.

Parameters
----------
model : CrushModel
pulse : Pulse
weights : {'normalised', 'paper'} or three floats
    Weights of acceleration, velocity and displacement.
loss : {'l1', 'l2', 'huber'}
    Penalty on residuals.

Returns
-------
FitError

Raises
------
InvalidInput
    On a bad model, weight or loss, or a pulse without t_m.
)");
}

}  // namespace crashsim::python
