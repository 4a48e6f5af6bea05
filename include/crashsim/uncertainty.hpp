#pragma once
/// How far an identified crush model can be believed: errors, correlations, replicates, profiles and bands.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <crashsim/identify.hpp>
#include <crashsim/simulate_many.hpp>

namespace crashsim {

/// How replicates of the fit are made.
///     linearised   draws of the linear problem at the solution, inside the bounds: microseconds each
///     parametric   noise of the estimated process on the model's own motion, fitted again
///     block        blocks of the residual in random order on it, fitted again
enum class Resample { linearised, parametric, block };
inline constexpr std::string_view kResampleNames[] = {"linearised", "parametric", "block"};
template <>
inline constexpr std::span<const std::string_view> enum_names<Resample>{kResampleNames};

/// How to tell the uncertainty of an identification.
struct UncertaintyOptions {
  Resample resample = Resample::linearised;
  int replicates = 200;  ///< 0: none, and no bands.
  double level = 0.95;   ///< Of intervals and bands.
  bool profile = false;  ///< Also profile likelihoods, which cost some hundred simulations an ordinate.
  int block = 0;         ///< Samples in a block; 0: twice the residual's correlation lag, at least n^(1/3).
  std::uint64_t seed = 1;
  int jobs = 0;  ///< Threads; 0: all cores. The result does not depend on it.

  bool operator==(const UncertaintyOptions&) const = default;
};
inline constexpr std::array<Field<UncertaintyOptions>, 7> kUncertaintyFields = {{
    {"resample", "resample", "", "how replicates of the fit are made", choice<&UncertaintyOptions::resample>()},
    {"replicates", "replicates", "", "replicates of the fit, for bands; 0: none", &UncertaintyOptions::replicates,
     between(0, 1e5)},
    {"level", "level", "", "probability that intervals and bands stand for", &UncertaintyOptions::level,
     between(0.5, 0.9999)},
    {"profile", "profile", "", "also profile likelihoods of the ordinates", &UncertaintyOptions::profile},
    {"block", "block", "", "samples in a block of the bootstrap; 0: from the residual's correlation",
     &UncertaintyOptions::block, between(0, 1e6)},
    {"seed", "seed", "", "seed of the replicates", &UncertaintyOptions::seed},
    {"jobs", "jobs", "", "threads; 0: all cores", &UncertaintyOptions::jobs, between(0, 1024)},
}};
template <>
inline constexpr std::span<const Field<UncertaintyOptions>> fields<UncertaintyOptions>{kUncertaintyFields};

/// What the errors of an ordinate stand on.
enum class OrdinateState { free, at_bound, untouched, undetermined };
inline constexpr std::string_view kOrdinateStateNames[] = {"free", "at_bound", "untouched", "undetermined"};
template <>
inline constexpr std::span<const std::string_view> enum_names<OrdinateState>{kOrdinateStateNames};

/// One number of the fit, in the order of Identification.ordinates.
struct OrdinateUncertainty {
  std::string name;                           ///< "k1".."kn", "c1".."cn".
  double value = kUnset;                      ///< [N/m], [N] or [N s/m].
  OrdinateState state = OrdinateState::free;  ///< Held at a bound or by no sample: the others' errors take it as it is.
  double standard_error = kUnset;             ///< Unset unless `free`.
  double low = kUnset, high = kUnset;  ///< Interval: value -+ z errors inside the bounds; of the replicates where held.
  double profile_low = kUnset, profile_high = kUnset;        ///< Of the profile likelihood; the bound where it is open.
  bool profile_low_open = false, profile_high_open = false;  ///< Up to the bound nothing speaks against it.
  std::vector<double> profile_at, profile_rise;              ///< The profile: ordinate, and rise of 2 ln likelihood.
};

/// A direction in the space of ordinates.
struct FisherDirection {
  double singular_value = kUnset;  ///< Of the sensitivities to relative changes, relative to the largest.
  double relative_error = kUnset;  ///< Standard error along it, relative to the ordinates.
  double error_change = kUnset;    ///< What `change` does to E, to second order.
  std::vector<double> change;      ///< Relative changes of all ordinates, the largest 10 %.
  std::string words;  ///< "k3 and c5 trade off: raising k3 by 10 % and lowering c5 by 7 % changes E by ..".
};

/// A curve with what the replicates say of it, point by point.
struct Band {
  std::vector<double> at, value, low, high;
};

enum class UncertaintyOutcome { not_run, completed, interrupted };
inline constexpr std::string_view kUncertaintyOutcomeNames[] = {"not_run", "completed", "interrupted"};
template <>
inline constexpr std::span<const std::string_view> enum_names<UncertaintyOutcome>{kUncertaintyOutcomeNames};

/// What is known of an identification's errors. The noise is that of the measured acceleration, a stationary process
/// estimated from its residual; velocity and displacement, its integrals, share it:
///     covariance = A^-1 B A^-1,   A = J'WJ + smoothing and priors,   B = (S'WJ)' Gamma (S'WJ),   S = [1, C, C^2]
/// with C the running integral. Of the losses l1 and huber W holds the parabolas that have the same expected slope for
/// normal residuals of each channel's size. Errors of the tests that were sought are taken as unknown, except in
/// replicates that are fitted again. What a model cannot follow is taken for noise.
struct Uncertainty {
  UncertaintyOutcome outcome = UncertaintyOutcome::not_run;
  std::string message;
  Resample resample = Resample::linearised;
  double level = kUnset;
  std::vector<OrdinateUncertainty> ordinates;
  std::vector<std::vector<double>> covariance, correlation;  ///< In the ordinates' order; unset where meaningless.
  std::vector<FisherDirection> spectrum;                     ///< The weakest direction first.
  std::vector<std::string> combinations;   ///< What is determined where single ordinates are not, in words.
  std::vector<double> noise_mps2;          ///< Standard deviation of the acceleration's noise, a test each [m/s^2].
  std::vector<double> correlation_time_s;  ///< Beyond which the noise is independent, a test each [s].
  CrushModels replicates;                  ///< A row each; none without.
  int failed_replicates = 0;               ///< Left out.
  Band spring, damper;                     ///< k(x) over [m] and c(v) over [m/s].
  std::vector<Band> force;                 ///< F over crush [m] along the model's motion in each test [N].
  double seconds = kUnset;                 ///< Wall time.

  [[nodiscard]] bool usable() const { return outcome == UncertaintyOutcome::completed; }
  [[nodiscard]] std::string brief_report() const;
};

/// Uncertainty of what identify() gave for the same pulses and options.
/// @throws InvalidInput on a bad option, or when the identification is not usable or not of these pulses and options.
Uncertainty uncertainty(std::span<const Pulse> pulses, const IdentifyOptions& how, const Identification& fit,
                        const UncertaintyOptions& options = {}, const Progress& progress = {});

/// Number of replicates in an ensemble; 0 for one that has no arrays.
std::size_t replicate_count(const CrushModels& replicates);

}  // namespace crashsim
