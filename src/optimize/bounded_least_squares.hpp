#pragma once
/// Linear least squares with bounds.

#include <Eigen/Core>

namespace crashsim {

/// Minimises |A p - b|^2 over 0 <= p <= upper by the active-set method of Lawson and Hanson, extended to upper bounds
/// (Stark and Parker, BVLS). Rank-deficient columns stay at 0.
/// @throws NumericalFailure when it does not converge.
Eigen::VectorXd bounded_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, const Eigen::VectorXd& upper);

}  // namespace crashsim
