#pragma once
/// Metrics as the events of a simulated motion give them, exactly.

#include <cmath>

#include <crashsim/metrics.hpp>
#include <crashsim/units.hpp>

namespace crashsim {

/// Overrides what samples give by what the events of the motion say.
/// @param motion has t_m_s, max_crush_m, separation_s, static_crush_m and rebound_velocity_mps.
template <class M>
void take_events(const M& motion, double mass_kg, double speed_mps, Metrics& out) {
  out.t_m_s = motion.t_m_s;
  out.mean_decel_g = speed_mps / motion.t_m_s / kStandardGravity;
  out.energy_j = std::isnan(motion.t_m_s) ? kUnset : 0.5 * mass_kg * speed_mps * speed_mps;
  out.max_crush_m = motion.max_crush_m;
  out.centroid_s = motion.max_crush_m / speed_mps;
  if (std::isnan(motion.separation_s)) return;
  out.static_crush_m = motion.static_crush_m;
  out.rebound_velocity_mps = motion.rebound_velocity_mps;
  out.restitution = std::fabs(motion.rebound_velocity_mps) / speed_mps;  // of 0: not -0
}

}  // namespace crashsim
