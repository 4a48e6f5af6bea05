#pragma once
/// Tests of one structure as instruments with white noise record them.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <crashsim/identify.hpp>
#include <crashsim/signal.hpp>

#include "support/fit_cases.hpp"
#include "support/random.hpp"

namespace crashsim::test {

inline constexpr double kTestSpeeds[] = {40.0 / 3.6, 56.0 / 3.6, 72.0 / 3.6};  // m/s
inline constexpr double kCoarse = 5e-4;                                        // s between samples

inline double normal(Random& random) {
  constexpr double kLeast = 1e-300;
  return std::sqrt(-2.0 * std::log(random.between(kLeast, 1.0))) *
         std::cos(2.0 * std::numbers::pi * random.between(0.0, 1.0));
}

/// A car whose ordinates all lie well inside the bounds and are all seen at kTestSpeeds.
inline CrushModel three_speed_model(int knots = 5) {
  CrushModel model;
  model.mass_kg = 1500.0;
  model.impact_speed_mps = kTestSpeeds[2];
  model.spring.knots = uniform_knots(0.75, knots);
  model.damper.knots = uniform_knots(kTestSpeeds[2], knots);
  for (int i = 0; i < knots; ++i) {
    const double along = static_cast<double>(i) / (knots - 1);
    model.spring.ordinates.push_back(5e5 * (1.0 - 0.3 * std::sin(4.0 * along)));
    model.damper.ordinates.push_back(1.2e4 * (1.0 - 0.5 * along + 0.2 * std::sin(5.0 * along)));
  }
  return model;
}

/// The motion of the model with noise of the acceleration, which velocity and displacement integrate.
/// @param share standard deviation, relative to the largest deceleration.
inline Pulse measured(const CrushModel& model, double speed_mps, double share, Random& random, double dt_s = kCoarse) {
  Pulse pulse = pulse_of(model, speed_mps, dt_s).value();
  double largest = 0.0;
  for (const double a : pulse.accel_mps2) largest = std::max(largest, std::fabs(a));
  std::vector<double> noise;
  for (std::size_t i = 0; i < pulse.time_s.size(); ++i) noise.push_back(share * largest * normal(random));
  const std::vector<double> velocity = integrate(pulse.time_s, noise, 0.0);
  const std::vector<double> displacement = integrate(pulse.time_s, velocity, 0.0);
  for (std::size_t i = 0; i < pulse.time_s.size(); ++i) {
    pulse.accel_mps2[i] += noise[i];
    pulse.velocity_mps[i] += velocity[i];
    pulse.displacement_m[i] += displacement[i];
  }
  return pulse;
}

/// Three speeds of it.
inline std::vector<Pulse> measured_tests(const CrushModel& model, double share, std::uint64_t seed) {
  Random random(seed);
  std::vector<Pulse> pulses;
  for (const double speed : kTestSpeeds) pulses.push_back(measured(model, speed, share, random));
  return pulses;
}

/// One descent from the equation-error solution, of the squared loss, with the model's own knots.
inline IdentifyOptions one_descent(const CrushModel& model) {
  IdentifyOptions options;
  options.loss = Loss::l2;
  options.starts = options.jobs = 1;
  options.spring_knots = static_cast<int>(model.spring.knots.size());
  options.damper_knots = static_cast<int>(model.damper.knots.size());
  options.knots = {KnotPlacement::given, model.spring.knots};
  return options;
}

/// What the message of a refusal says; "" when nothing is refused.
template <class F>
std::string refusal_of(const F& f) {
  try {
    f();
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

}  // namespace crashsim::test
