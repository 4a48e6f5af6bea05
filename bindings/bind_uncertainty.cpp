#include <span>
#include <vector>

#include <pybind11/stl.h>

#include <crashsim/uncertainty.hpp>

#include "bindings.hpp"
#include "long_call.hpp"
#include "pulse_argument.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

void bind_parts(py::module_& module) {
  using O = OrdinateUncertainty;
  ValueClass<O>(module, "OrdinateUncertainty", "What is known of one fitted number.")
      .field("name", &O::name, "As in Identification.ordinates.")
      .field("value", &O::value, "[N/m], [N], [N s/m], [-], [m] or [m/s].")
      .field("state", &O::state, "'free', 'at_bound', 'untouched' or 'undetermined'.")
      .field("standard_error", &O::standard_error, "[as value]; NaN unless free.")
      .field("low", &O::low, "Lower end of the interval [as value].")
      .field("high", &O::high, "Its upper end [as value].")
      .field("profile_low", &O::profile_low, "Lower end of the profile likelihood's interval [as value].")
      .field("profile_high", &O::profile_high, "Its upper end [as value].")
      .field("profile_low_open", &O::profile_low_open, "Down to the bound nothing speaks against it.")
      .field("profile_high_open", &O::profile_high_open, "Up to the bound nothing speaks against it.")
      .field("profile_at", &O::profile_at, "Values of the profile [as value].")
      .field("profile_rise", &O::profile_rise, "Rise of twice the log likelihood there.");
  using D = FisherDirection;
  ValueClass<D>(module, "FisherDirection", "A direction in the space of the fitted numbers.")
      .field("singular_value", &D::singular_value, "Of the sensitivities to relative changes, of the largest.")
      .field("relative_error", &D::relative_error, "Standard error along it, relative to the numbers.")
      .field("error_change", &D::error_change, "What `change` does to E, to second order.")
      .field("change", &D::change, "Relative changes of all numbers, the largest 10 %.")
      .field("words", &D::words, "In words.");
  ValueClass<Band>(module, "Band", "A curve with what the replicates say of it, point by point.")
      .field("at", &Band::at, "Where: crush [m] or velocity [m/s].")
      .field("value", &Band::value, "Of the model.")
      .field("low", &Band::low, "Lower end of the band.")
      .field("high", &Band::high, "Its upper end.");
}

void bind_result(py::module_& module) {
  using U = Uncertainty;
  ValueClass<U>(module, "Uncertainty", "How far an identification can be believed.")
      .field("outcome", &U::outcome, "'not_run', 'completed' or 'interrupted'.")
      .field("message", &U::message, "In words.")
      .field("resample", &U::resample, "'linearised', 'parametric' or 'block'.")
      .field("level", &U::level, "Probability that intervals and bands stand for.")
      .field("ordinates", &U::ordinates, "An OrdinateUncertainty each.")
      .field("covariance", &U::covariance, "Array of (n, n); NaN where meaningless.")
      .field("correlation", &U::correlation, "Array of (n, n); NaN where meaningless.")
      .field("spectrum", &U::spectrum, "A FisherDirection each, the weakest first.")
      .field("combinations", &U::combinations, "What is determined where single numbers are not, in words.")
      .field("noise_mps2", &U::noise_mps2, "Standard deviation of the acceleration's noise, a test each [m/s^2].")
      .field("correlation_time_s", &U::correlation_time_s, "Beyond which the noise is independent, a test each [s].")
      .field("replicates", &U::replicates, "CrushModels, a row each.")
      .field("failed_replicates", &U::failed_replicates, "Left out.")
      .field("spring", &U::spring, "Band of the spring over crush.")
      .field("damper", &U::damper, "Band of the damper over velocity; with law 'crush_damping' over crush.")
      .field("force", &U::force, "Band of the force over crush along the model's motion [N], a test each.")
      .field("seconds", &U::seconds, "Wall time [s].")
      .result();
}

IdentifyOptions identify_options(const py::object& given) {
  const py::kwargs keywords = given.is_none() ? py::kwargs() : py::kwargs(py::dict(given));
  return options_from<IdentifyOptions>(keywords, "uncertainty: identify");
}

}  // namespace

void bind_uncertainty(py::module_& module) {
  bind_parts(module);
  bind_result(module);
  module.def(
      "uncertainty",
      [](const py::object& pulses, const Identification& fit, const py::object& identify, const py::object& progress,
         const py::kwargs& keywords) {
        const std::vector<Pulse> tests = pulses_of(pulses);
        const IdentifyOptions how = identify_options(identify);
        const auto options = options_from<UncertaintyOptions>(keywords, "uncertainty");
        return watched(progress, [&](const Progress& told) {
          return uncertainty(std::span<const Pulse>(tests), how, fit, options, told);
        });
      },
      py::arg("pulses"), py::arg("fit"), py::kw_only(), py::arg("identify") = py::none(),
      py::arg("progress") = py::none(),
      with_options_doc<UncertaintyOptions>(
          R"(Tells how far an identification can be believed: errors, correlations, replicates, profiles and bands.

Parameters
----------
pulses : Pulse or sequence of Pulse
    What was identified from.
fit : Identification
    What identify() gave.
identify : mapping, optional
    Options that identify() was given: ``{"law": "force"}``.
progress : callable or tqdm bar, optional
    ``progress(done, total)`` is called now and then with the replicates and profiles done; return False to stop. A
    tqdm bar is moved.
**options
    See below.

Returns
-------
Uncertainty

Raises
------
InvalidInput
    On bad options, or an identification that is not usable or not of these pulses and options.
KeyboardInterrupt
    On Ctrl-C.)")
          .c_str());
}

}  // namespace crashsim::python
