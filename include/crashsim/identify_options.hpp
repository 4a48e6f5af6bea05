#pragma once
/// How to identify a crush model.

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <crashsim/crush_model.hpp>
#include <crashsim/error.hpp>
#include <crashsim/options.hpp>

namespace crashsim {

/// Penalty on a weighted residual r (normalised: relative to its channel's maximum): |r|, r^2, or Huber's
/// (|r| > 0.05: |r| - 0.025, else 10 r^2).
enum class Loss { l1, l2, huber };
inline constexpr std::string_view kLossNames[] = {"l1", "l2", "huber"};
template <>
inline constexpr std::span<const std::string_view> enum_names<Loss>{kLossNames};

/// Weights of acceleration, velocity and displacement: 1/(N max|target|) each, the paper's 1 in SI, or three numbers,
/// of all tests or of each in turn.
enum class Weights { normalised, paper, given };
inline constexpr std::string_view kWeightsNames[] = {"normalised", "paper", "given"};
template <>
inline constexpr std::span<const std::string_view> enum_names<Weights>{kWeightsNames};

/// Where knots are put on [0, C] and [0, v0]: evenly, at quantiles of the samples, where they fit best (each within 45
/// % of the way from its even place to the next), or at given fractions of the range.
enum class KnotPlacement { uniform, quantile, free, given };
inline constexpr std::string_view kKnotPlacementNames[] = {"uniform", "quantile", "free", "given"};
template <>
inline constexpr std::span<const std::string_view> enum_names<KnotPlacement>{kKnotPlacementNames};

/// Curves between knots: lines, or monotone cubics (PCHIP), which the model holds as tables of eight lines a cubic.
enum class Curve { linear, pchip };
inline constexpr std::string_view kCurveNames[] = {"linear", "pchip"};
template <>
inline constexpr std::span<const std::string_view> enum_names<Curve>{kCurveNames};

/// Weight of the smoothing: the number `smooth`, or chosen from the data by generalised cross-validation or at the
/// corner of the L-curve of the equation error.
enum class Smoothing { fixed, gcv, l_curve };
inline constexpr std::string_view kSmoothingNames[] = {"fixed", "gcv", "l-curve"};
template <>
inline constexpr std::span<const std::string_view> enum_names<Smoothing>{kSmoothingNames};

/// Multistart optimisation of the output error, or the linear least-squares problem in the measured motion.
enum class IdentifyMethod { multistart, equation_error };
inline constexpr std::string_view kIdentifyMethodNames[] = {"multistart", "equation-error"};
template <>
inline constexpr std::span<const std::string_view> enum_names<IdentifyMethod>{kIdentifyMethodNames};

/// NLopt's gradient-based algorithms that handle bounds.
enum class Algorithm { lbfgs, slsqp, tnewton, var2 };
inline constexpr std::string_view kAlgorithmNames[] = {"lbfgs", "slsqp", "tnewton", "var2"};
template <>
inline constexpr std::span<const std::string_view> enum_names<Algorithm>{kAlgorithmNames};
inline constexpr NameAlias kAlgorithmAliases[] = {
    {"LD_LBFGS", 0}, {"LD_SLSQP", 1}, {"LD_TNEWTON_PRECOND_RESTART", 2}, {"LD_VAR2", 3}};  ///< NLopt's own names.
template <>
inline constexpr std::span<const NameAlias> enum_aliases<Algorithm>{kAlgorithmAliases};

/// How to identify.
struct IdentifyOptions {
  double mass_kg = kUnset;  ///< Unset: the pulse's.
  int starts = 100;         ///< Optimisations from different initial values; start 0 is the equation-error solution.
  std::uint64_t seed = 1;
  Loss loss = Loss::l1;
  Setting<Weights> weights;
  CrushLaw law = CrushLaw::stiffness;
  int spring_knots = 7;
  int damper_knots = 7;  ///< Law `rate` has none.
  /// Given: crush knots [m], the first 0, instead of spring_knots; damper knots at the same fractions of their range.
  Setting<KnotPlacement> knots;
  IdentifyMethod method = IdentifyMethod::multistart;
  Algorithm algorithm = Algorithm::lbfgs;
  double spring_upper = kUnset;  ///< Upper bound of spring ordinates; unset: from the data.
  double damper_upper = kUnset;  ///< Upper bound of damper ordinates; unset: from the data.
  int jobs = 0;                  ///< Threads; 0: all cores. The result does not depend on it.
  double smooth = 0.0;           ///< Weight of squared second differences of the ordinates.
  Smoothing smoothing = Smoothing::fixed;
  Curve curve = Curve::linear;
  double reference_speed_mps = 1.0;  ///< v_ref of law `rate`.
  double rate_upper = kUnset;        ///< Upper bound of its r; unset: the rate may treble the force.
  std::vector<double> test_weights;  ///< One a test; empty: equal.
  // Errors of each test's accelerometer that are sought with the ordinates: the deviation expected of each; 0: none.
  double time_shift_deviation_s = 0.0;
  double gain_deviation = 0.0;
  double bias_deviation_mps2 = 0.0;
  // What is known of the ordinates beforehand.
  std::vector<double> spring_prior;  ///< One an ordinate, or one for all; empty: nothing.
  std::vector<double> damper_prior;
  double prior_deviation = 0.3;  ///< Expected of them, of each curve's largest.

  bool operator==(const IdentifyOptions&) const = default;
};
inline constexpr std::array<Field<IdentifyOptions>, 26> kIdentifyFields = {{
    {"mass_kg", "mass", "kg", "test mass; default: the pulse's", &IdentifyOptions::mass_kg, positive()},
    {"starts", "starts", "", "number of starts", &IdentifyOptions::starts, between(1, 1e6)},
    {"seed", "seed", "", "seed of the random starts", &IdentifyOptions::seed},
    {"loss", "loss", "", "penalty on residuals", choice<&IdentifyOptions::loss>()},
    {"weights", "weights", "", "weights of acceleration, velocity, displacement", setting<&IdentifyOptions::weights>()},
    {"law", "law", "", "what the spring's ordinates are", choice<&IdentifyOptions::law>()},
    {"spring_knots", "spring-knots", "", "knots of the spring; 0: no spring", &IdentifyOptions::spring_knots,
     between(0, 100)},
    {"damper_knots", "damper-knots", "", "knots of the damper; 0: no damper", &IdentifyOptions::damper_knots,
     between(0, 100)},
    {"knots", "knots", "m", "placement of the knots: uniform, quantile, or the spring's (dampers alike)",
     setting<&IdentifyOptions::knots>()},
    {"method", "method", "", "multistart optimisation, or equation error alone", choice<&IdentifyOptions::method>()},
    {"algorithm", "algorithm", "", "NLopt algorithm", choice<&IdentifyOptions::algorithm>()},
    {"spring_upper", "spring-upper", "", "upper bound of spring ordinates [N/m or N]; default from the data",
     &IdentifyOptions::spring_upper, positive()},
    {"damper_upper", "damper-upper", "", "upper bound of damper ordinates [N s/m]; default from the data",
     &IdentifyOptions::damper_upper, positive()},
    {"jobs", "jobs", "", "threads; 0: all cores", &IdentifyOptions::jobs, between(0, 1024)},
    {"smooth", "smooth", "", "weight of squared second differences of the ordinates", &IdentifyOptions::smooth,
     at_least(0.0)},
    {"smoothing", "smoothing", "", "how that weight is chosen", choice<&IdentifyOptions::smoothing>()},
    {"curve", "curve", "", "curves between knots", choice<&IdentifyOptions::curve>()},
    {"reference_speed_mps", "reference-speed", "m/s", "v_ref of law rate", &IdentifyOptions::reference_speed_mps,
     positive()},
    {"rate_upper", "rate-upper", "", "upper bound of the coefficient of law rate; default: the rate trebles the force",
     &IdentifyOptions::rate_upper, positive()},
    {"test_weights", "test-weights", "", "weights of the tests, one each; default equal",
     &IdentifyOptions::test_weights},
    {"time_shift_deviation_s", "time-shift", "s", "expected error of a test's time zero; 0: not sought",
     &IdentifyOptions::time_shift_deviation_s, at_least(0.0)},
    {"gain_deviation", "gain", "", "expected relative error of a test's accelerations; 0: not sought",
     &IdentifyOptions::gain_deviation, at_least(0.0)},
    {"bias_deviation_mps2", "bias", "m/s^2", "expected offset of a test's accelerations; 0: not sought",
     &IdentifyOptions::bias_deviation_mps2, at_least(0.0)},
    {"spring_prior", "spring-prior", "", "spring ordinates known beforehand [N/m or N], one each or one for all",
     &IdentifyOptions::spring_prior},
    {"damper_prior", "damper-prior", "", "damper ordinates known beforehand [N s/m], one each or one for all",
     &IdentifyOptions::damper_prior},
    {"prior_deviation", "prior-deviation", "", "deviation expected of them, of each curve's largest",
     &IdentifyOptions::prior_deviation, positive()},
}};
template <>
inline constexpr std::span<const Field<IdentifyOptions>> fields<IdentifyOptions>{kIdentifyFields};

}  // namespace crashsim
