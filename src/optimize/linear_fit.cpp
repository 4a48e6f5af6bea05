#include "optimize/linear_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/QR>
#include <Eigen/SVD>

#include <crashsim/simulate.hpp>

#include "optimize/identifiability.hpp"

namespace crashsim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kMotionRtol = 1e-10;   // as the fit's own simulations
constexpr double kLeastSize = 1e-12;    // of residuals, relative to their channel
constexpr double kNoCurvature = 1e-10;  // singular value, relative to the largest: rounding
constexpr double kHasNoPart = 1e-6;     // of a direction without curvature in a parameter
constexpr Index kChannels = 3;

double root_mean_square(const std::vector<double>& measured, const std::vector<double>& model) {
  double sum = 0.0;
  for (std::size_t i = 0; i < measured.size(); ++i) sum += (measured[i] - model[i]) * (measured[i] - model[i]);
  return std::sqrt(sum / static_cast<double>(measured.size()));
}

/// Makes the scale of a channel one of the squared loss.
void make_quadratic(Loss loss, double residual, double size, double& scale) {
  if (scale > 0.0) scale *= std::sqrt(equivalent_weight(loss, std::max(scale * residual, kLeastSize * size)));
}

FitTarget quadratic_target(FitTarget target, Loss loss, const FittedMotion& motion) {
  make_quadratic(loss, root_mean_square(target.accel_mps2, motion.accel_mps2), target.accel_size, target.accel_scale);
  make_quadratic(loss, root_mean_square(target.velocity_mps, motion.velocity_mps), target.velocity_size,
                 target.velocity_scale);
  make_quadratic(loss, root_mean_square(target.displacement_m, motion.displacement_m), target.displacement_size,
                 target.displacement_scale);
  return target;
}

/// Rows of one channel of a target whose first row is `first`, as E weights them, scaled once more: by it a unit error
/// of the channel becomes that of the row.
MatrixXd channel_rows(const MatrixXd& jacobian, Index first, const FitTarget& target, Index channel, double scale) {
  const auto samples = static_cast<Index>(target.time_s.size());
  MatrixXd rows(samples, jacobian.cols());
  for (Index i = 0; i < samples; ++i) rows.row(i) = jacobian.row(first + kChannels * i + channel);
  return std::sqrt(target.factor) * scale * rows;
}

std::span<const double> parameters_of(const VectorXd& theta) {
  return {theta.data(), static_cast<std::size_t>(theta.size())};
}

/// What presses parameters against their bounds.
void set_gradient(FitObjective& objective, std::size_t targets, LinearFit& fit) {
  fit.gradient.resize(fit.theta.size());
  objective.evaluate(parameters_of(fit.theta), 0.0, {fit.gradient.data(), objective.size()});
  fit.gradient *= 0.5 * static_cast<double>(targets);  // E is the targets' mean
  for (Index i = 0; i < fit.theta.size(); ++i)
    if (fit.is_free[static_cast<std::size_t>(i)]) fit.gradient[i] = 0.0;  // a loss with a corner never quite gets there
}

/// Takes out of the rows what a nuisance makes of them; rows of what is expected of it go with it.
void take_out(const MatrixXd& nuisance, MatrixXd& jacobian) {
  MatrixXd padded = MatrixXd::Zero(nuisance.rows(), jacobian.cols());
  padded.topRows(jacobian.rows()) = jacobian;
  jacobian = without_nuisance(padded, nuisance);
}

/// The free columns, of unit length, by their singular values.
struct FreeSpectrum {
  std::vector<Index> free;
  VectorXd norms;
  MatrixXd half;     ///< half half' = (J'J)^-1 of the columns of unit length.
  MatrixXd without;  ///< Directions without curvature.

  explicit FreeSpectrum(const LinearFit& fit) {
    for (Index i = 0; i < fit.rows.cols(); ++i)
      if (fit.is_free[static_cast<std::size_t>(i)] && fit.rows.col(i).norm() > 0.0) free.push_back(i);
    const auto count = static_cast<Index>(free.size());
    if (count == 0) return;
    MatrixXd columns(fit.rows.rows(), count);
    norms.resize(count);
    for (Index j = 0; j < count; ++j) {
      norms[j] = fit.rows.col(at(j)).norm();
      columns.col(j) = fit.rows.col(at(j)) / norms[j];
    }
    const Eigen::JacobiSVD<MatrixXd> svd(columns, Eigen::ComputeThinV);
    const VectorXd& sigma = svd.singularValues();
    const Index rank = (sigma.array() > kNoCurvature * sigma[0]).count();
    half = svd.matrixV().leftCols(rank) * sigma.head(rank).cwiseInverse().asDiagonal();
    without = svd.matrixV().rightCols(count - rank);
  }

  [[nodiscard]] Index at(Index j) const { return free[static_cast<std::size_t>(j)]; }
  [[nodiscard]] bool is_determined(Index j) const {
    return without.cols() == 0 || without.row(j).cwiseAbs().maxCoeff() < kHasNoPart;
  }
};

}  // namespace

FittedMotion fitted_motion(const FitStructure& structure, std::span<const double> parameters, const FitTarget& target) {
  SimulateOptions options;
  options.times_s = target.time_s;
  options.rtol = kMotionRtol;
  options.integrator = Integrator::taylor;
  CrushResponse run = simulate(make_model(structure, parameters, target.mass_kg, target.impact_speed_mps), options);
  if (run.time_s.size() != target.time_s.size())
    throw NumericalFailure("the fitted model could not be simulated: " + run.message);
  return {std::move(run.accel_mps2), std::move(run.velocity_mps), std::move(run.displacement_m)};
}

double equivalent_weight(Loss loss, double size) {
  switch (loss) {
    case Loss::l1:
      return 1.0 / (size * std::sqrt(2.0 * std::numbers::pi));
    case Loss::huber:
      return std::erf(kHuberThreshold / (size * std::numbers::sqrt2)) / (2.0 * kHuberThreshold);
    case Loss::l2:
      break;
  }
  return 1.0;
}

void add_transposed_integral(std::span<const double> time_s, const MatrixXd& g, MatrixXd& sum) {
  VectorXd after = VectorXd::Zero(g.cols());  // sum of g over the samples from i on
  for (Index i = g.rows() - 1; i > 0; --i) {
    const auto at = static_cast<std::size_t>(i);
    after += g.row(i).transpose();
    const VectorXd half = 0.5 * (time_s[at] - time_s[at - 1]) * after;
    sum.row(i) += half.transpose();
    sum.row(i - 1) += half.transpose();
  }
}

LinearFit linearise(const FitStudy& study, const VectorXd& theta, const std::vector<bool>& is_free,
                    const std::function<MatrixXd(const std::vector<FitTarget>& targets)>& nuisance) {
  LinearFit fit;
  fit.theta = theta;
  fit.is_free = is_free;
  double samples = 0.0;
  for (const FitTarget& target : study.targets) {
    const FittedMotion motion = fitted_motion(study.structure, parameters_of(theta), target);
    fit.targets.push_back(quadratic_target(target, study.options.loss, motion));
    std::vector<double>& residual = fit.residual.emplace_back(target.accel_mps2);
    for (std::size_t i = 0; i < residual.size(); ++i) residual[i] -= motion.accel_mps2[i];
    samples += static_cast<double>(residual.size());
  }
  const auto found = static_cast<double>(std::count(is_free.begin(), is_free.end(), true));
  fit.freedom = samples / std::max(1.0, samples - found);
  for (const std::vector<double>& residual : fit.residual) fit.noise.push_back(estimate_noise(residual, fit.freedom));
  FitObjective objective(study.structure, fit.targets, Loss::l2, study.smooth, study.prior);
  set_gradient(objective, study.targets.size(), fit);
  fit.jacobian = objective.jacobian(parameters_of(theta));
  if (nuisance) take_out(nuisance(fit.targets), fit.jacobian);
  const MatrixXd penalties = objective.penalty_rows();
  MatrixXd all(fit.jacobian.rows() + penalties.rows(), theta.size());
  all << fit.jacobian, penalties;
  fit.rows = Eigen::HouseholderQR<MatrixXd>(all).matrixQR().topRows(theta.size()).triangularView<Eigen::Upper>();
  fit.score_covariance = score_covariance(fit);
  return fit;
}

MatrixXd score_covariance(const LinearFit& fit) {
  MatrixXd covariance = MatrixXd::Zero(fit.jacobian.cols(), fit.jacobian.cols());
  Index first = 0;
  for (std::size_t t = 0; t < fit.targets.size(); ++t) {
    const FitTarget& target = fit.targets[t];
    const auto rows = [&](Index channel, double scale) {
      return channel_rows(fit.jacobian, first, target, channel, scale);
    };
    MatrixXd velocity = rows(1, target.velocity_scale), accel = rows(0, target.accel_scale);
    add_transposed_integral(target.time_s, rows(2, target.displacement_scale), velocity);
    add_transposed_integral(target.time_s, velocity, accel);
    covariance += covariance_of_sums(fit.noise[t], accel);
    first += kChannels * static_cast<Index>(target.time_s.size());
  }
  return covariance;
}

MatrixXd covariance_of(const LinearFit& fit) {
  const Index n = fit.theta.size();
  MatrixXd covariance = MatrixXd::Constant(n, n, kUnset);
  for (Index i = 0; i < n; ++i)
    if (!fit.is_free[static_cast<std::size_t>(i)]) covariance.row(i).setZero(), covariance.col(i).setZero();
  const FreeSpectrum spectrum(fit);
  const auto count = static_cast<Index>(spectrum.free.size());
  MatrixXd scores(count, count);
  for (Index i = 0; i < count; ++i)
    for (Index j = 0; j < count; ++j)
      scores(i, j) = fit.score_covariance(spectrum.at(i), spectrum.at(j)) / (spectrum.norms[i] * spectrum.norms[j]);
  const MatrixXd inverse = spectrum.half * spectrum.half.transpose();
  const MatrixXd scaled = inverse * scores * inverse;
  for (Index i = 0; i < count; ++i)
    for (Index j = 0; j < count; ++j)
      if (spectrum.is_determined(i) && spectrum.is_determined(j))
        covariance(spectrum.at(i), spectrum.at(j)) = scaled(i, j) / (spectrum.norms[i] * spectrum.norms[j]);
  return covariance;
}

MatrixXd correlation_of(const MatrixXd& covariance) {
  const VectorXd errors = covariance.diagonal().cwiseSqrt();
  return covariance.cwiseQuotient(errors * errors.transpose());
}

VectorXd inverse_curvature(const LinearFit& fit) {
  VectorXd diagonal = VectorXd::Constant(fit.theta.size(), kUnset);
  const FreeSpectrum spectrum(fit);
  for (Index i = 0; i < static_cast<Index>(spectrum.free.size()); ++i)
    if (spectrum.is_determined(i))
      diagonal[spectrum.at(i)] = spectrum.half.row(i).squaredNorm() / (spectrum.norms[i] * spectrum.norms[i]);
  return diagonal;
}

}  // namespace crashsim
