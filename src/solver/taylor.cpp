#include "solver/taylor.hpp"

#include <algorithm>
#include <cmath>

namespace crashsim {
namespace {

/// n-th coefficient of the square of a series.
[[gnu::always_inline]] inline double square_coefficient(const Coefficients& c, std::size_t n) {
  double sum = 0.0;
  for (std::size_t i = 0; 2 * i < n; ++i) sum += c[i] * c[n - i];
  sum *= 2.0;
  if (n % 2 == 0) sum += c[n / 2] * c[n / 2];
  return sum;
}

/// Largest step whose last two terms stay below the tolerance.
double step_length(const StepPolynomial& step, double tolerance_mps) {
  double log_inverse = -std::numeric_limits<double>::infinity();
  for (int k = kTaylorDegree - 1; k <= kTaylorDegree; ++k)
    log_inverse = std::max(log_inverse, std::log(std::fabs(step.v[static_cast<std::size_t>(k)]) / tolerance_mps) / k);
  return std::exp(-log_inverse);
}

/// Series of the energy the damper takes: W' = damper(v) v.
void energy_series(const Quadratic& damper, double dissipated, StepPolynomial& step) {
  step.dissipated[0] = dissipated;
  Coefficients force{};
  for (std::size_t n = 0; n < static_cast<std::size_t>(step.degree); ++n) {
    force[n] = damper[1] * step.v[n] + damper[2] * square_coefficient(step.v, n);
    double power = 0.0;
    for (std::size_t i = 0; i <= n; ++i) power += force[i] * step.v[n - i];
    step.dissipated[n + 1] = power / static_cast<double>(n + 1);
  }
}

}  // namespace

void taylor_series(const RegionForce& force, double mass_kg, double x, double v, StepPolynomial& step) {
  const double c0 = -(force.spring[0] + force.damper[0]) / mass_kg;
  const double cx = -force.spring[1] / mass_kg, cxx = -force.spring[2] / mass_kg;
  const double cv = -force.damper[1] / mass_kg, cvv = -force.damper[2] / mass_kg;
  step.degree = kTaylorDegree;
  step.x[0] = x;
  step.v[0] = v;
#pragma GCC unroll 16
  for (std::size_t n = 0; n < static_cast<std::size_t>(kTaylorDegree); ++n) {
    const double a = (n == 0 ? c0 : 0.0) + cx * step.x[n] + cxx * square_coefficient(step.x, n) + cv * step.v[n] +
                     cvv * square_coefficient(step.v, n);
    const double factor = 1.0 / static_cast<double>(n + 1);
    step.x[n + 1] = step.v[n] * factor;
    step.v[n + 1] = a * factor;
  }
}

void TaylorStepper::restart(const CrushProblem& problem, const Region& region, double t, double x, double v,
                            double dissipated) {
  mass_kg_ = problem.mass_kg;
  speed_mps_ = problem.speed_mps;
  force_ = region_force(problem, region);
  t_ = t;
  x_ = x;
  v_ = v;
  dissipated_ = dissipated;
}

const StepPolynomial& TaylorStepper::advance(double end_time_s) {
  taylor_series(force_, mass_kg_, x_, v_, step_);
  if (with_energy_) energy_series(force_.damper, dissipated_, step_);
  const double remaining = end_time_s - t_;
  const double length = step_length(step_, tolerance_ * speed_mps_);
  step_.base = t_;
  step_.from = 0.0;
  step_.to = std::min(length, remaining);
  step_.start = {x_, v_};
  x_ = step_.x_at(step_.to);
  v_ = step_.v_at(step_.to);
  step_.end = {x_, v_};
  if (with_energy_) dissipated_ = step_.dissipated_at(step_.to);
  t_ = length < remaining ? t_ + length : end_time_s;
  return step_;
}

}  // namespace crashsim
