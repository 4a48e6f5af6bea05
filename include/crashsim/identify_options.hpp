#pragma once
/// How to identify a crush model.

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

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

/// Weights of acceleration, velocity and displacement: 1/(N max|target|) each, the paper's 1 in SI, or three numbers.
enum class Weights { normalised, paper, given };
inline constexpr std::string_view kWeightsNames[] = {"normalised", "paper", "given"};
template <>
inline constexpr std::span<const std::string_view> enum_names<Weights>{kWeightsNames};

/// Where knots are put on [0, C] and [0, v0]: evenly, at quantiles of the samples, or at given fractions of the range.
enum class KnotPlacement { uniform, quantile, given };
inline constexpr std::string_view kKnotPlacementNames[] = {"uniform", "quantile", "given"};
template <>
inline constexpr std::span<const std::string_view> enum_names<KnotPlacement>{kKnotPlacementNames};

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
  int damper_knots = 7;
  /// Given: crush knots [m], the first 0, instead of spring_knots; damper knots at the same fractions of the speed.
  Setting<KnotPlacement> knots;
  IdentifyMethod method = IdentifyMethod::multistart;
  Algorithm algorithm = Algorithm::lbfgs;
  double spring_upper = kUnset;  ///< Upper bound of spring ordinates; unset: from the data.
  double damper_upper = kUnset;  ///< Upper bound of damper ordinates; unset: from the data.
  int jobs = 0;                  ///< Threads; 0: all cores. The result does not depend on it.
  double smooth = 0.0;           ///< Weight of squared second differences of the ordinates.

  bool operator==(const IdentifyOptions&) const = default;
};
inline constexpr std::array<Field<IdentifyOptions>, 15> kIdentifyFields = {{
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
}};
template <>
inline constexpr std::span<const Field<IdentifyOptions>> fields<IdentifyOptions>{kIdentifyFields};

}  // namespace crashsim
