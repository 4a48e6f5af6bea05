#include <crashsim/rating.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <gmock/gmock.h>

#include "dtw.hpp"
#include "support/rating_pairs.hpp"

namespace crashsim {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kRounding = 1e-12;
constexpr double kStep = 1e-4;

std::vector<double> ramp(std::size_t count, double offset, double slope) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = offset + slope * static_cast<double>(i);
  return values;
}

TEST(Rating, AmbiguousShiftIsTheShortest) {
  EXPECT_EQ(rate(ramp(200, 1.0, 0.3), ramp(200, 1.5, 0.3), kStep).phase, 1.0);
}

TEST(Rating, ConstantCurvesHaveNoShift) {
  const Rating rating = rate(ramp(50, 2.0, 0.0), ramp(50, 2.2, 0.0), kStep);
  EXPECT_EQ(rating.phase, 1.0);
  EXPECT_NEAR(rating.magnitude, 0.8, kRounding);
  EXPECT_EQ(rating.slope, 1.0);
  EXPECT_EQ(rate(ramp(50, 2.0, 0.0), ramp(50, 2.0, 0.1), kStep).slope, 0.0);
}

TEST(Rating, CorridorFallsFromInnerToOuterAsAParabola) {
  const auto reference = ramp(20, 1.0, 0.0);
  EXPECT_EQ(rate(reference, ramp(20, 1.04, 0.0), kStep).corridor, 1.0);
  EXPECT_NEAR(rate(reference, ramp(20, 1.275, 0.0), kStep).corridor, 0.25, kRounding);
  EXPECT_EQ(rate(reference, ramp(20, 0.49, 0.0), kStep).corridor, 0.0);
}

TEST(Rating, OppositeCurvesScoreNothingButThePhaseTheyReach) {
  const auto pair = test::rating_pair(3);
  std::vector<double> opposite(pair.reference);
  for (double& value : opposite) value = -value;
  const Rating rating = rate(pair.reference, opposite, kStep);
  EXPECT_EQ(rating.magnitude, 0.0);
  EXPECT_LT(rating.overall, 0.58);
}

TEST(Rating, TenSamplesAreEnough) {
  const auto pulse = test::rating_pair(1).reference;
  const std::vector<double> ten(pulse.end() - 60, pulse.end() - 50);
  EXPECT_EQ(rate(ten, ten, kStep).overall, 1.0);
}

TEST(Rating, RefusesWhatCannotBeRated) {
  const auto ten = ramp(10, 1.0, 1.0);
  EXPECT_THAT([&] { rate(ten, ramp(11, 0, 1), kStep); },
              ThrowsMessage<InvalidInput>(HasSubstr("reference has 10 samples but candidate has 11")));
  EXPECT_THAT([&] { rate(ramp(9, 0, 1), ramp(9, 0, 1), kStep); },
              ThrowsMessage<InvalidInput>(HasSubstr("9 samples to compare: at least 10 are needed")));
  EXPECT_THAT([&] { rate(ramp(40, 0, 1), ramp(40, 0, 1), 1e-5); },
              ThrowsMessage<InvalidInput>(HasSubstr("at least 10 samples at 10 kHz are needed")));
  EXPECT_THAT([&] { rate(ten, ten, 0.0); }, ThrowsMessage<InvalidInput>(HasSubstr("dt_s = 0 s: must be > 0")));
  EXPECT_THAT([&] { rate(ten, ten, 1.0); }, ThrowsMessage<InvalidInput>(HasSubstr("at most 2 s can be rated")));
  EXPECT_THAT([&] { rate(ramp(10, 0, 0), ten, kStep); },
              ThrowsMessage<InvalidInput>(HasSubstr("the reference is zero throughout")));
  auto holed = ten;
  holed[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { rate(ten, holed, kStep); },
              ThrowsMessage<InvalidInput>(HasSubstr("candidate[4] = nan: must be finite")));
  EXPECT_THAT([&] { rate(holed, ten, kStep); },
              ThrowsMessage<InvalidInput>(HasSubstr("reference[4] = nan: must be finite")));
}

TEST(Rating, GradesHaveOpenLowerEnds) {
  EXPECT_EQ(grade(0.941), "excellent");
  EXPECT_EQ(grade(0.94), "good");
  EXPECT_EQ(grade(0.80), "fair");
  EXPECT_EQ(grade(0.58), "poor");
  EXPECT_EQ(grade(kUnset), "unrated");
}

TEST(Errors, AreThoseOfTheDefinition) {
  const ErrorSummary summary = errors(std::vector{0.0, -4.0, 2.0}, std::vector{1.0, -4.0, 4.0});
  EXPECT_DOUBLE_EQ(summary.mean_abs, 1.0);
  EXPECT_DOUBLE_EQ(summary.rms, std::sqrt(5.0 / 3.0));
  EXPECT_DOUBLE_EQ(summary.max_abs, 2.0);
  EXPECT_DOUBLE_EQ(summary.mean_abs_relative, 0.25);
}

TEST(Errors, OfAZeroReferenceHaveNoRelativeOne) {
  const ErrorSummary summary = errors(std::vector{0.0, 0.0}, std::vector{1.0, 0.0});
  EXPECT_DOUBLE_EQ(summary.mean_abs, 0.5);
  EXPECT_TRUE(std::isnan(summary.mean_abs_relative));
}

TEST(Errors, RefuseUnequalOrEmptySeries) {
  EXPECT_THAT(
      [] {
        errors(std::vector{1.0}, std::vector{1.0, 2.0});
      },
      ThrowsMessage<InvalidInput>(HasSubstr("reference has 1 samples but candidate has 2")));
  EXPECT_THAT([] { errors({}, {}); }, ThrowsMessage<InvalidInput>(HasSubstr("0 samples to compare")));
}

double cost(const std::vector<double>& a, const std::vector<double>& b, std::size_t band) {
  double sum = 0.0;
  for (const auto [i, j] : warp(a, b, band)) sum += (a[i] - b[j]) * (a[i] - b[j]);
  return sum;
}

/// Smallest cost from (i, j) to the end by trying every path.
double exhaustive(const std::vector<double>& a, const std::vector<double>& b, std::size_t band, std::size_t i,
                  std::size_t j) {
  if (i >= a.size() || j >= b.size() || (i > j ? i - j : j - i) > band) return std::numeric_limits<double>::infinity();
  const double here = (a[i] - b[j]) * (a[i] - b[j]);
  if (i + 1 == a.size() && j + 1 == b.size()) return here;
  return here + std::min({exhaustive(a, b, band, i + 1, j), exhaustive(a, b, band, i, j + 1),
                          exhaustive(a, b, band, i + 1, j + 1)});
}

TEST(Warp, IsTheCheapestPathOfAllWithinTheBand) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    test::Congruential random(seed);
    std::vector<double> a(7), b(7);
    for (double& value : a) value = random.next();
    for (double& value : b) value = random.next();
    for (const std::size_t band : {0u, 1u, 2u, 6u, 9u})
      EXPECT_NEAR(cost(a, b, band), exhaustive(a, b, band, 0, 0), kRounding) << "seed " << seed << " band " << band;
  }
}

}  // namespace
}  // namespace crashsim
