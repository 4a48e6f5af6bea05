/// Where identification puts its knots.

#include <gmock/gmock.h>

#include <crashsim/identify.hpp>

#include "support/fit_cases.hpp"

namespace crashsim {
namespace {

Pulse example_pulse() {
  const CrushModel model = test::example_model();
  return test::pulse_of(model, model.impact_speed_mps).value();
}

CrushModel linear_fit(const Pulse& pulse, const IdentifyOptions& options) {
  IdentifyOptions linear = options;
  linear.method = IdentifyMethod::equation_error;
  return identify(pulse, linear).model;
}

void expect_increasing_from_zero(const std::vector<double>& knots) {
  ASSERT_FALSE(knots.empty());
  EXPECT_EQ(knots.front(), 0.0);
  for (std::size_t i = 1; i < knots.size(); ++i) EXPECT_GT(knots[i], knots[i - 1]) << "knot " << i;
}

TEST(Knots, UniformReachFromZeroToTheMaxima) {
  const Pulse pulse = example_pulse();
  IdentifyOptions options;
  options.spring_knots = 4;
  options.damper_knots = 3;
  const CrushModel model = linear_fit(pulse, options);
  EXPECT_EQ(model.spring.knots, uniform_knots(pulse.max_crush_m, 4));
  EXPECT_EQ(model.damper.knots, uniform_knots(pulse.impact_speed_mps, 3));
}

TEST(Knots, QuantilesHoldEqualNumbersOfSamples) {
  const Pulse pulse = example_pulse();
  IdentifyOptions options;
  options.knots.rule = KnotPlacement::quantile;
  options.spring_knots = 5;
  const std::vector<double> knots = linear_fit(pulse, options).spring.knots;
  expect_increasing_from_zero(knots);
  EXPECT_EQ(knots.back(), pulse.max_crush_m);
  double total = 0.0;
  std::vector<double> counts(4);
  for (std::size_t i = 0; i < pulse.time_s.size() && pulse.time_s[i] <= pulse.t_m_s; ++i, ++total)
    for (std::size_t k = 0; k + 1 < knots.size(); ++k)
      if (pulse.displacement_m[i] >= knots[k] && (pulse.displacement_m[i] < knots[k + 1] || k + 2 == knots.size()))
        ++counts[k];
  constexpr double kUneven = 3.0;  // rounding: samples at the knots themselves
  for (const double count : counts) EXPECT_NEAR(count, total / 4.0, kUneven);
}

/// A sensor that repeats a value over half the pulse: quantiles alone would put several knots at one place.
TEST(Knots, QuantilesOfAPlateauStayApart) {
  Pulse pulse = example_pulse();
  const std::size_t n = pulse.time_s.size();
  for (std::size_t i = 0; i < n / 2; ++i) pulse.velocity_mps[i] = pulse.impact_speed_mps;
  for (std::size_t i = n / 3; i < 5 * n / 6; ++i) pulse.displacement_m[i] = pulse.displacement_m[n / 3];
  IdentifyOptions options;
  options.knots.rule = KnotPlacement::quantile;
  for (const int count : {2, 3, 7, 20}) {
    options.spring_knots = options.damper_knots = count;
    const CrushModel model = linear_fit(pulse, options);
    EXPECT_EQ(model.spring.knots.size(), static_cast<std::size_t>(count));
    expect_increasing_from_zero(model.spring.knots);
    expect_increasing_from_zero(model.damper.knots);
    EXPECT_EQ(model.damper.knots.back(), pulse.impact_speed_mps);
  }
}

TEST(Knots, GivenSetTheDampersAtTheSameFractionsOfTheSpeed) {
  const Pulse pulse = example_pulse();
  IdentifyOptions options;
  options.knots = {KnotPlacement::given, {0.0, 0.125, 0.25, 0.5}};
  const CrushModel model = linear_fit(pulse, options);
  const double v = pulse.impact_speed_mps;
  EXPECT_EQ(model.spring.knots, options.knots.numbers);
  EXPECT_THAT(model.damper.knots, testing::ElementsAre(0.0, 0.25 * v, 0.5 * v, v));
  options.damper_knots = 0;
  EXPECT_TRUE(linear_fit(pulse, options).damper.knots.empty());
  options.damper_knots = 7;
  options.spring_knots = 0;
  EXPECT_TRUE(linear_fit(pulse, options).spring.knots.empty());
  EXPECT_EQ(linear_fit(pulse, options).damper.knots.size(), 4U);
}

TEST(Knots, OneIsAConstant) {
  IdentifyOptions options;
  options.spring_knots = options.damper_knots = 1;
  for (const KnotPlacement placement : {KnotPlacement::uniform, KnotPlacement::quantile}) {
    options.knots.rule = placement;
    const CrushModel model = linear_fit(example_pulse(), options);
    EXPECT_EQ(model.spring.knots, std::vector<double>{0.0});
    EXPECT_EQ(model.damper.knots, std::vector<double>{0.0});
  }
}

TEST(Knots, NoneLeavesACurveOut) {
  IdentifyOptions options;
  options.spring_knots = 0;
  options.starts = 2;
  const Identification damper = identify(example_pulse(), options);
  EXPECT_TRUE(damper.usable()) << damper.brief_report();
  EXPECT_TRUE(damper.model.spring.knots.empty());
  EXPECT_EQ(damper.ordinates.front().name, "c1");
}

TEST(Knots, AsManyAsAHundredAreFitted) {
  IdentifyOptions options;
  options.spring_knots = options.damper_knots = 100;
  options.method = IdentifyMethod::equation_error;
  const Identification fit = identify(example_pulse(), options);
  EXPECT_TRUE(fit.usable()) << fit.brief_report();
  EXPECT_FALSE(fit.verdict.identifiable);
}

/// Two pulses: the knots reach to the deeper and the faster of them.
TEST(Knots, OfAJointFitReachToTheLargest) {
  const CrushModel model = test::example_model();
  const std::vector<Pulse> pulses = {test::pulse_of(model, 10.0).value(), test::pulse_of(model, 14.0).value()};
  IdentifyOptions options;
  options.method = IdentifyMethod::equation_error;
  const Identification fit = identify(pulses, options);
  EXPECT_EQ(fit.model.spring.knots.back(), pulses[1].max_crush_m);
  EXPECT_EQ(fit.model.damper.knots.back(), 14.0);
}

}  // namespace
}  // namespace crashsim
