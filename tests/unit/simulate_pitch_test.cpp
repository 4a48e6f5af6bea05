#include <crashsim/simulate_pitch.hpp>

#include <cmath>
#include <limits>
#include <string>

#include <gmock/gmock.h>

#include "support/pitch_cases.hpp"

namespace crashsim {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::ThrowsMessage;

constexpr double kRounding = 1e-12;

PitchForcing half_sine() {
  PitchForcing forcing;
  forcing.vertical_force_n = test::sampled_half_sine(80);
  forcing.t_m_s = 0.05;
  return forcing;
}

PitchOptions from(PitchStart rule, std::vector<double> numbers = {}) {
  PitchOptions options;
  options.start = {rule, std::move(numbers)};
  options.end_time_s = 0.1;
  options.dt_s = 0.01;
  return options;
}

HeavePitchModel without_suspension() {
  HeavePitchModel body = test::oracle_vehicle();
  for (const auto member : {&HeavePitchModel::front_stiffness_n_per_m, &HeavePitchModel::rear_stiffness_n_per_m,
                            &HeavePitchModel::front_damping_ns_per_m, &HeavePitchModel::rear_damping_ns_per_m})
    body.*member = 0.0;
  return body;
}

TEST(SimulatePitch, IsPessimisticUntilItHasRun) {
  const PitchResponse r;
  EXPECT_FALSE(r.usable());
  for (const auto& number : kPitchNumbers) EXPECT_TRUE(std::isnan(r.*number.member)) << number.name;
  for (const auto& column : kPitchColumns) EXPECT_THAT(r.*column.member, IsEmpty()) << column.name;
  EXPECT_THAT(r.brief_report(), HasSubstr("not_run"));
}

TEST(SimulatePitch, FillsEveryColumnAndNumber) {
  const PitchResponse r = simulate_pitch(test::oracle_vehicle(), half_sine(), from(PitchStart::impact));
  ASSERT_TRUE(r.usable()) << r.message;
  for (const auto& number : kPitchNumbers) EXPECT_TRUE(std::isfinite(r.*number.member)) << number.name;
  for (const auto& column : kPitchColumns) EXPECT_THAT(r.*column.member, SizeIs(11)) << column.name;
  EXPECT_THAT(r.modes, SizeIs(2));
  EXPECT_THAT(r.notes, IsEmpty());
  EXPECT_THAT(r.brief_report(), AllOf(HasSubstr("completed: largest pitch"), HasSubstr("heave velocity down to")));
}

TEST(SimulatePitch, SamplesAreUniformFromImpactAndIncludeTheEnd) {
  PitchOptions options = from(PitchStart::impact);
  options.dt_s = 0.04;
  EXPECT_THAT(simulate_pitch(test::oracle_vehicle(), half_sine(), options).time_s, ElementsAre(0.0, 0.04, 0.08, 0.1));
  options.dt_s = 0.05;
  EXPECT_THAT(simulate_pitch(test::oracle_vehicle(), half_sine(), options).time_s, ElementsAre(0.0, 0.05, 0.1));
  options.dt_s = 7.0;
  EXPECT_THAT(simulate_pitch(test::oracle_vehicle(), half_sine(), options).time_s, ElementsAre(0.0, 0.1));
  options = from(PitchStart::given, {-0.02});
  options.dt_s = 0.06;
  EXPECT_THAT(simulate_pitch(test::oracle_vehicle(), half_sine(), options).time_s,
              ElementsAre(-0.02, testing::DoubleNear(0.04, kRounding), testing::DoubleNear(0.1, kRounding)));
}

TEST(SimulatePitch, TheBodyIsHeldUntilTheStart) {
  PitchOptions options = from(PitchStart::t_m);
  options.heave_m = 0.01;
  options.heave_velocity_mps = -0.2;
  const PitchResponse r = simulate_pitch(test::oracle_vehicle(), half_sine(), options);
  EXPECT_EQ(r.start_time_s, 0.05);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(r.heave_m[i], 0.01);
    EXPECT_EQ(r.heave_velocity_mps[i], 0.0);
    EXPECT_EQ(r.heave_accel_mps2[i], 0.0);
    EXPECT_EQ(r.heave_force_n[i], 0.0);
    EXPECT_NEAR(r.front_axle_force_n[i], -300.0, kRounding * 300.0);
  }
  EXPECT_EQ(r.heave_m[5], 0.01);
  EXPECT_EQ(r.heave_velocity_mps[5], -0.2);
  EXPECT_NEAR(r.heave_force_n[5], -test::half_sine(0.05), kRounding * test::kHalfSinePeak);
  EXPECT_LT(r.heave_m[6], 0.01);
}

TEST(SimulatePitch, StartingAtMaximumCrushIsStartingAtThatTime) {
  const PitchResponse at_t_m = simulate_pitch(test::oracle_vehicle(), half_sine(), from(PitchStart::t_m));
  const PitchResponse given = simulate_pitch(test::oracle_vehicle(), half_sine(), from(PitchStart::given, {0.05}));
  const PitchResponse impact = simulate_pitch(test::oracle_vehicle(), half_sine(), from(PitchStart::impact));
  EXPECT_EQ(at_t_m.pitch_rad, given.pitch_rad);
  EXPECT_LT(at_t_m.pitch_rad.back(), impact.pitch_rad.back());
  EXPECT_EQ(impact.start_time_s, 0.0);
}

TEST(SimulatePitch, ForcesAreZeroOutsideTheirSamples) {
  const HeavePitchModel body = without_suspension();
  PitchForcing forcing;
  forcing.vertical_force_n = {{0.02, 0.06}, {2582.0, 2582.0}};  // 1 m/s^2 for 40 ms
  const PitchResponse r = simulate_pitch(body, forcing, from(PitchStart::impact));
  EXPECT_EQ(r.heave_m[2], 0.0);
  EXPECT_NEAR(r.heave_m[4], -0.5 * 0.02 * 0.02, kRounding);
  EXPECT_NEAR(r.heave_velocity_mps[6], -0.04, kRounding);
  EXPECT_NEAR(r.heave_velocity_mps[10], -0.04, kRounding);
  EXPECT_NEAR(r.heave_m[10], -0.5 * 0.04 * 0.04 - 0.04 * 0.04, kRounding);
  EXPECT_THAT(r.notes, ElementsAre(HasSubstr("vertical_force_n begins at 0.02 s with 2582 N, 100 % of its largest"),
                                   HasSubstr("vertical_force_n ends at 0.06 s")));
}

/// Constant rates that hold the energy and turn about the point that an impulse at the arm leaves at rest.
TEST(SimulatePitch, AFreeBodyKeepsTheResidualEnergyAsConstantRates) {
  HeavePitchModel body = without_suspension();
  body.force_arm_m = 1.7;
  PitchOptions options = from(PitchStart::given, {0.02});
  options.residual_energy_j = 800.0;
  options.heave_m = 0.03;
  const PitchResponse r = simulate_pitch(body, {}, options);
  ASSERT_TRUE(r.usable()) << r.message;
  EXPECT_EQ(r.heave_velocity_mps[1], 0.0);
  for (std::size_t i = 2; i < r.time_s.size(); ++i) {
    const double heave = r.heave_velocity_mps[i], pitch = r.pitch_rate_radps[i];
    EXPECT_LT(heave, 0.0);
    EXPECT_NEAR(0.5 * body.mass_kg * heave * heave + 0.5 * body.pitch_inertia_kgm2 * pitch * pitch, 800.0,
                kRounding * 800.0);
    const double at_rest_m = body.pitch_inertia_kgm2 / (body.mass_kg * body.force_arm_m);  // behind the centre
    EXPECT_NEAR(heave + at_rest_m * pitch, 0.0, kRounding);
    EXPECT_NEAR(r.heave_m[i], 0.03 + heave * (r.time_s[i] - 0.02), kRounding);
    EXPECT_NEAR(r.pitch_rad[i], pitch * (r.time_s[i] - 0.02), kRounding);
  }
  EXPECT_THAT(r.notes, ElementsAre(AllOf(HasSubstr("residual energy of 800 J: the motion starts with a heave velocity"),
                                         HasSubstr("at the force's arm gives a free body"))));
}

TEST(SimulatePitch, NoResidualEnergyIsStartingAtRest) {
  PitchOptions options = from(PitchStart::t_m);
  const PitchResponse at_rest = simulate_pitch(test::oracle_vehicle(), half_sine(), options);
  options.residual_energy_j = 0.0;
  EXPECT_EQ(simulate_pitch(test::oracle_vehicle(), half_sine(), options).pitch_rad, at_rest.pitch_rad);
}

TEST(SimulatePitch, ThePrintedFormTakesTheResidualEnergyAtItsOwnArm) {
  HeavePitchModel body = without_suspension();
  PitchOptions options = from(PitchStart::impact);
  options.residual_energy_j = 500.0;
  body.force_arm_m = 1.0;
  const PitchResponse derived = simulate_pitch(body, {}, options);
  body.force_arm_m = kUnset;
  body.formulation = PitchFormulation::as_printed;
  EXPECT_EQ(simulate_pitch(body, {}, options).pitch_rate_radps.front(), derived.pitch_rate_radps.front());
}

TEST(SimulatePitch, NotesWhatThePrintedFormLeavesOut) {
  HeavePitchModel model = test::oracle_vehicle();
  model.force_arm_m = kUnset;  // not needed
  model.formulation = PitchFormulation::as_printed;
  model.front_damping_ns_per_m = 0.0;
  model.front_axle_m = model.rear_axle_m = 0.8;
  PitchForcing forcing = half_sine();
  forcing.longitudinal_force_n = {{0.0, 0.05, 0.1}, {0.0, 1e5, 0.0}};
  const PitchResponse both = simulate_pitch(model, forcing, from(PitchStart::impact));
  EXPECT_THAT(both.notes, ElementsAre(HasSubstr("lever arm of 1 m"), HasSubstr("the longitudinal force is not in"),
                                      HasSubstr("not positive semidefinite")));
  EXPECT_EQ(both.pitch_rad, simulate_pitch(model, half_sine(), from(PitchStart::impact)).pitch_rad);
  EXPECT_NEAR(both.pitch_moment_nm[4], test::half_sine(0.04), kRounding * test::kHalfSinePeak);
}

TEST(SimulatePitch, AMotionThatGrowsBeyondAllBoundsIsNotUsable) {
  HeavePitchModel model = test::oracle_vehicle();
  model.formulation = PitchFormulation::as_printed;
  model.front_damping_ns_per_m = 0.0;
  model.rear_damping_ns_per_m = 1e9;
  model.front_axle_m = model.rear_axle_m = 0.2;
  const PitchResponse r = simulate_pitch(model, half_sine(), from(PitchStart::impact));
  EXPECT_EQ(r.outcome, PitchOutcome::failed);
  EXPECT_FALSE(r.usable());
  EXPECT_THAT(r.heave_m, IsEmpty());
  EXPECT_THAT(r.time_s, IsEmpty());
  EXPECT_TRUE(std::isnan(r.pitch_max_rad));
  EXPECT_THAT(r.brief_report(), HasSubstr("failed: the motion grows beyond all bounds"));
}

using M = HeavePitchModel;
using F = PitchForcing;
using O = PitchOptions;

/// Runs with something changed.
template <class Change>
auto with(const Change& change) {
  HeavePitchModel model = test::oracle_vehicle();
  PitchForcing forcing = half_sine();
  PitchOptions options = from(PitchStart::impact);
  change(model, forcing, options);
  return [=] { (void)simulate_pitch(model, forcing, options); };
}

TEST(SimulatePitch, RefusesAResidualEnergyThatSaysNothingClear) {
  const auto energy = [](M& m, O& o) {
    o.residual_energy_j = 100.0;
    m.force_arm_m = 1.2;
  };
  EXPECT_NO_THROW(with([&](M& m, F&, O& o) { energy(m, o); })());
  EXPECT_THAT(with([&](M& m, F&, O& o) {
                energy(m, o);
                o.residual_energy_j = -1.0;
              }),
              ThrowsMessage<InvalidInput>(HasSubstr("PitchOptions.residual_energy_j = -1 J: must be >= 0")));
  EXPECT_THAT(with([&](M& m, F&, O& o) {
                energy(m, o);
                o.pitch_rate_radps = 0.1;
              }),
              ThrowsMessage<InvalidInput>(
                  HasSubstr("PitchOptions.residual_energy_j = 100 J comes with heave_velocity_mps = 0 m/s and "
                            "pitch_rate_radps = 0.1 rad/s: the energy gives the initial rates: leave out one")));
  EXPECT_THAT(with([&](M& m, F& f, O& o) {
                energy(m, o);
                f = {};
                m.force_arm_m = kUnset;
                o.start.rule = PitchStart::impact;
              }),
              ThrowsMessage<InvalidInput>(
                  HasSubstr("HeavePitchModel.force_arm_m is not set but there is a residual energy: give the ")));
}

TEST(SimulatePitch, RefusesAModelThatLacksWhatTheForceNeeds) {
  EXPECT_THAT(with([](M& m, F&, O&) { m.mass_kg = -3.0; }),
              ThrowsMessage<InvalidInput>(HasSubstr("HeavePitchModel.mass_kg = -3 kg: must be > 0")));
  EXPECT_THAT(with([](M& m, F&, O&) { m.force_arm_m = kUnset; }),
              ThrowsMessage<InvalidInput>(
                  AllOf(HasSubstr("HeavePitchModel.force_arm_m is not set but there is a vertical force"),
                        HasSubstr("give the lever arm of the vertical force"))));
  const auto pushed = [](M& m, F& f) {
    f.longitudinal_force_n = {{0.0, 0.1}, {1e5, 0.0}};
    m.cg_height_m = 0.6;
    m.force_height_m = 0.5;
  };
  EXPECT_NO_THROW(with([&](M& m, F& f, O&) { pushed(m, f); })());
  EXPECT_THAT(with([&](M& m, F& f, O&) {
                pushed(m, f);
                m.cg_height_m = kUnset;
              }),
              ThrowsMessage<InvalidInput>(
                  HasSubstr("HeavePitchModel.cg_height_m is not set but there is a longitudinal force")));
  EXPECT_THAT(with([&](M& m, F& f, O&) {
                pushed(m, f);
                m.force_height_m = kUnset;
              }),
              ThrowsMessage<InvalidInput>(HasSubstr("HeavePitchModel.force_height_m is not set but there is a "
                                                    "longitudinal force without a series of its height")));
}

TEST(SimulatePitch, RefusesBadSeriesByName) {
  EXPECT_THAT(with([](M&, F& f, O&) {
                f.vertical_force_n = {{0.0, 0.1, 0.1}, {1, 2, 3}};
              }),
              ThrowsMessage<InvalidInput>(
                  AllOf(HasSubstr("PitchForcing.vertical_force_n: time of sample 3 is 0.1 s, not after"),
                        HasSubstr("times must increase"))));
  EXPECT_THAT(with([](M&, F& f, O&) {
                f.vertical_force_n = {{0.0, 0.1}, {1, kUnset}};
              }),
              ThrowsMessage<InvalidInput>(HasSubstr("PitchForcing.vertical_force_n: sample 2 at 0.1 s is nan")));
  EXPECT_THAT(with([](M&, F& f, O&) {
                f.longitudinal_force_n = {{0.0, 0.1}, {1}};
              }),
              ThrowsMessage<InvalidInput>(HasSubstr("PitchForcing.longitudinal_force_n: 2 times but 1 values")));
  EXPECT_THAT(with([](M&, F& f, O&) {
                f.force_height_m = {{0.0}, {0.5}};
              }),
              ThrowsMessage<InvalidInput>(HasSubstr("PitchForcing.force_height_m: 1 samples: at least 2 are needed")));
}

TEST(SimulatePitch, RefusesBadOptionsByName) {
  EXPECT_THAT(with([](M&, F& f, O& o) {
                o.start.rule = PitchStart::t_m;
                f.t_m_s = kUnset;
              }),
              ThrowsMessage<InvalidInput>(AllOf(
                  HasSubstr("PitchOptions.start = t_m: PitchForcing.t_m_s, the time of maximum crush, is not set"),
                  HasSubstr("start = impact or a time"))));
  EXPECT_THAT(with([](M&, F&, O& o) {
                o.start = {PitchStart::given, {}};
              }),
              ThrowsMessage<InvalidInput>(HasSubstr("PitchOptions.start = : must be one finite time in s")));
  EXPECT_THAT(with([](M&, F&, O& o) {
                o.start = {PitchStart::given, {0.01, 0.02}};
              }),
              ThrowsMessage<InvalidInput>(HasSubstr("PitchOptions.start = 0.01,0.02: must be one finite time")));
  EXPECT_THAT(with([](M&, F&, O& o) {
                o.start = {PitchStart::given, {0.1}};
              }),
              ThrowsMessage<InvalidInput>(
                  HasSubstr("PitchOptions.end_time_s = 0.1 s: must be after the start of the motion, 0.1 s")));
  EXPECT_THAT(with([](M&, F&, O& o) { o.dt_s = 0.0; }),
              ThrowsMessage<InvalidInput>(HasSubstr("PitchOptions.dt_s = 0 s: must be > 0")));
  EXPECT_THAT(with([](M&, F&, O& o) { o.dt_s = 1e-12; }),
              ThrowsMessage<InvalidInput>(AllOf(HasSubstr("PitchOptions.dt_s = 1e-12 s: gives 1e+11 samples"),
                                                HasSubstr("take a longer one"))));
  EXPECT_THAT(with([](M&, F&, O& o) { o.rtol = 0.1; }),
              ThrowsMessage<InvalidInput>(HasSubstr("PitchOptions.rtol = 0.1: must be >= 1e-13 and <= 0.01")));
  EXPECT_THAT(with([](M&, F&, O& o) { o.pitch_rate_radps = std::numeric_limits<double>::infinity(); }),
              ThrowsMessage<InvalidInput>(HasSubstr("PitchOptions.pitch_rate_radps = inf rad/s: must be finite")));
}

}  // namespace
}  // namespace crashsim
