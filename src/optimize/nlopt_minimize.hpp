#pragma once
/// Bounded minimisation, also under constraints, by NLopt.

#include <cstddef>
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

/// Objective, then constraints g <= 0, at a point. Fills their gradients, a row of the point's length each, unless that
/// array is empty. An objective that is not finite marks a point that cannot be used.
using ConstrainedFunction =
    std::function<void(std::span<const double> point, std::span<double> values, std::span<double> gradients)>;

enum class ConstrainedAlgorithm {
  slsqp,  ///< With gradients.
  cobyla  ///< Without: comes near the bottom of a kink, where gradients mislead.
};

struct ConstrainedMinimum {
  std::vector<double> point;  ///< Best point seen: the lowest that keeps the constraints, else the nearest to it.
  double value = kUnset;
  double violation = kUnset;  ///< Largest constraint there; <= 0: all are kept. Without constraints: 0.
  int evaluations = 0;
};

/// Whether `a` is better: keeps the constraints at a lower value, or violates them less.
bool is_better(const ConstrainedMinimum& a, const ConstrainedMinimum& b);

/// The same under constraints; the search keeps a margin of 1e-7 from them, so that rounding does not break them.
/// @param initial_step of the algorithm without gradients, in units of the box.
ConstrainedMinimum minimize_constrained(ConstrainedAlgorithm algorithm, const ConstrainedFunction& function,
                                        std::size_t constraints, std::span<const double> start, double ftol_rel,
                                        int max_evaluations, double initial_step = 0.1);

}  // namespace crashsim
