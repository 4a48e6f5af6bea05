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

/// Columns of unit length: sensitivities of what is determined, by samples or smoothing.
struct ScaledColumns {
  std::vector<std::size_t> ordinates;
  std::size_t springs = 0;  ///< So many of them belong to the spring.
  Eigen::MatrixXd columns;
  Eigen::VectorXd norms;
};

ScaledColumns scale_columns(const FitStructure& structure, const Eigen::VectorXd& upper,
                            const Eigen::MatrixXd& jacobian, const Eigen::MatrixXd& roughness) {
  Eigen::MatrixXd stacked(jacobian.rows() + roughness.rows(), jacobian.cols());
  stacked << jacobian, roughness;
  const std::vector<bool> determined = touched_ordinates(stacked, upper);
  ScaledColumns scaled;
  for (std::size_t i = 0; i < determined.size(); ++i) {
    if (!determined[i]) continue;
    scaled.ordinates.push_back(i);
    if (i < structure.spring_knots.size()) ++scaled.springs;
  }
  const auto count = static_cast<Index>(scaled.ordinates.size());
  scaled.columns.resize(stacked.rows(), count);
  scaled.norms.resize(count);
  for (Index j = 0; j < count; ++j) {
    const auto column = stacked.col(static_cast<Index>(scaled.ordinates[static_cast<std::size_t>(j)]));
    scaled.norms[j] = column.norm();
    scaled.columns.col(j) = column / scaled.norms[j];
  }
  return scaled;
}

void set_covariance(const ScaledColumns& scaled, const Eigen::MatrixXd& covariance, double variance,
                    Identifiability& out) {
  const Index count = scaled.norms.size();
  for (Index i = 0; i < count; ++i) {
    const std::size_t row = scaled.ordinates[static_cast<std::size_t>(i)];
    out.ordinates[row].standard_error = std::sqrt(variance * covariance(i, i)) / scaled.norms[i];
    for (Index j = 0; j < count; ++j)
      out.correlation[row][scaled.ordinates[static_cast<std::size_t>(j)]] =
          covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j));
  }
}

}  // namespace

std::vector<bool> touched_ordinates(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& upper) {
  const Eigen::VectorXd sizes = jacobian.colwise().norm().transpose().cwiseProduct(upper);
  const double largest = sizes.maxCoeff();
  std::vector<bool> touched;
  for (const double size : sizes) touched.push_back(size > kUntouched * largest);
  return touched;
}

void hold_untouched(const FitStructure& structure, const std::vector<bool>& touched, std::span<double> parameters) {
  const auto hold = [&](std::size_t first, std::size_t count) {
    const auto end = static_cast<std::ptrdiff_t>(first + count);
    for (auto i = static_cast<std::ptrdiff_t>(first); i < end; ++i) {
      if (touched[static_cast<std::size_t>(i)]) continue;
      for (std::ptrdiff_t distance = 1; distance < static_cast<std::ptrdiff_t>(count); ++distance)
        for (const std::ptrdiff_t j : {i - distance, i + distance}) {
          if (j < static_cast<std::ptrdiff_t>(first) || j >= end || !touched[static_cast<std::size_t>(j)]) continue;
          parameters[static_cast<std::size_t>(i)] = parameters[static_cast<std::size_t>(j)];
          distance = end;
          break;
        }
    }
  };
  hold(0, structure.spring_knots.size());
  hold(structure.spring_knots.size(), structure.damper_knots.size());
}

Identifiability judge_identifiability(const FitStructure& structure, std::span<const double> parameters,
                                      const Eigen::VectorXd& upper, const Eigen::MatrixXd& jacobian,
                                      const Eigen::MatrixXd& roughness, double residual_variance, std::size_t tests) {
  const std::size_t n = parameters.size();
  const std::vector<bool> touched = touched_ordinates(jacobian, upper);
  Identifiability out;
  out.ordinates = describe(structure, parameters, upper, touched);
  out.correlation.assign(n, std::vector<double>(n, kUnset));
  const ScaledColumns scaled = scale_columns(structure, upper, jacobian, roughness);
  const auto count = static_cast<Index>(scaled.ordinates.size());
  if (count == 0) {
    out.verdict.message = "no sample depends on any ordinate";
    return out;
  }
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(scaled.columns, Eigen::ComputeThinV);
  const Eigen::VectorXd& sigma = svd.singularValues();
  const auto springs = static_cast<Index>(scaled.springs);
  out.verdict.rank = static_cast<int>((sigma.array() > kRankTolerance * sigma[0]).count());
  out.verdict.condition = sigma[0] / sigma[count - 1];
  out.verdict.spring_damper_cosine =
      largest_cosine(scaled.columns.leftCols(springs), scaled.columns.rightCols(count - springs));
  out.verdict.identifiable =
      out.verdict.rank == count && scaled.ordinates.size() == n && out.verdict.condition <= kWellConditioned;
  const auto untouched = static_cast<std::size_t>(std::count(touched.begin(), touched.end(), false));
  out.verdict.message = explain(out.verdict, count, untouched, tests);
  if (out.verdict.rank < count) return out;  // no covariance
  const Eigen::MatrixXd half = svd.matrixV() * sigma.cwiseInverse().asDiagonal();
  set_covariance(scaled, half * half.transpose(), residual_variance, out);
  return out;
}

}  // namespace crashsim
