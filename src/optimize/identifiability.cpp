#include "optimize/identifiability.hpp"

#include <cmath>

#include <Eigen/QR>
#include <Eigen/SVD>

#include <crashsim/error.hpp>

namespace crashsim {
namespace {

using Eigen::Index;

constexpr double kUntouched = 1e-9;      // column norm, relative to the largest scaled by its size
constexpr double kRankTolerance = 1e-8;  // singular value, relative to the largest

}  // namespace

std::vector<bool> touched_columns(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& sizes) {
  const Eigen::VectorXd norms = jacobian.colwise().norm().transpose().cwiseProduct(sizes);
  const double largest = norms.maxCoeff();
  std::vector<bool> touched;
  for (const double norm : norms) touched.push_back(norm > kUntouched * largest);
  return touched;
}

ColumnAnalysis analyse_columns(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& sizes) {
  ColumnAnalysis analysis;
  const std::vector<bool> touched = touched_columns(jacobian, sizes);
  analysis.parameters = touched.size();
  for (std::size_t i = 0; i < touched.size(); ++i)
    if (touched[i]) analysis.determined.push_back(i);
  const auto count = static_cast<Index>(analysis.determined.size());
  if (count == 0) return analysis;
  analysis.columns.resize(jacobian.rows(), count);
  analysis.norms.resize(count);
  for (Index j = 0; j < count; ++j) {
    const auto column = jacobian.col(static_cast<Index>(analysis.determined[static_cast<std::size_t>(j)]));
    analysis.norms[j] = column.norm();
    analysis.columns.col(j) = column / analysis.norms[j];
  }
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(analysis.columns, Eigen::ComputeThinV);
  const Eigen::VectorXd& sigma = svd.singularValues();
  analysis.rank = static_cast<int>((sigma.array() > kRankTolerance * sigma[0]).count());
  analysis.condition = sigma[0] / sigma[count - 1];
  analysis.weakest = svd.matrixV().col(count - 1);
  if (analysis.rank < count) return analysis;
  const Eigen::MatrixXd half = svd.matrixV() * sigma.cwiseInverse().asDiagonal();
  analysis.covariance = half * half.transpose();
  return analysis;
}

Eigen::MatrixXd without_nuisance(const Eigen::MatrixXd& rows, const Eigen::MatrixXd& nuisance) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(nuisance);
  const Eigen::MatrixXd basis = qr.householderQ() * Eigen::MatrixXd::Identity(nuisance.rows(), qr.rank());
  return rows - basis * (basis.transpose() * rows);
}

ParameterErrors errors_of(const ColumnAnalysis& analysis, double residual_variance) {
  const std::size_t n = analysis.parameters;
  ParameterErrors out{std::vector<double>(n, kUnset), {n, std::vector<double>(n, kUnset)}};
  const Eigen::MatrixXd& covariance = analysis.covariance;
  for (Index i = 0; i < covariance.rows(); ++i) {
    const std::size_t row = analysis.determined[static_cast<std::size_t>(i)];
    out.standard_errors[row] = std::sqrt(residual_variance * covariance(i, i)) / analysis.norms[i];
    for (Index j = 0; j < covariance.cols(); ++j)
      out.correlation[row][analysis.determined[static_cast<std::size_t>(j)]] =
          covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j));
  }
  return out;
}

}  // namespace crashsim
