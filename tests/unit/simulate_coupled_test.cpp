#include <crashsim/simulate_coupled.hpp>

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include <crashsim/coupled_columns.hpp>
#include <crashsim/option_docs.hpp>
#include <crashsim/units.hpp>

#include "support/coupled_cases.hpp"

namespace crashsim {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::ThrowsMessage;

constexpr double kRounding = 1e-12;
constexpr double kAccuracy = 1e-9;  // [s] of the default rtol

CoupledOptions short_run() {
  CoupledOptions options;
  options.end_time_s = 0.2;
  options.dt_s = 0.01;
  return options;
}

TEST(SimulateCoupled, IsPessimisticUntilItHasRun) {
  const CoupledResponse r;
  EXPECT_FALSE(r.usable());
  for (const auto& number : kCoupledNumbers) EXPECT_TRUE(std::isnan(r.*number.member)) << number.name;
  for (const auto& column : kCoupledColumns) EXPECT_THAT(r.*column.member, IsEmpty()) << column.name;
  EXPECT_THAT(r.brief_report(), HasSubstr("not run"));
}

TEST(SimulateCoupled, FillsEveryColumnAndNumber) {
  CoupledModel model = test::coupled_vehicle();
  model.ground.lift_off = true;
  model.body.force_height_m = 0.2;
  model.vertical.angle_rad = -0.2;
  const CoupledResponse r = simulate_coupled(model, short_run());
  ASSERT_TRUE(r.usable()) << r.message;
  for (const auto& column : kCoupledColumns) EXPECT_THAT(r.*column.member, SizeIs(21)) << column.name;
  for (const auto& number : kCoupledNumbers)
    if (number.name.find("lift_off") == std::string_view::npos) {
      EXPECT_TRUE(std::isfinite(r.*number.member)) << number.name;
    }
  EXPECT_GT(r.statistics.steps, 0);
  EXPECT_GT(r.statistics.force_evaluations, r.statistics.steps);
  EXPECT_GT(r.statistics.events, 10);
  EXPECT_THAT(r.brief_report(), AllOf(HasSubstr("maximum crush 0."), HasSubstr("largest pitch")));
}

TEST(SimulateCoupled, StartsAtTheImpactSpeedInStaticEquilibrium) {
  const CoupledResponse r = simulate_coupled(test::coupled_vehicle(), short_run());
  EXPECT_EQ(r.time_s.front(), 0.0);
  EXPECT_EQ(r.velocity_mps.front(), 56.0 / 3.6);
  EXPECT_EQ(r.heave_m.front(), 0.0);
  EXPECT_EQ(r.pitch_rad.front(), 0.0);
  EXPECT_NEAR(r.front_axle_load_n.front(), 2582.0 * kStandardGravity * 1.0 / 2.4, kRounding * 1e5);
  EXPECT_NEAR(r.rear_axle_load_n.front(), 2582.0 * kStandardGravity * 1.4 / 2.4, kRounding * 1e5);
  EXPECT_NEAR(r.accel_mps2.front(), -r.longitudinal_force_n.front() / 2582.0, kRounding * 1e3);
}

TEST(SimulateCoupled, SamplesAreUniformAndIncludeTheEnd) {
  CoupledOptions options = short_run();
  options.end_time_s = 0.1;
  options.dt_s = 0.04;
  EXPECT_THAT(simulate_coupled(test::coupled_vehicle(), options).time_s, ElementsAre(0.0, 0.04, 0.08, 0.1));
  options.dt_s = 7.0;
  EXPECT_THAT(simulate_coupled(test::coupled_vehicle(), options).time_s, ElementsAre(0.0, 0.1));
  options.end_time_s = kUnset;
  EXPECT_EQ(simulate_coupled(test::coupled_vehicle(), options).time_s.back(), 0.3);
}

TEST(SimulateCoupled, OneMassIsEnough) {
  const CoupledModel both = test::coupled_vehicle();
  CoupledModel crush_only = both, body_only = both;
  crush_only.body.mass_kg = kUnset;
  body_only.crush.mass_kg = kUnset;
  const CoupledResponse r = simulate_coupled(both, short_run());
  EXPECT_EQ(simulate_coupled(crush_only, short_run()).pitch_rad, r.pitch_rad);
  EXPECT_EQ(simulate_coupled(body_only, short_run()).pitch_rad, r.pitch_rad);
}

TEST(SimulateCoupled, AWheelsValuesAreHalfAnAxles) {
  const CoupledModel wheel = test::coupled_vehicle();
  CoupledModel axle = wheel;
  axle.body = with_axle_values(wheel.body);
  EXPECT_EQ(simulate_coupled(axle, short_run()).pitch_rad, simulate_coupled(wheel, short_run()).pitch_rad);
}

TEST(SimulateCoupled, AGivenForceActsWhateverTheContact) {
  const TimeSeries late = {{0.18, 0.19}, {2582.0, 2582.0}};
  const CoupledResponse r = simulate_coupled(test::coupled_vehicle(), short_run(), late);
  EXPECT_LT(r.separation_s, 0.18);
  EXPECT_EQ(r.vertical_force_n[17], 0.0);
  EXPECT_THAT(r.notes, Contains(HasSubstr("the given vertical force still reaches 2582 N after contact is lost")));
  CoupledOptions finer = short_run();
  finer.dt_s = 0.001;
  EXPECT_EQ(simulate_coupled(test::coupled_vehicle(), finer, late).vertical_force_n[185], 2582.0);
}

TEST(SimulateCoupled, NotesWhatACarefulReaderShouldKnow) {
  CoupledModel model = test::coupled_vehicle();
  EXPECT_THAT(simulate_coupled(model, short_run()).notes, IsEmpty());
  model.body.force_height_m = 0.0;
  model.body.cg_height_m = 1.0;
  EXPECT_THAT(simulate_coupled(model, short_run()).notes,
              AllOf(Contains(HasSubstr("the equations are for small angles")),
                    Contains(AllOf(HasSubstr("the ground pulls the rear axle with up to"), HasSubstr("lift_off")))));
  model.ground.lift_off = true;
  const CoupledResponse lifted = simulate_coupled(model, short_run());
  EXPECT_THAT(lifted.notes, ElementsAre(HasSubstr("the equations are for small angles")));
  EXPECT_TRUE(std::isfinite(lifted.rear_lift_off_s));
  EXPECT_EQ(lifted.rear_axle_load_min_n, 0.0);
}

TEST(SimulateCoupled, NotesThatPitchingCrushesTheFrontAgain) {
  CoupledModel model = test::coupled_vehicle();
  model.crush = test::kelvin_model(2582.0, 1e5, 0.0, 2.0);
  model.crush.unloading.bilateral = true;
  model.body.force_height_m = 1.65;
  const double t_m = simulate_coupled(model).t_m_s;
  const TimeSeries pushed_down = {{t_m + 0.01, t_m + 0.02}, {5e6, 5e6}};
  const CoupledResponse r = simulate_coupled(model, {}, pushed_down);
  EXPECT_NEAR(r.t_m_s, t_m, kAccuracy);
  EXPECT_THAT(r.notes, Contains(AllOf(HasSubstr("crush is up to"), HasSubstr("after t_m"))));
}

TEST(SimulateCoupled, WithoutMaximumCrushThereIsNoTime) {
  CoupledOptions options = short_run();
  options.end_time_s = 0.02;
  const CoupledResponse r = simulate_coupled(test::coupled_vehicle(), options);
  EXPECT_EQ(r.outcome, CoupledOutcome::no_max_crush);
  EXPECT_FALSE(r.usable());
  EXPECT_TRUE(std::isnan(r.t_m_s));
  EXPECT_THAT(r.message,
              AllOf(HasSubstr("no maximum crush"), HasSubstr("within 0..0.02 s"), HasSubstr("simulate longer")));
}

TEST(SimulateCoupled, LeavingTheKnotsEndsTheRunWhenAskedFor) {
  CoupledModel model = test::coupled_vehicle();
  model.crush.extrapolation = Extrapolation::error;
  model.crush.spring = {{0.0, 0.2, 0.4}, {1e6, 1e6, 1e6}};
  const CoupledResponse r = simulate_coupled(model, short_run());
  EXPECT_EQ(r.outcome, CoupledOutcome::left_knot_range);
  EXPECT_NEAR(r.crush_m.back(), 0.4, kRounding);
  EXPECT_THAT(r.message, AllOf(HasSubstr("crush 0.4 m"), HasSubstr("extend the curves")));
}

TEST(SimulateCoupled, AnAngleThatGrowsTooSteepEndsTheRun) {
  CoupledModel model = test::coupled_vehicle();
  model.vertical = {.angle_rate_rad_per_m = 5.0};
  const CoupledResponse r = simulate_coupled(model, short_run());
  EXPECT_EQ(r.outcome, CoupledOutcome::failed);
  EXPECT_NEAR(r.crush_m.back(), 0.3, kRounding);
  EXPECT_THAT(r.brief_report(),
              AllOf(HasSubstr("failed: at t = "), HasSubstr("reaches 1.5 rad"), HasSubstr("give friction")));
  model.vertical.friction = 0.3;
  EXPECT_TRUE(simulate_coupled(model, short_run()).usable());
}

/// Runs with something changed.
template <class Change>
auto with(const Change& change) {
  CoupledModel model = test::coupled_vehicle();
  CoupledOptions options = short_run();
  TimeSeries force;
  change(model, options, force);
  return [=] { (void)simulate_coupled(model, options, force); };
}

using M = CoupledModel;
using O = CoupledOptions;
using F = TimeSeries;

TEST(SimulateCoupled, RefusesAModelThatDoesNotFitTogether) {
  EXPECT_THAT(
      with([](M& m, O&, F&) { m.crush.mass_kg = 1700.0; }),
      ThrowsMessage<InvalidInput>(AllOf(HasSubstr("CrushModel.mass_kg = 1700 kg but HeavePitchModel.mass_kg = 2582 kg"),
                                        HasSubstr("leave one unset"))));
  EXPECT_THAT(with([](M& m, O&, F&) { m.crush.mass_kg = m.body.mass_kg = kUnset; }),
              ThrowsMessage<InvalidInput>(HasSubstr("CrushModel.mass_kg = nan kg: must be > 0")));
  EXPECT_THAT(with([](M& m, O&, F&) { m.body.pitch_inertia_kgm2 = -1.0; }),
              ThrowsMessage<InvalidInput>(HasSubstr("HeavePitchModel.pitch_inertia_kgm2 = -1 kg m^2: must be > 0")));
  EXPECT_THAT(with([](M& m, O&, F&) { m.body.cg_height_m = kUnset; }),
              ThrowsMessage<InvalidInput>(
                  HasSubstr("HeavePitchModel.cg_height_m is not set but the crush force acts at a height")));
  EXPECT_THAT(with([](M& m, O&, F&) { m.body.force_height_m = kUnset; }),
              ThrowsMessage<InvalidInput>(HasSubstr("HeavePitchModel.force_height_m is not set")));
  const auto without_arm = [](M& m, O&, F&) {
    m.body.force_arm_m = kUnset;
    m.vertical.angle_rad = 0.1;
  };
  EXPECT_THAT(
      with(without_arm),
      ThrowsMessage<InvalidInput>(HasSubstr("HeavePitchModel.force_arm_m is not set but there is a vertical force")));
  EXPECT_NO_THROW(with([](M& m, O&, F&) { m.body.force_arm_m = kUnset; })());
  EXPECT_THAT(with([](M& m, O&, F&) { m.body.formulation = PitchFormulation::as_printed; }),
              ThrowsMessage<InvalidInput>(HasSubstr("HeavePitchModel.formulation = as_printed: the coupled model has "
                                                    "the derived equations only")));
  EXPECT_THAT(with([](M& m, O&, F&) { m.ground.front_bump_gap_m = 0.05; }),
              ThrowsMessage<InvalidInput>(
                  HasSubstr("GroundContact.front_bump_stiffness_n_per_m is not set but there is a bump stop")));
  EXPECT_THAT(with([](M& m, O&, F&) { m.ground.rear_bump_stiffness_n_per_m = 1e5; }),
              ThrowsMessage<InvalidInput>(HasSubstr("GroundContact.rear_bump_gap_m is not set")));
  EXPECT_THAT(with([](M& m, O&, F&) { m.ground.rear_bump_gap_m = -0.01; }),
              ThrowsMessage<InvalidInput>(HasSubstr("GroundContact.rear_bump_gap_m = -0.01 m: must be >= 0")));
}

TEST(SimulateCoupled, RefusesBadOptionsAndSeriesByName) {
  EXPECT_THAT(with([](M& m, O&, F&) { m.crush.impact_speed_mps = kUnset; }),
              ThrowsMessage<InvalidInput>(
                  AllOf(HasSubstr("CoupledOptions.impact_speed_mps: not given"), HasSubstr("give a speed"))));
  EXPECT_THAT(with([](M&, O& o, F&) { o.impact_speed_mps = -1.0; }),
              ThrowsMessage<InvalidInput>(HasSubstr("CoupledOptions.impact_speed_mps = -1 m/s: must be > 0")));
  EXPECT_THAT(with([](M&, O& o, F&) { o.end_time_s = 0.0; }),
              ThrowsMessage<InvalidInput>(HasSubstr("CoupledOptions.end_time_s = 0 s: must be > 0")));
  EXPECT_THAT(with([](M&, O& o, F&) { o.dt_s = 1e-12; }),
              ThrowsMessage<InvalidInput>(AllOf(HasSubstr("CoupledOptions.dt_s = 1e-12 s: gives 2e+11 samples"),
                                                HasSubstr("take a longer one"))));
  EXPECT_THAT(with([](M&, O& o, F&) { o.rtol = 0.1; }),
              ThrowsMessage<InvalidInput>(HasSubstr("CoupledOptions.rtol = 0.1: must be >= 1e-10 and <= 0.01")));
  EXPECT_THAT(with([](M&, O&, F& f) {
                f = {{0.0, 0.1}, {1.0}};
              }),
              ThrowsMessage<InvalidInput>(HasSubstr("vertical_force_n: 2 times but 1 values")));
  EXPECT_THAT(with([](M&, O&, F& f) {
                f = {{0.0, 0.1}, {1.0, kUnset}};
              }),
              ThrowsMessage<InvalidInput>(HasSubstr("vertical_force_n: sample 2 at 0.1 s is nan")));
  const auto law_and_series = [](M& m, O&, F& f) {
    f = {{0.0, 0.1}, {1.0, 2.0}};
    m.vertical.angle_rad = 0.1;
  };
  EXPECT_THAT(with(law_and_series),
              ThrowsMessage<InvalidInput>(HasSubstr("vertical_force_n: there is also a VerticalForceLaw with an angle: "
                                                    "give either a series or a law")));
  const auto series_without_arm = [](M& m, O&, F& f) {
    f = {{0.0, 0.1}, {1.0, 2.0}};
    m.body.force_arm_m = kUnset;
  };
  EXPECT_THAT(with(series_without_arm), ThrowsMessage<InvalidInput>(HasSubstr("HeavePitchModel.force_arm_m")));
}

template <class S>
void expect_documented() {
  for (const Field<S>& field : fields<S>) {
    EXPECT_FALSE(describe_field(field).doc.empty()) << field.name;
    EXPECT_EQ(field.flag.find('_'), std::string_view::npos) << field.flag;
  }
}

TEST(SimulateCoupled, EveryOptionHasWordsAndAFlagOfTheShell) {
  expect_documented<CoupledOptions>();
  expect_documented<GroundContact>();
}

}  // namespace
}  // namespace crashsim
