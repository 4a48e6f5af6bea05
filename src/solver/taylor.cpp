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

/// n-th coefficient of the product of two series.
double product_coefficient(const Coefficients& a, const Coefficients& b, std::size_t n) {
  double sum = 0.0;
  for (std::size_t i = 0; i <= n; ++i) sum += a[i] * b[n - i];
  return sum;
}

/// n-th coefficient of a polynomial of a series.
double polynomial_coefficient(const Quadratic& c, const Coefficients& s, std::size_t n) {
  return (n == 0 ? c[0] : 0.0) + c[1] * s[n] + c[2] * square_coefficient(s, n);
}

/// Series of the spring's force and of rate ln(1 + per_reference v), coefficient by coefficient.
class RateSeries {
 public:
  explicit RateSeries(const RegionForce& force) : force_(force) {}

  /// n-th coefficient of the rate's part of the force; that of the spring's is spring(n). Call for n = 0, 1, ... in
  /// turn.
  double next(const StepPolynomial& step, std::size_t n) {
    spring_[n] = polynomial_coefficient(force_.spring, step.x, n);
    argument_[n] = force_.per_reference * step.v[n] + (n == 0 ? 1.0 : 0.0);
    log_[n] = n == 0 ? std::log1p(force_.per_reference * step.v[0]) : log_coefficient(n);
    return force_.rate * product_coefficient(spring_, log_, n);
  }
  [[nodiscard]] double spring(std::size_t n) const { return spring_[n]; }

 private:
  /// From w L' = w' with w = 1 + per_reference v.
  [[nodiscard]] double log_coefficient(std::size_t n) const {
    double sum = 0.0;
    for (std::size_t j = 1; j < n; ++j) sum += static_cast<double>(j) * log_[j] * argument_[n - j];
    return (argument_[n] - sum / static_cast<double>(n)) / argument_[0];
  }

  const RegionForce& force_;
  Coefficients spring_{}, argument_{}, log_{};
};

/// Largest step whose last two terms stay below the tolerance.
double step_length(const StepPolynomial& step, double tolerance_mps) {
  double log_inverse = -std::numeric_limits<double>::infinity();
  for (int k = kTaylorDegree - 1; k <= kTaylorDegree; ++k)
    log_inverse = std::max(log_inverse, std::log(std::fabs(step.v[static_cast<std::size_t>(k)]) / tolerance_mps) / k);
  return std::exp(-log_inverse);
}

/// Series of the energy the damper takes: W' = F_c v.
void energy_series(const RegionForce& force, double dissipated, StepPolynomial& step) {
  step.dissipated[0] = dissipated;
  Coefficients damper{};
  RateSeries rate(force);
  for (std::size_t n = 0; n < static_cast<std::size_t>(step.degree); ++n) {
    damper[n] = polynomial_coefficient(force.damper, step.v, n);
    if (force.cross != 0.0) damper[n] += force.cross * product_coefficient(step.x, step.v, n);
    if (force.rate != 0.0) damper[n] += rate.next(step, n);
    step.dissipated[n + 1] = product_coefficient(damper, step.v, n) / static_cast<double>(n + 1);
  }
}

void set_coefficient(double accel, std::size_t n, StepPolynomial& step) {
  const double factor = 1.0 / static_cast<double>(n + 1);
  step.x[n + 1] = step.v[n] * factor;
  step.v[n + 1] = accel * factor;
}

void rate_series(const RegionForce& force, double mass_kg, StepPolynomial& step) {
  RateSeries rate(force);
  for (std::size_t n = 0; n < static_cast<std::size_t>(kTaylorDegree); ++n) {
    const double by_rate = rate.next(step, n);
    const double damper = polynomial_coefficient(force.damper, step.v, n);
    set_coefficient(-(rate.spring(n) + by_rate + damper) / mass_kg, n, step);
  }
}

template <bool kHasCross>
[[gnu::always_inline]] inline void polynomial_series(const RegionForce& force, double mass_kg, StepPolynomial& step) {
  const double c0 = -(force.spring[0] + force.damper[0]) / mass_kg;
  const double cx = -force.spring[1] / mass_kg, cxx = -force.spring[2] / mass_kg;
  const double cv = -force.damper[1] / mass_kg, cvv = -force.damper[2] / mass_kg;
  const double cxv = -force.cross / mass_kg;
#pragma GCC unroll 16
  for (std::size_t n = 0; n < static_cast<std::size_t>(kTaylorDegree); ++n) {
    double a = (n == 0 ? c0 : 0.0) + cx * step.x[n] + cxx * square_coefficient(step.x, n) + cv * step.v[n] +
               cvv * square_coefficient(step.v, n);
    if constexpr (kHasCross) a += cxv * product_coefficient(step.x, step.v, n);
    set_coefficient(a, n, step);
  }
}

}  // namespace

void taylor_series(const RegionForce& force, double mass_kg, double x, double v, StepPolynomial& step) {
  step.degree = kTaylorDegree;
  step.x[0] = x;
  step.v[0] = v;
  if (force.rate != 0.0) return rate_series(force, mass_kg, step);
  if (force.cross != 0.0) return polynomial_series<true>(force, mass_kg, step);
  polynomial_series<false>(force, mass_kg, step);
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
  if (with_energy_) energy_series(force_, dissipated_, step_);
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
