#include <crashsim/rating.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <ostream>
#include <vector>

#include <gmock/gmock.h>

#include "support/rating_pairs.hpp"

namespace crashsim {
namespace {

constexpr double kRounding = 1e-10;       // sums of some thousand terms in another order
constexpr double kPrintedDigits = 6e-10;  // scores given to nine digits

struct ReferenceScore {
  std::uint64_t seed;
  double dt_s, overall, corridor, phase, magnitude, slope;
};
void PrintTo(const ReferenceScore& score, std::ostream* out) { *out << "seed_" << score.seed; }

constexpr ReferenceScore kScores[] = {
#include "iso18571_reference.inc"
};

class Iso18571 : public testing::TestWithParam<ReferenceScore> {};

TEST_P(Iso18571, AgreesWithTheReferenceImplementation) {
  const ReferenceScore& expected = GetParam();
  const test::RatingPair pair = test::rating_pair(expected.seed);
  const Rating rating = rate(pair.reference, pair.candidate, expected.dt_s);
  EXPECT_NEAR(rating.corridor, expected.corridor, kRounding);
  EXPECT_NEAR(rating.phase, expected.phase, kRounding);
  EXPECT_NEAR(rating.magnitude, expected.magnitude, kRounding);
  EXPECT_NEAR(rating.slope, expected.slope, kRounding);
  EXPECT_NEAR(rating.overall, expected.overall, kRounding);
}

INSTANTIATE_TEST_SUITE_P(RandomPairs, Iso18571, testing::ValuesIn(kScores));

/// Half-sine of 20 g and 100 ms in 150 ms at 10 kHz.
std::vector<double> half_sine(double scale, double start_s) {
  std::vector<double> values(1500);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double phase = (static_cast<double>(i) * 1e-4 - start_s) / 0.1;
    if (phase > 0.0 && phase < 1.0) values[i] = scale * 20.0 * std::sin(std::numbers::pi * phase);
  }
  return values;
}

TEST(Iso18571Vectors, IdenticalCurvesScoreOne) {
  const auto pulse = half_sine(1.0, 0.010);
  const Rating rating = rate(pulse, pulse, 1e-4);
  for (const auto& field : kRatingFields) EXPECT_EQ(rating.*field.member, 1.0) << field.name;
}

TEST(Iso18571Vectors, ScaledHalfSine) {
  const Rating rating = rate(half_sine(1.0, 0.010), half_sine(0.9, 0.010), 1e-4);
  EXPECT_NEAR(rating.overall, 0.955984719, kPrintedDigits);
  EXPECT_NEAR(rating.corridor, 0.938256524, kPrintedDigits);
  EXPECT_EQ(rating.phase, 1.0);
  EXPECT_NEAR(rating.magnitude, 0.953410545, kPrintedDigits);
  EXPECT_NEAR(rating.slope, 0.95, kPrintedDigits);
}

TEST(Iso18571Vectors, DelayedHalfSine) {
  const Rating rating = rate(half_sine(1.0, 0.010), half_sine(1.0, 0.013), 1e-4);
  EXPECT_NEAR(rating.overall, 0.959549029, kPrintedDigits);
  EXPECT_NEAR(rating.corridor, 0.948872572, kPrintedDigits);
  EXPECT_NEAR(rating.phase, 0.9, kRounding);
  EXPECT_NEAR(rating.magnitude, 1.0, kRounding);
  EXPECT_NEAR(rating.slope, 1.0, kRounding);
}

TEST(Iso18571Vectors, ScaledAndDelayedHalfSine) {
  const Rating rating = rate(half_sine(1.0, 0.010), half_sine(0.9, 0.013), 1e-4);
  EXPECT_NEAR(rating.overall, 0.915996726, kPrintedDigits);
  EXPECT_NEAR(rating.corridor, 0.888286542, kPrintedDigits);
  EXPECT_NEAR(rating.phase, 0.9, kRounding);
  EXPECT_NEAR(rating.magnitude, 0.953410545, kPrintedDigits);
  EXPECT_NEAR(rating.slope, 0.95, kPrintedDigits);
}

}  // namespace
}  // namespace crashsim
