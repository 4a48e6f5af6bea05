#pragma once
/// Taylor-series integrator of the crush model. Between knots the force is quadratic in x and v, or that times a
/// logarithm of v, so that the coefficients of the motion follow from a short recurrence.

#include "solver/crush_events.hpp"

namespace crashsim {

inline constexpr int kTaylorDegree = 10;  ///< Of the series: cheapest of 8..14 at the accuracies in use.

/// Series of x and v about a state, m v' = -F(x, v).
void taylor_series(const RegionForce& force, double mass_kg, double x, double v, StepPolynomial& step);

/// Stepper for integrate_motion().
class TaylorStepper {
 public:
  /// @param tolerance error of a step relative to the impact speed.
  TaylorStepper(double tolerance, bool with_energy) : tolerance_(tolerance), with_energy_(with_energy) {}

  void restart(const CrushProblem& problem, const Region& region, double t, double x, double v, double dissipated);
  const StepPolynomial& advance(double end_time_s);

 private:
  double tolerance_;
  bool with_energy_;
  double mass_kg_ = 0.0, speed_mps_ = 0.0;
  RegionForce force_;
  double t_ = 0.0, x_ = 0.0, v_ = 0.0, dissipated_ = 0.0;
  StepPolynomial step_;
};

}  // namespace crashsim
