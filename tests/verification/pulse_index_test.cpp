/// Occupant load criterion, vehicle pulse index, sliding means and acceleration severity index against closed forms.

#include <crashsim/metrics.hpp>

#include <cmath>
#include <functional>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/signal.hpp>
#include <crashsim/units.hpp>

namespace crashsim {
namespace {

using std::numbers::pi;

constexpr double kImpactSpeed = 56.0 / 3.6;
constexpr double kG = kStandardGravity;
constexpr double kRounding = 1e-12;

/// Deceleration pulse of duration T and height A, with its first and second integral divided by A T and A T^2, over
/// t / T in 0..1.
struct Shape {
  std::string name;
  std::function<double(double)> accel, speed, travel;
};

const Shape kConstant{"constant", [](double) { return 1.0; }, [](double s) { return s; },
                      [](double s) { return s * s / 2.0; }};
const Shape kHalfSine{"half_sine", [](double s) { return std::sin(pi * s); },
                      [](double s) { return (1.0 - std::cos(pi * s)) / pi; },
                      [](double s) { return (s - std::sin(pi * s) / pi) / pi; }};
const Shape kTriangle{"triangle", [](double s) { return s < 0.5 ? 2.0 * s : 2.0 - 2.0 * s; },
                      [](double s) { return s < 0.5 ? s * s : 0.5 - (1.0 - s) * (1.0 - s); },
                      [](double s) {
                        const double rest = 1.0 - s;
                        return s < 0.5 ? s * s * s / 3.0 : 0.25 - rest / 2.0 + rest * rest * rest / 3.0;
                      }};

struct SampledMotion {
  std::vector<double> time, accel, velocity, displacement;
  [[nodiscard]] Motion motion() const { return {time, accel, velocity, displacement}; }
};

/// Exact samples of a vehicle that decelerates from v0 by a pulse and then keeps its velocity.
SampledMotion sample(const Shape& shape, double v0, double height, double duration, double dt, double end) {
  SampledMotion m;
  m.time = uniform_times(0.0, dt, static_cast<std::size_t>(std::lround(end / dt)) + 1);
  const double late_speed = v0 - height * duration * shape.speed(1.0);
  for (const double t : m.time) {
    const double s = std::min(t / duration, 1.0);
    const double late = std::max(t - duration, 0.0);
    m.accel.push_back(t < duration ? -height * shape.accel(s) : 0.0);
    m.velocity.push_back(v0 - height * duration * shape.speed(s));
    m.displacement.push_back(v0 * std::min(t, duration) - height * duration * duration * shape.travel(s) +
                             late_speed * late);
  }
  return m;
}

struct OlcCase {
  std::string name;
  Shape shape;
  double height_g, duration_s, olc_g, t1_s, t2_s;
};
void PrintTo(const OlcCase& c, std::ostream* out) { *out << c.name; }

const double kStop = 0.1;
const OlcCase kOlcCases[] = {
    {"constant_20g", kConstant, 20.0, kImpactSpeed / (20.0 * kG), 23.883552634, 0.025745204183, 0.092137485398},
    {"half_sine_full_stop", kHalfSine, kImpactSpeed / kStop* pi / 2.0 / kG, kStop, 25.281568292, 0.037925247946,
     0.100646180626},
    {"triangle_full_stop", kTriangle, kImpactSpeed / kStop * 2.0 / kG, kStop, 26.818877391, 0.039722785624,
     0.098832311538},
    {"half_sine_20g", kHalfSine, 20.0, kStop, 19.252119041, 0.040970272462, 0.107082721989},
    {"triangle_20g", kTriangle, 20.0, kStop, 14.587103592, 0.046326338912, 0.114856633867},
};

class OccupantLoadCriterion : public testing::TestWithParam<OlcCase> {};

TEST_P(OccupantLoadCriterion, HasThePublishedValue) {
  constexpr double kPrintedDigits = 1e-9;
  const OlcCase& c = GetParam();
  const SampledMotion m = sample(c.shape, kImpactSpeed, c.height_g * kG, c.duration_s, 1e-4, 0.15);
  const Olc olc = occupant_load_criterion(m.time, m.velocity, m.displacement);
  EXPECT_NEAR(olc.olc_g / c.olc_g, 1.0, kPrintedDigits);
  EXPECT_NEAR(olc.t1_s / c.t1_s, 1.0, kPrintedDigits);
  EXPECT_NEAR(olc.t2_s / c.t2_s, 1.0, kPrintedDigits);
}

TEST_P(OccupantLoadCriterion, NeedsNoSamplesAfterThePulse) {
  constexpr double kJumpWithinAStep = 2e-6;
  const OlcCase& c = GetParam();
  const double end = std::ceil(c.duration_s / 1e-4) * 1e-4;
  const SampledMotion m = sample(c.shape, kImpactSpeed, c.height_g * kG, c.duration_s, 1e-4, end);
  const Olc olc = occupant_load_criterion(m.time, m.velocity, m.displacement);
  EXPECT_NEAR(olc.olc_g / c.olc_g, 1.0, kJumpWithinAStep);
}

INSTANTIATE_TEST_SUITE_P(Vectors, OccupantLoadCriterion, testing::ValuesIn(kOlcCases));

TEST(VehiclePulseIndex, OfAConstantDecelerationIsTheClosedForm) {
  // Free over the slack, then A + sqrt(A^2 + 2 A k d): the belt's balance plus the amplitude about it.
  constexpr double kA = 20.0 * kG;
  const SampledMotion m = sample(kConstant, 30.0, kA, 30.0 / kA, 1e-3, 0.15);
  EXPECT_NEAR(vehicle_pulse_index(m.motion()) / (kA + std::sqrt(kA * kA + 2.0 * kA * 2500.0 * 0.03)), 1.0, kRounding);
}

TEST(VehiclePulseIndex, OfASuddenStopIsSpeedTimesFrequency) {
  constexpr double kStopTime = 1e-9;
  const std::vector<double> time{0.0, kStopTime, 2.0 * kStopTime, 1e-3};
  const std::vector<double> accel{0.0, -kImpactSpeed / kStopTime, 0.0, 0.0};
  const Motion motion{time, accel, {}, {}};
  EXPECT_NEAR(vehicle_pulse_index(motion) / (50.0 * kImpactSpeed), 1.0, kRounding);
}

TEST(VehiclePulseIndex, DoesNotDependOnHowThePulseIsCut) {
  const SampledMotion fine = sample(kTriangle, kImpactSpeed, 25.0 * kG, kStop, 1e-5, 0.2);
  const std::vector<double> time{0.0, kStop / 2.0, kStop};
  const std::vector<double> accel{0.0, -25.0 * kG, 0.0};
  const Motion coarse{time, accel, {}, {}};
  EXPECT_NEAR(vehicle_pulse_index(coarse) / vehicle_pulse_index(fine.motion()), 1.0, kRounding);
}

/// The belt model by 4th-order Runge-Kutta in small steps.
double runge_kutta_pulse_index(const std::function<double(double)>& vehicle_accel, double end) {
  constexpr double kStep = 2e-6;
  double gap = 0.0, speed = 0.0, largest = 0.0;
  const auto belt = [](double x) { return x > 0.03 ? 2500.0 * (x - 0.03) : 0.0; };
  for (double t = 0.0; t < end; t += kStep) {
    const auto rate = [&](double x, double at) { return -belt(x) - vehicle_accel(at); };
    const double k1 = rate(gap, t), middle = t + kStep / 2.0;
    const double k2 = rate(gap + speed * kStep / 2.0, middle);
    const double k3 = rate(gap + (speed + k1 * kStep / 2.0) * kStep / 2.0, middle);
    const double k4 = rate(gap + (speed + k2 * kStep / 2.0) * kStep, t + kStep);
    gap += kStep * (speed + kStep * (k1 + k2 + k3) / 6.0);
    speed += kStep * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0;
    largest = std::max(largest, belt(gap));
  }
  return largest;
}

TEST(VehiclePulseIndex, FollowsContactLostAndFoundAgain) {
  constexpr double kRungeKutta = 1e-6;
  constexpr double kLinearSamples = 1e-6;
  // Two short blows with a push forward between them, so that the belt slackens in between.
  const auto accel = [](double t) {
    const auto blow = [t](double start, double length, double height) {
      const double s = (t - start) / length;
      return s > 0.0 && s < 1.0 ? height * std::sin(pi * s) * std::sin(pi * s) : 0.0;
    };
    return blow(0.0, 0.04, -300.0) + blow(0.05, 0.03, 250.0) + blow(0.14, 0.05, -700.0);
  };
  const std::vector<double> time = uniform_times(0.0, 2e-5, 15001);
  std::vector<double> samples;
  for (const double t : time) samples.push_back(accel(t));
  const double expected = runge_kutta_pulse_index(accel, 0.3);
  EXPECT_NEAR(vehicle_pulse_index({time, samples, {}, {}}) / expected, 1.0, kRungeKutta + kLinearSamples);
}

TEST(SlidingMean, OfAHalfSineIsTheClosedForm) {
  constexpr double kLinearSamples = 1e-5;
  constexpr double kHeight = 200.0;
  const SampledMotion m = sample(kHalfSine, kImpactSpeed, kHeight, kStop, 1e-4, 0.15);
  for (const double w : {0.010, 0.025, 0.038, 0.050}) {
    const double half_angle = pi * w / kStop / 2.0;
    EXPECT_NEAR(sliding_mean_peak(m.time, m.velocity, w) / (kHeight * std::sin(half_angle) / half_angle), 1.0,
                kLinearSamples);
  }
}

TEST(AccelerationSeverityIndex, MovingMeansOfThreeAxes) {
  constexpr double kTrapezoids = 4e-6;
  const SampledMotion m = sample(kHalfSine, kImpactSpeed, 12.0 * kG, kStop, 1e-4, 0.15);
  std::vector<double> y(m.accel), z(m.accel);
  for (double& value : y) value *= 9.0 / 12.0;
  for (double& value : z) value *= 10.0 / 12.0;
  const double half_angle = pi * 0.050 / kStop / 2.0;
  const double one = std::sin(half_angle) / half_angle;
  EXPECT_NEAR(acceleration_severity_index(m.accel, {}, {}, 1e-4), one, kTrapezoids);
  EXPECT_NEAR(acceleration_severity_index(m.accel, y, z, 1e-4), std::sqrt(3.0) * one, kTrapezoids);
}

TEST(AccelerationSeverityIndex, ButterworthPassesAConstantAndHalvesThePowerAt13Hz) {
  constexpr double kSpreadOfABurst = 2e-4;
  constexpr double kDuration = 4.0;
  const std::vector<double> time = uniform_times(0.0, 1e-4, 40001);
  std::vector<double> constant(time.size(), 12.0 * kG), burst;
  for (const double t : time)
    burst.push_back(12.0 * kG * std::pow(std::sin(pi * t / kDuration), 2) * std::sin(2.0 * pi * 13.0 * t + 0.3));
  const auto index = [](const std::vector<double>& x) {
    return acceleration_severity_index(x, {}, {}, 1e-4, AsiMethod::butterworth_2010);
  };
  EXPECT_NEAR(index(constant), 1.0, kRounding);
  // Two passes of a Butterworth section designed for 1.25 x 13 Hz: 1 / (1 + 0.8^4), within 0.3 % of -3 dB.
  EXPECT_NEAR(index(burst), 1.0 / (1.0 + std::pow(0.8, 4)), kSpreadOfABurst);
}

}  // namespace
}  // namespace crashsim
