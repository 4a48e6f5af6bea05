#pragma once
/// Bounded minimisation of sums of losses by Gauss and Newton's method with Levenberg and Marquardt's damping.

#include <functional>
#include <span>

#include <Eigen/Core>

#include "optimize/nlopt_minimize.hpp"

namespace crashsim {

/// Value at a point; with its gradient and Gauss-Newton's Hessian unless `gradient` is empty. A value that is not
/// finite marks a point that cannot be used.
using NormalEquations =
    std::function<double(std::span<const double> point, std::span<double> gradient, Eigen::MatrixXd& hessian)>;

/// Minimises over 0 <= p <= 1 from `start`, until a step changes the value by less than `ftol_rel` or for
/// `max_evaluations`. Gives up at once where the start has no finite value.
Minimum minimize_by_gauss_newton(const NormalEquations& function, std::span<const double> start, double ftol_rel,
                                 int max_evaluations);

}  // namespace crashsim
