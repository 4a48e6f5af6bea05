/// NHTSA test 10146: what a correction makes of its accelerometers 93 and 94 and the wall, whose impulse over 150 ms is
/// 32 807 N s against 31 049 N s of the vehicle.

#include <crashsim/sensor_correction.hpp>

#include <cmath>
#include <optional>
#include <string>

#include <gmock/gmock.h>

#include "support/shared_data.hpp"

namespace crashsim {
namespace {

using testing::IsNan;

constexpr double kMass_kg = 1719.0, kSpeed_mps = 57.09 / 3.6;

class CamrySensors : public testing::Test {
 protected:
  void SetUp() override {
    const auto header = test::shared_data("nhtsa-10146/v10146.EV5");
    const auto rows = test::shared_data("nhtsa-10146/barrier_rows_cfc60.csv");
    if (!header || !rows) GTEST_SKIP() << test::kNoSharedData;
    path_ = header->string();
    wall_ = read_wall(rows->string());
  }
  [[nodiscard]] SensorCorrection correct(const SensorCorrectionOptions& options, bool with_wall = true) const {
    return read_sensor_correction(path_, {}, options, with_wall ? &wall_ : nullptr);
  }
  std::string path_;
  LoadCellWall wall_;
};

TEST_F(CamrySensors, ShareTheDifferenceOfImpulseWithTheWall) {
  constexpr double kImpulse_mps = 1e-3, kDigits = 5e-4, kCrush_m = 5e-4;  // regression
  const SensorCorrection found = correct({});
  ASSERT_TRUE(found.usable()) << found.message;
  ASSERT_EQ(found.conditions.size(), 1u);
  const CorrectionCondition& impulse = found.conditions[0];
  EXPECT_NEAR(impulse.known_mps, kSpeed_mps - 32807.1 / kMass_kg, kImpulse_mps);
  EXPECT_NEAR(impulse.before_mps, kSpeed_mps - 31049.0 / kMass_kg, 5.0 * kImpulse_mps);
  EXPECT_NEAR(impulse.after_mps, -2.593, kImpulse_mps);
  EXPECT_NEAR(found.wall_gain, 1.0246, kDigits);
  EXPECT_NEAR(found.channels[0].gain, 0.9896, kDigits);
  EXPECT_NEAR(found.channels[1].gain, 0.9851, kDigits);
  const Pulse pulse = make_pulse(found.corrected);
  EXPECT_NEAR(pulse.max_crush_m, 0.7377, kCrush_m);
}

TEST_F(CamrySensors, AgainstAnExactWallAreThreePercentLow) {
  SensorCorrectionOptions options;
  options.wall_gain_sd = 0.0;
  const SensorCorrection found = correct(options);
  ASSERT_TRUE(found.usable());
  EXPECT_THAT(found.wall_gain, IsNan());
  for (const ChannelCorrection& channel : found.channels) EXPECT_LT(channel.gain, 0.985);
  EXPECT_THAT(found.warnings, testing::Contains(testing::HasSubstr("by the wall's impulse: known as -3.227 m/s")));
}

TEST_F(CamrySensors, AgreeWithEachOther) {
  const SensorCorrection found = correct({}, false);
  ASSERT_TRUE(found.usable());
  for (const ChannelCorrection& channel : found.channels) {
    EXPECT_LT(std::abs(channel.gain - 1.0), channel.gain_error);
    EXPECT_LT(std::abs(channel.bias_mps2), channel.bias_error_mps2);
    EXPECT_LT(std::abs(channel.time_shift_s), channel.time_shift_error_s);
  }
  EXPECT_THAT(found.by_prior, testing::Contains(testing::HasSubstr("gain common to all channels")));
}

}  // namespace
}  // namespace crashsim
