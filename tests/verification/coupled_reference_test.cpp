/// The coupled model against an integrator that shares no code with it, over random models.

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <crashsim/coupled_columns.hpp>

#include "support/coupled_cases.hpp"
#include "support/coupled_reference.hpp"

namespace crashsim {
namespace {

constexpr double kAgreement = 1e-8;  // relative to each channel's largest value, as asked
constexpr double kRtol = 1e-10;
constexpr double kEnd = 0.15;
constexpr double kBalance = 1e-8;  // energy, relative to the initial one

constexpr std::vector<double> CoupledResponse::*kStates[] = {
    &CoupledResponse::displacement_m,     &CoupledResponse::heave_m,
    &CoupledResponse::pitch_rad,          &CoupledResponse::velocity_mps,
    &CoupledResponse::heave_velocity_mps, &CoupledResponse::pitch_rate_radps};

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double v : values) most = std::max(most, std::abs(v));
  return most;
}

CoupledOptions options() {
  CoupledOptions options;
  options.end_time_s = kEnd;
  options.dt_s = 1e-3;
  options.rtol = kRtol;
  return options;
}

/// Worst difference over all states, relative to each channel's largest value.
double disagreement(const CoupledResponse& r, const std::vector<test::CoupledReference::State>& reference) {
  double worst = 0.0;
  for (std::size_t c = 0; c < std::size(kStates); ++c) {
    const std::vector<double>& channel = r.*kStates[c];
    double most = 0.0;
    for (std::size_t i = 0; i < channel.size(); ++i)
      most = std::max(most, std::abs(channel[i] - static_cast<double>(reference[i][c])));
    if (most > 0.0) worst = std::max(worst, most / largest(channel));
  }
  return worst;
}

/// What the runs went through.
struct Seen {
  int separated = 0, lifted = 0, no_t_m = 0;
  double worst = 0.0;
};

/// Compares a run with the reference.
void expect_reference(const CoupledModel& model, const TimeSeries& force, const std::string& name, Seen& seen) {
  SCOPED_TRACE(name);
  const double speed = model.crush.impact_speed_mps;
  const CoupledResponse r = simulate_coupled(model, options(), force);
  ASSERT_TRUE(r.usable() || r.outcome == CoupledOutcome::no_max_crush) << r.message;
  test::CoupledReference reference(model, speed, force);
  const auto states = reference.at(r.time_s);
  const double difference = disagreement(r, states);
  EXPECT_LT(difference, kAgreement);
  EXPECT_EQ(std::isnan(r.t_m_s), std::isnan(reference.t_m_s()));
  EXPECT_EQ(std::isnan(r.separation_s), std::isnan(reference.separation_s()));
  if (r.usable()) {
    EXPECT_NEAR(r.t_m_s, reference.t_m_s(), kAgreement * kEnd);
    EXPECT_NEAR(r.max_crush_m, reference.max_crush_m(), kAgreement * r.max_crush_m);
  }
  if (!std::isnan(r.separation_s)) {
    EXPECT_NEAR(r.separation_s, reference.separation_s(), kAgreement * kEnd);
  }
  const double loads = largest(r.front_axle_load_n) + largest(r.rear_axle_load_n);
  for (std::size_t i = 0; i < states.size(); ++i) {
    EXPECT_NEAR(r.front_axle_load_n[i], static_cast<double>(reference.axle_load(0, states[i])), kAgreement * loads);
    EXPECT_NEAR(r.rear_axle_load_n[i], static_cast<double>(reference.axle_load(1, states[i])), kAgreement * loads);
  }
  const double mass = model.crush.mass_kg;
  EXPECT_LT(largest(r.energy_residual_j), kBalance * 0.5 * mass * speed * speed);
  seen.separated += std::isnan(r.separation_s) ? 0 : 1;
  seen.lifted += std::isnan(r.front_lift_off_s) && std::isnan(r.rear_lift_off_s) ? 0 : 1;
  seen.no_t_m += r.usable() ? 0 : 1;
  seen.worst = std::max(seen.worst, difference);
}

TEST(CoupledReference, RandomModelsAgreeWithAnIndependentIntegrator) {
  test::Random random(41);
  Seen seen;
  for (int i = 0; i < 100; ++i)
    expect_reference(test::random_coupled_model(random), {}, "model " + std::to_string(i), seen);
  EXPECT_GT(seen.separated, 20);
  EXPECT_GT(seen.lifted, 10);
  EXPECT_GT(seen.no_t_m, 5);
  EXPECT_GT(seen.worst, 0.0);  // they are two integrators
  RecordProperty("worst", fmt::format("{:.2g}", seen.worst));
}

TEST(CoupledReference, EveryLawAgreesWithAnIndependentIntegrator) {
  constexpr double kLowestReference = 0.5;  // m/s: the reference's fixed steps resolve it
  test::Random random(44);
  for (const CrushLaw law : {CrushLaw::crush_damping, CrushLaw::rate}) {
    Seen seen;
    for (int i = 0; i < 30; ++i) {
      CoupledModel model = test::random_coupled_model(random);
      model.crush = test::random_model_of(law, random);
      if (law == CrushLaw::rate)
        model.crush.reference_speed_mps = std::max(model.crush.reference_speed_mps, kLowestReference);
      if (i % 5 == 0) model.crush.unloading = {UnloadingKind::plastic, false, kUnset, random.between(0.02, 0.1)};
      if (simulate_coupled(model, options()).outcome == CoupledOutcome::unloading_too_soft) continue;
      expect_reference(model, {}, std::string(name_of(law)) + ", model " + std::to_string(i), seen);
    }
    EXPECT_GT(seen.separated, 8);
    RecordProperty("worst_" + std::string(name_of(law)), fmt::format("{:.2g}", seen.worst));
  }
}

TEST(CoupledReference, AGivenVerticalForceAgreesWithAnIndependentIntegrator) {
  test::Random random(42);
  Seen seen;
  for (int i = 0; i < 30; ++i) {
    CoupledModel model = test::random_coupled_model(random);
    model.vertical = {};
    const TimeSeries force = test::random_series(random, -0.02, 0.17, random.whole(2, 30), -6e4, 6e4);
    expect_reference(model, force, "model " + std::to_string(i), seen);
  }
  EXPECT_GT(seen.lifted, 3);
  RecordProperty("worst", fmt::format("{:.2g}", seen.worst));
}

TEST(CoupledReference, PlasticUnloadingAgreesWithAnIndependentIntegrator) {
  test::Random random(43);
  Seen seen;
  int too_soft = 0;
  for (int i = 0; i < 40; ++i) {
    CoupledModel model = test::random_coupled_model(random);
    model.crush.unloading = {UnloadingKind::plastic, false, kUnset, random.between(0.02, 0.3)};
    if (simulate_coupled(model, options()).outcome == CoupledOutcome::unloading_too_soft)
      ++too_soft;
    else
      expect_reference(model, {}, "model " + std::to_string(i), seen);
  }
  EXPECT_GT(seen.separated, 15);
  EXPECT_LT(too_soft, 15);
  RecordProperty("worst", fmt::format("{:.2g}", seen.worst));
}

CoupledOptions coarse() {
  CoupledOptions options;
  options.end_time_s = 0.6;
  options.dt_s = 1e-3;
  options.rtol = 1e-5;
  return options;
}

void expect_reference_in_large_steps(const CoupledModel& model, const TimeSeries& force) {
  const CoupledResponse r = simulate_coupled(model, coarse(), force);
  ASSERT_TRUE(r.usable()) << r.message;
  EXPECT_LT(disagreement(r, test::CoupledReference(model, model.crush.impact_speed_mps, force).at(r.time_s)),
            coarse().rtol);
}

TEST(CoupledReference, AShortExcursionOntoABumpStopIsNotSteppedOver) {
  CoupledModel model = test::coupled_vehicle();
  model.body.force_height_m = model.body.cg_height_m;
  const TimeSeries force = {{0.0, 1.0}, {8000.0, 8000.0}};
  const CoupledResponse without = simulate_coupled(model, coarse(), force);
  double lowest = 0.0;
  for (std::size_t i = 0; i < without.time_s.size(); ++i)
    lowest = std::min(lowest, without.heave_m[i] - model.body.front_axle_m * without.pitch_rad[i]);
  model.ground.front_bump_stiffness_n_per_m = 1e8;
  for (const double share : {0.999, 0.9999, 0.99998, 0.999995}) {
    SCOPED_TRACE(share);
    model.ground.front_bump_gap_m = -share * lowest;
    expect_reference_in_large_steps(model, force);
  }
}

TEST(CoupledReference, AShortExcursionOverADamperKnotIsNotSteppedOver) {
  CoupledModel model = test::coupled_vehicle();
  model.crush = test::kelvin_model(2582.0, 1e6, 0.0, 5.0);
  model.body.force_height_m = 1.15;
  const TimeSeries force = {{0.0, 0.3}, {2e5, 0.0}};  // at first the nose goes down faster than the front is stopped
  const CoupledResponse without = simulate_coupled(model, coarse(), force);
  double fastest = 0.0;
  for (std::size_t i = 0; i < without.time_s.size(); ++i)
    fastest = std::max(fastest, without.velocity_mps[i] + 0.5 * without.pitch_rate_radps[i]);
  ASSERT_GT(fastest, 5.05);
  for (const double share : {0.98, 0.985, 0.99, 0.995}) {
    SCOPED_TRACE(share);
    const double knot = 5.0 + share * (fastest - 5.0);
    model.crush.damper = {{0.0, knot, knot + 1.0}, {0.0, 0.0, 3e5}};
    expect_reference_in_large_steps(model, force);
  }
}

TEST(CoupledReference, TheAccuracyIsWhatWasAskedFor) {
  test::Random random(43);
  double worst = 0.0;
  for (int i = 0; i < 30; ++i) {
    const CoupledModel model = test::random_coupled_model(random);
    CoupledOptions defaults = options();
    defaults.rtol = CoupledOptions{}.rtol;
    const CoupledResponse r = simulate_coupled(model, defaults);
    const double difference = disagreement(r, test::CoupledReference(model, model.crush.impact_speed_mps).at(r.time_s));
    EXPECT_LT(difference, defaults.rtol) << "model " << i;
    worst = std::max(worst, difference);
  }
  RecordProperty("worst", fmt::format("{:.2g}", worst));
}

}  // namespace
}  // namespace crashsim
