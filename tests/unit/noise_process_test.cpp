#include "optimize/noise_process.hpp"

#include <cmath>
#include <cstdlib>

#include <gmock/gmock.h>
#include <Eigen/Core>

#include "support/random.hpp"

namespace crashsim {
namespace {

constexpr double kRounding = 1e-12;  // relative to the largest entry
constexpr int kSamples = 20000;
constexpr double kSampling = 0.05;  // regression: spread of estimates from kSamples, five of their standard errors

/// Mean of a few white numbers: correlated over their count.
std::vector<double> moving_means(std::size_t count, std::size_t width, std::uint64_t seed) {
  std::vector<double> means(count, 0.0);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < width; ++j)
      means[i] += normal_random(seed, 7, i + j) / std::sqrt(static_cast<double>(width));
  return means;
}

NoiseProcess triangular(std::size_t lags) {
  NoiseProcess noise;
  for (std::size_t i = 0; i < lags; ++i)
    noise.autocovariance.push_back(3.0 * (1.0 - static_cast<double>(i) / static_cast<double>(lags)));
  return noise;
}

TEST(NormalRandom, HasMeanZeroAndVarianceOne) {
  double sum = 0.0, squares = 0.0;
  for (std::uint64_t i = 0; i < kSamples; ++i) {
    const double x = normal_random(3, 5, i);
    sum += x / kSamples;
    squares += x * x / kSamples;
  }
  EXPECT_NEAR(sum, 0.0, kSampling);
  EXPECT_NEAR(squares, 1.0, kSampling);
}

TEST(CorrelationLag, IsZeroOfMostWhiteNoise) {
  int white = 0;
  constexpr int kSeries = 100;
  for (int i = 0; i < kSeries; ++i)
    if (correlation_lag(moving_means(300, 1, static_cast<std::uint64_t>(i))) == 0) ++white;
  constexpr int kMost = 65;  // five lags, each beyond two standard errors by chance once in 22
  EXPECT_GE(white, kMost);
}

TEST(CorrelationLag, IsAboutTheWidthOfMovingMeans) {
  for (const std::size_t width : {4U, 12U, 40U}) {
    const std::size_t lag = correlation_lag(moving_means(4000, width, 1));
    EXPECT_GE(lag, width / 2) << width;
    EXPECT_LE(lag, 3 * width) << width;
  }
}

TEST(CorrelationLag, OfNothingIsZero) { EXPECT_EQ(correlation_lag(std::vector<double>(50, 0.0)), 0U); }

TEST(EstimateNoise, ScalesByTheFreedom) {
  const std::vector<double> residual = moving_means(500, 6, 2);
  const NoiseProcess once = estimate_noise(residual, 1.0), more = estimate_noise(residual, 1.5);
  ASSERT_EQ(once.autocovariance.size(), more.autocovariance.size());
  double squares = 0.0;
  for (const double r : residual) squares += r * r / 500.0;
  EXPECT_NEAR(once.deviation(), std::sqrt(squares), kRounding);
  for (std::size_t i = 0; i < once.autocovariance.size(); ++i)
    EXPECT_NEAR(more.autocovariance[i], 1.5 * once.autocovariance[i], kRounding);
}

TEST(CovarianceOfSums, IsThatOfTheDenseMatrix) {
  test::Random random(4);
  for (const int rows : {10, 33, 64}) {
    Eigen::MatrixXd g(rows, 4), gamma(rows, rows);
    for (double& entry : g.reshaped()) entry = random.between(-1.0, 1.0);
    const NoiseProcess noise = triangular(9);
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < rows; ++j) {
        const auto lag = static_cast<std::size_t>(std::abs(i - j));
        gamma(i, j) = lag < noise.autocovariance.size() ? noise.autocovariance[lag] : 0.0;
      }
    const Eigen::MatrixXd dense = g.transpose() * gamma * g;
    EXPECT_LT((covariance_of_sums(noise, g) - dense).cwiseAbs().maxCoeff(), kRounding * dense.cwiseAbs().maxCoeff());
  }
}

TEST(DrawNoise, HasTheAutocovarianceOfTheProcess) {
  const NoiseProcess noise = triangular(5);
  std::vector<double> found(7, 0.0);
  constexpr int kDraws = 400;
  constexpr std::size_t kLength = 100;
  for (std::uint64_t draw = 0; draw < kDraws; ++draw) {
    const std::vector<double> samples = draw_noise(noise, kLength, 11, draw);
    for (std::size_t lag = 0; lag < found.size(); ++lag)
      for (std::size_t i = 0; i + lag < kLength; ++i)
        found[lag] += samples[i] * samples[i + lag] / static_cast<double>((kLength - lag) * kDraws);
  }
  for (std::size_t lag = 0; lag < found.size(); ++lag) {
    const double truth = lag < noise.autocovariance.size() ? noise.autocovariance[lag] : 0.0;
    EXPECT_NEAR(found[lag], truth, kSampling * noise.autocovariance.front()) << lag;
  }
}

TEST(DrawNoise, DependsOnSeedAndStreamOnly) {
  const NoiseProcess noise = triangular(5);
  EXPECT_EQ(draw_noise(noise, 50, 1, 2), draw_noise(noise, 50, 1, 2));
  EXPECT_NE(draw_noise(noise, 50, 1, 2), draw_noise(noise, 50, 1, 3));
  EXPECT_NE(draw_noise(noise, 50, 1, 2), draw_noise(noise, 50, 2, 2));
}

}  // namespace
}  // namespace crashsim
