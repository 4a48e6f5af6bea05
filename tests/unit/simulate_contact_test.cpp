/// Loss of contact, leaving the knots, running out of steps.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/simulate.hpp>

#include "support/crush_cases.hpp"

namespace crashsim {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::IsNan;
using testing::StartsWith;

constexpr double kSolver = 1e-7;     // solver: relative, 10 times the default rtol
constexpr double kRounding = 1e-12;  // rounding: relative

class CrushContact : public testing::TestWithParam<Integrator> {
 protected:
  [[nodiscard]] static SimulateOptions options() {
    SimulateOptions options;
    options.integrator = GetParam();
    return options;
  }
};

std::string name_of_parameter(const testing::TestParamInfo<Integrator>& info) {
  return std::string(name_of(info.param));
}
INSTANTIATE_TEST_SUITE_P(Both, CrushContact, testing::ValuesIn(test::kBothIntegrators), name_of_parameter);

TEST_P(CrushContact, ForceThatBeginsAtNothingIsNotTakenForAPull) {
  // At impact F = k x = 0; x = -1e-20 m, as rounding makes it in a first small step, is no loss of contact.
  for (const bool bilateral : {false, true}) {
    CrushModel model = test::syn_b();
    model.unloading.bilateral = bilateral;
    for (const double rtol : {1e-6, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12}) {
      SimulateOptions options = CrushContact::options();
      options.rtol = rtol;
      const CrushResponse r = simulate(model, options);
      ASSERT_TRUE(r.usable()) << "rtol " << rtol << ": " << r.message;
      EXPECT_EQ(std::isnan(r.separation_s), bilateral);
    }
  }
}

TEST_P(CrushContact, UnilateralMotionNeverPulls) {
  CrushModel model = test::syn_a();
  const CrushResponse r = simulate(model, options());
  ASSERT_TRUE(r.usable());
  ASSERT_GT(r.separation_s, r.t_m_s);
  ASSERT_LT(r.separation_s, r.time_s.back());
  EXPECT_LT(r.rebound_velocity_mps, 0.0);
  EXPECT_GT(r.static_crush_m, 0.0);
  for (std::size_t i = 0; i < r.time_s.size(); ++i) {
    const double force = r.spring_force_n[i] + r.damper_force_n[i];
    EXPECT_GE(force, 0.0) << r.time_s[i];
    if (r.time_s[i] <= r.separation_s) continue;
    EXPECT_EQ(force, 0.0);
    EXPECT_NEAR(r.velocity_mps[i], r.rebound_velocity_mps, kRounding * r.impact_speed_mps);
    EXPECT_NEAR(r.displacement_m[i], r.static_crush_m + r.rebound_velocity_mps * (r.time_s[i] - r.separation_s),
                kRounding);
  }
  model.unloading.bilateral = true;
  const CrushResponse held = simulate(model, options());
  EXPECT_NEAR(held.t_m_s, r.t_m_s, kRounding);
  for (const double number : {held.separation_s, held.static_crush_m, held.rebound_velocity_mps})
    EXPECT_THAT(number, IsNan());
  EXPECT_LT(std::ranges::min(held.spring_force_n), 0.0);  // the barrier pulls too
  EXPECT_GT(held.velocity_mps.back(), r.velocity_mps.back());
}

TEST_P(CrushContact, YieldForceLetsGoAtZeroCrush) {
  // F jumps from F_y to -F_y at x = 0 on the way back.
  CrushModel model;
  model.mass_kg = 1000.0;
  model.impact_speed_mps = 10.0;
  model.law = CrushLaw::force;
  model.spring = {{0.0}, {1e5}};
  SimulateOptions options = CrushContact::options();
  options.end_time_s = 0.25;
  const CrushResponse r = simulate(model, options);
  ASSERT_TRUE(r.usable());
  EXPECT_NEAR(r.t_m_s, 0.1, kSolver);
  EXPECT_NEAR(r.max_crush_m, 0.5, kSolver);
  EXPECT_EQ(r.static_crush_m, 0.0);
  EXPECT_NEAR(r.separation_s, 0.2, kSolver);
  EXPECT_NEAR(r.rebound_velocity_mps, -10.0, kSolver);
}

TEST_P(CrushContact, ForceThatPullsFromTheStartNeverMakesContact) {
  // The falling last line of c(v) is below zero at the impact speed.
  CrushModel model = test::kelvin_model(1000.0, 4e5, 0.0, 10.0);
  model.damper = {{0.0, 4.0}, {6000.0, 2000.0}};
  model.extrapolation = Extrapolation::linear;
  const CrushResponse r = simulate(model, options());
  EXPECT_EQ(r.outcome, CrushOutcome::no_max_crush);
  EXPECT_EQ(r.separation_s, 0.0);
  EXPECT_THAT(r.static_crush_m, IsNan());
  EXPECT_THAT(r.rebound_velocity_mps, IsNan());
  EXPECT_THAT(r.accel_mps2, Each(0.0));
  EXPECT_THAT(r.velocity_mps, Each(10.0));
  EXPECT_THAT(r.spring_force_n, Each(0.0));
  EXPECT_THAT(r.damper_force_n, Each(0.0));
  EXPECT_THAT(r.energy_residual_j, Each(0.0));
}

TEST_P(CrushContact, EnergyOfASpringThatLostContactIsDissipated) {
  const CrushResponse r = simulate(test::syn_a(), options());
  const double impact = 0.5 * 2582.0 * r.impact_speed_mps * r.impact_speed_mps;
  EXPECT_EQ(r.spring_energy_j, 0.0);
  EXPECT_NEAR(r.kinetic_energy_j, 0.5 * 2582.0 * std::pow(r.rebound_velocity_mps, 2), kRounding * impact);
  EXPECT_NEAR(r.dissipated_energy_j, impact - r.kinetic_energy_j, kSolver * impact);
  SimulateOptions to_max_crush = options();
  to_max_crush.to_max_crush = true;
  const CrushResponse loading = simulate(test::syn_a(), to_max_crush);
  EXPECT_NEAR(loading.kinetic_energy_j, 0.0, kRounding * impact);
  EXPECT_NEAR(loading.spring_energy_j, spring_energy(test::syn_a(), loading.max_crush_m), kRounding * impact);
  EXPECT_NEAR(loading.spring_energy_j + loading.dissipated_energy_j, impact, kSolver * impact);
}

/// SYN_A with the knots' ends at the given crush and speed and extrapolation `error`.
CrushModel with_last_knots(double crush, double speed) {
  CrushModel model = test::syn_a();
  for (double& knot : model.spring.knots) knot *= crush / test::syn_a().spring.knots.back();
  for (double& knot : model.damper.knots) knot *= speed / test::syn_a().damper.knots.back();
  model.damper.knots.back() = speed;
  model.extrapolation = Extrapolation::error;
  return model;
}

TEST_P(CrushContact, LeavingTheSpringsKnotsIsAnOutcome) {
  const double speed = test::syn_a().impact_speed_mps;
  const CrushResponse r = simulate(with_last_knots(0.4, speed), options());
  EXPECT_EQ(r.outcome, CrushOutcome::left_knot_range);
  EXPECT_NEAR(r.displacement_m.back(), 0.4, kRounding);
  EXPECT_GT(r.velocity_mps.back(), 0.0);
  EXPECT_THAT(r.t_m_s, IsNan());
  EXPECT_THAT(r.message, HasSubstr("the motion left the knots (x = 0.4 m, v = "));
  EXPECT_THAT(r.message, HasSubstr("extrapolation is 'error': extend the curves or choose extrapolation 'constant'"));
  EXPECT_THAT(r.brief_report(), StartsWith("left_knot_range: at t = "));
  EXPECT_TRUE(simulate(with_last_knots(0.8, speed), options()).usable());
}

TEST_P(CrushContact, AnImpactBeyondTheDampersKnotsIsAnOutcomeToo) {
  const double speed = test::syn_a().impact_speed_mps;
  const CrushResponse r = simulate(with_last_knots(0.8, 0.9 * speed), options());
  EXPECT_EQ(r.outcome, CrushOutcome::left_knot_range);
  EXPECT_THAT(r.message, StartsWith("at t = 0 s the motion left the knots (x = 0 m, v = 15.5556 m/s)"));
  EXPECT_EQ(r.velocity_mps, std::vector<double>{speed});
  EXPECT_TRUE(simulate(with_last_knots(0.8, 1.1 * speed), options()).usable());
}

TEST_P(CrushContact, AnEndlesslyChatteringForceReachesTheStepLimit) {
  // A bilateral yield force under heavy damping: x swings about 0 ever faster while it decays.
  CrushModel model = test::kelvin_model(1000.0, 0.0, 8e4, 10.0);
  model.law = CrushLaw::force;
  model.spring = {{0.0}, {1e5}};
  model.unloading.bilateral = true;
  SimulateOptions options = CrushContact::options();
  options.end_time_s = 20.0;
  const CrushResponse r = simulate(model, options);
  EXPECT_EQ(r.outcome, CrushOutcome::step_limit);
  EXPECT_FALSE(r.usable());
  EXPECT_GT(r.t_m_s, 0.0);
  EXPECT_LT(r.time_s.back(), options.end_time_s);
  EXPECT_THAT(r.message, HasSubstr("100000 steps reached only t = "));
  EXPECT_THAT(r.message, HasSubstr("loosen rtol or check the model's ordinates"));
}

TEST_P(CrushContact, AMotionThatGrowsWithoutBoundIsNotUsable) {
  // Past x = 0.2 m the falling line of k(x) drives the vehicle, x'' = 5000 x (x - 0.2), to infinity in finite time.
  CrushModel model = test::kelvin_model(1000.0, 0.0, 0.0, 20.0);
  model.spring = {{0.0, 0.1}, {1e6, 5e5}};
  model.extrapolation = Extrapolation::linear;
  model.unloading.bilateral = true;
  const CrushResponse r = simulate(model, options());
  EXPECT_FALSE(r.usable());
  EXPECT_THAT(r.outcome, testing::AnyOf(CrushOutcome::failed, CrushOutcome::step_limit));
  EXPECT_THAT(r.t_m_s, IsNan());
  EXPECT_LT(r.time_s.back(), 0.1);
  for (const double x : r.displacement_m) ASSERT_TRUE(std::isfinite(x));
  EXPECT_THAT(r.message, HasSubstr("check the model's ordinates"));
}

TEST_P(CrushContact, ForcesBeyondAllNumbersAreAFailure) {
  const CrushResponse r = simulate(test::kelvin_model(1e-10, 1e300, 0.0, 20.0), options());
  EXPECT_EQ(r.outcome, CrushOutcome::failed);
  EXPECT_THAT(r.brief_report(), StartsWith("failed: "));
  EXPECT_THAT(r.max_crush_m, IsNan());
}

}  // namespace
}  // namespace crashsim
