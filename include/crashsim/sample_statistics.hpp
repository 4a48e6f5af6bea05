#pragma once
/// What many samples of a model say: spread, correlations, and Sobol' indices, the parts of an output's variance. What
/// varies by less than 1e-7 of itself, as numbers do by errors of integration, counts as the same.

#include <cstddef>
#include <span>
#include <vector>

#include <crashsim/error.hpp>

namespace crashsim {

/// Spread of one number over the samples that have it; unset where there are too few.
struct SampleStatistics {
  std::size_t count = 0;                            ///< Samples that have it.
  double mean = kUnset, sd = kUnset;                ///< Arithmetic mean; standard deviation, of count - 1.
  double q05 = kUnset, q50 = kUnset, q95 = kUnset;  ///< Quantiles, linear between ordered samples.
  double min = kUnset, max = kUnset;                ///< Smallest and largest.
  std::size_t min_at = 0, max_at = 0;               ///< Where these first are.
};
/// Quantile p, 0..1, of ordered values, at least one, linear between them.
double quantile_of(const std::vector<double>& ordered, double p);

/// Statistics of values; those that are NaN are left out.
SampleStatistics statistics_of(std::span<const double> values);

/// Pearson's correlation coefficient of pairs; unset when one of both does not vary.
double correlation(std::span<const double> x, std::span<const double> y);

/// Ranks from 1; equal values share the mean of theirs. The correlation of ranks is Spearman's.
std::vector<double> ranks_of(std::span<const double> values);

/// Part of the variance of y that its mean at given x explains: first-order Sobol' index from any samples of
/// independent inputs, to about 1 / classes. By means over n^(1/3) classes of equally many samples, less what chance
/// gives them:
///     S = 1 - (1 - SS_between / SS) (n - 1) / (n - classes)
/// @param ranks of x, see ranks_of(). Unset when there are no more samples than classes or y does not vary.
double first_order_index(std::span<const double> ranks, std::span<const double> y);

/// A Sobol' index and its standard error, as independent points would have it.
struct SobolIndex {
  double value = kUnset, error = kUnset;
};
/// Sobol' indices of one input.
struct SobolIndices {
  SobolIndex first_order;  ///< Part of the variance by this input alone, 0..1.
  SobolIndex total;        ///< Part by this input and all that it acts together with.
};
/// Sobol' indices from the outputs of SampleMethod::saltelli, in the order of the samples, by Jansen's estimators:
///     S_i = 1 - mean (f_b - f_i)^2 / 2 V,   T_i = mean (f_a - f_i)^2 / 2 V
/// V is the variance over a and b. Groups in which an output is NaN are left out.
std::vector<SobolIndices> sobol_indices(std::span<const double> outputs, int dimensions);

}  // namespace crashsim
