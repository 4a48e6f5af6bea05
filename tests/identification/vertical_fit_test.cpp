/// Laws of the vertical force found again from the force they give, and what is said where they cannot be.

#include <ostream>

#include <gmock/gmock.h>

#include <crashsim/option_values.hpp>

#include "support/vertical_fit_cases.hpp"

namespace crashsim {
namespace {

using testing::Contains;
using testing::HasSubstr;
using L = VerticalForceLaw;

constexpr double kRecovered = 1e-6;  // solver: relative, as asked

struct Twin {
  const char* name;
  L truth, guess;
  std::vector<std::string> free;
  Loss loss = Loss::l1;
};
void PrintTo(const Twin& twin, std::ostream* out) { *out << twin.name; }

class VerticalTwin : public testing::TestWithParam<Twin> {};

TEST_P(VerticalTwin, IsFoundAgain) {
  const Twin& twin = GetParam();
  IdentifyVerticalOptions options;
  options.free = twin.free;
  options.loss = twin.loss;
  options.starts = 100;
  const VerticalIdentification fit = identify_vertical(test::measured_by(twin.truth), twin.guess, options);
  ASSERT_TRUE(fit.usable()) << fit.message;
  for (const Field<L>& field : fields<L>) {
    const auto member = std::get<double L::*>(field.member);
    if (std::isnan(twin.truth.*member)) continue;
    EXPECT_NEAR(fit.law.*member, twin.truth.*member, kRecovered * std::fabs(twin.truth.*member)) << field.name;
  }
  EXPECT_TRUE(fit.verdict.identifiable) << fit.verdict.message;
  EXPECT_GE(fit.starts_at_best, 2);
  ASSERT_EQ(fit.parameters.size(), twin.free.size());
  for (const ParameterReport& parameter : fit.parameters) {
    EXPECT_FALSE(parameter.at_bound || parameter.untouched) << parameter.name;
    EXPECT_LT(parameter.standard_error, kRecovered * std::fabs(parameter.value)) << parameter.name;
  }
  EXPECT_EQ(fit.samples, 192);  // of the vertical force
  EXPECT_EQ(fit.limited_samples > 0, !std::isnan(twin.truth.friction));
}

const std::vector<std::string> kAngles = {"angle", "angle-rate"}, kUsual = IdentifyVerticalOptions().free;
const std::vector<std::string> kAll = {"angle", "angle-rate", "angle-start", "friction"};
INSTANTIATE_TEST_SUITE_P(Cases, VerticalTwin,
                         testing::Values(Twin{"usual", {0.05, 0.6, 0.0, 0.3}, {}, kUsual},
                                         Twin{"usual_squared", {0.05, 0.6, 0.0, 0.3}, {}, kUsual, Loss::l2},
                                         Twin{"usual_huber", {0.05, 0.6, 0.0, 0.3}, {}, kUsual, Loss::huber},
                                         Twin{"upwards", {-0.1, -0.7, 0.0, 0.35}, {}, kUsual},
                                         Twin{"without_friction", {0.1, 0.5, 0.0, kUnset}, {}, kAngles},
                                         Twin{"from_down_to_up", {0.2, -1.5, 0.1, 0.3}, {0.0, 0.0, 0.1, 0.3}, kAngles},
                                         Twin{"all_four", {0.05, 1.0, 0.15, 0.3}, {}, kAll},
                                         Twin{"all_four_squared", {0.05, 1.0, 0.15, 0.3}, {}, kAll, Loss::l2},
                                         Twin{"a_constant_angle", {0.2, 0.0, 0.0, kUnset}, {}, {"angle"}}),
                         [](const auto& twin) { return std::string(twin.param.name); });

VerticalIdentification refit(const L& truth, std::vector<std::string> free) {
  IdentifyVerticalOptions options;
  options.free = std::move(free);
  options.loss = Loss::l2;
  options.starts = 1;
  return identify_vertical(test::measured_by(truth), truth, options);
}

TEST(VerticalVerdict, SaysThatFrictionNeverActed) {
  const VerticalIdentification fit = refit({0.1, 0.2, 0.0, 0.9}, kUsual);
  EXPECT_TRUE(fit.usable());
  EXPECT_FALSE(fit.verdict.identifiable);
  EXPECT_TRUE(fit.parameters[2].untouched);
  EXPECT_TRUE(std::isnan(fit.parameters[2].standard_error));
  EXPECT_EQ(fit.limited_samples, 0);
  EXPECT_THAT(fit.verdict.message, HasSubstr("no sample depends on friction"));
}

TEST(VerticalVerdict, SaysThatAConstantAngleHasNoStartOfChange) {
  const VerticalIdentification fit = refit({0.2, 0.0, 0.3, kUnset}, {"angle", "angle_start"});
  EXPECT_FALSE(fit.verdict.identifiable);
  EXPECT_THAT(fit.verdict.message, HasSubstr("no sample depends on angle_start_m"));
}

TEST(VerticalVerdict, SaysThatFrictionHidesTheAngle) {
  const VerticalIdentification fit = refit({0.5, 0.0, 0.0, 0.3}, kUsual);
  EXPECT_EQ(fit.limited_samples, fit.samples);
  EXPECT_FALSE(fit.verdict.identifiable);
  EXPECT_TRUE(fit.parameters[0].untouched && fit.parameters[1].untouched);
  EXPECT_FALSE(fit.parameters[2].untouched);
}

/// From the first sample on, a later start of the change is a smaller angle.
TEST(VerticalVerdict, SaysThatAStartBeforeTheSamplesIsAnAngle) {
  const L truth{0.1, 0.5, 0.05, kUnset};
  IdentifyVerticalOptions options;
  options.free = {"angle", "angle-rate", "angle-start"};
  options.loss = Loss::l2;
  options.starts = 1;
  options.from_s = 0.02;  // crush 0.18 m
  const VerticalIdentification fit = identify_vertical(test::measured_by(truth), truth, options);
  EXPECT_FALSE(fit.verdict.identifiable);
  EXPECT_EQ(fit.verdict.rank, 2);
  EXPECT_THAT(fit.verdict.message, HasSubstr("cannot be told apart"));
}

TEST(VerticalFit, WarnsOfABoundThatHolds) {
  IdentifyVerticalOptions options;
  options.free = {"angle", "friction"};
  options.upper = {0.15, 1.0};
  options.starts = 4;
  const VerticalIdentification fit = identify_vertical(test::measured_by({.angle_rad = 0.2}), {}, options);
  EXPECT_TRUE(fit.parameters[0].at_bound);
  EXPECT_THAT(fit.warnings, Contains(HasSubstr("angle_rad = 0.15 rad is at its bound")));
}

TEST(VerticalFit, DoesNotDependOnTheNumberOfThreads) {
  IdentifyVerticalOptions options;
  options.starts = 5;
  options.jobs = 1;
  const VerticalForceTarget target = test::measured_by({0.05, 0.6, 0.0, 0.3});
  const VerticalIdentification alone = identify_vertical(target, {}, options);
  options.jobs = 3;
  EXPECT_EQ(identify_vertical(target, {}, options).law, alone.law);
}

TEST(VerticalFit, StoppedKeepsWhatIsFinished) {
  IdentifyVerticalOptions options;
  options.starts = 100000;
  options.jobs = 1;
  const VerticalIdentification fit =
      identify_vertical(test::measured_by({0.05, 0.6, 0.0, 0.3}), {}, options, [](int done, int) { return done < 1; });
  EXPECT_EQ(fit.outcome, IdentifyOutcome::interrupted);
  EXPECT_FALSE(fit.usable());
  EXPECT_LT(fit.starts.size(), 100000U);
}

}  // namespace
}  // namespace crashsim
