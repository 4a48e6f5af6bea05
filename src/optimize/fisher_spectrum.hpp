#pragma once
/// Which combinations of ordinates a fit determines, and which it does not, in words.

#include <string>
#include <vector>

#include <Eigen/Core>

#include <crashsim/uncertainty.hpp>

#include "optimize/linear_fit.hpp"

namespace crashsim {

/// Standard deviation, relative to a parameter's size, from which it counts as not determined.
inline constexpr double kNotDetermined = 0.2;

/// What relative changes of parameters are relative to: the value, or a tenth of the largest of its curve.
Eigen::VectorXd sizes_of(const Eigen::VectorXd& theta, const std::vector<std::string>& names);

/// Singular values and directions of the sensitivities to relative changes of the free parameters, the weakest first.
/// @param error E at the solution.
std::vector<FisherDirection> fisher_spectrum(const LinearFit& fit, const Eigen::MatrixXd& covariance,
                                             const std::vector<std::string>& names, double error);

/// Sums of two parameters that are determined though one of them alone is not, in words.
std::vector<std::string> determined_sums(const LinearFit& fit, const Eigen::MatrixXd& covariance,
                                         const std::vector<std::string>& names);

}  // namespace crashsim
