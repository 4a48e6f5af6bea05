#include <crashsim/measured_motion.hpp>

#include <cmath>
#include <functional>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <crashsim/error.hpp>
#include <crashsim/option_values.hpp>

#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

constexpr double kHeave = 0.05, kPitch = 0.02, kRate = 7.0;  // amplitudes [m], [rad]; [rad/s]

double heave(double t) { return kHeave * std::sin(kRate * t); }
double pitch(double t) { return kPitch * std::sin(2.0 * kRate * t); }
double heave_velocity(double t) { return kHeave * kRate * std::cos(kRate * t); }
double pitch_rate(double t) { return 2.0 * kPitch * kRate * std::cos(2.0 * kRate * t); }

/// A rigid body seen by nodes at 0.5 m (two of them, rolling) and -1.2 m ahead of the centre of gravity.
std::string nodes() {
  std::string text = "time_s,L_DZ_mm,R_DZ_mm,B_DZ_mm,L_VZ_mps,R_VZ_mps,B_VZ_mps,F_N\n";
  for (int i = 0; i < 200; ++i) {
    const double t = 1e-3 * i, roll = 0.003 * t;
    const auto at = [&](const auto& z, const auto& theta, double x) { return z(t) - x * theta(t); };
    const double front = at(heave, pitch, 0.5), rear = at(heave, pitch, -1.2);
    const double front_rate = at(heave_velocity, pitch_rate, 0.5), rear_rate = at(heave_velocity, pitch_rate, -1.2);
    text += fmt::format("{:.3f},{:.14g},{:.14g},{:.14g},{:.14g},{:.14g},{:.14g},1\n", t, 1e3 * (front + roll),
                        1e3 * (front - roll), 1e3 * rear, front_rate + 0.003, front_rate - 0.003, rear_rate);
  }
  return text;
}

MotionOptions options_for(const std::string& path) {
  MotionOptions options;
  options.file = path;
  options.front_channels = {"L_*Z_*", "R_*Z_*"};
  options.rear_channels = {"B_*Z_*"};
  options.front_position_m = 2.5;  // from the rear bumper, say
  options.rear_position_m = 0.8;
  options.cg_position_m = 2.0;
  return options;
}

class Motion : public testing::Test {
 protected:
  test::TempDir dir;
  MotionOptions options = options_for(dir.file("nodes.csv", nodes()));
};

TEST_F(Motion, OfNodesIsTheirBodys) {
  const MeasuredMotion motion = read_motion(options);
  ASSERT_EQ(motion.heave_m.values.size(), 200U);
  for (std::size_t i = 0; i < motion.heave_m.values.size(); i += 10) {
    const double t = motion.heave_m.time_s[i];
    EXPECT_NEAR(motion.heave_m.values[i], heave(t), 1e-12);
    EXPECT_NEAR(motion.pitch_rad.values[i], pitch(t), 1e-12);
    EXPECT_NEAR(motion.heave_velocity_mps.values[i], heave_velocity(t), 1e-12);
    EXPECT_NEAR(motion.pitch_rate_radps.values[i], pitch_rate(t), 1e-12);
  }
}

TEST_F(Motion, OfChannelsThatPointDownIsTurned) {
  options.motion_sign = VerticalSign::down;
  const MeasuredMotion motion = read_motion(options);
  EXPECT_NEAR(motion.heave_m.values[50], -heave(0.05), 1e-12);
  EXPECT_NEAR(motion.pitch_rad.values[50], -pitch(0.05), 1e-12);
}

TEST_F(Motion, WhatNoChannelMeasuresIsEmpty) {
  options.front_channels = {"L_DZ_mm"};
  options.rear_channels = {"B_DZ_mm"};
  const MeasuredMotion motion = read_motion(options);
  EXPECT_FALSE(motion.heave_m.empty());
  EXPECT_THAT(motion.heave_velocity_mps.values, IsEmpty());
  EXPECT_THAT(motion.pitch_rate_radps.values, IsEmpty());
}

TEST_F(Motion, IsRefusedWithFileChannelAndRemedy) {
  const auto refused = [&](const std::function<void(MotionOptions&)>& change, const std::string& message) {
    MotionOptions bad = options;
    change(bad);
    EXPECT_THAT([&] { static_cast<void>(read_motion(bad)); }, ThrowsMessage<InvalidInput>(HasSubstr(message)));
  };
  refused([](MotionOptions& o) { o.front_channels.clear(); },
          "nodes.csv: say which vertical channels are at the front");
  refused([](MotionOptions& o) { o.rear_channels = {"F_N"}; },
          "channel 8 F_N: measures force; a displacement or a velocity is needed");
  refused([](MotionOptions& o) { o.rear_channels = {"B_DZ_mm"}; }, "the rear station has no speed channel");
  refused([](MotionOptions& o) { o.rear_position_m = kUnset; }, "MotionOptions.rear_position_m is not set");
  refused([](MotionOptions& o) { o.rear_position_m = 3.0; }, "BodyStation");
  refused([](MotionOptions& o) { o.file += ".gone"; }, "no such file");
}

}  // namespace
}  // namespace crashsim
