#pragma once
/// Identification of a crush model from pulses, [Noorsumar2021] eq. (4).

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <crashsim/crush_model.hpp>
#include <crashsim/error.hpp>
#include <crashsim/identify_options.hpp>
#include <crashsim/options.hpp>
#include <crashsim/pulse.hpp>

namespace crashsim {

/// Sum of the channels' errors, [Noorsumar2021] eq. (4).
struct FitError {
  double total = kUnset;
  double accel = kUnset, velocity = kUnset, displacement = kUnset;
};

/// How far the ordinates can be believed.
struct Verdict {
  bool identifiable = false;
  int rank = 0;                          ///< Numerical rank of the sensitivity matrix.
  double condition = kUnset;             ///< Condition number with columns scaled to unit length.
  double spring_damper_cosine = kUnset;  ///< Largest cosine between the spring's and the damper's column spaces.
  std::string message;                   ///< In words.
};

/// What a number of the result belongs to.
enum class FittedPart { spring, damper, rate, spring_knot, damper_knot };
inline constexpr std::string_view kFittedPartNames[] = {"spring", "damper", "rate", "spring_knot", "damper_knot"};
template <>
inline constexpr std::span<const std::string_view> enum_names<FittedPart>{kFittedPartNames};

/// One number of the result: ordinates of the spring, then of the damper, r of law `rate`, free knots.
struct OrdinateReport {
  std::string name;  ///< "k1".."kn", "c1".."cn", "r", "x2".."x(n-1)", "v2".. (law `crush_damping`: "d2"..).
  FittedPart part = FittedPart::spring;
  double value = kUnset;  ///< [N/m], [N], [N s/m], [-], [m] or [m/s].
  /// By noise of the acceleration that velocity and displacement share, see Uncertainty; unset where it is held at a
  /// bound or the data say nothing about it.
  double standard_error = kUnset;
  double upper_bound = kUnset;
  bool untouched = false;  ///< No sample depends on it: not fitted, but held as the nearest fitted one.
  bool at_bound = false;   ///< At a bound, 0 or the upper.
};

/// One number of a model that is identified as it is.
struct ParameterReport {
  std::string name;                ///< Of the model's field.
  std::string unit;                ///< SI symbol.
  double value = kUnset;           ///< [unit].
  double standard_error = kUnset;  ///< Unset when the data say nothing about it.
  double lower_bound = kUnset, upper_bound = kUnset;
  bool untouched = false;  ///< No sample depends on it.
  bool at_bound = false;
};

/// One start.
struct StartReport {
  double error = kUnset;  ///< E reached; infinite when it failed.
  int evaluations = 0;
  bool failed = false;
};

/// One test of the fit: what of it was fitted, and the errors of its accelerometer that were found.
struct TestReport {
  double impact_speed_mps = kUnset, mass_kg = kUnset, max_crush_m = kUnset, t_m_s = kUnset;  ///< Measured.
  double weight = 1.0;  ///< In E, whose mean weight is 1.
  FitError error;       ///< Of this test.
  // measured(t) = gain * true(t - time_shift) + bias, with standard errors; unset where not sought.
  double time_shift_s = kUnset, gain = kUnset, bias_mps2 = kUnset;
  double time_shift_error_s = kUnset, gain_error = kUnset, bias_error_mps2 = kUnset;
};

/// How an identification ended.
enum class IdentifyOutcome { not_run, completed, no_max_crush, interrupted, every_start_failed, engines_disagree };
inline constexpr std::string_view kIdentifyOutcomeNames[] = {"not_run",     "completed",          "no_max_crush",
                                                             "interrupted", "every_start_failed", "engines_disagree"};
template <>
inline constexpr std::span<const std::string_view> enum_names<IdentifyOutcome>{kIdentifyOutcomeNames};

/// What an identification gives.
struct Identification {
  IdentifyOutcome outcome = IdentifyOutcome::not_run;
  std::string message;
  CrushModel model;  ///< The best model.
  FitError error;    ///< Its E, from the model as CVODE simulates it.
  Verdict verdict;
  std::vector<OrdinateReport> ordinates;
  std::vector<TestReport> tests;
  double smooth = kUnset;                        ///< Weight of the smoothing: as given, or as chosen from the data.
  std::vector<std::vector<double>> correlation;  ///< Between ordinates, in their order; unset where meaningless.
  std::vector<StartReport> starts;
  int starts_at_best = 0;   ///< Starts with E within 0.1 % of the best.
  long evaluations = 0;     ///< Of the objective, with its derivatives; the best start goes on beyond its own.
  double seconds = kUnset;  ///< Wall time.
  std::uint64_t seed = 0;
  std::vector<std::string> warnings;

  [[nodiscard]] bool usable() const { return outcome == IdentifyOutcome::completed; }
  [[nodiscard]] std::string brief_report() const;
};

/// Called now and then from the calling thread with starts done and planned; false stops the identification.
using Progress = std::function<bool(int done, int total)>;

/// Identifies spring and damper from pulses of one structure.
/// A pulse without t_m gives the outcome `no_max_crush`.
/// @throws InvalidInput on bad options, or a pulse without mass.
Identification identify(std::span<const Pulse> pulses, const IdentifyOptions& options = {},
                        const Progress& progress = {});
Identification identify(const Pulse& pulse, const IdentifyOptions& options = {}, const Progress& progress = {});

/// identify() by the equation error alone: microseconds, and for ordinates between given knots the one best solution.
Identification equation_error(std::span<const Pulse> pulses, IdentifyOptions options = {});

/// E of a model against a pulse over the pulse's own samples 0..t_m, simulated by CVODE.
FitError fit_error(const CrushModel& model, const Pulse& pulse, const Setting<Weights>& weights = {},
                   Loss loss = Loss::l1);

}  // namespace crashsim
