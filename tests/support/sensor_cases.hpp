#pragma once
/// Accelerometers of one compartment with errors that are known.

#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <crashsim/sensor_correction.hpp>
#include <crashsim/signal.hpp>

#include "support/random.hpp"

namespace crashsim::test {

/// What is wrong with a channel: measured(t) = gain a(t - shift) + bias.
struct SensorFault {
  double bias_mps2 = 0.0, gain = 1.0, time_shift_s = 0.0;
};

inline constexpr double kSensorSpeed_mps = 15.0, kSensorRebound_mps = -1.4, kSensorDuration_s = 0.11;

/// Smooth pulse from 15 m/s to a rebound of 1.4 m/s.
inline double sensor_accel(double t) {
  const double s = t / kSensorDuration_s;
  if (!(s > 0.0 && s < 1.0)) return 0.0;
  const double mean = (kSensorSpeed_mps - kSensorRebound_mps) / kSensorDuration_s;
  using std::numbers::pi;
  return -mean * (1.0 - std::cos(2.0 * pi * s)) * (1.0 + 0.4 * std::sin(4.0 * pi * s));
}

/// Standard normal number.
inline double normal_number(Random& random) {
  const double radius = std::sqrt(-2.0 * std::log1p(-random.between(0.0, 1.0)));
  return radius * std::cos(random.between(0.0, 2.0 * std::numbers::pi));
}

/// Channels "1", "2", .. from 50 ms before impact on, each with its fault, and white noise of its own.
inline TraceSet sensor_traces(const std::vector<SensorFault>& faults, double noise_mps2 = 0.0, std::uint64_t seed = 1,
                              double step_s = 5e-4, double end_s = 0.2) {
  constexpr double kBegin_s = -0.05;
  TraceSet set;
  set.path = "made-up";
  set.impact_speed_mps = kSensorSpeed_mps;
  set.mass_kg = 1500.0;
  Random random(seed);
  const auto count = static_cast<std::size_t>(std::lround((end_s - kBegin_s) / step_s)) + 1;
  auto times = std::make_shared<std::vector<double>>();
  for (std::size_t i = 0; i < count; ++i)
    times->push_back(static_cast<double>(static_cast<long>(i) + std::lround(kBegin_s / step_s)) * step_s);
  for (std::size_t c = 0; c < faults.size(); ++c) {
    Trace trace;
    trace.id = fmt::format("{}", c + 1);
    trace.name = fmt::format("SENSOR {}", c + 1);
    trace.axis = 'X';
    trace.dimension = Dimension::acceleration;
    trace.time_s = times;
    for (std::size_t i = 0; i < count; ++i)
      trace.values.push_back(faults[c].gain * sensor_accel((*times)[i] - faults[c].time_shift_s) + faults[c].bias_mps2 +
                             noise_mps2 * normal_number(random));
    set.compartment_x.push_back(trace.id);
    set.traces.push_back(std::move(trace));
  }
  return set;
}

/// Neither filtered nor freed of offset: faults stay as they are.
inline PulseOptions untouched() {
  PulseOptions options;
  options.cfc = 0.0;
  options.bias.rule = Bias::none;
  return options;
}

/// Velocity at a time by trapezoids over the steps of sensor_traces().
inline double sensor_velocity(double time_s, double step_s = 5e-4) {
  const std::vector<double> times =
      uniform_times(0.0, step_s, static_cast<std::size_t>(std::lround(time_s / step_s)) + 1);
  std::vector<double> accel;
  for (const double t : times) accel.push_back(sensor_accel(t));
  return integrate(times, accel, kSensorSpeed_mps).back();
}

}  // namespace crashsim::test
