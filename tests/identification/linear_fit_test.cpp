/// Covariance of a fit whose velocity and displacement are integrals of the same noisy acceleration, against dense
/// matrices and brute force.
#include "optimize/linear_fit.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <crashsim/signal.hpp>

#include "optimize/replicates.hpp"
#include "support/random.hpp"

namespace crashsim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kRounding = 1e-9;  // relative, of sums over some hundred samples
constexpr double kSampling = 0.08;  // regression: spread of a variance from kDraws, five of its standard errors
constexpr int kDraws = 8000;
constexpr Index kSamples = 80;
constexpr Index kParameters = 3;

/// A linear problem of one test with random sensitivities; smooth along time, as those of a motion are.
LinearFit random_fit(test::Random& random, const NoiseProcess& noise) {
  LinearFit fit;
  FitTarget target;
  for (Index i = 0; i < kSamples; ++i)
    target.time_s.push_back(1e-3 * (static_cast<double>(i) + 0.2 * std::sin(static_cast<double>(i))));
  target.accel_scale = 0.01;
  target.velocity_scale = 0.3;
  target.displacement_scale = 5.0;
  target.factor = 1.0 / kSamples;
  fit.jacobian.resize(3 * kSamples, kParameters);
  for (Index j = 0; j < kParameters; ++j)
    for (Index channel = 0; channel < 3; ++channel) {
      const double rate = random.between(1.0, 6.0), size = random.between(0.1, 1.0);
      for (Index i = 0; i < kSamples; ++i)
        fit.jacobian(3 * i + channel, j) = size * std::cos(rate * static_cast<double>(i) / kSamples);
    }
  fit.rows = fit.jacobian;
  fit.theta = VectorXd::Constant(kParameters, 1.0);
  fit.gradient = VectorXd::Zero(kParameters);
  fit.is_free.assign(kParameters, true);
  fit.targets = {target};
  fit.noise = {noise};
  fit.score_covariance = score_covariance(fit);
  return fit;
}

/// Matrix of the running integral by trapezoids.
MatrixXd integral_matrix(const std::vector<double>& time_s) {
  MatrixXd c(kSamples, kSamples);
  for (Index j = 0; j < kSamples; ++j) {
    std::vector<double> unit(kSamples, 0.0);
    unit[static_cast<std::size_t>(j)] = 1.0;
    const std::vector<double> column = integrate(time_s, unit, 0.0);
    c.col(j) = Eigen::Map<const VectorXd>(column.data(), kSamples);
  }
  return c;
}

/// Errors of the scaled rows by those of the acceleration.
MatrixXd dense_stack(const FitTarget& target) {
  const MatrixXd c = integral_matrix(target.time_s), cc = c * c;
  MatrixXd stack(3 * kSamples, kSamples);
  const double root = std::sqrt(target.factor);
  for (Index i = 0; i < kSamples; ++i) {
    stack.row(3 * i) = root * target.accel_scale * MatrixXd::Identity(kSamples, kSamples).row(i);
    stack.row(3 * i + 1) = root * target.velocity_scale * c.row(i);
    stack.row(3 * i + 2) = root * target.displacement_scale * cc.row(i);
  }
  return stack;
}

NoiseProcess correlated() { return {{4.0, 3.0, 2.0, 1.0}}; }

TEST(TransposedIntegral, IsThatOfTheDenseMatrix) {
  test::Random random(1);
  const FitTarget target = random_fit(random, correlated()).targets.front();
  MatrixXd g(kSamples, 2), sum(kSamples, 2);
  for (double& entry : g.reshaped()) entry = random.between(-1.0, 1.0);
  for (double& entry : sum.reshaped()) entry = random.between(-1.0, 1.0);
  const MatrixXd dense = sum + integral_matrix(target.time_s).transpose() * g;
  add_transposed_integral(target.time_s, g, sum);
  EXPECT_LT((sum - dense).cwiseAbs().maxCoeff(), kRounding);
}

TEST(Covariance, IsThatOfDenseMatrices) {
  test::Random random(2);
  const LinearFit fit = random_fit(random, correlated());
  MatrixXd gamma(kSamples, kSamples);
  for (Index i = 0; i < kSamples; ++i)
    for (Index j = 0; j < kSamples; ++j) gamma(i, j) = std::max(0.0, 4.0 - static_cast<double>(std::abs(i - j)));
  const MatrixXd inverse = (fit.jacobian.transpose() * fit.jacobian).inverse();
  const MatrixXd map = inverse * fit.jacobian.transpose() * dense_stack(fit.targets.front());
  const MatrixXd dense = map * gamma * map.transpose();
  EXPECT_LT((covariance_of(fit) - dense).norm(), kRounding * dense.norm());
  const VectorXd diagonal = inverse.diagonal();
  EXPECT_LT((inverse_curvature(fit) - diagonal).norm(), kRounding * diagonal.norm());
}

TEST(Covariance, IsWhatBruteForceScatters) {
  test::Random random(3);
  const LinearFit fit = random_fit(random, correlated());
  const MatrixXd map = (fit.jacobian.transpose() * fit.jacobian).inverse() * fit.jacobian.transpose();
  const double root = std::sqrt(fit.targets.front().factor);
  MatrixXd scatter = MatrixXd::Zero(kParameters, kParameters);
  for (int draw = 0; draw < kDraws; ++draw) {
    const FitTarget& target = fit.targets.front();
    const std::vector<double> accel = draw_noise(correlated(), kSamples, 9, static_cast<std::uint64_t>(draw));
    const std::vector<double> velocity = integrate(target.time_s, accel, 0.0);
    const std::vector<double> displacement = integrate(target.time_s, velocity, 0.0);
    VectorXd error(3 * kSamples);
    for (Index i = 0; i < kSamples; ++i) {
      const auto at = static_cast<std::size_t>(i);
      error[3 * i] = root * target.accel_scale * accel[at];
      error[3 * i + 1] = root * target.velocity_scale * velocity[at];
      error[3 * i + 2] = root * target.displacement_scale * displacement[at];
    }
    const VectorXd estimate = map * error;
    scatter += estimate * estimate.transpose() / kDraws;
  }
  const MatrixXd covariance = covariance_of(fit);
  for (Index i = 0; i < kParameters; ++i)
    for (Index j = 0; j < kParameters; ++j)
      EXPECT_NEAR(scatter(i, j), covariance(i, j), kSampling * std::sqrt(covariance(i, i) * covariance(j, j)));
}

/// White noise of the acceleration alone: the textbook's sigma^2 (J'J)^-1.
TEST(Covariance, OfWhiteAccelerationAloneIsTheTextbooks) {
  test::Random random(4);
  constexpr double kVariance = 2.5;
  LinearFit fit = random_fit(random, {{kVariance}});
  fit.targets.front().velocity_scale = fit.targets.front().displacement_scale = 0.0;
  for (Index i = 0; i < kSamples; ++i) fit.jacobian.middleRows(3 * i + 1, 2).setZero();
  fit.rows = fit.jacobian;
  fit.score_covariance = score_covariance(fit);
  const FitTarget& target = fit.targets.front();
  const MatrixXd by_accel = fit.jacobian / (std::sqrt(target.factor) * target.accel_scale);
  const MatrixXd textbook = kVariance * (by_accel.transpose() * by_accel).inverse();
  EXPECT_LT((covariance_of(fit) - textbook).norm(), kRounding * textbook.norm());
}

TEST(Covariance, HeldParametersHaveNone) {
  test::Random random(5);
  LinearFit fit = random_fit(random, correlated());
  fit.is_free[1] = false;
  const MatrixXd covariance = covariance_of(fit);
  EXPECT_EQ(covariance.row(1).norm(), 0.0);
  EXPECT_EQ(covariance.col(1).norm(), 0.0);
  EXPECT_GT(covariance(0, 0), 0.0);
}

TEST(Covariance, IsUnsetWhereNothingIsDetermined) {
  test::Random random(6);
  LinearFit fit = random_fit(random, correlated());
  fit.jacobian.col(2) = 2.0 * fit.jacobian.col(1);
  fit.rows = fit.jacobian;
  fit.score_covariance = score_covariance(fit);
  const MatrixXd covariance = covariance_of(fit);
  EXPECT_GT(covariance(0, 0), 0.0);
  EXPECT_TRUE(std::isnan(covariance(1, 1)));
  EXPECT_TRUE(std::isnan(covariance(2, 2)));
}

/// The parabola of a loss has its expected slope: E[loss'(u) u] by summing over normal u.
TEST(EquivalentWeight, HasTheLossesExpectedSlope) {
  constexpr double kSummation = 1e-6;
  for (const Loss loss : {Loss::l1, Loss::l2, Loss::huber})
    for (const double size : {0.01, 0.05, 0.3}) {
      double slope = 0.0;
      constexpr double kStep = 1e-4;
      for (double z = -8.0 + 0.5 * kStep; z < 8.0; z += kStep)
        slope += kStep * loss_value(loss, size * z, 0.0).derivative * size * z * std::exp(-0.5 * z * z) /
                 std::sqrt(2.0 * std::acos(-1.0));
      EXPECT_NEAR(2.0 * equivalent_weight(loss, size) * size * size, slope, kSummation * slope)
          << name_of(loss) << ' ' << size;
    }
}

VectorXd far_bounds() { return VectorXd::Constant(kParameters, 1e6); }

TEST(LinearReplicates, ScatterAsTheCovarianceSays) {
  test::Random random(7);
  LinearFit fit = random_fit(random, correlated());
  fit.theta.setConstant(5e5);
  const LinearReplicates replicates(fit, far_bounds());
  MatrixXd scatter = MatrixXd::Zero(kParameters, kParameters);
  for (int draw = 0; draw < kDraws; ++draw) {
    const std::vector<double> drawn = replicates.draw(1, draw);
    const VectorXd off = Eigen::Map<const VectorXd>(drawn.data(), kParameters) - fit.theta;
    scatter += off * off.transpose() / kDraws;
  }
  const MatrixXd covariance = covariance_of(fit);
  for (Index i = 0; i < kParameters; ++i)
    for (Index j = 0; j < kParameters; ++j)
      EXPECT_NEAR(scatter(i, j), covariance(i, j), kSampling * std::sqrt(covariance(i, i) * covariance(j, j)));
}

TEST(LinearReplicates, StayInTheBounds) {
  test::Random random(8);
  LinearFit fit = random_fit(random, correlated());
  const double deviation = std::sqrt(covariance_of(fit)(0, 0));
  fit.theta.setConstant(0.3 * deviation);
  const VectorXd upper = VectorXd::Constant(kParameters, deviation);
  const LinearReplicates replicates(fit, upper);
  int at_bound = 0;
  for (int draw = 0; draw < 200; ++draw)
    for (const double value : replicates.draw(1, draw)) {
      EXPECT_GE(value, 0.0);
      EXPECT_LE(value, deviation);
      if (value == 0.0 || value == deviation) ++at_bound;
    }
  EXPECT_GT(at_bound, 0);
}

/// What presses against a bound with more than the noise stays there.
TEST(LinearReplicates, StayAtABoundThatIsPressed) {
  test::Random random(9);
  LinearFit fit = random_fit(random, correlated());
  fit.theta.setConstant(5e5);
  fit.theta[0] = 0.0;
  fit.is_free[0] = false;
  fit.gradient[0] = 50.0 * std::sqrt(fit.score_covariance(0, 0));
  const LinearReplicates replicates(fit, far_bounds());
  for (int draw = 0; draw < 200; ++draw) EXPECT_EQ(replicates.draw(1, draw)[0], 0.0);
}

/// A parameter without any sample takes any value between its bounds.
TEST(LinearReplicates, SpreadOverTheBoundsWhereDataSayNothing) {
  test::Random random(10);
  LinearFit fit = random_fit(random, correlated());
  fit.theta.setConstant(5e5);
  fit.jacobian.col(2).setZero();
  fit.rows = fit.jacobian;
  fit.is_free[2] = false;
  fit.score_covariance = score_covariance(fit);
  const LinearReplicates replicates(fit, far_bounds());
  double mean = 0.0, least = 1e6, largest = 0.0;
  constexpr int kFew = 400;
  for (int draw = 0; draw < kFew; ++draw) {
    const double value = replicates.draw(1, draw)[2];
    mean += value / kFew;
    least = std::min(least, value);
    largest = std::max(largest, value);
  }
  EXPECT_NEAR(mean, 5e5, kSampling * 1e6);
  EXPECT_LT(least, kSampling * 1e6);
  EXPECT_GT(largest, (1.0 - kSampling) * 1e6);
}

}  // namespace
}  // namespace crashsim
