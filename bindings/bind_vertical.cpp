#include <string>

#include <crashsim/identify_vertical.hpp>
#include <crashsim/measured_vertical.hpp>
#include <crashsim/vertical_force.hpp>

#include "bindings.hpp"
#include "keywords.hpp"
#include "long_call.hpp"
#include "paths.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

void bind_law(py::module_& module) {
  ValueClass<VerticalForceLaw>(module, "VerticalForceLaw",
                               R"(The barrier's vertical force on the vehicle, as a law of the crush force.

    F_v = F_x tan(alpha(s)),  alpha(s) = alpha0 + alpha' max(0, s - s_b),  abs(F_v) <= mu abs(F_x)

F_v is downward positive on the vehicle, F_x positive while it stops the vehicle, s is crush [m]. Fields are keywords of
the constructor and take text with units; bad values raise InvalidInput.)")
      .option_fields()
      .def(
          "validate", [](const VerticalForceLaw& self) { validate(self); },
          "Raises InvalidInput naming the field, its value and the rule when the law is not one.")
      .def("is_active", &is_active, "True when the law gives any force.")
      .def("vertical_ratio", &vertical_ratio, py::arg("crush_m"),
           "F_v / F_x at a crush [m]. Raises InvalidInput when no friction bounds an angle beyond 1.5 rad.");
  module.def(
      "vertical_force",
      [](const VerticalForceLaw& law, const CrushResponse& response) {
        return unlocked([&] { return vertical_force(law, response); });
      },
      py::arg("law"), py::arg("response"),
      R"(F_v over the output times of a crush motion, to drive heave and pitch.

Linear between samples: choose dt_s of the crush short against the pulse.

Parameters
----------
law : VerticalForceLaw
    The law.
response : CrushResponse
    A simulated crush.

Returns
-------
TimeSeries
    Vertical force on the vehicle [N], downward positive.

Raises
------
InvalidInput
    On a bad law or a response without motion.
)");
}

void bind_measured(py::module_& module) {
  ValueClass<VerticalForceTarget>(module, "VerticalForceTarget",
                                  "Measured forces on the vehicle and its crush, each a TimeSeries, on one clock.")
      .field("vertical_force_n", &VerticalForceTarget::vertical_force_n, "F_v [N], downward positive.")
      .field("longitudinal_force_n", &VerticalForceTarget::longitudinal_force_n,
             "F_x [N], positive while it stops the vehicle.")
      .field("crush_m", &VerticalForceTarget::crush_m, "Crush s [m].");
  ValueClass<MeasuredVertical>(module, "MeasuredVertical", "Forces and crush read from a trace, with what was done.")
      .field("target", &MeasuredVertical::target, "The VerticalForceTarget.")
      .field("steps", &MeasuredVertical::steps, "What was done, in order.")
      .field("warnings", &MeasuredVertical::warnings, "What a careful reader should know.")
      .field("input_files", &MeasuredVertical::input_files, "Every file read.");
  module.def(
      "read_vertical_target",
      [](const py::object& file, const py::kwargs& keywords) {
        auto [forces, crush] = options_of<ForcingOptions, CrushChannelOptions>(keywords, "read_vertical_target");
        forces.file = path_text(file);
        return unlocked([&, &from = forces, &path = crush] { return read_vertical_target(from, path); });
      },
      py::arg("file"),
      with_options_doc<ForcingOptions, CrushChannelOptions>(
          R"(Reads the barrier's forces on the vehicle and its crush, from which identify_vertical finds a law.

Parameters
----------
file : str or os.PathLike
    Trace file or folder of any format that read_traces reads.
**options
    See below.

Returns
-------
MeasuredVertical

Raises
------
InvalidInput
    Names file and channel when it cannot be read, lacks a force or the crush, or a channel is none.)")
          .c_str());
}

void bind_fit(py::module_& module) {
  using R = VerticalIdentification;
  ValueClass<R>(module, "VerticalIdentification", "What an identification of the law of the vertical force gives.")
      .field("outcome", &R::outcome, "'not_run', 'completed', 'interrupted' or 'every_start_failed'.")
      .field("message", &R::message, "Why it is not usable, or ''.")
      .field("law", &R::law, "The best VerticalForceLaw.")
      .field("error", &R::error, "E: mean over samples of loss((law - measured) / largest measured).")
      .field("samples", &R::samples, "Number of samples compared.")
      .field("limited_samples", &R::limited_samples, "Of these, where friction bounds the law's force.")
      .field("verdict", &R::verdict, "Verdict on the numbers identified; there is no spring_damper_cosine.")
      .field("parameters", &R::parameters, "A ParameterReport each, in the order of `free`.")
      .field("correlation", &R::correlation, "Between parameters, array of (n, n); NaN where meaningless.")
      .field("starts", &R::starts, "A StartReport each.")
      .field("starts_at_best", &R::starts_at_best, "Starts with E within 0.1 % of the best, or 1e-9.")
      .field("evaluations", &R::evaluations, "Of the objective, with gradient.")
      .field("seconds", &R::seconds, "Wall time [s].")
      .field("seed", &R::seed, "Of the random starts.")
      .field("warnings", &R::warnings, "What a careful reader should know.")
      .result();
}

VerticalForceTarget target_of(const py::object& given) {
  if (py::isinstance<MeasuredVertical>(given)) return given.cast<const MeasuredVertical&>().target;
  return from_python<VerticalForceTarget>(given, "target");
}

void bind_identify_vertical(py::module_& module) {
  module.def(
      "identify_vertical",
      [](const py::object& target, const VerticalForceLaw& guess, const py::object& progress,
         const py::kwargs& keywords) {
        const VerticalForceTarget measured = target_of(target);
        const auto options = options_from<IdentifyVerticalOptions>(keywords, "identify_vertical");
        return watched(progress,
                       [&](const Progress& told) { return identify_vertical(measured, guess, options, told); });
      },
      py::arg("target"), py::arg_v("guess", VerticalForceLaw{}, "VerticalForceLaw()"), py::kw_only(),
      py::arg("progress") = py::none(),
      with_options_doc<IdentifyVerticalOptions>(
          R"(Identifies numbers of the law of the barrier's vertical force from measured forces and crush.

Bounds are in the order of `free`; by default angles within 1 rad, rates within 4 rad over the largest crush, starts up
to it, friction up to 2.

Parameters
----------
target : VerticalForceTarget or MeasuredVertical
    Measured forces and crush, compared at the vertical force's samples.
guess : VerticalForceLaw, optional
    Numbers that are not free are kept; start 0 is this law.
progress : callable, optional
    ``progress(done, total)`` is called now and then with the starts done; return False to stop.
**options
    See below.

Returns
-------
VerticalIdentification

Raises
------
InvalidInput
    On a bad law, series or option, series without common samples in the window, forces or a crush that are nowhere
    positive, or a bound that is not allowed.
KeyboardInterrupt
    On Ctrl-C.)")
          .c_str());
}

}  // namespace

void bind_vertical(py::module_& module) {
  bind_law(module);
  bind_measured(module);
  bind_fit(module);
  bind_identify_vertical(module);
}

}  // namespace crashsim::python
