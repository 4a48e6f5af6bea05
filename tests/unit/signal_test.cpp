#include <crashsim/signal.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <ostream>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/error.hpp>
#include <crashsim/units.hpp>

namespace crashsim {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kDt = 1e-4;
constexpr double kRounding = 1e-12;              // rounding: a few hundred eps on values of order 1..10
constexpr double kPublishedDigits = 1e-11;       // regression: the coefficients are given to 12 digits
constexpr double kPublishedGainDigits = 0.5e-5;  // regression: the gain is given to 5 digits

std::vector<double> rough_ramp(int count) {
  std::vector<double> x;
  for (int i = 0; i < count; ++i) x.push_back((i * i * 7919 % 1009) / 1009.0 - 0.5 + 0.01 * i);
  return x;
}

struct PublishedSection {
  double cfc;
  CfcStandard standard;
  double b0, a1, a2;
};
void PrintTo(const PublishedSection& s, std::ostream* out) { *out << name_of(s.standard) << "_CFC" << s.cfc; }

class CfcSection : public testing::TestWithParam<PublishedSection> {};

TEST_P(CfcSection, HasThePublishedCoefficients) {
  const auto& p = GetParam();
  const CfcCoefficients c = cfc_coefficients(p.cfc, kDt, p.standard);
  EXPECT_NEAR(c.b0, p.b0, kPublishedDigits);
  EXPECT_NEAR(c.a1, p.a1, kPublishedDigits);
  EXPECT_NEAR(c.a2, p.a2, kPublishedDigits);
  EXPECT_EQ(c.b1, 2 * c.b0);
  EXPECT_EQ(c.b2, c.b0);
  EXPECT_NEAR(c.b0 + c.b1 + c.b2 + c.a1 + c.a2, 1.0, kRounding) << "gain at 0 Hz";
}

// J211: SIGNALS.md 2. ISO 6487: scipy.signal.butter(2, 2 CFC/0.6 * 1.25 T), SciPy 1.17.
INSTANTIATE_TEST_SUITE_P(
    At10kHz, CfcSection,
    testing::Values(
        PublishedSection{60, CfcStandard::j211, .00145236747355, 1.88934322422, -.895152694116},
        PublishedSection{180, CfcStandard::j211, .0117962710998, 1.67011746327, -.717302547667},
        PublishedSection{600, CfcStandard::j211, .0971846252794, .945574009062, -.334312510179},
        PublishedSection{1000, CfcStandard::j211, .219231417219, .311896544996, -.188822213872},
        PublishedSection{60, CfcStandard::iso6487, .001460316305527735, 1.8890330793945245, -.8948743446166354},
        PublishedSection{180, CfcStandard::iso6487, .01185768264324116, 1.6692031429311929, -.7166338735041575},
        PublishedSection{1000, CfcStandard::iso6487, .22019470027295862, .30756635979221014, -.18834516088404454}));

TEST(CfcFilter, Cfc60PassesSeventyPercentAt100Hz) {
  std::vector<double> wave(4000);
  for (std::size_t i = 0; i < wave.size(); ++i)
    wave[i] = std::sin(2 * std::numbers::pi * 100.0 * kDt * static_cast<double>(i));
  const auto filtered = cfc_filter(wave, kDt, 60);
  double top = 0.0, dot = 0.0, norm = 0.0;
  for (std::size_t i = 1000; i < 3000; ++i) {
    top = std::max(top, filtered[i]);
    dot += filtered[i] * wave[i];
    norm += wave[i] * wave[i];
  }
  EXPECT_NEAR(dot / norm, 0.70725, kPublishedGainDigits);
  EXPECT_NEAR(top, 0.70725, kPublishedGainDigits) << "in phase: the peak is where the wave's is";
}

// An independent program: scipy.signal.butter and lfilter (SciPy 1.17) forward and backward over numpy arrays padded
// with 2 x_0 - x_i, lfiltic started from the mean of the first ten samples, on the series of rough_ramp().
TEST(CfcFilter, AgreesWithAnIndependentProgram) {
  struct Case {
    int count;
    double dt_s, cfc;
    CfcStandard standard;
    std::vector<std::pair<std::size_t, double>> expected;
  };
  const std::vector<Case> cases = {
      {400,
       kDt,
       60,
       CfcStandard::j211,
       {{0, -0.49960629055881617},
        {1, -0.46381966174486916},
        {57, 0.5842585142213367},
        {200, 1.9507297739255363},
        {399, 4.000894584586705}}},
      {400,
       kDt,
       180,
       CfcStandard::j211,
       {{1, -0.4059851250051887}, {57, 0.5580515811754947}, {399, 4.001397429309262}}},
      {400, kDt, 60, CfcStandard::iso6487, {{0, -0.4996126722854742}, {57, 0.5841412097815056}}},
      {40, kDt, 180, CfcStandard::j211, {{0, -0.500073973229169}, {20, 0.16641582520943227}, {39, 0.2518464357402837}}},
      {400,
       2e-5,
       60,
       CfcStandard::j211,
       {{0, -0.49832246649233064}, {200, 2.037489747951865}, {399, 4.006896613485813}}},
  };
  for (const Case& c : cases) {
    const auto y = cfc_filter(rough_ramp(c.count), c.dt_s, c.cfc, c.standard);
    ASSERT_EQ(y.size(), static_cast<std::size_t>(c.count));
    for (const auto& [i, value] : c.expected)
      EXPECT_NEAR(y[i], value, kRounding) << "CFC" << c.cfc << ", " << c.count << " samples, sample " << i;
  }
}

TEST(CfcFilter, KeepsConstantsAndStraightLinesOffTheEnds) {
  std::vector<double> line(2000);
  for (std::size_t i = 0; i < line.size(); ++i) line[i] = 3.0 + 0.002 * static_cast<double>(i);
  const auto filtered = cfc_filter(line, kDt, 60);
  EXPECT_NEAR(filtered[1000], line[1000], kRounding);
  for (const double y : cfc_filter(std::vector<double>(50, 7.0), kDt, 60)) EXPECT_NEAR(y, 7.0, kRounding);
}

TEST(CfcFilter, RefusesARateBelowTenTimesTheClass) {
  EXPECT_THAT([] { cfc_coefficients(60, 1.0 / 500.0); },
              ThrowsMessage<InvalidInput>(AllOf(HasSubstr("sampling rate 500 Hz is too low for CFC60"),
                                                HasSubstr("10 x 60 = 600 Hz"), HasSubstr("choose a lower class"))));
  EXPECT_NO_THROW(cfc_coefficients(1000, 1.0000001e-4)) << "10 kHz read from rounded times";
  EXPECT_THAT([] { cfc_coefficients(-1, kDt); }, ThrowsMessage<InvalidInput>(HasSubstr("cfc = -1 Hz: must be > 0")));
  EXPECT_THAT(
      [] {
        cfc_filter(std::vector<double>{1, 2}, kDt, 60);
      },
      ThrowsMessage<InvalidInput>(HasSubstr("2 samples: at least 3")));
}

TEST(Calculus, TrapezoidsAreExactForLinesAndDifferencesForParabolas) {
  const std::vector<double> t = {0.0, 0.1, 0.25, 0.7, 1.0};
  std::vector<double> line, parabola;
  for (const double x : t) line.push_back(2.0 - 3.0 * x), parabola.push_back(1.0 + 2.0 * x - 1.5 * x * x);
  const auto sum = integrate(t, line, 1.0);
  const auto rate = differentiate(t, parabola);
  for (std::size_t i = 0; i < t.size(); ++i) EXPECT_NEAR(sum[i], parabola[i], kRounding);
  for (std::size_t i = 1; i + 1 < t.size(); ++i) EXPECT_NEAR(rate[i], line[i], kRounding);
  EXPECT_NEAR(rate.front(), (parabola[1] - parabola[0]) / 0.1, kRounding);
  EXPECT_THAT([] { differentiate(std::vector<double>{0}, std::vector<double>{1}); },
              ThrowsMessage<InvalidInput>(HasSubstr("at least 2 are needed")));
}

TEST(Resampling, IsLinearAndReachesBothEnds) {
  const std::vector<double> t = {0.0, 1.0, 3.0}, y = {1.0, 2.0, -2.0};
  EXPECT_THAT(resample(t, y, std::vector<double>{0.0, 0.5, 1.0, 2.0, 3.0}), testing::ElementsAre(1, 1.5, 2, 0, -2));
  EXPECT_THAT(uniform_times(0.5, 0.25, 3), testing::ElementsAre(0.5, 0.75, 1.0));
}

TEST(Resampling, AStepIsUniformWithinTwoPercent) {
  EXPECT_NEAR(uniform_step(std::vector<double>{0.0, 0.1001, 0.1999, 0.3}), 0.1, kRounding);
  EXPECT_TRUE(std::isnan(uniform_step(std::vector<double>{0.0, 0.1, 0.21, 0.3})));
  EXPECT_TRUE(std::isnan(uniform_step(std::vector<double>{0.0})));
}

TEST(Bias, IsTheMeanOfAHalfOpenWindow) {
  const std::vector<double> t = {-2, -1, 0, 1}, y = {3, 5, 100, 100};
  EXPECT_EQ(mean_between(t, y, -2, 0), 4.0);
  EXPECT_THAT(
      [&] { mean_between(t, y, 5, 6); },
      ThrowsMessage<InvalidInput>(AllOf(HasSubstr("no samples with 5 s <= time < 6 s"), HasSubstr("-2 to 1 s"))));
}

TEST(FindTimeZero, WalksBackFromFiveGToHalfAG) {
  const double g = kStandardGravity;
  const std::vector<double> t = {0, 1, 2, 3, 4, 5}, a = {0.1 * g, -0.7 * g, 0.2 * g, -1.0 * g, -4.9 * g, -6.0 * g};
  EXPECT_EQ(find_time_zero(t, a), 2.0);
  EXPECT_EQ(find_time_zero(std::vector<double>{7, 8}, std::vector<double>{6 * g, 7 * g}), 7.0);
  EXPECT_THAT([&] { find_time_zero(t, std::vector<double>(6, 1.0)); },
              ThrowsMessage<InvalidInput>(AllOf(HasSubstr("never reaches 5 g"), HasSubstr("give the time of impact"))));
}

TEST(CheckSeries, NamesTheSampleThatIsWrong) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> t = {0, 1, 2};
  const auto refuses = [&](std::vector<double> times, std::vector<double> values, const char* text) {
    EXPECT_THAT([&] { check_series(times, values, "channel 93"); }, ThrowsMessage<InvalidInput>(HasSubstr(text)));
  };
  refuses({0, 1}, {1, 2}, "channel 93: 2 samples: at least 3 are needed");
  refuses({0, 1, 2}, {1, 2}, "channel 93: 3 times but 2 values");
  refuses({0, 1, 2}, {1, nan, 2}, "channel 93: sample 2 at 1 s is nan: must be finite");
  refuses({0, nan, 2}, {1, 1, 2}, "channel 93: time of sample 2 is nan: must be finite");
  refuses({0, 2, 2}, {1, 1, 1}, "channel 93: time of sample 3 is 2 s, not after the one before it, 2 s");
  EXPECT_NO_THROW(check_series(t, t, "channel 93"));
}

}  // namespace
}  // namespace crashsim
