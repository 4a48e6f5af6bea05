#pragma once
/// Heave and pitch models and forces that several tests use.

#include <cmath>
#include <numbers>

#include <crashsim/simulate_pitch.hpp>

#include "support/random.hpp"

namespace crashsim::test {

/// The oracle cases' vehicle with one wheel's suspension for an axle's (P1, P2).
inline HeavePitchModel oracle_vehicle() {
  HeavePitchModel model;
  model.mass_kg = 2582.0;
  model.pitch_inertia_kgm2 = 6158.0;
  model.front_axle_m = 1.4;
  model.rear_axle_m = 1.0;
  model.front_stiffness_n_per_m = 30000.0;
  model.rear_stiffness_n_per_m = 20000.0;
  model.front_damping_ns_per_m = 1500.0;
  model.rear_damping_ns_per_m = 3000.0;
  model.force_arm_m = 1.0;
  return model;
}

inline constexpr double kHalfSinePeak = 60e3;    // N
inline constexpr double kHalfSineLength = 0.08;  // s

/// The oracle cases' vertical force [N].
inline double half_sine(double t) {
  return t < kHalfSineLength ? kHalfSinePeak * std::sin(std::numbers::pi * t / kHalfSineLength) : 0.0;
}

/// The oracle cases' force in `intervals` samples: linear interpolation is off by 0.8 / intervals^2 of the impulse.
inline TimeSeries sampled_half_sine(int intervals) {
  TimeSeries force;
  for (int i = 0; i <= intervals; ++i) {
    force.time_s.push_back(kHalfSineLength * i / intervals);
    force.values.push_back(kHalfSinePeak * std::sin(std::numbers::pi * i / intervals));
  }
  return force;
}

inline HeavePitchModel random_vehicle(Random& random) {
  HeavePitchModel model;
  model.mass_kg = random.between(700.0, 4000.0);
  model.pitch_inertia_kgm2 = random.between(800.0, 9000.0);
  model.front_axle_m = random.between(0.8, 2.0);
  model.rear_axle_m = random.between(0.8, 2.0);
  model.front_stiffness_n_per_m = random.between(1e4, 2e5);
  model.rear_stiffness_n_per_m = random.between(1e4, 2e5);
  model.front_damping_ns_per_m = random.between(0.0, 1e4);
  model.rear_damping_ns_per_m = random.between(0.0, 1e4);
  model.force_arm_m = random.between(0.5, 2.5);
  model.cg_height_m = random.between(0.4, 0.9);
  model.force_height_m = random.between(0.3, 0.9);
  return model;
}

/// `count` samples at uneven times from about `first` to about `last`.
inline TimeSeries random_series(Random& random, double first, double last, int count, double low, double high) {
  TimeSeries series;
  for (int i = 0; i < count; ++i) {
    series.time_s.push_back(first + (last - first) * (i + random.between(0.0, 0.9)) / count);
    series.values.push_back(random.between(low, high));
  }
  return series;
}

}  // namespace crashsim::test
