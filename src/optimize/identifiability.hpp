#pragma once
/// What a matrix of sensitivities says about the parameters: which are determined, how well, and which combination is
/// not.

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace crashsim {

/// Which columns of a matrix are not negligible, each scaled by the size of its parameter.
std::vector<bool> touched_columns(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& sizes);

/// A matrix of sensitivities with columns of unit length, those that are zero left out.
struct ColumnAnalysis {
  std::size_t parameters = 0;           ///< Columns of the whole matrix.
  std::vector<std::size_t> determined;  ///< Columns that are not zero. All that follows is of these, in this order.
  Eigen::MatrixXd columns;              ///< Of unit length.
  Eigen::VectorXd norms;                ///< Before.
  int rank = 0;                         ///< Numerical rank.
  double condition = 0.0;               ///< Largest over smallest singular value.
  Eigen::VectorXd weakest;              ///< Combination of unit length that changes the rows least.
  Eigen::MatrixXd covariance;           ///< (columns' columns)^-1, empty when the rank is deficient.

  [[nodiscard]] bool has_full_rank() const { return rank == static_cast<int>(determined.size()); }
};

/// @param sizes of the parameters, by which columns are compared.
ColumnAnalysis analyse_columns(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& sizes);

/// Rows without what the columns of `nuisance` can make of them: what they then say of their parameters is what is left
/// when the nuisance is unknown, too.
Eigen::MatrixXd without_nuisance(const Eigen::MatrixXd& rows, const Eigen::MatrixXd& nuisance);

/// Standard errors and correlations of all parameters; unset for those that are not determined.
struct ParameterErrors {
  std::vector<double> standard_errors;
  std::vector<std::vector<double>> correlation;
};

/// @param residual_variance of the scaled residuals that the rows belong to.
ParameterErrors errors_of(const ColumnAnalysis& analysis, double residual_variance);

}  // namespace crashsim
