#include "optimize/replicates.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/SVD>

#include <crashsim/signal.hpp>

#include "optimize/bounded_least_squares.hpp"
#include "optimize/multistart.hpp"
#include "random.hpp"

namespace crashsim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNoCurvature = 1e-10;               // singular value, relative to the largest: rounding
constexpr std::uint64_t kBoundsStream = 1ULL << 32;  // beside those of the replicates' noise

/// B = F F' of a covariance matrix that may be singular.
MatrixXd factor_of(const MatrixXd& covariance) {
  const Eigen::JacobiSVD<MatrixXd> svd(covariance, Eigen::ComputeThinU);
  return svd.matrixU() * svd.singularValues().cwiseSqrt().asDiagonal();
}

std::vector<double> by_blocks(const std::vector<double>& residual, double freedom, std::size_t block,
                              std::uint64_t seed, std::uint64_t stream) {
  const std::size_t count = residual.size(), length = std::clamp<std::size_t>(block, 1, count);
  double mean = 0.0;
  for (const double r : residual) mean += r / static_cast<double>(count);
  std::vector<double> noise;
  noise.reserve(count);
  for (std::uint64_t i = 0; noise.size() < count; ++i) {
    const auto places = static_cast<double>(count - length + 1);
    const auto first = static_cast<std::size_t>(places * uniform_random(seed, stream, i));
    for (std::size_t j = first; j < first + length && noise.size() < count; ++j)
      noise.push_back(std::sqrt(freedom) * (residual[j] - mean));
  }
  return noise;
}

std::size_t block_length(const std::vector<double>& residual, int asked) {
  if (asked > 0) return static_cast<std::size_t>(asked);
  const auto root = static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(residual.size()))));
  return std::max(root, 2 * correlation_lag(residual));
}

void add(const std::vector<double>& more, std::vector<double>& to) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += more[i];
}

}  // namespace

LinearReplicates::LinearReplicates(const LinearFit& fit, const VectorXd& upper) : upper_(upper) {
  const Index n = fit.theta.size();
  // Of parameters relative to their bounds, so that singular values compare.
  const Eigen::JacobiSVD<MatrixXd> svd(fit.rows * upper.asDiagonal(), Eigen::ComputeThinV);
  const VectorXd& sigma = svd.singularValues();
  const Index rank = (sigma.array() > kNoCurvature * sigma[0]).count();
  const MatrixXd directions = svd.matrixV().leftCols(rank).transpose() * upper.asDiagonal();
  const MatrixXd back = sigma.head(rank).cwiseInverse().asDiagonal() * directions;
  const MatrixXd rows = sigma.head(rank).asDiagonal() * directions * upper.cwiseAbs2().cwiseInverse().asDiagonal();
  solution_ = rows * fit.theta - back * fit.gradient;
  noise_ = back * factor_of(fit.score_covariance);
  const double scatter = std::sqrt(noise_.squaredNorm() / static_cast<double>(std::max<Index>(rank, 1)));
  bound_rows_ = scatter * upper.cwiseInverse();
  rows_ = MatrixXd::Zero(rank + n, n);
  rows_.topRows(rank) = rows;
  rows_.bottomRows(n).diagonal() = bound_rows_;
}

std::vector<double> LinearReplicates::draw(std::uint64_t seed, int index) const {
  const auto stream = static_cast<std::uint64_t>(index);
  VectorXd normal(noise_.cols()), right(rows_.rows());
  for (Index i = 0; i < normal.size(); ++i) normal[i] = normal_random(seed, stream, static_cast<std::uint64_t>(i));
  right.head(solution_.size()) = solution_ - noise_ * normal;
  for (Index i = 0; i < upper_.size(); ++i)
    right[solution_.size() + i] =
        bound_rows_[i] * upper_[i] * uniform_random(seed, kBoundsStream + stream, static_cast<std::uint64_t>(i));
  const VectorXd drawn = bounded_least_squares(rows_, right, upper_);
  return {drawn.begin(), drawn.end()};
}

std::vector<FitTarget> renewed_tests(const FitStudy& study, const LinearFit& fit,
                                     const std::vector<FittedMotion>& motions, const Renewal& how, std::uint64_t seed,
                                     int index) {
  std::vector<FitTarget> tests = study.targets;
  for (std::size_t t = 0; t < tests.size(); ++t) {
    FitTarget& test = tests[t];
    const std::vector<double>& residual = fit.residual[t];
    const std::uint64_t stream = static_cast<std::uint64_t>(index) * tests.size() + t;
    const std::vector<double> noise =
        how.by_blocks ? by_blocks(residual, fit.freedom, block_length(residual, how.block), seed, stream)
                      : draw_noise(fit.noise[t], residual.size(), seed, stream);
    const std::vector<double> velocity = integrate(test.time_s, noise, 0.0);
    test.accel_mps2 = motions[t].accel_mps2;
    test.velocity_mps = motions[t].velocity_mps;
    test.displacement_m = motions[t].displacement_m;
    add(noise, test.accel_mps2);
    add(velocity, test.velocity_mps);
    add(integrate(test.time_s, velocity, 0.0), test.displacement_m);
  }
  return tests;
}

std::vector<double> fit_again(const FitStudy& study, const std::vector<FitTarget>& targets, const VectorXd& from,
                              const std::function<bool()>& go_on) {
  IdentifyOptions options = study.options;
  if (options.method == IdentifyMethod::equation_error) {
    const VectorXd found = solve_equation_error(study.structure, targets, study.upper, study.smooth, study.prior);
    return {found.begin(), found.end()};
  }
  options.starts = options.jobs = 1;
  const MultistartProblem problem{study.structure, targets, options, study.upper, from, study.smooth, study.prior};
  const std::vector<StartResult> results = run_starts(problem, [&go_on](int, int) { return go_on(); });
  const StartResult& result = results.front();
  const bool has_ended = result.report.evaluations > 0 && !result.report.failed && go_on();
  return has_ended ? result.parameters : std::vector<double>();
}

}  // namespace crashsim
