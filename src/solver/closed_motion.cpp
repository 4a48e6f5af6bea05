#include "solver/closed_motion.hpp"

#include <cmath>
#include <numbers>

namespace crashsim {

ClosedMotion closed_motion(const CrushProblem& problem, double end_time_s, MotionState& state) {
  const double stiffness = state.region.unloading ? state.region.return_line[1] : 0.0;
  ClosedMotion motion;
  if (state.region.separated || !(stiffness > 0.0)) {
    motion.free = state.t;
    motion.x_free = state.x;
    motion.v_free = state.v;
    return motion;
  }
  motion.start = state.t;
  motion.omega = std::sqrt(stiffness / problem.mass_kg);
  motion.centre = -state.region.return_line[0] / stiffness;
  motion.amplitude = state.x - motion.centre;
  if (problem.unloading.bilateral) return motion;
  motion.free = state.t + 0.5 * std::numbers::pi / motion.omega;
  motion.x_free = motion.centre;
  motion.v_free = -motion.amplitude * motion.omega;
  if (motion.free > end_time_s) return motion;
  state.summary.separation_s = motion.free;
  state.summary.static_crush_m = motion.x_free;
  state.summary.rebound_velocity_mps = motion.v_free;
  return motion;
}

PointOfMotion at(const ClosedMotion& motion, double t) {
  if (t >= motion.free) return {0.0, motion.v_free, motion.x_free + motion.v_free * (t - motion.free)};
  const double phase = motion.omega * (t - motion.start);
  const double swing = motion.amplitude * std::cos(phase);
  return {-motion.omega * motion.omega * swing, -motion.amplitude * motion.omega * std::sin(phase),
          motion.centre + swing};
}

}  // namespace crashsim
