/// Identities every crush motion satisfies, on random models: centroid, work, scaling, energy ledger.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <crashsim/simulate.hpp>

#include "support/crush_cases.hpp"

namespace crashsim {
namespace {

constexpr double kRtol = 1e-10;
constexpr double kSolver = 1e-9;    // solver: relative, 10 kRtol
constexpr double kLedger = 1e-7;    // solver: energy relative to the impact's, 10 times the default rtol
constexpr double kSampling = 2e-6;  // solver: Simpson's rule over samples across the knots' kinks

class CrushIdentities : public testing::TestWithParam<Integrator> {
 protected:
  [[nodiscard]] static SimulateOptions options(double rtol = kRtol) {
    SimulateOptions options;
    options.integrator = GetParam();
    options.rtol = rtol;
    return options;
  }
};

std::string name_of_parameter(const testing::TestParamInfo<Integrator>& info) {
  return std::string(name_of(info.param));
}
INSTANTIATE_TEST_SUITE_P(Both, CrushIdentities, testing::ValuesIn(test::kBothIntegrators), name_of_parameter);

double impact_energy(const CrushModel& m) { return 0.5 * m.mass_kg * m.impact_speed_mps * m.impact_speed_mps; }

/// Random models that reach maximum crush.
std::vector<CrushModel> stopping_models(std::uint64_t seed, std::size_t count) {
  test::Random random(seed);
  std::vector<CrushModel> models;
  SimulateOptions options;
  options.to_max_crush = true;
  options.integrator = Integrator::taylor;
  while (models.size() < count) {
    models.push_back(test::random_crush_model(random));
    if (!simulate(models.back(), options).usable()) models.pop_back();
  }
  return models;
}

/// Simpson's rule over samples `dt` apart, an even number of intervals.
template <class F>
double simpson(std::size_t intervals, double dt, F f) {
  double sum = 0.0;
  for (std::size_t i = 0; i < intervals; i += 2) sum += f(i) + 4.0 * f(i + 1) + f(i + 2);
  return sum * dt / 3.0;
}

TEST_P(CrushIdentities, CentroidAndWorkOfThePulse) {
  constexpr std::size_t kIntervals = 20000;
  for (const CrushModel& model : stopping_models(31, 60)) {
    SimulateOptions options = CrushIdentities::options();
    options.to_max_crush = true;
    const CrushResponse first = simulate(model, options);
    const double v0 = model.impact_speed_mps, t_m = first.t_m_s, dt = t_m / kIntervals;
    options.to_max_crush = false;
    for (std::size_t i = 0; i <= kIntervals; ++i) options.times_s.push_back(dt * static_cast<double>(i));
    const CrushResponse r = simulate(model, options);
    ASSERT_EQ(r.time_s.size(), kIntervals + 1);
    const double moment = simpson(kIntervals, dt, [&](std::size_t i) { return -r.accel_mps2[i] * r.time_s[i]; });
    const double change = simpson(kIntervals, dt, [&](std::size_t i) { return -r.accel_mps2[i]; });
    EXPECT_NEAR(change, v0, kSampling * v0);
    EXPECT_NEAR(moment / change, first.max_crush_m / v0, kSampling * t_m);
    // Work of F = -m a over the crush, dx = v dt.
    const double work =
        simpson(kIntervals, dt, [&](std::size_t i) { return -model.mass_kg * r.accel_mps2[i] * r.velocity_mps[i]; });
    EXPECT_NEAR(work, impact_energy(model), kSampling * impact_energy(model));
  }
}

TEST_P(CrushIdentities, ScalingMassAndOrdinatesLeavesTheMotion) {
  constexpr double kScale = 0.25;  // a power of two: not a bit changes
  constexpr double kOddScale = 3.7;
  for (const CrushModel& model : stopping_models(32, 60)) {
    const CrushResponse r = simulate(model, options());
    for (const double scale : {kScale, kOddScale}) {
      CrushModel scaled = model;
      scaled.mass_kg *= scale;
      for (PiecewiseLinear* curve : {&scaled.spring, &scaled.damper})
        for (double& ordinate : curve->ordinates) ordinate *= scale;
      const CrushResponse s = simulate(scaled, options());
      ASSERT_EQ(s.time_s, r.time_s);
      EXPECT_NEAR(s.t_m_s, r.t_m_s, kSolver * r.t_m_s);
      EXPECT_NEAR(s.max_crush_m, r.max_crush_m, kSolver * r.max_crush_m);
      if (scale == kScale) {
        EXPECT_EQ(s.displacement_m, r.displacement_m);
        EXPECT_EQ(s.velocity_mps, r.velocity_mps);
        EXPECT_EQ(s.accel_mps2, r.accel_mps2);
      }
      for (std::size_t i = 0; i < r.time_s.size(); i += 100)
        EXPECT_NEAR(s.spring_force_n[i], scale * r.spring_force_n[i],
                    kLedger * scale * model.mass_kg * model.impact_speed_mps / r.t_m_s);
    }
  }
}

TEST_P(CrushIdentities, EnergyLedgerClosesAtEverySample) {
  test::Random random(33);
  for (int i = 0; i < 150; ++i) {
    const CrushModel model = test::random_crush_model(random);
    const double impact = impact_energy(model);
    const CrushResponse r = simulate(model, options(SimulateOptions{}.rtol));
    for (std::size_t j = 0; j < r.time_s.size(); ++j)
      ASSERT_NEAR(r.energy_residual_j[j], 0.0, kLedger * impact) << "model " << i << " at " << r.time_s[j] << " s";
    EXPECT_NEAR(r.kinetic_energy_j + r.spring_energy_j + r.dissipated_energy_j, impact, kLedger * impact);
    if (model.damper.knots.empty() && std::isnan(r.separation_s)) {
      EXPECT_EQ(r.dissipated_energy_j, 0.0);
    }
  }
}

TEST_P(CrushIdentities, EnergyLedgerClosesThroughPlasticUnloading) {
  test::Random random(35);
  int separated = 0;
  for (int i = 0; i < 150; ++i) {
    CrushModel model = test::random_crush_model(random);
    test::make_plastic(model, random);
    const double impact = impact_energy(model);
    const CrushResponse r = simulate(model, options(SimulateOptions{}.rtol));
    for (std::size_t j = 0; j < r.time_s.size(); ++j)
      ASSERT_NEAR(r.energy_residual_j[j], 0.0, kLedger * impact) << "model " << i << " at " << r.time_s[j] << " s";
    EXPECT_NEAR(r.kinetic_energy_j + r.spring_energy_j + r.dissipated_energy_j, impact, kLedger * impact);
    separated += r.separation_s > r.t_m_s ? 1 : 0;
  }
  EXPECT_GT(separated, 30);
}

TEST_P(CrushIdentities, DissipatedEnergyIsTheDampersWork) {
  // The ledger's residual is made of the model's own energies: here the work is summed from the samples.
  SimulateOptions options = CrushIdentities::options();
  options.to_max_crush = true;
  for (const CrushModel& model : stopping_models(34, 30)) {
    SimulateOptions sampled = options;
    const CrushResponse first = simulate(model, options);
    constexpr std::size_t kIntervals = 20000;
    const double dt = first.t_m_s / kIntervals;
    for (std::size_t i = 0; i <= kIntervals; ++i) sampled.times_s.push_back(dt * static_cast<double>(i));
    sampled.to_max_crush = false;
    const CrushResponse r = simulate(model, sampled);
    const double impact = impact_energy(model);
    const double dissipated =
        simpson(kIntervals, dt, [&](std::size_t i) { return r.damper_force_n[i] * r.velocity_mps[i]; });
    const double stored =
        simpson(kIntervals, dt, [&](std::size_t i) { return r.spring_force_n[i] * r.velocity_mps[i]; });
    EXPECT_NEAR(first.dissipated_energy_j, dissipated, kSampling * impact);
    EXPECT_NEAR(first.spring_energy_j, stored, kSampling * impact);
  }
}

}  // namespace
}  // namespace crashsim
