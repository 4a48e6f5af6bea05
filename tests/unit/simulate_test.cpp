#include <crashsim/simulate.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "support/crush_cases.hpp"

namespace crashsim {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsNan;
using testing::Lt;
using testing::SizeIs;
using testing::StartsWith;
using testing::ThrowsMessage;

constexpr double kRounding = 1e-14;  // rounding: relative, a few operations on doubles
constexpr double kSolver = 1e-7;     // solver: relative, 10 times the default rtol
constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Simulate : public testing::TestWithParam<Integrator> {
 protected:
  [[nodiscard]] static SimulateOptions options(double end_time_s = kUnset) {
    SimulateOptions options;
    options.integrator = GetParam();
    options.end_time_s = end_time_s;
    return options;
  }
};

std::string name_of_parameter(const testing::TestParamInfo<Integrator>& info) {
  return std::string(name_of(info.param));
}
INSTANTIATE_TEST_SUITE_P(Both, Simulate, testing::ValuesIn(test::kBothIntegrators), name_of_parameter);

/// Linear spring, no damper: w = 20/s, t_m = pi/40 s, C = 0.5 m.
CrushModel spring_model() {
  CrushModel model;
  model.mass_kg = 1000.0;
  model.impact_speed_mps = 10.0;
  model.spring = {{0.0}, {4e5}};
  return model;
}

testing::Matcher<std::function<CrushResponse()>> rejected(const std::string& message) {
  return ThrowsMessage<InvalidInput>(HasSubstr(message));
}
std::function<CrushResponse()> simulating(const CrushModel& model, const SimulateOptions& options = {}) {
  return [=] { return simulate(model, options); };
}

TEST(CrushResponse, IsPessimisticUntilComputed) {
  const CrushResponse r;
  EXPECT_EQ(r.outcome, CrushOutcome::not_run);
  EXPECT_FALSE(r.usable());
  EXPECT_EQ(r.brief_report(), "not run");
  for (const double number : {r.impact_speed_mps, r.t_m_s, r.max_crush_m, r.separation_s, r.static_crush_m,
                              r.rebound_velocity_mps, r.kinetic_energy_j, r.spring_energy_j, r.dissipated_energy_j})
    EXPECT_THAT(number, IsNan());
  for (const auto* column : {&r.time_s, &r.accel_mps2, &r.velocity_mps, &r.displacement_m, &r.spring_force_n,
                             &r.damper_force_n, &r.energy_residual_j})
    EXPECT_THAT(*column, IsEmpty());
}

TEST_P(Simulate, ReportsMaximumCrushOnOneLine) {
  const CrushResponse r = simulate(spring_model(), options());
  ASSERT_TRUE(r.usable());
  EXPECT_THAT(r.message, IsEmpty());
  EXPECT_THAT(r.brief_report(), StartsWith("maximum crush 0.5000 m at 78.54 ms from 10.000 m/s ("));
  EXPECT_GT(r.statistics.steps, 0);
  EXPECT_GT(r.statistics.force_evaluations, r.statistics.steps);
  EXPECT_EQ(r.statistics.events, 3);  // turning point, x = 0, separation
}

TEST_P(Simulate, WithoutMaximumCrushThereIsNoTimeOfIt) {
  for (const double end : {0.0785, 0.03}) {
    const CrushResponse r = simulate(spring_model(), options(end));
    EXPECT_EQ(r.outcome, CrushOutcome::no_max_crush);
    EXPECT_FALSE(r.usable());
    for (const double number : {r.t_m_s, r.max_crush_m, r.separation_s, r.static_crush_m, r.rebound_velocity_mps})
      EXPECT_THAT(number, IsNan());
    EXPECT_EQ(r.time_s.back(), end);  // the motion until then is there
    EXPECT_GT(r.velocity_mps.back(), 0.0);
    EXPECT_THAT(r.brief_report(), StartsWith("no_max_crush: no maximum crush: v did not reach zero within 0.."));
    EXPECT_THAT(r.message, HasSubstr("simulate longer, or the structure is too weak"));
  }
  EXPECT_TRUE(simulate(spring_model(), options(0.0786)).usable());
}

TEST_P(Simulate, AsksForASpeedWhenTheModelHasNone) {
  CrushModel model = spring_model();
  EXPECT_EQ(simulate(model, options()).impact_speed_mps, model.impact_speed_mps);
  model.impact_speed_mps = kUnset;
  EXPECT_THAT(simulating(model, options()),
              rejected("SimulateOptions.impact_speed_mps: not given, and the model has none: give a speed"));
  SimulateOptions faster = options();
  faster.impact_speed_mps = 12.0;
  EXPECT_NEAR(simulate(model, faster).max_crush_m, 0.6, kSolver);
  model.impact_speed_mps = 10.0;
  EXPECT_NEAR(simulate(model, faster).max_crush_m, 0.6, kSolver);  // the option wins
}

TEST(SimulateOptions, RejectsValuesThatMakeNoSense) {
  const auto with = [](auto member, auto value) {
    SimulateOptions options;
    options.*member = value;
    return simulating(spring_model(), options);
  };
  EXPECT_THAT(with(&SimulateOptions::dt_s, 0.0), rejected("SimulateOptions.dt_s = 0 s: must be > 0"));
  EXPECT_THAT(with(&SimulateOptions::dt_s, -1e-3), rejected("SimulateOptions.dt_s = -0.001 s: must be > 0"));
  EXPECT_THAT(with(&SimulateOptions::dt_s, kInfinity), rejected("SimulateOptions.dt_s = inf s"));
  EXPECT_THAT(with(&SimulateOptions::dt_s, 1e-12), rejected("choose a larger interval"));
  EXPECT_THAT(with(&SimulateOptions::end_time_s, 0.0), rejected("SimulateOptions.end_time_s = 0 s: must be > 0"));
  EXPECT_THAT(with(&SimulateOptions::rtol, 0.5), rejected("SimulateOptions.rtol = 0.5: must be >= 1e-12 and <= 0.01"));
  EXPECT_THAT(with(&SimulateOptions::rtol, 1e-13), rejected("SimulateOptions.rtol = 1e-13: must be >= 1e-12"));
  EXPECT_THAT(with(&SimulateOptions::impact_speed_mps, -3.0),
              rejected("SimulateOptions.impact_speed_mps = -3 m/s: must be > 0"));
  using Times = std::vector<double>;
  const std::string rule = "times must be finite and increase from 0";
  EXPECT_THAT(with(&SimulateOptions::times_s, Times{0.0, 0.1, 0.1}),
              rejected("SimulateOptions.times_s[2] = 0.1 s: " + rule));
  EXPECT_THAT(with(&SimulateOptions::times_s, Times{-0.1, 0.1}),
              rejected("SimulateOptions.times_s[0] = -0.1 s: " + rule));
  EXPECT_THAT(with(&SimulateOptions::times_s, Times{kUnset}), rejected("SimulateOptions.times_s[0] = nan s: " + rule));
  EXPECT_THAT(with(&SimulateOptions::times_s, Times{0.1, kUnset, 0.2}),
              rejected("SimulateOptions.times_s[1] = nan s: " + rule));
  EXPECT_THAT(with(&SimulateOptions::times_s, Times{0.1, kInfinity}),
              rejected("SimulateOptions.times_s[1] = inf s: " + rule));
  EXPECT_THAT(with(&SimulateOptions::times_s, Times{0.0}),
              rejected("SimulateOptions.times_s: the last time is the end of the run and must be > 0 s"));
}

TEST_P(Simulate, SamplesUniformlyFromZeroToTheEndBothIncluded) {
  for (const double end : {0.2, 0.15, 0.1234567}) {
    for (const double dt : {1e-4, 1e-3, 7e-4, 0.5}) {
      SimulateOptions options = Simulate::options(end);
      options.dt_s = dt;
      const CrushResponse r = simulate(spring_model(), options);
      ASSERT_GE(r.time_s.size(), 2U);
      EXPECT_EQ(r.time_s.front(), 0.0);
      EXPECT_NEAR(r.time_s.back(), end, kRounding);
      EXPECT_EQ(r.time_s.size(), static_cast<std::size_t>(std::ceil(end / dt * (1.0 - kRounding))) + 1);
      for (std::size_t i = 0; i + 1 < r.time_s.size(); ++i) EXPECT_EQ(r.time_s[i], dt * static_cast<double>(i));
      for (const auto* column : {&r.accel_mps2, &r.velocity_mps, &r.displacement_m, &r.spring_force_n,
                                 &r.damper_force_n, &r.energy_residual_j})
        EXPECT_THAT(*column, SizeIs(r.time_s.size()));
    }
  }
  const CrushResponse r = simulate(spring_model(), options());
  EXPECT_EQ(r.time_s.back(), 0.2);  // the default end
  EXPECT_EQ(r.displacement_m.front(), 0.0);
  EXPECT_EQ(r.velocity_mps.front(), 10.0);
}

TEST_P(Simulate, SamplesAtTheTimesAskedFor) {
  test::Random random(4);
  for (int i = 0; i < 30; ++i) {
    const CrushModel model = test::random_crush_model(random);
    SimulateOptions options = Simulate::options();
    double t = i % 2 == 0 ? 0.0 : random.between(0.0, 0.01);
    for (int j = random.whole(1, 200); j > 0; --j) options.times_s.push_back(t += random.between(1e-7, 2e-3));
    EXPECT_EQ(simulate(model, options).time_s, options.times_s);
  }
}

TEST_P(Simulate, SamplesDoNotDependOnTheOutputTimes) {
  const CrushResponse fine = simulate(test::syn_a(), options());
  SimulateOptions coarse = options();
  coarse.times_s = {0.03, 0.06, 0.09, 0.2};
  const CrushResponse r = simulate(test::syn_a(), coarse);
  EXPECT_EQ(r.t_m_s, fine.t_m_s);
  EXPECT_EQ(r.max_crush_m, fine.max_crush_m);
  for (std::size_t i = 0; i < r.time_s.size(); ++i) {
    const auto j = static_cast<std::size_t>(std::lround(r.time_s[i] * 1e4));
    EXPECT_NEAR(r.displacement_m[i], fine.displacement_m[j], kRounding);
    EXPECT_NEAR(r.velocity_mps[i], fine.velocity_mps[j], kRounding * fine.impact_speed_mps);
  }
}

TEST_P(Simulate, EndsAtMaximumCrush) {
  SimulateOptions options = Simulate::options();
  options.to_max_crush = true;
  const CrushResponse r = simulate(test::syn_a(), options);
  ASSERT_TRUE(r.usable());
  EXPECT_EQ(r.time_s.back(), r.t_m_s);
  EXPECT_EQ(r.displacement_m.back(), r.max_crush_m);
  EXPECT_NEAR(r.velocity_mps.back(), 0.0, kRounding * r.impact_speed_mps);
  EXPECT_EQ(r.t_m_s, simulate(test::syn_a(), Simulate::options()).t_m_s);
  options.times_s = {0.0, 0.05, 0.1, 0.15};
  EXPECT_EQ(simulate(test::syn_a(), options).time_s, (std::vector<double>{0.0, 0.05}));
}

TEST_P(Simulate, DoesNotDependOnWhatRanBefore) {
  test::Random random(5);
  std::vector<CrushModel> models;
  for (int i = 0; i < 20; ++i) models.push_back(test::random_crush_model(random));
  std::vector<CrushResponse> forwards;
  for (const CrushModel& model : models) forwards.push_back(simulate(model, options()));
  for (std::size_t i = models.size(); i-- > 0;) {
    const CrushResponse again = simulate(models[i], options());
    EXPECT_EQ(again.displacement_m, forwards[i].displacement_m);
    EXPECT_EQ(again.velocity_mps, forwards[i].velocity_mps);
    EXPECT_EQ(again.accel_mps2, forwards[i].accel_mps2);
    EXPECT_EQ(again.statistics.steps, forwards[i].statistics.steps);
  }
}

}  // namespace
}  // namespace crashsim
