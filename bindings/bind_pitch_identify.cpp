#include <crashsim/identify_pitch.hpp>
#include <crashsim/measured_motion.hpp>

#include "bindings.hpp"
#include "forcing_argument.hpp"
#include "keywords.hpp"
#include "long_call.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

PitchTarget target_of(const py::object& given) {
  if (!py::isinstance<MeasuredMotion>(given)) return from_python<PitchTarget>(given, "target");
  const MeasuredMotion& motion = given.cast<const MeasuredMotion&>();
  return {motion.heave_m, motion.pitch_rad, motion.heave_velocity_mps, motion.pitch_rate_radps};
}

void bind_target(py::module_& module) {
  ValueClass<PitchTarget>(
      module, "PitchTarget",
      "Measured motion of the body, each a TimeSeries on the forcing's clock; at least one of them.")
      .field("heave_m", &PitchTarget::heave_m, "Heave z, up positive, from static equilibrium [m].")
      .field("pitch_rad", &PitchTarget::pitch_rad, "Pitch theta, nose-down positive [rad].")
      .field("heave_velocity_mps", &PitchTarget::heave_velocity_mps, "z' [m/s].")
      .field("pitch_rate_radps", &PitchTarget::pitch_rate_radps, "theta' [rad/s].");
  ValueClass<PitchFitError>(
      module, "PitchFitError",
      "E: sum over the channels given of the mean over samples of loss((model - target) / largest "
      "target); NaN for a channel not given.")
      .field("total", &PitchFitError::total, "E: the sum.")
      .field("heave", &PitchFitError::heave, "Its part of heave.")
      .field("pitch", &PitchFitError::pitch, "Its part of pitch.")
      .field("heave_velocity", &PitchFitError::heave_velocity, "Its part of heave velocity.")
      .field("pitch_rate", &PitchFitError::pitch_rate, "Its part of pitch rate.");
}

void bind_fit(py::module_& module) {
  using R = PitchIdentification;
  ValueClass<R>(module, "PitchIdentification", "What an identification of a heave-pitch model gives.")
      .field("outcome", &R::outcome,
             "'not_run', 'completed', 'interrupted', 'every_start_failed' or 'engines_disagree'.")
      .field("message", &R::message, "Why it is not usable, or ''.")
      .field("model", &R::model, "The best HeavePitchModel.")
      .field("error", &R::error, "Its PitchFitError, as the engine of the options simulates it.")
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

}  // namespace

void bind_pitch_identify(py::module_& module) {
  bind_target(module);
  bind_fit(module);
  module.def(
      "identify_pitch",
      [](const HeavePitchModel& guess, const py::object& force, const py::object& target, const py::object& progress,
         const py::kwargs& keywords) {
        const PitchForcing forcing = forcing_from(force, "force");
        const PitchTarget measured = target_of(target);
        const auto [simulation, options] = options_of<PitchOptions, IdentifyPitchOptions>(keywords, "identify_pitch");
        return watched(progress, [&, &how = simulation, &chosen = options](const Progress& told) {
          return identify_pitch(guess, forcing, measured, how, chosen, told);
        });
      },
      py::arg("guess"), py::arg("force"), py::arg("target"), py::kw_only(), py::arg("progress") = py::none(),
      with_options_doc<IdentifyPitchOptions, PitchOptions>(
          R"(Identifies numbers of a heave-pitch model from the measured motion of the body, [Noorsumar2021] next steps.

The model's motion and its sensitivities are exact at the target's own samples, for forces that are linear between
theirs. Bounds are in the order of `free`; by default a factor of 20 either way for stiffness and damping, 5 for mass
and inertia, 4 for the axles' distances.

Parameters
----------
guess : HeavePitchModel
    Numbers that are not free are kept; start 0 is this model.
force : PitchForcing, MeasuredForcing, CrushResponse, TimeSeries, Trace or (time_s, values)
    What drives it, as in simulate_pitch.
target : PitchTarget or MeasuredMotion
    Measured motion; samples before the motion starts are not compared.
progress : callable, optional
    ``progress(done, total)`` is called now and then with the starts done; return False to stop.
**options
    See below; those of simulate_pitch say when and from which state the motion starts.

Returns
-------
PitchIdentification

Raises
------
InvalidInput
    On a bad model, series or option, a target without samples in the window, or a bound that is not allowed.
KeyboardInterrupt
    On Ctrl-C.)")
          .c_str());
}

}  // namespace crashsim::python
