#pragma once
/// Equation error: with the measured motion inserted, m a + F(x, v) = 0 is linear in the ordinates.

#include <span>

#include <Eigen/Core>

#include "optimize/fit_objective.hpp"

namespace crashsim {

/// Bounded least-squares solution over all targets, each sample weighted as its acceleration residual.
/// @throws InvalidInput when there are fewer rows than parameters.
Eigen::VectorXd solve_equation_error(const FitStructure& structure, std::span<const FitTarget> targets,
                                     const Eigen::VectorXd& upper, double smooth);

}  // namespace crashsim
