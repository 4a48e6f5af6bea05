/// Plastic unloading against closed forms: on the return line the motion is a quarter of a linear spring's swing.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/simulate.hpp>
#include <crashsim/summary.hpp>

#include "solver/crush_events.hpp"
#include "support/crush_cases.hpp"

namespace crashsim {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::IsNan;

constexpr double kRtol = 1e-10;
constexpr double kSolver = 1e-9;     // solver: relative, 10 kRtol
constexpr double kLedger = 1e-9;     // solver: energy relative to the impact's
constexpr double kRounding = 1e-12;  // rounding: relative

class PlasticUnloading : public testing::TestWithParam<Integrator> {
 protected:
  [[nodiscard]] static SimulateOptions options() {
    SimulateOptions options;
    options.integrator = GetParam();
    options.rtol = kRtol;
    return options;
  }
  [[nodiscard]] static SimulateOptions until(double end_time_s) {
    SimulateOptions options = PlasticUnloading::options();
    options.end_time_s = end_time_s;
    return options;
  }
};

std::string name_of_parameter(const testing::TestParamInfo<Integrator>& info) {
  return std::string(name_of(info.param));
}
INSTANTIATE_TEST_SUITE_P(Both, PlasticUnloading, testing::ValuesIn(test::kBothIntegrators), name_of_parameter);

CrushModel with_restitution(CrushModel model, double e) {
  model.unloading.kind = UnloadingKind::plastic;
  model.unloading.restitution = e;
  return model;
}

CrushModel with_stiffness(CrushModel model, double k_u) {
  model.unloading.kind = UnloadingKind::plastic;
  model.unloading.unloading_stiffness_n_per_m = k_u;
  return model;
}

/// Spring F = k x without a damper, unloaded with restitution e: k_u = k / e^2.
struct LinearSpring {
  double m = 1500.0, k = 9e5, v0 = 15.0;

  [[nodiscard]] CrushModel model() const { return test::kelvin_model(m, k, 0.0, v0); }
  [[nodiscard]] double energy() const { return 0.5 * m * v0 * v0; }
  [[nodiscard]] double frequency() const { return std::sqrt(k / m); }
  [[nodiscard]] double t_m() const { return std::numbers::pi / 2.0 / frequency(); }
  [[nodiscard]] double crush() const { return v0 / frequency(); }
  [[nodiscard]] double force() const { return k * crush(); }
  [[nodiscard]] double static_crush(double e) const { return crush() - e * e * m * v0 * v0 / force(); }
  [[nodiscard]] double separation(double k_u) const { return t_m() + std::numbers::pi / 2.0 * std::sqrt(m / k_u); }
};
constexpr double kRestitutions[] = {0.02, 0.15, 0.5, 0.9, 1.0};

TEST_P(PlasticUnloading, OfALinearSpringIsAQuarterSwingOnTheReturnLine) {
  const LinearSpring spring;
  for (const double e : kRestitutions) {
    SCOPED_TRACE(e);
    const double k_u = spring.k / (e * e), frequency = spring.frequency() / e;
    const double end = spring.static_crush(e), swing = spring.crush() - end;
    for (const CrushModel& model : {with_restitution(spring.model(), e), with_stiffness(spring.model(), k_u)}) {
      const CrushResponse r = simulate(model, options());
      ASSERT_TRUE(r.usable()) << r.message;
      EXPECT_NEAR(r.t_m_s, spring.t_m(), kSolver * spring.t_m());
      EXPECT_NEAR(r.max_crush_m, spring.crush(), kSolver * spring.crush());
      EXPECT_NEAR(r.separation_s, spring.separation(k_u), kSolver * r.separation_s);
      EXPECT_NEAR(r.static_crush_m, end, kSolver * spring.crush());
      EXPECT_NEAR(r.rebound_velocity_mps, -e * spring.v0, kSolver * spring.v0);
      EXPECT_NEAR(metrics_of(r, spring.m).restitution, e, kSolver);
      for (std::size_t i = 0; i < r.time_s.size(); ++i) {
        const double t = r.time_s[i] - spring.t_m();
        if (t <= 0.0) continue;
        const bool free = r.time_s[i] > r.separation_s;
        const double angle = frequency * t;
        const double x = free ? end - e * spring.v0 * (r.time_s[i] - r.separation_s) : end + swing * std::cos(angle);
        EXPECT_NEAR(r.displacement_m[i], x, kSolver * spring.crush());
        EXPECT_NEAR(r.velocity_mps[i], -e * spring.v0 * (free ? 1.0 : std::sin(angle)), kSolver * spring.v0);
        EXPECT_NEAR(r.spring_force_n[i], free ? 0.0 : spring.force() * std::cos(angle), kSolver * spring.force() / e);
      }
    }
  }
}

TEST_P(PlasticUnloading, SharesTheEnergyByTheSquareOfTheRestitution) {
  const LinearSpring spring;
  for (const double e : kRestitutions) {
    SCOPED_TRACE(e);
    const double lost = (1.0 - e * e) * spring.energy(), half_way = std::numbers::pi / 4.0 * e / spring.frequency();
    const CrushModel model = with_restitution(spring.model(), e);
    const CrushResponse on_the_line = simulate(model, until(spring.t_m() + half_way));
    EXPECT_NEAR(on_the_line.dissipated_energy_j, lost, kLedger * spring.energy());
    EXPECT_NEAR(on_the_line.spring_energy_j, 0.5 * e * e * spring.energy(), kLedger * spring.energy());
    EXPECT_NEAR(on_the_line.kinetic_energy_j, 0.5 * e * e * spring.energy(), kLedger * spring.energy());
    const CrushResponse free = simulate(model, options());
    EXPECT_NEAR(free.dissipated_energy_j, lost, kLedger * spring.energy());
    EXPECT_EQ(free.spring_energy_j, 0.0);
    EXPECT_NEAR(free.kinetic_energy_j, e * e * spring.energy(), kLedger * spring.energy());
  }
  // At maximum crush itself the spring still holds everything.
  SimulateOptions to_max_crush = options();
  to_max_crush.to_max_crush = true;
  const CrushResponse loaded = simulate(with_restitution(spring.model(), 0.1), to_max_crush);
  EXPECT_NEAR(loaded.spring_energy_j, spring.energy(), kLedger * spring.energy());
  EXPECT_EQ(loaded.dissipated_energy_j, 0.0);
}

TEST_P(PlasticUnloading, StartsFromTheSpringsForceAloneAndSwitchesTheDamperOff) {
  // Kelvin's closed form to maximum crush.
  constexpr double kMass = 2582.0, kStiffness = 1.2e6, kDamping = 20000.0, kSpeed = 56.0 / 3.6, kE = 0.2;
  const double w = std::sqrt(kStiffness / kMass), zeta = kDamping / (2.0 * kMass * w);
  const double root = std::sqrt(1.0 - zeta * zeta), t_m = std::atan2(root, zeta) / (w * root);
  const double crush = kSpeed / w * std::exp(-zeta * w * t_m), force = kStiffness * crush;
  const double k_u = force * force / (kE * kE * kMass * kSpeed * kSpeed);
  const CrushModel model = with_restitution(test::kelvin_model(kMass, kStiffness, kDamping, kSpeed), kE);
  const CrushResponse r = simulate(model, options());
  EXPECT_NEAR(r.t_m_s, t_m, kSolver * t_m);
  EXPECT_NEAR(r.static_crush_m, crush - force / k_u, kSolver * crush);
  EXPECT_NEAR(r.separation_s, t_m + std::numbers::pi / 2.0 * std::sqrt(kMass / k_u), kSolver * r.separation_s);
  EXPECT_NEAR(r.rebound_velocity_mps, -kE * kSpeed, kSolver * kSpeed);
  for (std::size_t i = 0; i < r.time_s.size(); ++i) {
    if (r.time_s[i] <= r.t_m_s) continue;
    EXPECT_EQ(r.damper_force_n[i], 0.0);
    EXPECT_NEAR(r.spring_force_n[i], std::max(0.0, force - k_u * (crush - r.displacement_m[i])), kSolver * force / kE);
  }
}

TEST_P(PlasticUnloading, OfANonlinearModelReboundsAsAskedAndClosesTheLedger) {
  const double energy = 0.5 * 2582.0 * std::pow(test::syn_a().impact_speed_mps, 2);
  for (const CrushModel& loading : {test::syn_a(), test::syn_b()})
    for (const double e : {0.05, 0.15, 0.4}) {
      SCOPED_TRACE(e);
      const CrushResponse elastic = simulate(loading, options());
      const CrushResponse r = simulate(with_restitution(loading, e), options());
      ASSERT_TRUE(r.usable()) << r.message;
      EXPECT_EQ(r.t_m_s, elastic.t_m_s);  // loading is not touched
      EXPECT_EQ(r.max_crush_m, elastic.max_crush_m);
      EXPECT_NEAR(r.rebound_velocity_mps, -e * r.impact_speed_mps, kSolver * r.impact_speed_mps);
      EXPECT_LT(r.static_crush_m, r.max_crush_m);
      for (const double residual : r.energy_residual_j) ASSERT_NEAR(residual, 0.0, kLedger * energy);
      EXPECT_NEAR(r.kinetic_energy_j + r.spring_energy_j + r.dissipated_energy_j, energy, kLedger * energy);
      EXPECT_NEAR(r.kinetic_energy_j, e * e * energy, kLedger * energy);
    }
}

TEST_P(PlasticUnloading, NeverPullsAndLetsGoForGood) {
  const CrushResponse r = simulate(with_restitution(test::syn_a(), 0.15), options());
  ASSERT_GT(r.separation_s, r.t_m_s);
  ASSERT_LT(r.separation_s, r.time_s.back());
  for (std::size_t i = 0; i < r.time_s.size(); ++i) {
    EXPECT_GE(r.spring_force_n[i] + r.damper_force_n[i], 0.0) << r.time_s[i];
    if (r.time_s[i] <= r.separation_s) continue;
    EXPECT_EQ(r.accel_mps2[i], 0.0);
    EXPECT_NEAR(r.velocity_mps[i], r.rebound_velocity_mps, kRounding * r.impact_speed_mps);
  }
}

TEST_P(PlasticUnloading, BilateralSwingsAboutTheStaticCrush) {
  const LinearSpring spring;
  constexpr double kE = 0.25;
  CrushModel model = with_restitution(spring.model(), kE);
  model.unloading.bilateral = true;
  const double period = 2.0 * std::numbers::pi * kE / spring.frequency();
  const CrushResponse r = simulate(model, until(spring.t_m() + 2.5 * period));
  ASSERT_TRUE(r.usable()) << r.message;
  for (const double number : {r.separation_s, r.static_crush_m, r.rebound_velocity_mps}) EXPECT_THAT(number, IsNan());
  const double end = spring.static_crush(kE);
  EXPECT_NEAR(r.displacement_m.back(), 2.0 * end - spring.crush(), kSolver * spring.crush());
  EXPECT_NEAR(r.spring_force_n.back(), -spring.force(), kSolver * spring.force() / kE);
  EXPECT_NEAR(r.velocity_mps.back(), 0.0, kSolver * spring.v0);
  for (const double residual : r.energy_residual_j) ASSERT_NEAR(residual, 0.0, kLedger * spring.energy());
}

TEST_P(PlasticUnloading, WithoutRestitutionStaysAtMaximumCrush) {
  for (const double e : {0.0, 1e-9, 1e-200}) {  // what rounding cannot tell from it, too
    const CrushModel model = with_restitution(test::syn_a(), e);
    const CrushResponse r = simulate(model, options());
    ASSERT_TRUE(r.usable()) << r.message;
    EXPECT_NEAR(r.separation_s, r.t_m_s, kSolver * r.t_m_s);
    EXPECT_NEAR(r.static_crush_m, r.max_crush_m, kSolver * r.max_crush_m);
    EXPECT_NEAR(r.displacement_m.back(), r.max_crush_m, kSolver * r.max_crush_m);
    EXPECT_NEAR(r.velocity_mps.back(), 0.0, kSolver * r.impact_speed_mps);
    EXPECT_EQ(r.accel_mps2.back(), 0.0);
  }
  const CrushResponse r = simulate(with_restitution(test::syn_a(), 0.0), options());
  EXPECT_EQ(r.separation_s, r.t_m_s);
  EXPECT_EQ(r.rebound_velocity_mps, 0.0);
  CrushModel held = with_restitution(test::syn_a(), 0.0);
  held.unloading.bilateral = true;
  const CrushResponse at_rest = simulate(held, options());
  EXPECT_THAT(at_rest.separation_s, IsNan());
  EXPECT_EQ(at_rest.displacement_m.back(), at_rest.max_crush_m);
}

TEST(ReturnLine, WithoutAForceAtMaximumCrushLetsGoAtOnce) {
  // No motion stops where nothing holds it but by rounding: the event alone is made here.
  CrushModel model = with_restitution(test::kelvin_model(1000.0, 0.0, 1e4, 10.0), 0.3);
  const CrushForce force = make_force(model);
  for (const bool bilateral : {false, true}) {
    model.unloading.bilateral = bilateral;
    const CrushProblem problem{force, model.mass_kg, model.impact_speed_mps, model.unloading};
    const Event stop{EventKind::damper_knot, 0.0, -1, 0.0};
    const Region after = next_region(problem, initial_region(problem), stop, 0.4, 0.0);
    EXPECT_EQ(after.separated, !bilateral);
    EXPECT_THAT(region_force(problem, after).spring, Each(0.0));
    EXPECT_EQ(stored_energy(problem, after, 0.4), 0.0);
  }
}

TEST_P(PlasticUnloading, MayNotGiveBackMoreThanWasAbsorbed) {
  const LinearSpring spring;  // k_u = k is the limit of both rules
  const CrushResponse r = simulate(with_stiffness(spring.model(), 0.99 * spring.k), options());
  EXPECT_EQ(r.outcome, CrushOutcome::unloading_too_soft);
  EXPECT_NEAR(r.time_s.back(), spring.t_m(), kSolver);
  EXPECT_NEAR(r.max_crush_m, spring.crush(), kSolver);
  for (const double number : {r.separation_s, r.static_crush_m, r.rebound_velocity_mps}) EXPECT_THAT(number, IsNan());
  EXPECT_THAT(r.message, HasSubstr("a return line of 891000 N/m would give back more energy than was absorbed"));
  EXPECT_THAT(r.message, HasSubstr("unloading_stiffness_n_per_m must be at least 900000"));
  EXPECT_TRUE(simulate(with_stiffness(spring.model(), spring.k), options()).usable());

  SimulateOptions to_max_crush = options();
  to_max_crush.to_max_crush = true;  // what comes later is not asked for
  EXPECT_TRUE(simulate(with_stiffness(spring.model(), 1.0), to_max_crush).usable());
}

TEST_P(PlasticUnloading, MayNotPushAheadOfTheUndeformedFront) {
  // The force has fallen so far at C that it takes more than C to give back 0.9^2 of the energy.
  CrushModel model;
  model.mass_kg = 1000.0;
  model.impact_speed_mps = 10.0;
  model.law = CrushLaw::force;
  model.spring = {{0.0, 0.3, 0.4}, {1.5e5, 1.5e5, 3e4}};
  const CrushResponse loaded = simulate(with_restitution(model, 0.1), options());
  ASSERT_TRUE(loaded.usable()) << loaded.message;
  const double force = spring_force(model, loaded.max_crush_m);
  const double most = std::sqrt(force * loaded.max_crush_m / (1000.0 * 100.0));
  ASSERT_LT(most, 0.9);
  const CrushResponse r = simulate(with_restitution(model, 0.9), options());
  EXPECT_EQ(r.outcome, CrushOutcome::unloading_too_soft);
  EXPECT_THAT(r.message, HasSubstr("push ahead of the undeformed front: restitution = 0.9 must be at most 0."));
  EXPECT_TRUE(simulate(with_restitution(model, 0.999 * most), options()).usable());
  EXPECT_FALSE(simulate(with_restitution(model, 1.001 * most), options()).usable());
}

TEST(PlasticIntegrators, Agree) {
  constexpr double kAgreement = 1e-8;  // solver: relative
  SimulateOptions cvode, taylor;
  taylor.integrator = Integrator::taylor;
  cvode.rtol = taylor.rtol = kRtol;
  for (const CrushModel& model : {with_restitution(test::syn_a(), 0.15), with_stiffness(test::syn_b(), 2e7)}) {
    const CrushResponse a = simulate(model, cvode), b = simulate(model, taylor);
    ASSERT_EQ(a.time_s, b.time_s);
    for (std::size_t i = 0; i < a.time_s.size(); ++i) {
      EXPECT_NEAR(a.displacement_m[i], b.displacement_m[i], kAgreement * b.max_crush_m);
      EXPECT_NEAR(a.velocity_mps[i], b.velocity_mps[i], kAgreement * b.impact_speed_mps);
    }
    EXPECT_NEAR(a.separation_s, b.separation_s, kAgreement * b.separation_s);
    EXPECT_NEAR(a.static_crush_m, b.static_crush_m, kAgreement * b.max_crush_m);
  }
}

}  // namespace
}  // namespace crashsim
