#pragma once
/// Models and pulses that the identification tests share.

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <crashsim/identify.hpp>
#include <crashsim/simulate.hpp>

#include "support/random.hpp"
#include "support/shared_data.hpp"

namespace crashsim::test {

inline constexpr double kCarMass = 1719.0;   // kg
inline constexpr double kCarSpeed = 15.858;  // m/s
inline constexpr double kSampling = 1e-4;    // s

/// Random car-like model; `damper_share` scales the damper.
inline CrushModel random_crush_model(Random& random, CrushLaw law, int spring_knots = 7, int damper_knots = 7,
                                     double damper_share = 1.0) {
  CrushModel model;
  model.mass_kg = random.between(900.0, 2500.0);
  model.impact_speed_mps = random.between(9.0, 18.0);
  model.law = law;
  const double deep = random.between(0.5, 0.9);
  const double force = model.mass_kg * model.impact_speed_mps * model.impact_speed_mps / deep;
  if (spring_knots > 0) model.spring.knots = uniform_knots(deep, spring_knots);
  for (std::size_t i = 0; i < model.spring.knots.size(); ++i)
    model.spring.ordinates.push_back(random.between(0.2, 1.6) * (law == CrushLaw::force ? force : 2.0 * force / deep));
  if (damper_knots > 0) model.damper.knots = uniform_knots(model.impact_speed_mps, damper_knots);
  for (std::size_t i = 0; i < model.damper.knots.size(); ++i)
    model.damper.ordinates.push_back(damper_share * random.between(0.05, 0.6) * force / model.impact_speed_mps);
  return model;
}

/// What a perfect instrument would record of a model, to a little after maximum crush; nothing when it has none.
inline std::optional<Pulse> pulse_of(const CrushModel& model, double speed_mps, double dt_s = kSampling) {
  SimulateOptions options;
  options.impact_speed_mps = speed_mps;
  options.end_time_s = 0.3;
  options.dt_s = dt_s;
  options.rtol = 1e-12;
  const CrushResponse run = simulate(model, options);
  if (!run.usable()) return std::nullopt;
  Pulse pulse;
  pulse.mass_kg = model.mass_kg;
  pulse.impact_speed_mps = speed_mps;
  pulse.t_m_s = run.t_m_s;
  pulse.max_crush_m = run.max_crush_m;
  for (std::size_t i = 0; i < run.time_s.size() && run.time_s[i] <= run.t_m_s + 3.0 * dt_s; ++i) {
    pulse.time_s.push_back(run.time_s[i]);
    pulse.accel_mps2.push_back(run.accel_mps2[i]);
    pulse.velocity_mps.push_back(run.velocity_mps[i]);
    pulse.displacement_m.push_back(run.displacement_m[i]);
  }
  return pulse;
}

/// The same with smooth disturbances of a share of the largest deceleration; v and x stay its integrals.
inline Pulse noisy_pulse(const CrushModel& model, double speed_mps, double share, std::uint64_t seed) {
  const Pulse clean = pulse_of(model, speed_mps).value();
  double largest = 0.0;
  for (const double a : clean.accel_mps2) largest = std::max(largest, std::fabs(a));
  Random random(seed);
  std::vector<double> accel = clean.accel_mps2;
  for (int wave = 0; wave < 6; ++wave) {
    const double rate = random.between(300.0, 2500.0), phase = random.between(0.0, 6.0);
    for (std::size_t i = 0; i < accel.size(); ++i)
      accel[i] += share * largest * std::sin(rate * clean.time_s[i] + phase);
  }
  std::vector<double> time = clean.time_s;
  for (int i = 0; i < 200; ++i) {  // so that v surely reaches zero
    time.push_back(time.back() + kSampling);
    accel.push_back(accel.back());
  }
  return make_pulse(time, accel, speed_mps, model.mass_kg);
}

/// A car with a stiff front and a soft middle.
inline CrushModel example_model() {
  Random random(4);
  return random_crush_model(random, CrushLaw::stiffness);
}

/// Mean of the rear seat cross-members of NHTSA 10146; nothing where the shared data are absent.
inline std::optional<Pulse> camry_pulse() {
  const auto path = shared_data("nhtsa-10146/v10146.EV5");
  if (!path) return std::nullopt;
  PulseOptions options;
  options.channels = {"93", "94"};
  return read_pulse(path->string(), options);
}

inline std::vector<double> ordinates_of(const CrushModel& model) {
  std::vector<double> all = model.spring.ordinates;
  all.insert(all.end(), model.damper.ordinates.begin(), model.damper.ordinates.end());
  return all;
}

}  // namespace crashsim::test
