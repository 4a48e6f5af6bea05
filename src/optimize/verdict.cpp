#include "optimize/verdict.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace crashsim {
namespace {

using Eigen::Index;

constexpr double kUntouched = 1e-9;        // column norm, relative to the largest scaled by its bound
constexpr double kRankTolerance = 1e-8;    // singular value, relative to the largest
constexpr double kWellConditioned = 50.0;  // one speed gives 125 with 7 + 7 knots, two speeds 10
constexpr double kSeparable = 0.999;       // cosine between the closest directions of spring and damper
constexpr double kAtBound = 1e-6;          // relative to the upper bound

/// Orthonormal basis of a matrix's column space.
Eigen::MatrixXd column_basis(const Eigen::MatrixXd& a) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(a);
  return Eigen::MatrixXd(qr.householderQ() * Eigen::MatrixXd::Identity(a.rows(), qr.rank()));
}

double largest_cosine(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (a.cols() == 0 || b.cols() == 0) return kUnset;
  const Eigen::MatrixXd overlap = column_basis(a).transpose() * column_basis(b);
  if (overlap.size() == 0) return kUnset;
  return std::min(1.0, Eigen::JacobiSVD<Eigen::MatrixXd>(overlap).singularValues()[0]);
}

std::string explain(const Verdict& verdict, Index touched, std::size_t untouched, std::size_t tests) {
  const std::string from = tests == 1 ? "one speed" : fmt::format("{} tests", tests);
  std::string text;
  if (verdict.identifiable) {
    text = fmt::format("every ordinate is determined (rank {} of {}, condition {:.3g})", verdict.rank, touched,
                       verdict.condition);
  } else if (!std::isnan(verdict.spring_damper_cosine) && verdict.spring_damper_cosine > kSeparable) {
    text = fmt::format(
        "spring and damper are not separable from {}: only their total force is determined (rank {} of {}, condition "
        "{:.3g}, closest directions of spring and damper: cosine {:.5f}); a joint fit of several speeds, fewer knots "
        "or "
        "smoothing separates them",
        from, verdict.rank, touched, verdict.condition, verdict.spring_damper_cosine);
  } else {
    text = fmt::format(
        "the ordinates are not well determined from {} (rank {} of {}, condition {:.3g}): use fewer knots, smoothing "
        "or "
        "more tests",
        from, verdict.rank, touched, verdict.condition);
  }
  if (untouched > 0) text += fmt::format("; {} ordinate{} no sample depends on", untouched, untouched == 1 ? "" : "s");
  return text;
}

std::vector<OrdinateReport> describe(const FitStructure& structure, std::span<const double> parameters,
                                     const Eigen::VectorXd& upper, const std::vector<bool>& touched) {
  std::vector<OrdinateReport> reports(parameters.size());
  const std::size_t springs = structure.spring_knots.size();
  for (std::size_t i = 0; i < reports.size(); ++i) {
    OrdinateReport& report = reports[i];
    report.name = i < springs ? fmt::format("k{}", i + 1) : fmt::format("c{}", i - springs + 1);
    report.value = parameters[i];
    report.upper_bound = upper[static_cast<Index>(i)];
    report.untouched = !touched[i];
    report.at_bound =
        parameters[i] <= kAtBound * report.upper_bound || parameters[i] >= (1.0 - kAtBound) * report.upper_bound;
  }
  return reports;
}

}  // namespace

Identifiability judge_identifiability(const FitStructure& structure, std::span<const double> parameters,
                                      const Eigen::VectorXd& upper, const Eigen::MatrixXd& jacobian,
                                      double residual_variance, std::size_t tests) {
  const auto n = static_cast<std::size_t>(jacobian.cols());
  const Eigen::VectorXd norms = jacobian.colwise().norm().transpose();
  const double largest = norms.cwiseProduct(upper).maxCoeff();
  std::vector<bool> is_touched(n);
  std::vector<Index> touched;
  Index touched_springs = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const auto column = static_cast<Index>(i);
    is_touched[i] = norms[column] * upper[column] > kUntouched * largest;
    if (!is_touched[i]) continue;
    touched.push_back(column);
    if (i < structure.spring_knots.size()) ++touched_springs;
  }
  Identifiability out;
  out.ordinates = describe(structure, parameters, upper, is_touched);
  out.correlation.assign(n, std::vector<double>(n, kUnset));
  const auto count = static_cast<Index>(touched.size());
  Eigen::MatrixXd scaled(jacobian.rows(), count);
  for (Index j = 0; j < count; ++j) {
    const Index column = touched[static_cast<std::size_t>(j)];
    scaled.col(j) = jacobian.col(column) / norms[column];
  }
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinV);
  const Eigen::VectorXd& sigma = svd.singularValues();
  out.verdict.rank = static_cast<int>((sigma.array() > kRankTolerance * sigma[0]).count());
  out.verdict.condition = sigma[0] / sigma[count - 1];
  out.verdict.spring_damper_cosine =
      largest_cosine(scaled.leftCols(touched_springs), scaled.rightCols(count - touched_springs));
  out.verdict.identifiable =
      out.verdict.rank == count && static_cast<std::size_t>(count) == n && out.verdict.condition <= kWellConditioned;
  out.verdict.message = explain(out.verdict, count, n - touched.size(), tests);
  if (out.verdict.rank < count) return out;  // no covariance
  const Eigen::MatrixXd half = svd.matrixV() * sigma.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd covariance = half * half.transpose();
  for (Index i = 0; i < count; ++i) {
    const auto row = static_cast<std::size_t>(touched[static_cast<std::size_t>(i)]);
    out.ordinates[row].standard_error =
        std::sqrt(residual_variance * covariance(i, i)) / norms[touched[static_cast<std::size_t>(i)]];
    for (Index j = 0; j < count; ++j)
      out.correlation[row][static_cast<std::size_t>(touched[static_cast<std::size_t>(j)])] =
          covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j));
  }
  return out;
}

}  // namespace crashsim
