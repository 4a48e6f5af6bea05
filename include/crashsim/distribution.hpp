#pragma once
/// How a number varies: distributions by their quantiles.

#include <string_view>
#include <vector>

#include <crashsim/error.hpp>
#include <crashsim/options.hpp>

namespace crashsim {

enum class DistributionKind {
  normal,      ///< Mean, standard deviation.
  lognormal,   ///< Mean, standard deviation; of the number itself, not of its logarithm.
  uniform,     ///< Least, largest.
  triangular,  ///< Least, most likely, largest.
  table        ///< Each number of a list, as often as its weight says.
};
inline constexpr std::string_view kDistributionKindNames[] = {"normal", "lognormal", "uniform", "triangular", "table"};
template <>
inline constexpr std::span<const std::string_view> enum_names<DistributionKind>{kDistributionKindNames};

/// A distribution with its numbers.
struct Distribution {
  DistributionKind kind = DistributionKind::normal;
  std::vector<double> numbers = {};       ///< As `kind` says.
  std::vector<double> weights = {};       ///< Of a table, >= 0; empty: all the same.
  double lower = kUnset, upper = kUnset;  ///< Ends where it is cut off, of normal and lognormal; unset: none.
};

/// @throws InvalidInput naming `what`, the number and the rule.
void validate(const Distribution& distribution, std::string_view what);

/// Number below which the distribution has the probability `p`, inside (0, 1).
double quantile(const Distribution& distribution, double p);

/// Quantile of the standard normal distribution, p inside (0, 1).
double normal_quantile(double p);

}  // namespace crashsim
