#include "solver/cvode_crush.hpp"

#include <array>

namespace crashsim {

CvodeStepper::CvodeStepper(double rtol)
    : rtol_(rtol), cvode_(3, [this](double, const double* y, double* ydot) {
        ydot[0] = y[1];
        ydot[1] = -force_.at(y[0], y[1]) / mass_kg_;
        ydot[2] = force_.damper_at(y[0], y[1]) * y[1];
      }) {}

void CvodeStepper::restart(const CrushProblem& problem, const Region& region, double t, double x, double v,
                           double dissipated) {
  mass_kg_ = problem.mass_kg;
  force_ = region_force(problem, region);
  if (!started_) {
    const double speed = problem.speed_mps;
    cvode_.set_tolerances(
        rtol_, std::array{rtol_ * speed * kCrashTime, rtol_ * speed, rtol_ * 0.5 * mass_kg_ * speed * speed});
    started_ = true;
  }
  cvode_.start(t, std::array{x, v, dissipated});
}

const StepPolynomial& CvodeStepper::advance(double end_time_s) {
  cvode_.set_stop_time(end_time_s);
  const double t = cvode_.step();
  step_.base = t;
  step_.from = -cvode_.last_step();
  step_.to = 0.0;
  step_.degree = cvode_.last_order();
  double factorial = 1.0;
  for (int k = 0; k <= step_.degree; ++k) {
    if (k > 1) factorial *= k;
    const auto d = cvode_.derivative(t, k);
    const auto i = static_cast<std::size_t>(k);
    step_.x[i] = d[0] / factorial;
    step_.v[i] = d[1] / factorial;
    step_.dissipated[i] = d[2] / factorial;
  }
  step_.set_ends();
  return step_;
}

}  // namespace crashsim
