/// crashsim correct, and what is made of its result.

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "support/workspace.hpp"

namespace crashsim {
namespace {

using nlohmann::json;
using test::Finished;
using test::kDone;
using test::kUserCanFix;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class CorrectCommand : public testing::Test {
 protected:
  [[nodiscard]] Finished correct(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"correct", "data/sensors/channels.csv", "--channel", "*"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return workspace.run(arguments);
  }
  test::Workspace workspace;
};

TEST_F(CorrectCommand, FindsTheKnownErrorsOfTheExample) {
  constexpr double kMost = 2.5;  // standard errors
  const Finished finished =
      correct({"--rebound", "-1.4m/s", "--velocity-at", "80.84ms", "--velocity", "0", "--json", "--quiet"});
  ASSERT_EQ(finished.exit_code, kDone) << finished.err;
  const json found = json::parse(finished.out);
  EXPECT_EQ(found["outcome"], "completed");
  const std::vector<std::vector<double>> truth = {{1.02, 1.5, 2e-4}, {0.99, -2.0, 0.0}, {1.0, 0.0, -2e-4}};
  ASSERT_THAT(found["channels"], SizeIs(truth.size()));
  for (std::size_t c = 0; c < truth.size(); ++c) {
    const json& channel = found["channels"][c];
    const auto off = [&](const char* value, const char* error, double known) {
      return std::abs(channel[value].get<double>() - known) / channel[error].get<double>();
    };
    EXPECT_LT(off("gain", "gain_error", truth[c][0]), kMost);
    EXPECT_LT(off("bias_mps2", "bias_error_mps2", truth[c][1]), kMost);
    EXPECT_LT(off("time_shift_s", "time_shift_error_s", truth[c][2]), kMost);
    EXPECT_LT(channel["rms_after_mps2"].get<double>(), 0.5 * channel["rms_before_mps2"].get<double>());
  }
  ASSERT_THAT(found["conditions"], SizeIs(2));
  EXPECT_EQ(found["conditions"][1]["name"], "rebound velocity");
}

TEST_F(CorrectCommand, WhatItWritesMakesAPulseWithoutFurtherWords) {
  ASSERT_EQ(correct({"--rebound", "-1.4m/s", "-o", "corrected.csv"}).exit_code, kDone);
  EXPECT_THAT(
      workspace.text_of("corrected.csv"),
      AllOf(HasSubstr("# compartment_x = accel_mps2\n"), HasSubstr("# corrected = 2 left_accel_mps2: bias_mps2 "),
            HasSubstr("\ntime_s,accel_mps2,accel_2_mps2,accel_3_mps2,accel_4_mps2\n")));
  const Finished pulse = workspace.run({"pulse", "corrected.csv", "-o", "pulse.csv", "--json"});
  ASSERT_EQ(pulse.exit_code, kDone) << pulse.err;
  constexpr double kAsCorrected_mps = 0.02;
  const json numbers = json::parse(pulse.out);
  EXPECT_NEAR(numbers["rebound_velocity_mps"].get<double>(), -1.4, kAsCorrected_mps);
  EXPECT_EQ(numbers["mass_kg"], 1500.0);
  EXPECT_EQ(workspace.run({"pulse", "corrected.csv", "--channel", "accel_3_mps2", "--json"}).exit_code, kDone);
  EXPECT_EQ(workspace.run({"identify", "pulse.csv", "--starts", "2", "-o", "model.json"}).exit_code, kDone);
}

TEST_F(CorrectCommand, ItsRecordMakesTheSameFileAgain) {
  workspace.file("wall.csv", [] {
    std::string text = "# mass_kg = 1500\ntime_s,row_a_n\n";
    for (int i = -40; i <= 320; ++i) text += fmt::format("{},{}\n", i * 5e-4, i > 0 && i < 200 ? 2.4e5 : 0.0);
    return text;
  }());
  ASSERT_EQ(correct({"--wall", "wall.csv", "-o", "corrected.csv"}).exit_code, kDone);
  const Finished again = workspace.run({"run", "corrected.csv", "-o", "again.csv"});
  ASSERT_EQ(again.exit_code, kDone) << again.err;
  EXPECT_EQ(workspace.text_of("again.csv"), workspace.text_of("corrected.csv"));
}

TEST_F(CorrectCommand, TakesTheImpulseOfAWall) {
  // 15 m/s and 1.4 m/s back of 1500 kg are 24.6 kN s; this wall shows 2 % more.
  workspace.file("wall.csv", [] {
    std::string text = "time_s,row_a_n\n";
    for (int i = -40; i <= 320; ++i) {
      const double s = i * 5e-4 / 0.11;
      const double force =
          s > 0.0 && s < 1.0 ? 1.02 * 24.6e3 / 0.11 * (1.0 - std::cos(2.0 * std::numbers::pi * s)) : 0.0;
      text += fmt::format("{},{}\n", i * 5e-4, force);
    }
    return text;
  }());
  const Finished finished = correct({"--wall", "wall.csv", "--json", "--quiet"});
  ASSERT_EQ(finished.exit_code, kDone) << finished.err;
  const json found = json::parse(finished.out);
  ASSERT_THAT(found["conditions"], SizeIs(1));
  EXPECT_EQ(found["conditions"][0]["name"], "velocity at 0.15 s by the wall's impulse");
  EXPECT_NEAR(found["conditions"][0]["known_mps"].get<double>(), 15.0 - 1.02 * 16.4, 1e-3);
  EXPECT_GT(found["wall_gain"].get<double>(), 1.0);
  EXPECT_LT(found["wall_gain"].get<double>(), 1.02);
  EXPECT_EQ(correct({"--wall", "none.csv", "--json"}).exit_code, kUserCanFix);
}

TEST_F(CorrectCommand, ReportsChannelsConditionsAndWhatThePriorsHold) {
  const Finished finished = correct({"--rebound", "-1.4m/s", "--json"});
  EXPECT_THAT(finished.err,
              AllOf(HasSubstr("correction of data/sensors/channels.csv: completed"), HasSubstr("bias m/s^2"),
                    HasSubstr("2 left_accel_mps2"), HasSubstr("rebound velocity: known -1.4 +- 0.1 m/s, channels"),
                    HasSubstr("by the prior: time shift common to all channels")));
}

TEST_F(CorrectCommand, RefusesWhatItCannotUse) {
  const Finished speed = correct({"--speed", "-3", "--json"});
  EXPECT_EQ(speed.exit_code, kUserCanFix);
  const Finished alone = workspace.run({"correct", "data/sensors/channels.csv", "--channel", "2", "--json"});
  EXPECT_EQ(alone.exit_code, kUserCanFix);
  EXPECT_THAT(alone.err, HasSubstr("one channel and nothing it could be compared with"));
  const Finished velocity = workspace.run({"correct", "data/fe-car/C56.csv", "--channel", "*REAR_VX", "--json"});
  EXPECT_THAT(velocity.err, HasSubstr("measures speed: corrections are for accelerometers"));
}

}  // namespace
}  // namespace crashsim
