#include <crashsim/design.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/units.hpp>

#include "support/coupled_cases.hpp"

namespace crashsim {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::ThrowsMessage;

constexpr double kMass = 1500.0, kStiffness = 1e6, kSpeed = 15.0;
constexpr double kSlope = 1e-6;    // solver: relative, of an extrapolated difference
constexpr double kOptimum = 1e-5;  // solver: relative, of an optimum on a limit

/// A linear spring at the height of the centre of gravity: travel is C sin(w t), C = v0 sqrt(m / k), and nothing
/// pitches.
CoupledModel linear_model() {
  CoupledModel model;
  model.crush = test::kelvin_model(kMass, kStiffness, 0.0, kSpeed);
  model.body = test::oracle_vehicle();
  model.body.mass_kg = kUnset;
  model.body.cg_height_m = model.body.force_height_m = 0.5;
  return model;
}

CoupledOptions short_run() {
  CoupledOptions options;
  options.end_time_s = 0.15;
  return options;
}

DesignOptions stiffness_only(DesignQuantity minimise = DesignQuantity::none) {
  DesignOptions options;
  options.parameters = {"k1"};
  options.lower = {"300 kN/m"};
  options.upper = {"3 MN/m"};
  options.minimise = minimise;
  options.starts = 2;
  return options;
}

double derivative_of(const DesignResult& result, const std::string& response) {
  for (const DesignSensitivity& s : result.sensitivities)
    if (s.response == response) return s.derivative;
  return kUnset;
}

TEST(Design, IsPessimisticUntilItHasRun) {
  const DesignResult result;
  EXPECT_FALSE(result.usable());
  EXPECT_EQ(result.brief_report(), "not run");
  for (const auto& response : kDesignResponses) EXPECT_TRUE(std::isnan(result.after.*response.member)) << response.name;
  EXPECT_TRUE(std::isnan(design_responses({}).max_crush_m));
}

TEST(Design, SensitivitiesOfALinearSpringAreThoseOfItsClosedForm) {
  const DesignResult result = design(linear_model(), stiffness_only(), short_run());
  ASSERT_TRUE(result.usable()) << result.message;
  const double omega = std::sqrt(kStiffness / kMass);
  const double crush = kSpeed / omega, t_m = std::acos(-1.0) / 2.0 / omega, peak_g = kSpeed * omega / kStandardGravity;
  EXPECT_NEAR(result.before.peak_decel_g, peak_g, kSlope * peak_g);
  const double of_crush = -crush / (2.0 * kStiffness), of_time = -t_m / (2.0 * kStiffness),
               of_peak = peak_g / (2.0 * kStiffness);
  EXPECT_NEAR(derivative_of(result, "max_crush_m"), of_crush, kSlope * std::fabs(of_crush));
  EXPECT_NEAR(derivative_of(result, "t_m_s"), of_time, kSlope * std::fabs(of_time));
  EXPECT_NEAR(derivative_of(result, "peak_decel_g"), of_peak, kSlope * of_peak);
  EXPECT_EQ(derivative_of(result, "pitch_max_rad"), 0.0);
  const DesignSensitivity& s = result.sensitivities.at(2);
  EXPECT_EQ(s.response, "max_crush_m");
  EXPECT_NEAR(s.relative, -0.5, kSlope);
  EXPECT_LE(std::fabs(s.derivative - of_crush), s.error);
  EXPECT_LT(s.error, kSlope * std::fabs(of_crush));
  EXPECT_THAT(result.warnings, IsEmpty());
  EXPECT_EQ(result.brief_report(), "sensitivities only");
}

TEST(Design, ADerivativeAtTheEndOfWhatAParameterMayBeIsOneSided) {
  CoupledModel model = linear_model();
  model.crush.damper = {{0.0}, {0.0}};  // c >= 0
  DesignOptions options = stiffness_only();
  options.parameters = {"c1"};
  options.lower = {"0"};
  options.upper = {"20000"};
  const DesignResult result = design(model, options, short_run());
  ASSERT_TRUE(result.usable()) << result.message;
  const double omega = std::sqrt(kStiffness / kMass);
  // C = v0/w exp(-z/sqrt(1-z^2) acos z), z = c / (2 m w): dC/dz = -pi/2 C at z = 0
  const double expected = -kSpeed / omega * std::acos(-1.0) / 2.0 / (2.0 * kMass * omega);
  EXPECT_NEAR(derivative_of(result, "max_crush_m"), expected, kSlope * std::fabs(expected));
  EXPECT_TRUE(std::isnan(result.sensitivities.front().relative));
}

/// Mean of `f` over 0..end by midpoints, times end.
template <class F>
double midpoint_rule(double end, const F& f) {
  constexpr int kIntervals = 100'000;
  double sum = 0.0;
  for (int i = 0; i < kIntervals; ++i) sum += f(end * (i + 0.5) / kIntervals);
  return sum * end / kIntervals;
}

TEST(Design, TheCoefficientOfARateMayChange) {
  constexpr double kForce = 3e5, kRate = 0.1, kReference = 0.5;
  CoupledModel model = linear_model();
  model.crush.law = CrushLaw::rate;
  model.crush.spring = {{0.0}, {kForce}};
  model.crush.damper = {};
  model.crush.rate_coefficient = kRate;
  model.crush.reference_speed_mps = kReference;
  DesignOptions options = stiffness_only();
  options.parameters = {"rate_coefficient"};
  options.lower = {"0.05"};
  options.upper = {"0.3"};
  const DesignResult result = design(model, options, short_run());
  ASSERT_TRUE(result.usable()) << result.message;
  // C = m v_ref^2/f integral of (e^2u - e^u) / (1 + r u) over 0..ln(1 + v0/v_ref)
  const double end = std::log1p(kSpeed / kReference);
  const double expected = -kMass * kReference * kReference / kForce * midpoint_rule(end, [](double u) {
    const double factor = 1.0 + kRate * u;
    return (std::exp(2.0 * u) - std::exp(u)) * u / (factor * factor);
  });
  EXPECT_NEAR(derivative_of(result, "max_crush_m"), expected, kSlope * std::fabs(expected));
  model.crush = linear_model().crush;
  EXPECT_THAT([&] { design(model, options, short_run()); },
              testing::ThrowsMessage<InvalidInput>(testing::HasSubstr("unknown name 'rate_coefficient'")));
}

TEST(Design, LiesOnTheLimitWhereThatIsTheOptimum) {
  DesignOptions options = stiffness_only(DesignQuantity::peak_decel);
  options.max_crush_m = 0.7;
  const DesignResult result = design(linear_model(), options, short_run());
  ASSERT_TRUE(result.usable()) << result.message;
  const double peak_g = kSpeed * kSpeed / 0.7 / kStandardGravity;  // C a = v0^2
  EXPECT_NEAR(result.after.peak_decel_g, peak_g, kOptimum * peak_g);
  EXPECT_LE(result.after.max_crush_m, 0.7);
  ASSERT_THAT(result.limits, SizeIs(1));
  EXPECT_TRUE(result.limits[0].active);
  EXPECT_EQ(result.limits[0].after, result.after.max_crush_m);
  EXPECT_EQ(result.variables.at(0).before, kStiffness);
  EXPECT_EQ(result.optimum.crush.spring.ordinates.at(0), result.variables[0].after);
  EXPECT_FALSE(result.variables[0].at_bound);
  EXPECT_EQ(result.starts_at_best, 2);
  EXPECT_THAT(result.brief_report(), AllOf(HasSubstr("peak_decel 32.777 g, was 39.493"), HasSubstr("max_crush 0.7 m")));
}

TEST(Design, LiesAtABoundWhereThatIsTheOptimumAndSaysSo) {
  const DesignResult result = design(linear_model(), stiffness_only(DesignQuantity::max_crush), short_run());
  ASSERT_TRUE(result.usable()) << result.message;
  EXPECT_NEAR(result.variables.at(0).after, 3e6, kOptimum * 3e6);
  EXPECT_TRUE(result.variables[0].at_bound);
  EXPECT_THAT(result.warnings, testing::Contains(HasSubstr("k1_n_per_m = 3e+06 N/m is at its bound")));
}

TEST(Design, TheTradeOffOfCrushAndDecelerationIsTheHyperbolaOfTheClosedForm) {
  DesignOptions options = stiffness_only(DesignQuantity::peak_decel);
  options.starts = 1;
  options.trade_off = DesignQuantity::max_crush;
  options.trade_off_limits = {"0.8", "200 mm", "0.5 m..0.6 m:2"};
  const DesignResult result = design(linear_model(), options, short_run());
  ASSERT_TRUE(result.usable()) << result.message;
  ASSERT_THAT(result.trade_off, SizeIs(4));
  EXPECT_FALSE(result.trade_off[0].feasible);  // 0.2 m needs more than 3 MN/m
  EXPECT_TRUE(std::isnan(result.trade_off[0].objective));
  EXPECT_THAT(result.trade_off[0].values, ElementsAre(testing::IsNan()));
  for (std::size_t i = 1; i < 4; ++i) {
    const TradeOffPoint& point = result.trade_off[i];
    ASSERT_TRUE(point.feasible) << point.limit;
    const double peak_g = kSpeed * kSpeed / point.limit / kStandardGravity;
    EXPECT_NEAR(point.objective, peak_g, kOptimum * peak_g) << point.limit;
    EXPECT_LE(point.responses.max_crush_m, point.limit);
  }
}

TEST(Design, SaysWhichLimitsNoDesignKeeps) {
  DesignOptions options = stiffness_only(DesignQuantity::pitch);
  options.max_crush_m = 0.2;
  const DesignResult result = design(linear_model(), options, short_run());
  EXPECT_EQ(result.outcome, DesignOutcome::infeasible);
  EXPECT_FALSE(result.usable());
  EXPECT_THAT(result.message, HasSubstr("the nearest has max_crush = 0.33541 m where 0.2 is allowed"));
  EXPECT_NEAR(result.variables.at(0).after, 3e6, kOptimum * 3e6);
}

TEST(Design, NoRandomDesignBeatsTheOptimum) {
  const CoupledModel model = [] {
    CoupledModel vehicle = test::coupled_vehicle();
    vehicle.vertical.angle_rad = 0.02;
    return vehicle;
  }();
  DesignOptions options;
  options.parameters = {"force_height", "k3", "angle"};
  options.lower = {"0.4", "0.6e6", "-0.02"};
  options.upper = {"0.62", "2.4e6", "0.03"};
  options.minimise = DesignQuantity::olc;
  options.max_crush_m = 0.62;
  options.max_pitch_rad = 0.05;
  CoupledOptions simulation;
  const DesignResult result = design(model, options, simulation);
  ASSERT_TRUE(result.usable()) << result.message;
  EXPECT_LE(result.after.max_crush_m, options.max_crush_m);
  EXPECT_LE(result.after.pitch_max_rad, options.max_pitch_rad);
  const double allowance = kOptimum * result.after.olc_g;
  test::Random random(7);
  int kept = 0;
  constexpr int kSamples = 300;
  for (int i = 0; i < kSamples; ++i) {
    CoupledModel other = model;
    // half of them near the optimum
    const double reach = i % 2 == 0 ? 1.0 : 0.05;
    const auto pick = [&](std::size_t at, double low, double high) {
      const double middle = i % 2 == 0 ? random.between(low, high) : result.variables.at(at).after;
      return std::clamp(middle + reach * random.between(low - high, high - low), low, high);
    };
    other.body.force_height_m = pick(0, 0.4, 0.62);
    other.crush.spring.ordinates[2] = pick(1, 0.6e6, 2.4e6);
    other.vertical.angle_rad = pick(2, -0.02, 0.03);
    const DesignResponses r = design_responses(simulate_coupled(other, simulation));
    if (!(r.max_crush_m <= options.max_crush_m && r.pitch_max_rad <= options.max_pitch_rad)) continue;
    ++kept;
    EXPECT_GE(r.olc_g, result.after.olc_g - allowance);
  }
  EXPECT_GT(kept, 10);
}

TEST(Design, DoesNotDependOnTheNumberOfThreads) {
  DesignOptions options = stiffness_only(DesignQuantity::peak_decel);
  options.max_crush_m = 0.7;
  options.starts = 3;
  options.jobs = 1;
  const DesignResult one = design(linear_model(), options, short_run());
  options.jobs = 3;
  const DesignResult three = design(linear_model(), options, short_run());
  EXPECT_EQ(one.variables.at(0).after, three.variables.at(0).after);
  EXPECT_EQ(one.simulations, three.simulations);
}

TEST(Design, StopsWhenAsked) {
  DesignOptions options = stiffness_only(DesignQuantity::peak_decel);
  options.starts = 50;
  options.jobs = 1;
  const DesignResult result = design(linear_model(), options, short_run(), [](int, int) { return false; });
  EXPECT_EQ(result.outcome, DesignOutcome::interrupted);
  EXPECT_LT(result.starts, 50);
  EXPECT_THAT(result.message, HasSubstr("of 50 starts"));
}

TEST(Design, AModelWithoutMaximumCrushIsNoBaseline) {
  CoupledOptions options = short_run();
  options.end_time_s = 0.01;
  const DesignResult result = design(linear_model(), stiffness_only(), options);
  EXPECT_EQ(result.outcome, DesignOutcome::model_failed);
  EXPECT_THAT(result.message, HasSubstr("no_max_crush: no maximum crush"));
}

struct Bad {
  const char* what;
  void (*change)(DesignOptions&);
  const char* message;
};
void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.what; }

class BadDesign : public testing::TestWithParam<Bad> {};

TEST_P(BadDesign, IsRefused) {
  DesignOptions options = stiffness_only(DesignQuantity::olc);
  GetParam().change(options);
  EXPECT_THAT([&] { design(linear_model(), options); }, ThrowsMessage<InvalidInput>(HasSubstr(GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(
    Options, BadDesign,
    testing::Values(Bad{"no_parameter", [](DesignOptions& o) { o.parameters.clear(); },
                        "DesignOptions.parameters names nothing: give at least one parameter"},
                    Bad{"unknown_parameter", [](DesignOptions& o) { o.parameters = {"force_heigth"}; },
                        "DesignOptions.parameters[0]: unknown name 'force_heigth', did you mean 'force_height'?"},
                    Bad{"ordinate_beyond_the_knots", [](DesignOptions& o) { o.parameters = {"k2"}; },
                        "DesignOptions.parameters[0]: unknown name 'k2'"},
                    Bad{"not_a_number", [](DesignOptions& o) { o.parameters = {"per_wheel"}; },
                        "unknown name 'per_wheel'"},
                    Bad{"unset_in_the_model", [](DesignOptions& o) { o.parameters = {"friction"}; },
                        "DesignOptions.parameters[0] = 'friction': the model has no such number to start from"},
                    Bad{"named_twice",
                        [](DesignOptions& o) {
                          o.parameters = {"k1", "k1_n_per_m"};
                          o.lower = {"1", "1"};
                          o.upper = {"2", "2"};
                        },
                        "DesignOptions.parameters[1] = 'k1_n_per_m': is named twice"},
                    Bad{"bounds_missing", [](DesignOptions& o) { o.lower.clear(); },
                        "DesignOptions.lower has 0 numbers but there are 1 parameters"},
                    Bad{"bounds_swapped", [](DesignOptions& o) { o.upper = {"1 kN/m"}; },
                        "DesignOptions.lower[0] = 300000 N/m: must be below upper[0] = 1000 N/m of k1_n_per_m"},
                    Bad{"bound_not_allowed", [](DesignOptions& o) { o.lower = {"-1"}; },
                        "DesignOptions.lower[0] (k1_n_per_m) = -1 N/m: must be >= 0"},
                    Bad{"unit_of_something_else", [](DesignOptions& o) { o.lower = {"2 m"}; },
                        "DesignOptions.lower[0] (k1_n_per_m) = '2 m': 'm' measures length, not stiffness"},
                    Bad{"limit_not_positive", [](DesignOptions& o) { o.max_crush_m = 0.0; },
                        "DesignOptions.max_crush_m = 0 m: must be > 0"},
                    Bad{"curve_of_what_is_minimised",
                        [](DesignOptions& o) {
                          o.trade_off = DesignQuantity::olc;
                          o.trade_off_limits = {"30"};
                        },
                        "DesignOptions.trade_off = olc: minimise is olc: the curve needs something else to minimise"},
                    Bad{"curve_without_limits", [](DesignOptions& o) { o.trade_off = DesignQuantity::max_crush; },
                        "DesignOptions.trade_off = max_crush: give its trade_off_limits"},
                    Bad{"limits_without_a_curve", [](DesignOptions& o) { o.trade_off_limits = {"1"}; },
                        "DesignOptions.trade_off_limits are limits of nothing: name it in trade_off"},
                    Bad{"range_without_a_count",
                        [](DesignOptions& o) {
                          o.trade_off = DesignQuantity::max_crush;
                          o.trade_off_limits = {"0.5..0.7"};
                        },
                        "DesignOptions.trade_off_limits[0] = '0.5..0.7': a range needs a count"}));

TEST(Design, NeedsAnArmWhereAnAngleMayBecomeAForce) {
  CoupledModel model = linear_model();
  model.body.force_arm_m = kUnset;
  DesignOptions options = stiffness_only();
  options.parameters = {"angle"};
  options.lower = {"-1 deg"};
  options.upper = {"1 deg"};
  EXPECT_THAT([&] { design(model, options); },
              ThrowsMessage<InvalidInput>(HasSubstr("HeavePitchModel.force_arm_m is not set but there is a vertical")));
}

}  // namespace
}  // namespace crashsim
