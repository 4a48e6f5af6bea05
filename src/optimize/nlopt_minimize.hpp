#pragma once
/// Bounded minimisation with gradients, by NLopt.

#include <functional>
#include <span>
#include <vector>

#include <crashsim/identify_options.hpp>

namespace crashsim {

/// Value at a point; fills the gradient. Both arrays have the length of the start.
using GradientFunction = std::function<double(std::span<const double>, std::span<double>)>;

struct Minimum {
  std::vector<double> point;  ///< Best point seen.
  double value = kUnset;
  int evaluations = 0;
};

/// Minimises over 0 <= p <= 1 from `start`, until the value changes by less than `ftol_rel` or `max_evaluations`.
/// Gives up at once where the start has no finite value. What the function throws is thrown again here. @throws
/// NumericalFailure when NLopt refuses the problem.
Minimum minimize_in_unit_box(Algorithm algorithm, const GradientFunction& function, std::span<const double> start,
                             double ftol_rel, int max_evaluations);

}  // namespace crashsim
