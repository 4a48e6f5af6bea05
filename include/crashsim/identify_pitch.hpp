#pragma once
/// Identification of a heave-pitch model from the measured motion of the body: the second next step of
/// [Noorsumar2021].

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <crashsim/heave_pitch_model.hpp>
#include <crashsim/identify.hpp>
#include <crashsim/simulate_pitch.hpp>
#include <crashsim/time_series.hpp>

namespace crashsim {

/// Measured motion on the forcing's clock, each channel at its own times; samples before the motion starts are not
/// compared. At least one channel is needed.
struct PitchTarget {
  TimeSeries heave_m;             ///< z, up positive, from static equilibrium [m].
  TimeSeries pitch_rad;           ///< theta, nose-down positive [rad].
  TimeSeries heave_velocity_mps;  ///< z' [m/s].
  TimeSeries pitch_rate_radps;    ///< theta' [rad/s].
};

/// How to identify a heave-pitch model. A list of bounds is in the order of `free`; an empty one, or an unset number in
/// it, means the default: a factor of 20 either way for stiffness and damping, 5 for mass and inertia, 4 for the axles'
/// distances; a range of its own where the given model has no such number or 0, for the force's arm and for heights.
struct IdentifyPitchOptions {
  /// Numbers of HeavePitchModel to identify, by name or flag; all others are kept as given.
  std::vector<std::string> free = {"front_stiffness_n_per_m", "rear_stiffness_n_per_m", "front_damping_ns_per_m",
                                   "rear_damping_ns_per_m"};
  std::vector<double> lower;  ///< Lower bounds [SI].
  std::vector<double> upper;  ///< Upper bounds [SI].
  double from_s = kUnset;     ///< Samples from here on are compared [s]; unset: from the start of the motion.
  double to_s = kUnset;       ///< Samples to here are compared [s]; unset: all.
  int starts = 100;           ///< Optimisations from different initial values; start 0 is the given model.
  std::uint64_t seed = 1;
  Loss loss = Loss::l1;
  Algorithm algorithm = Algorithm::lbfgs;
  int jobs = 0;  ///< Threads; 0: all cores. The result does not depend on it.

  bool operator==(const IdentifyPitchOptions&) const = default;
};
inline constexpr std::array<Field<IdentifyPitchOptions>, 10> kIdentifyPitchFields = {{
    {"free", "free", "", "numbers of the heave-pitch model to identify", &IdentifyPitchOptions::free},
    {"lower", "lower", "", "their lower bounds, in SI units; default around the given model",
     &IdentifyPitchOptions::lower},
    {"upper", "upper", "", "their upper bounds, in SI units; default around the given model",
     &IdentifyPitchOptions::upper},
    {"from_s", "from", "s", "time of the first sample compared; default the start of the motion",
     &IdentifyPitchOptions::from_s},
    {"to_s", "to", "s", "time of the last sample compared; default the last there is", &IdentifyPitchOptions::to_s},
    {"starts", "starts", "", "number of starts", &IdentifyPitchOptions::starts, between(1, 1e6)},
    {"seed", "seed", "", "seed of the random starts", &IdentifyPitchOptions::seed},
    {"loss", "loss", "", "penalty on residuals", choice<&IdentifyPitchOptions::loss>()},
    {"algorithm", "algorithm", "", "NLopt algorithm", choice<&IdentifyPitchOptions::algorithm>()},
    {"jobs", "jobs", "", "threads; 0: all cores", &IdentifyPitchOptions::jobs, between(0, 1024)},
}};
template <>
inline constexpr std::span<const Field<IdentifyPitchOptions>> fields<IdentifyPitchOptions>{kIdentifyPitchFields};

/// E: sum over the channels given of the mean over samples of loss((model - target) / max|target|).
struct PitchFitError {
  double total = kUnset;
  double heave = kUnset, pitch = kUnset, heave_velocity = kUnset, pitch_rate = kUnset;  ///< Unset when not given.
};

/// What an identification of a heave-pitch model gives.
struct PitchIdentification {
  IdentifyOutcome outcome = IdentifyOutcome::not_run;
  std::string message;
  HeavePitchModel model;                         ///< The best model.
  PitchFitError error;                           ///< Its E, as the engine of PitchOptions simulates it.
  Verdict verdict;                               ///< Of the numbers identified; there is no spring_damper_cosine.
  std::vector<ParameterReport> parameters;       ///< In the order of IdentifyPitchOptions::free.
  std::vector<std::vector<double>> correlation;  ///< Between parameters, in their order; unset where meaningless.
  std::vector<StartReport> starts;
  int starts_at_best = 0;   ///< Starts with E within 0.1 % of the best, or 1e-9.
  long evaluations = 0;     ///< Of the objective, with gradient.
  double seconds = kUnset;  ///< Wall time.
  std::uint64_t seed = 0;
  std::vector<std::string> warnings;

  [[nodiscard]] bool usable() const { return outcome == IdentifyOutcome::completed; }
  [[nodiscard]] std::string brief_report() const;
};

/// Identifies numbers of a heave-pitch model. The model's motion and its sensitivities are exact at the target's own
/// samples, for forces that are linear between theirs. `simulation` says when and from which state the motion starts
/// and which engine gives the error of record; its end, when set, ends the comparison, too.
/// @throws InvalidInput on a bad model, series or option, a target without samples in the window, or a bound that is
///         not allowed.
PitchIdentification identify_pitch(const HeavePitchModel& guess, const PitchForcing& forcing, const PitchTarget& target,
                                   const PitchOptions& simulation = {}, const IdentifyPitchOptions& options = {},
                                   const Progress& progress = {});

}  // namespace crashsim
