#include "optimize/sensitivity.hpp"

namespace crashsim {
namespace {

void square(const Coefficients& c, int degree, Coefficients& out) {
  for (int n = 0; n <= degree; ++n) {
    double sum = 0.0;
    for (int i = 0; i <= n; ++i) sum += c[static_cast<std::size_t>(i)] * c[static_cast<std::size_t>(n - i)];
    out[static_cast<std::size_t>(n)] = sum;
  }
}

/// Forcing -dF/dtheta / m of the two ordinates acting in a segment, as series in `v` (later overwritten by the
/// solution).
void set_forcing(const ForceAxis& axis, int segment, int offset, int column, const Coefficients& s, int degree,
                 double mass_kg, SensitivitySeries& series) {
  Coefficients squared;
  square(s, degree, squared);
  for (const OrdinateBasis& basis : axis.segments[static_cast<std::size_t>(segment)]) {
    const auto lane = static_cast<std::size_t>(column++);
    if (basis.ordinate < 0) continue;
    series.ordinate[lane] = offset + basis.ordinate;
    for (std::size_t n = 0; n < static_cast<std::size_t>(degree); ++n)
      series.v[n + 1][lane] = -(basis.c[1] * s[n] + basis.c[2] * squared[n]) / mass_kg;
    series.v[1][lane] -= basis.c[0] / mass_kg;
  }
}

}  // namespace

CRASHSIM_WIDEST_VECTORS
void sensitivity_series(const CrushProblem& problem, const Region& region, const StepPolynomial& step,
                        int damper_offset, SensitivitySeries& series) {
  const auto degree = static_cast<std::size_t>(step.degree);
  for (std::size_t n = 0; n <= degree; ++n) series.x[n] = series.v[n] = Lanes{};
  series.ordinate.fill(-1);
  series.x[0][0] = 1.0;
  series.v[0][1] = 1.0;
  const double m = problem.mass_kg;
  Lanes* const sx = series.x.data();
  Lanes* const sv = series.v.data();
  if (!region.separated) {
    set_forcing(problem.force.spring, region.spring, 0, kHomogeneous, step.x, step.degree, m, series);
    set_forcing(problem.force.damper, region.damper, damper_offset, kHomogeneous + 2, step.v, step.degree, m, series);
  }
  // alpha = -(dF/dx)/m and beta = -(dF/dv)/m along the motion.
  const RegionForce force = region_force(problem, region);
  Coefficients alpha, beta;
  for (std::size_t n = 0; n < degree; ++n) {
    alpha[n] = -2.0 * force.spring[2] / m * step.x[n];
    beta[n] = -2.0 * force.damper[2] / m * step.v[n];
  }
  alpha[0] -= force.spring[1] / m;
  beta[0] -= force.damper[1] / m;
  for (std::size_t n = 0; n < degree; ++n) {
    Lanes sum = sv[n + 1];
    for (std::size_t i = 0; i <= n; ++i) sum += alpha[i] * sx[n - i] + beta[i] * sv[n - i];
    const double factor = 1.0 / static_cast<double>(n + 1);
    sx[n + 1] = sv[n] * factor;
    sv[n + 1] = sum * factor;
  }
}

CRASHSIM_WIDEST_VECTORS
void evaluate(const SensitivitySeries& series, int degree, double tau, SensitivityValues& at) {
  const Lanes* const sx = series.x.data();
  const Lanes* const sv = series.v.data();
  Lanes x = sx[degree], v = sv[degree];
  for (int n = degree - 1; n >= 0; --n) {
    x = x * tau + sx[n];
    v = v * tau + sv[n];
  }
  at.x = x;
  at.v = v;
}

}  // namespace crashsim
