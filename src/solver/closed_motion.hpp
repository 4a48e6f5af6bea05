#pragma once
/// What is left of a motion once it is on the return line of plastic unloading or out of contact: a swing, then a
/// straight line in time, known without integration.

#include <limits>
#include <span>

#include "solver/crush_motion.hpp"

namespace crashsim {

/// x = centre + amplitude cos(omega (t - start)) until `free`, then x_free + v_free (t - free).
struct ClosedMotion {
  double start = 0.0, centre = 0.0, amplitude = 0.0, omega = 0.0;
  double free = std::numeric_limits<double>::infinity(), x_free = 0.0, v_free = 0.0;
};

/// Continuation of a motion that is unloading or separated. Until `end_time_s` its events go into the summary.
ClosedMotion closed_motion(const CrushProblem& problem, double end_time_s, MotionState& state);

struct PointOfMotion {
  double accel, velocity, displacement;
};
PointOfMotion at(const ClosedMotion& motion, double t);

}  // namespace crashsim
