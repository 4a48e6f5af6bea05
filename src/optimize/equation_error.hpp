#pragma once
/// Equation error: the force law with the measured motion inserted, least squares in the parameters.

#include <span>

#include <Eigen/Core>

#include "optimize/fit_force.hpp"
#include "optimize/fit_penalties.hpp"
#include "optimize/fit_target.hpp"

namespace crashsim {

/// The weighted force residuals of all samples, F(x, v) + m a, at given parameters, and their derivatives by them.
struct ForceResiduals {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;
};
ForceResiduals force_residuals(const FitStructure& structure, std::span<const FitTarget> targets,
                               std::span<const double> parameters);

/// |rows p - rhs|^2 + smooth |roughness p|^2 is what a solution makes least; about the first guess where the force is
/// not linear in the parameters.
struct EquationErrorSystem {
  Eigen::MatrixXd rows;       ///< A sample each, over all targets, weighted as its acceleration residual.
  Eigen::VectorXd rhs;        ///< Their measured force, weighted alike.
  Eigen::MatrixXd roughness;  ///< Second differences of each curve's ordinates.
};
/// @throws InvalidInput with fewer samples than parameters.
EquationErrorSystem assemble_equation_error(const FitStructure& structure, std::span<const FitTarget> targets,
                                            const Eigen::VectorXd& upper);

/// Parameters within 0..upper that leave the least sum of squared force residuals and penalties: of ordinates between
/// given knots at once, for the force is linear in them; of r, free knots and PCHIP curves by Gauss and Newton's steps.
/// @throws InvalidInput with fewer samples than parameters.
Eigen::VectorXd solve_equation_error(const FitStructure& structure, std::span<const FitTarget> targets,
                                     const Eigen::VectorXd& upper, double smooth, const Prior& prior = {});

}  // namespace crashsim
