#pragma once
/// What it took to integrate.

namespace crashsim {

/// Work of the integrator.
struct SolverStatistics {
  long steps = 0;              ///< Accepted steps.
  long force_evaluations = 0;  ///< Right-hand sides evaluated.
  long events = 0;             ///< Knots crossed, turning points, separation.
};

}  // namespace crashsim
