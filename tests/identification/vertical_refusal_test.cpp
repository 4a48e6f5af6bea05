/// What the identification of the vertical force's law says about input it cannot use.

#include <functional>
#include <ostream>

#include <gmock/gmock.h>

#include "support/vertical_fit_cases.hpp"

namespace crashsim {
namespace {

/// Input that is good, to be spoiled.
struct Input {
  VerticalForceTarget target = test::measured_by({0.05, 0.6, 0.0, 0.3});
  VerticalForceLaw guess;
  IdentifyVerticalOptions options;
};

struct BadInput {
  const char* name;
  std::function<void(Input&)> spoil;
  const char* message;
};
void PrintTo(const BadInput& bad, std::ostream* out) { *out << bad.name; }

class VerticalRefused : public testing::TestWithParam<BadInput> {};

TEST_P(VerticalRefused, SaysWhy) {
  Input input;
  input.options.starts = 1;
  GetParam().spoil(input);
  try {
    identify_vertical(input.target, input.guess, input.options);
    FAIL() << "accepted";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), testing::StartsWith(GetParam().message));
  }
}

void turn(TimeSeries& series) {
  for (double& value : series.values) value = -value;
}

const BadInput kBadInputs[] = {
    {"unknown_name", [](Input& in) { in.options.free = {"angel"}; },
     "IdentifyVerticalOptions.free: unknown name 'angel', did you mean 'angle'? (known: angle, "},
    {"named_twice",
     [](Input& in) {
       in.options.free = {"friction", "friction"};
     },
     "IdentifyVerticalOptions.free names friction twice"},
    {"nothing_free", [](Input& in) { in.options.free.clear(); },
     "IdentifyVerticalOptions.free names no number: give at least one to identify"},
    {"bound_not_allowed",
     [](Input& in) {
       in.options.lower = {kUnset, kUnset, -0.1};
     },
     "IdentifyVerticalOptions.lower[2] (friction) = -0.1: must be >= 0 and <= 10"},
    {"too_few_bounds", [](Input& in) { in.options.upper = {1.0}; },
     "IdentifyVerticalOptions.upper has 1 numbers but there are 3 in free: give one for each"},
    {"no_starts", [](Input& in) { in.options.starts = 0; }, "IdentifyVerticalOptions.starts = 0: must be >= 1"},
    {"bad_law", [](Input& in) { in.guess.angle_start_m = -1.0; },
     "VerticalForceLaw.angle_start_m = -1 m: must be >= 0"},
    {"window_inverted",
     [](Input& in) {
       in.options.from_s = 0.05;
       in.options.to_s = 0.02;
     },
     "IdentifyVerticalOptions.from_s = 0.05 s: must be before to_s = 0.02 s"},
    {"no_common_times", [](Input& in) { in.options.from_s = 0.2; },
     "VerticalForceTarget: no sample of vertical_force_n from 0.2 s to 0.1146 s, where all three are known"},
    {"a_series_is_missing", [](Input& in) { in.target.crush_m = {}; }, "VerticalForceTarget.crush_m: "},
    {"not_finite", [](Input& in) { in.target.longitudinal_force_n.values[4] = kUnset; },
     "VerticalForceTarget.longitudinal_force_n: sample 5 at -0.001 s is nan: must be finite"},
    {"no_vertical_force",
     [](Input& in) { in.target.vertical_force_n.values.assign(in.target.vertical_force_n.values.size(), 0.0); },
     "VerticalForceTarget.vertical_force_n is nowhere other than 0 where it is compared: there is no law to identify"},
    {"the_force_has_the_wrong_sign", [](Input& in) { turn(in.target.longitudinal_force_n); },
     "VerticalForceTarget.longitudinal_force_n is nowhere > 0 where it is compared: it is positive while it stops"},
    {"the_crush_has_the_wrong_sign", [](Input& in) { turn(in.target.crush_m); },
     "VerticalForceTarget.crush_m is nowhere > 0 where it is compared: it is positive while the front shortens"},
    {"few_samples", [](Input& in) { in.options.to_s = 0.0013; },
     "VerticalForceTarget: 3 samples cannot determine 3 parameters: free fewer or give more"},
};
INSTANTIATE_TEST_SUITE_P(Inputs, VerticalRefused, testing::ValuesIn(kBadInputs),
                         [](const auto& bad) { return std::string(bad.param.name); });

TEST(VerticalRefusals, AnAngleBeyondAllBoundsIsAnOutcome) {
  Input input;
  input.options.free = {"angle"};
  input.options.starts = 2;
  input.guess.angle_rate_rad_per_m = 20.0;
  const VerticalIdentification fit = identify_vertical(input.target, input.guess, input.options);
  EXPECT_EQ(fit.outcome, IdentifyOutcome::every_start_failed);
  EXPECT_THAT(fit.message, testing::StartsWith("all 2 starts failed: the angle is beyond 1.5 rad without friction"));
}

}  // namespace
}  // namespace crashsim
