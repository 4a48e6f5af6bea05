#include <crashsim/plausibility.hpp>

#include <cmath>
#include <functional>
#include <ostream>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/pulse.hpp>
#include <crashsim/signal.hpp>

namespace crashsim {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsNan;
using testing::Not;
using testing::SizeIs;
using testing::ThrowsMessage;

constexpr double kRounding = 1e-12;       // rounding: relative
constexpr double kTrapezoids = 1e-6;      // solver: of smooth curves in steps of 0.1 ms
constexpr double kBetweenSamples = 2e-5;  // solver: t_m by an acceleration that does not fit the velocity
constexpr double kSpeed_mps = 15.0, kStep_s = 1e-4;

Pulse half_sine(double peak_mps2 = 260.0) {
  std::vector<double> time = uniform_times(0.0, kStep_s, 1201), accel;
  for (const double t : time) accel.push_back(t < 0.1 ? -peak_mps2 * std::sin(M_PI * t / 0.1) : 0.0);
  return make_pulse(time, accel, kSpeed_mps);
}

MotionBalance balance_of(const Pulse& p) {
  return motion_balance(p.time_s, p.accel_mps2, p.velocity_mps, p.displacement_m);
}

TEST(Fleet, IsQuietBetweenItsPercentilesAndWhereNothingIsKnown) {
  for (const FleetRange& range : kFleetRanges) EXPECT_LT(range.percentile_5, range.median);
  EXPECT_THAT(check_fleet(0.653, 39.6), IsEmpty());
  EXPECT_THAT(check_fleet(0.442, 56.3), IsEmpty());
  EXPECT_THAT(check_fleet(kUnset, kUnset), IsEmpty());
}

TEST(Fleet, TellsWhatLiesOutside) {
  EXPECT_THAT(check_fleet(0.823, 20.0),
              ElementsAre("maximum crush 0.823 m is outside 0.442 to 0.796 m, where 9 of 10 frontal rigid-wall tests "
                          "lie: check channel, units and speed",
                          "peak deceleration 20 g is outside 25.5 to 56.3 g, where 9 of 10 frontal rigid-wall tests "
                          "lie: check channel, units and speed"));
}

TEST(MotionBalance, OfAPulseHolds) {
  const MotionBalance balance = balance_of(half_sine());
  EXPECT_LT(balance.velocity_deviation, kRounding);
  EXPECT_LT(balance.displacement_deviation, kRounding);
  EXPECT_LT(balance.energy_deviation, kTrapezoids);
  EXPECT_NEAR(balance.work_ratio, 1.0, kTrapezoids);
  EXPECT_NEAR(balance.centroid_ratio, 1.0, kTrapezoids);
  EXPECT_THAT(check_balance(balance), IsEmpty());
}

TEST(MotionBalance, WithoutMaximumCrushLeavesItsRatiosUnset) {
  const MotionBalance balance = balance_of(half_sine(100.0));
  EXPECT_THAT(balance.work_ratio, IsNan());
  EXPECT_THAT(balance.centroid_ratio, IsNan());
  EXPECT_THAT(check_balance(balance), IsEmpty());
}

TEST(MotionBalance, FindsAnAccelerationOfAnotherGain) {
  Pulse pulse = half_sine();
  for (double& a : pulse.accel_mps2) a *= 1.1;
  const MotionBalance balance = balance_of(pulse);
  const double change = (kSpeed_mps - pulse.velocity_mps.back()) / kSpeed_mps;
  EXPECT_NEAR(balance.velocity_deviation, 0.1 * change, kTrapezoids);
  EXPECT_NEAR(balance.work_ratio, 1.1, kTrapezoids);
  EXPECT_NEAR(balance.centroid_ratio, 1.0, kBetweenSamples);
  EXPECT_LT(balance.displacement_deviation, kRounding);
  EXPECT_THAT(check_balance(balance),
              testing::Contains(AllOf(HasSubstr("velocity is not the integral of acceleration: they differ by 11"),
                                      HasSubstr("% of the impact speed, most at 0.1 s"))));
}

TEST(MotionBalance, FindsADisplacementThatIsCutOff) {
  Pulse pulse = half_sine();
  const double longest = 0.9 * pulse.max_crush_m;
  for (double& x : pulse.displacement_m) x = std::min(x, longest);
  const MotionBalance balance = balance_of(pulse);
  EXPECT_NEAR(balance.displacement_deviation, (pulse.max_crush_m - longest) / longest, kTrapezoids * 1e3);
  EXPECT_NEAR(balance.displacement_deviation_s, pulse.t_m_s, kStep_s);
  EXPECT_LT(balance.velocity_deviation, kRounding);
  EXPECT_LT(balance.work_ratio, 0.995);
}

TEST(MotionBalance, FindsAnAccelerationThatIsLate) {
  Pulse pulse = half_sine();
  const std::vector<double> accel = pulse.accel_mps2;
  constexpr std::size_t kLate = 30;  // 3 ms
  for (std::size_t i = accel.size(); i-- > 0;) pulse.accel_mps2[i] = i < kLate ? 0.0 : accel[i - kLate];
  const MotionBalance balance = balance_of(pulse);
  EXPECT_GT(balance.centroid_ratio, 1.02);
  EXPECT_THAT(check_balance(balance),
              testing::Contains(HasSubstr("the time centroid of the deceleration is not C/v0")));
}

TEST(MotionBalance, LeavesOutWhatIsBeforeImpact) {
  const Pulse pulse = half_sine();
  Pulse longer = pulse;
  for (std::vector<double>* channel :
       {&longer.time_s, &longer.accel_mps2, &longer.velocity_mps, &longer.displacement_m})
    channel->insert(channel->begin(), channel == &longer.time_s ? -1.0 : 77.0);
  for (const auto& number : kMotionBalanceNumbers)
    EXPECT_EQ(balance_of(longer).*number.member, balance_of(pulse).*number.member) << number.name;
}

TEST(MotionBalance, RefusesWhatIsNoMotion) {
  Pulse pulse = half_sine();
  pulse.velocity_mps.front() = -1.0;
  EXPECT_THAT([&] { static_cast<void>(balance_of(pulse)); },
              ThrowsMessage<InvalidInput>(HasSubstr("velocity_mps[0] = -1 m/s: must be > 0, towards the barrier")));
  pulse = half_sine();
  pulse.accel_mps2.pop_back();
  EXPECT_THAT([&] { static_cast<void>(balance_of(pulse)); },
              ThrowsMessage<InvalidInput>(HasSubstr("accel_mps2: 1201 times but 1200 values")));
  pulse = half_sine();
  pulse.displacement_m[5] = kUnset;
  EXPECT_THAT([&] { static_cast<void>(balance_of(pulse)); },
              ThrowsMessage<InvalidInput>(HasSubstr("displacement_m: sample 6")));
}

}  // namespace
}  // namespace crashsim
