#include <crashsim/metrics.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/units.hpp>

namespace crashsim {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kRounding = 1e-12;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(OccupantLoad, IsUnsetWhenTheVehicleKeepsItsSpeed) {
  const std::vector<double> time{0.0, 0.05, 0.1}, velocity{10.0, 10.0, 10.0}, displacement{0.0, 0.5, 1.0};
  const Olc olc = occupant_load_criterion(time, velocity, displacement);
  EXPECT_TRUE(std::isnan(olc.olc_g));
  EXPECT_TRUE(std::isnan(olc.t1_s));
  EXPECT_TRUE(std::isnan(olc.t2_s));
}

TEST(OccupantLoad, OfASuddenStopIsTheSameFromAnyClockAndOrigin) {
  // v0 t1 = 0.065, v0 (t2 - t1) / 2 = 0.235: OLC = v0^2 / 0.47.
  const std::vector<double> time{2.0, 2.0 + 1e-9, 2.1}, velocity{10.0, 0.0, 0.0}, displacement{5.0, 5.0, 5.0};
  constexpr double kStopTravel = 1e-6;
  const Olc olc = occupant_load_criterion(time, velocity, displacement);
  EXPECT_NEAR(olc.olc_g * 9.81 * 0.47 / 100.0, 1.0, kStopTravel);
  EXPECT_NEAR(olc.t1_s - 2.0, 0.0065, kStopTravel);
  EXPECT_NEAR(olc.t2_s - 2.0, 0.0535, kStopTravel);
}

TEST(OccupantLoad, RefusesBadSeries) {
  const std::vector<double> two{0.0, 1.0}, three{0.0, 1.0, 2.0};
  EXPECT_THAT([&] { occupant_load_criterion(two, three, two); },
              ThrowsMessage<InvalidInput>(HasSubstr("velocity: 2 times but 3 values")));
  EXPECT_THAT([&] { occupant_load_criterion(two, two, three); },
              ThrowsMessage<InvalidInput>(HasSubstr("displacement: 2 times but 3 values")));
}

TEST(SlidingMeanPeak, LooksAtWindowsThatBeginAndThatEndAtSamples) {
  // Deceleration 1, 5, 1 over thirds of a second: the best window of 0.5 s holds the whole middle third.
  const std::vector<double> time{0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0}, velocity{7.0 / 3.0, 2.0, 1.0 / 3.0, 0.0};
  EXPECT_NEAR(sliding_mean_peak(time, velocity, 0.5), (5.0 / 3.0 + 0.5 - 1.0 / 3.0) / 0.5, kRounding);
  EXPECT_NEAR(sliding_mean_peak(time, velocity, 1.0), 7.0 / 3.0, kRounding);
}

TEST(SlidingMeanPeak, IsUnsetWhenTheWindowIsLongerThanTheTrace) {
  EXPECT_TRUE(std::isnan(sliding_mean_peak(std::vector{0.0, 0.02}, std::vector{5.0, 4.0}, 0.025)));
}

TEST(SlidingMeanPeak, RefusesAWindowOfNoLength) {
  EXPECT_THAT(
      [] {
        sliding_mean_peak(std::vector{0.0, 1.0}, std::vector{5.0, 4.0}, 0.0);
      },
      ThrowsMessage<InvalidInput>(HasSubstr("window_s = 0 s: must be > 0")));
}

TEST(PulseIndex, OfNoDecelerationIsZero) {
  const std::vector<double> time{0.0, 0.1, 0.2}, accel{0.0, 0.0, 0.0};
  EXPECT_EQ(vehicle_pulse_index({time, accel, {}, {}}), 0.0);
}

TEST(PulseIndex, OfAVehiclePushedForwardIsZero) {
  const std::vector<double> time{0.0, 0.1, 0.2}, accel{0.0, 50.0, 0.0};
  EXPECT_EQ(vehicle_pulse_index({time, accel, {}, {}}), 0.0);
}

TEST(SeverityIndex, IsUnsetBelowFiftyMilliseconds) {
  const std::vector<double> short_pulse(100, -50.0);
  EXPECT_TRUE(std::isnan(acceleration_severity_index(short_pulse, {}, {}, 1e-4)));
}

TEST(SeverityIndex, RefusesBadChannels) {
  const std::vector<double> x(600, -50.0), y(599, 1.0);
  std::vector<double> holed(x);
  holed[5] = kNan;
  EXPECT_THAT([&] { acceleration_severity_index(x, y, {}, 1e-4); },
              ThrowsMessage<InvalidInput>(HasSubstr("ay has 599 samples but ax has 600")));
  EXPECT_THAT([&] { acceleration_severity_index(x, {}, holed, 1e-4); },
              ThrowsMessage<InvalidInput>(HasSubstr("az: sample 6")));
  EXPECT_THAT([&] { acceleration_severity_index(x, {}, {}, 0.0); },
              ThrowsMessage<InvalidInput>(HasSubstr("dt_s = 0 s: must be > 0")));
  EXPECT_THAT([&] { acceleration_severity_index(x, {}, {}, 1e-3, AsiMethod::butterworth_2010); },
              ThrowsMessage<InvalidInput>(HasSubstr("too low for CFC180")));
}

}  // namespace
}  // namespace crashsim
