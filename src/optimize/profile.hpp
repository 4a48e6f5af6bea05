#pragma once
/// Profile likelihood: what a parameter may be when all others make the best of it.

#include <functional>
#include <vector>

#include "optimize/linear_fit.hpp"

namespace crashsim {

/// One side of a profile ends where its rise reaches the threshold, or at a bound.
struct Profile {
  std::vector<double> at, rise;  ///< Parameter, and rise of twice the log-likelihood; by increasing parameter.
  double low = kUnset, high = kUnset;
  bool low_open = false, high_open = false;  ///< The rise stays below the threshold up to the bound.
};

/// Profile of parameter `index`. The squared objective of the linear fit, whose errors are correlated, is scaled such
/// that its curvature along the profile is the inverse of the parameter's variance:
///     rise(p) = (min Q - Q^) (J'J)^-1_ii / covariance_ii,   Q the sum of squares, the minimum over the others
/// which for independent errors is Q / sigma^2 and rises by chi^2 with one degree of freedom.
/// @param scale (J'J)^-1_ii / covariance_ii. @param deviation sqrt(covariance_ii), from which the search starts.
/// @param threshold quantile of chi^2. @param go_on false stops the search. @returns no points when it was stopped or
///        could not be done.
Profile profile_of(const FitStudy& study, const LinearFit& fit, std::size_t index, double scale, double deviation,
                   double threshold, const std::function<bool()>& go_on);

}  // namespace crashsim
