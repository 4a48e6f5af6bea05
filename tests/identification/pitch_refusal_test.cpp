/// What the identification of heave and pitch says about input it cannot use.

#include <cmath>
#include <functional>
#include <ostream>

#include <gmock/gmock.h>

#include "support/pitch_fit_cases.hpp"

namespace crashsim {
namespace {

using M = HeavePitchModel;

/// Input that is good, to be spoiled.
struct Input {
  M model = test::oracle_vehicle();
  PitchForcing forcing = test::vertical_half_sine();
  PitchOptions simulation = test::to(0.5);
  PitchTarget target = test::target_of(simulate_pitch(model, forcing, simulation));
  IdentifyPitchOptions options;
};

struct BadInput {
  const char* name;
  std::function<void(Input&)> spoil;
  const char* message;
};
void PrintTo(const BadInput& bad, std::ostream* out) { *out << bad.name; }

class PitchRefused : public testing::TestWithParam<BadInput> {};

TEST_P(PitchRefused, SaysWhy) {
  Input input;
  input.options.starts = 1;
  GetParam().spoil(input);
  try {
    identify_pitch(input.model, input.forcing, input.target, input.simulation, input.options);
    FAIL() << "accepted";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), testing::StartsWith(GetParam().message));
  }
}

const BadInput kBadInputs[] = {
    {"unknown_name", [](Input& in) { in.options.free = {"front_stifness"}; },
     "IdentifyPitchOptions.free: unknown name 'front_stifness', did you mean 'front-stiffness'? (known: mass, "},
    {"not_a_number", [](Input& in) { in.options.free = {"per_wheel"}; },
     "IdentifyPitchOptions.free: per_wheel is not a number to identify"},
    {"named_twice",
     [](Input& in) {
       in.options.free = {"rear_axle", "rear_axle_m"};
     },
     "IdentifyPitchOptions.free names rear_axle_m twice"},
    {"nothing_free", [](Input& in) { in.options.free.clear(); },
     "IdentifyPitchOptions.free names no number: give at least one to identify"},
    {"bounds_inverted",
     [](Input& in) {
       in.options.free = {"rear_axle"};
       in.options.lower = {2.0};
       in.options.upper = {1.0};
     },
     "IdentifyPitchOptions: the bounds 2 to 1 m of rear_axle_m must increase: give lower and upper"},
    {"bound_below_what_the_model_allows",
     [](Input& in) {
       in.options.free = {"rear_damping", "pitch_inertia"};
       in.options.lower = {kUnset, 0.0};
     },
     "IdentifyPitchOptions.lower[1] (pitch_inertia_kgm2) = 0 kg m^2: must be > 0"},
    {"too_few_bounds",
     [](Input& in) {
       in.options.upper = {1e5, 1e5};
     },
     "IdentifyPitchOptions.upper has 2 numbers but there are 4 in free: give one for each"},
    {"no_starts", [](Input& in) { in.options.starts = 0; },
     "IdentifyPitchOptions.starts = 0: must be >= 1 and <= 1e+06"},
    {"window_inverted",
     [](Input& in) {
       in.options.from_s = 0.3;
       in.options.to_s = 0.2;
     },
     "IdentifyPitchOptions.from_s = 0.3 s: must be before to_s = 0.2 s"},
    {"target_empty", [](Input& in) { in.target = {}; },
     "PitchTarget is empty: give at least one of heave_m, pitch_rad, heave_velocity_mps, pitch_rate_radps"},
    {"target_outside_the_window", [](Input& in) { in.options.from_s = 0.6; },
     "PitchTarget.heave_m: none of its samples, from 0 s to 0.5 s, is compared: that is from 0.6 s, not before the "
     "motion starts, to 0.5 s: check clock and window"},
    {"target_before_the_start",
     [](Input& in) {
       in.simulation.start = {PitchStart::given, {0.7}};
     },
     "PitchTarget.heave_m: none of its samples, from 0 s to 0.5 s, is compared: that is from 0.7 s"},
    {"target_at_the_start_only",
     [](Input& in) {
       in.simulation.start = {PitchStart::given, {0.5}};
       in.simulation.end_time_s = kUnset;
     },
     "PitchTarget: no sample after the start of the motion, 0.5 s: check clock and window"},
    {"target_zero", [](Input& in) { in.target.pitch_rad.values.assign(in.target.pitch_rad.values.size(), 0.0); },
     "PitchTarget.pitch_rad is zero where it is compared: there is no motion to identify from"},
    {"target_not_finite", [](Input& in) { in.target.heave_m.values[3] = kUnset; },
     "PitchTarget.heave_m: sample 4 at 0.003 s is nan: must be finite"},
    {"few_samples",
     [](Input& in) {
       in.target = {{{0.1, 0.2, 0.3}, {0.1, 0.1, 0.1}}, {}, {}, {}};
     },
     "PitchTarget: 3 samples cannot determine 4 parameters: free fewer or give more"},
    {"a_number_that_is_not_free_is_missing", [](Input& in) { in.model.rear_axle_m = kUnset; },
     "HeavePitchModel.rear_axle_m is not set: give the "},
    {"the_force_needs_an_arm", [](Input& in) { in.model.force_arm_m = kUnset; },
     "HeavePitchModel.force_arm_m is not set but there is a vertical force: give the "},
    {"no_time_of_maximum_crush", [](Input& in) { in.simulation.start.rule = PitchStart::t_m; },
     "PitchOptions.start = t_m: PitchForcing.t_m_s, the time of maximum crush, is not set"},
    {"a_number_that_the_initial_motion_depends_on",
     [](Input& in) {
       in.options.free = {"rear_damping", "pitch_inertia"};
       in.simulation.residual_energy_j = 100.0;
     },
     "IdentifyPitchOptions.free names pitch_inertia_kgm2, which sets the motion that PitchOptions.residual_energy_j "
     "starts with: keep it as it is, or give the initial rates instead"},
    {"force_not_increasing", [](Input& in) { in.forcing.vertical_force_n.time_s[2] = 0.0; },
     "PitchForcing.vertical_force_n"},
};
INSTANTIATE_TEST_SUITE_P(Inputs, PitchRefused, testing::ValuesIn(kBadInputs),
                         [](const auto& bad) { return std::string(bad.param.name); });

/// The printed equations gain energy with a rear axle near the centre of gravity: doubles overflow.
TEST(PitchRefusals, AMotionBeyondAllBoundsIsAnOutcome) {
  Input input;
  input.model.formulation = PitchFormulation::as_printed;
  input.model.rear_axle_m = 0.5;
  input.simulation.end_time_s = kUnset;
  input.target = {{{100.0, 200.0, 300.0, 400.0}, {1.0, 1.0, 1.0, 1.0}}, {}, {}, {}};
  input.options.free = {"rear_damping"};
  input.options.lower = {1e5};
  input.options.upper = {2e5};
  input.options.starts = 2;
  const PitchIdentification fit =
      identify_pitch(input.model, input.forcing, input.target, input.simulation, input.options);
  EXPECT_EQ(fit.outcome, IdentifyOutcome::every_start_failed);
  EXPECT_THAT(fit.message, testing::StartsWith("all 2 starts failed: the motion grows beyond all bounds before the "
                                               "last sample, at 400 s: check units, bounds and formulation"));
  EXPECT_TRUE(fit.parameters.empty());
  EXPECT_TRUE(std::isnan(fit.error.total));
}

}  // namespace
}  // namespace crashsim
