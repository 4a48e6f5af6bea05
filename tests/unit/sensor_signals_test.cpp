#include "sensor_signals.hpp"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>

#include "support/sensor_cases.hpp"

namespace crashsim {
namespace {

constexpr double kRounding = 1e-12;

double cubic(double x) { return 2.0 - x + 0.5 * x * x - 0.3 * x * x * x; }
double cubic_slope(double x) { return -1.0 + x - 0.9 * x * x; }

TEST(ReadBetween, IsExactForCubics) {
  std::vector<double> values;
  for (int i = 0; i < 8; ++i) values.push_back(cubic(i));
  for (const double at : {0.3, 1.0, 1.7, 3.5, 6.0, 6.9}) {
    const Reading reading = read_between(values, at);
    EXPECT_NEAR(reading.value, cubic(at), kRounding * 1e3) << at;
    EXPECT_NEAR(reading.slope, cubic_slope(at), kRounding * 1e3) << at;
  }
}

TEST(ReadBetween, HoldsTheEnds) {
  const std::vector<double> values = {3.0, 1.0, 4.0, 1.0, 5.0};
  for (const auto& [at, value] :
       {std::pair(-2.0, 3.0), std::pair(0.0, 3.0), std::pair(4.0, 5.0), std::pair(9.0, 5.0)}) {
    EXPECT_EQ(read_between(values, at).value, value);
    EXPECT_EQ(read_between(values, at).slope, 0.0);
  }
}

TEST(QuadratureWeights, IntegrateStraightLinesToAnyEnd) {
  constexpr double kStep = 0.1;
  for (const double end : {0.0, 0.04, 0.1, 0.25, 0.3, 0.31}) {
    const std::vector<double> weights = quadrature_weights(kStep, end);
    double sum = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * (1.0 + 3.0 * kStep * static_cast<double>(i));
    EXPECT_NEAR(sum, end + 1.5 * end * end, kRounding) << end;
  }
}

TEST(NoiseLevel, OfWhiteNoiseIsItsVarianceAndOneSample) {
  constexpr double kSampling = 0.25;  // regression: of 4000 numbers; chance adds to the samples
  test::Random random(3);
  std::vector<double> noise(4000);
  for (double& value : noise) value = 2.0 * test::normal_number(random);
  const NoiseLevel level = noise_of({&noise, 1});
  EXPECT_NEAR(level.variance / 4.0, 1.0, kSampling);
  EXPECT_NEAR(level.samples, 1.0, kSampling);
}

TEST(NoiseLevel, OfCorrelatedNoiseCountsItsMemory) {
  constexpr double kMemory = 0.8, kSampling = 0.25;  // regression: relative, of 20000 numbers
  test::Random random(4);
  std::vector<double> noise(20000);
  for (std::size_t i = 1; i < noise.size(); ++i) noise[i] = kMemory * noise[i - 1] + test::normal_number(random);
  const NoiseLevel level = noise_of({&noise, 1});
  EXPECT_NEAR(level.samples / ((1.0 + kMemory) / (1.0 - kMemory)), 1.0, kSampling);
}

TEST(NoiseLevel, OfNoDifferencesIsNone) {
  const std::vector<std::vector<double>> none(2, std::vector<double>(50, 0.0));
  EXPECT_EQ(noise_of(none).variance, 0.0);
  EXPECT_EQ(noise_of(none).samples, 1.0);
}

}  // namespace
}  // namespace crashsim
