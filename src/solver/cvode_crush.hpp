#pragma once
/// CVODE as stepper of the crush motion: the integrator of record.

#include "solver/crush_events.hpp"
#include "solver/cvode.hpp"

namespace crashsim {

/// Stepper for integrate_motion(); unknowns x, v and the energy dissipated.
class CvodeStepper {
 public:
  /// @param rtol relative tolerance of CVODE's local error.
  explicit CvodeStepper(double rtol);

  void restart(const CrushProblem& problem, const Region& region, double t, double x, double v, double dissipated);
  const StepPolynomial& advance(double end_time_s);
  [[nodiscard]] long rhs_evaluations() const { return cvode_.rhs_evaluations(); }

 private:
  double rtol_;
  double mass_kg_ = 0.0;
  RegionForce force_;
  Cvode cvode_;
  StepPolynomial step_;
  bool started_ = false;
};

}  // namespace crashsim
