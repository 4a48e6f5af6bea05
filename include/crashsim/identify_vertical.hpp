#pragma once
/// Identification of the law of the barrier's vertical force from measured forces and crush.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <crashsim/identify.hpp>
#include <crashsim/options.hpp>
#include <crashsim/time_series.hpp>
#include <crashsim/vertical_force.hpp>

namespace crashsim {

/// Measured forces on the vehicle and its crush, on one clock, each at its own times. They are compared at the vertical
/// force's samples, where the other two are taken as linear between theirs.
struct VerticalForceTarget {
  TimeSeries vertical_force_n;      ///< F_v [N], downward positive.
  TimeSeries longitudinal_force_n;  ///< F_x [N], positive while it stops the vehicle.
  TimeSeries crush_m;               ///< s [m].
};

/// How to identify the law. A list of bounds is in the order of `free`; an empty one, or an unset number in it, means
/// the default: angles within 1 rad, rates within 4 rad over the largest crush, starts up to it, friction up to 2.
struct IdentifyVerticalOptions {
  /// Numbers of VerticalForceLaw to identify, by name or flag; all others are kept as given.
  std::vector<std::string> free = {"angle_rad", "angle_rate_rad_per_m", "friction"};
  std::vector<double> lower;  ///< Lower bounds [SI].
  std::vector<double> upper;  ///< Upper bounds [SI].
  double from_s = kUnset;     ///< Samples from here on are compared [s]; unset: all.
  double to_s = kUnset;       ///< Samples to here are compared [s]; unset: all.
  int starts = 100;           ///< Optimisations from different initial values; start 0 is the given law.
  std::uint64_t seed = 1;
  Loss loss = Loss::l1;
  Algorithm algorithm = Algorithm::lbfgs;
  int jobs = 0;  ///< Threads; 0: all cores. The result does not depend on it.

  bool operator==(const IdentifyVerticalOptions&) const = default;
};
inline constexpr std::array<Field<IdentifyVerticalOptions>, 10> kIdentifyVerticalFields = {{
    {"free", "free", "", "numbers of the law to identify", &IdentifyVerticalOptions::free},
    {"lower", "lower", "", "their lower bounds, in SI units", &IdentifyVerticalOptions::lower},
    {"upper", "upper", "", "their upper bounds, in SI units", &IdentifyVerticalOptions::upper},
    {"from_s", "from", "s", "time of the first sample compared; default the first there is",
     &IdentifyVerticalOptions::from_s},
    {"to_s", "to", "s", "time of the last sample compared; default the last there is", &IdentifyVerticalOptions::to_s},
    {"starts", "starts", "", "number of starts", &IdentifyVerticalOptions::starts, between(1, 1e6)},
    {"seed", "seed", "", "seed of the random starts", &IdentifyVerticalOptions::seed},
    {"loss", "loss", "", "penalty on residuals", choice<&IdentifyVerticalOptions::loss>()},
    {"algorithm", "algorithm", "", "NLopt algorithm", choice<&IdentifyVerticalOptions::algorithm>()},
    {"jobs", "jobs", "", "threads; 0: all cores", &IdentifyVerticalOptions::jobs, between(0, 1024)},
}};
template <>
inline constexpr std::span<const Field<IdentifyVerticalOptions>> fields<IdentifyVerticalOptions>{
    kIdentifyVerticalFields};

/// What an identification of the law gives.
struct VerticalIdentification {
  IdentifyOutcome outcome = IdentifyOutcome::not_run;
  std::string message;
  VerticalForceLaw law;                          ///< The best law.
  double error = kUnset;                         ///< E: mean over samples of loss((law - measured) / max|measured|).
  int samples = 0;                               ///< Compared.
  int limited_samples = 0;                       ///< Of these, where friction bounds the law's force.
  Verdict verdict;                               ///< Of the numbers identified; there is no spring_damper_cosine.
  std::vector<ParameterReport> parameters;       ///< In the order of IdentifyVerticalOptions::free.
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

/// Identifies numbers of the law. Those of `guess` that are not free are kept.
/// @throws InvalidInput on a bad law, series or option, series without common samples in the window, forces or a crush
///         that are nowhere positive, or a bound that is not allowed.
VerticalIdentification identify_vertical(const VerticalForceTarget& target, const VerticalForceLaw& guess = {},
                                         const IdentifyVerticalOptions& options = {}, const Progress& progress = {});

}  // namespace crashsim
