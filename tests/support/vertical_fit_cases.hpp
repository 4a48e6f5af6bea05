#pragma once
/// Measured forces and crush that the identification tests of the vertical force share.

#include <algorithm>
#include <cmath>
#include <numbers>

#include <crashsim/identify_vertical.hpp>

namespace crashsim::test {

inline constexpr double kLargestCrush = 0.6;  // m

/// Crush that grows as a sine and comes back a little, the force with a plateau, each at times of its own.
inline VerticalForceTarget crushing() {
  VerticalForceTarget target;
  for (int i = 0; i <= 200; ++i) {
    const double t = 0.0006 * i;
    target.crush_m.time_s.push_back(t);
    target.crush_m.values.push_back(kLargestCrush * std::sin(0.5 * std::numbers::pi * t / 0.1));
  }
  for (int i = 0; i <= 120; ++i) {
    const double t = -0.005 + 0.001 * i;
    target.longitudinal_force_n.time_s.push_back(t);
    target.longitudinal_force_n.values.push_back(t < 0.0 ? 0.0 : 3e5 * std::min(1.0, t / 0.02) + 1e6 * t);
  }
  return target;
}

/// The force that a law gives, at the times of the crush inside those of the longitudinal force.
inline VerticalForceTarget measured_by(const VerticalForceLaw& law) {
  VerticalForceTarget target = crushing();
  const TimeSeries& along = target.longitudinal_force_n;
  for (std::size_t i = 0; i < target.crush_m.time_s.size(); ++i) {
    const double t = target.crush_m.time_s[i];
    if (t > along.time_s.back()) break;
    const auto next = static_cast<std::size_t>(std::ranges::upper_bound(along.time_s, t) - along.time_s.begin());
    const std::size_t right = std::min(next, along.time_s.size() - 1);
    const double share = (t - along.time_s[right - 1]) / (along.time_s[right] - along.time_s[right - 1]);
    const double force = along.values[right - 1] + share * (along.values[right] - along.values[right - 1]);
    target.vertical_force_n.time_s.push_back(t);
    target.vertical_force_n.values.push_back(force * vertical_ratio(law, target.crush_m.values[i]));
  }
  return target;
}

}  // namespace crashsim::test
