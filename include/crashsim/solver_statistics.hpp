#pragma once
/// What it took to integrate.

namespace crashsim {

/// Longest motion that is simulated: far beyond any crash, and no run without end.
inline constexpr double kLongestMotion_s = 100.0;

/// Work of the integrator.
struct SolverStatistics {
  long steps = 0;              ///< Accepted steps.
  long force_evaluations = 0;  ///< Right-hand sides evaluated.
  long events = 0;             ///< Knots crossed, turning points, separation.
};

}  // namespace crashsim
