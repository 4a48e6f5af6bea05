#include "solver/crush_events.hpp"

#include "solver/return_line.hpp"

namespace crashsim {
namespace {

constexpr double kForceRounding = 1e-13;  // relative to the terms the force is the sum of

double magnitude(const Quadratic& c, double s) {
  return std::fabs(c[0]) + std::fabs(s) * (std::fabs(c[1]) + std::fabs(s * c[2]));
}

/// Force of a region at a state; what rounding leaves of it, its own or the state's, is zero. `margin` is the rounding
/// of v: a force that starts from nothing must not count as a pull because x is -1e-20 m.
double contact_force(const RegionForce& force, double x, double v, double margin) {
  const double sum = force.at(x, v);
  const double rounding =
      kForceRounding * (magnitude(force.spring, x) + magnitude(force.damper, v) + std::fabs(force.cross * x * v)) +
      margin * (kCrashTime * std::fabs(force.by_x(x, v)) + std::fabs(force.by_v(x, v)));
  return std::fabs(sum) > rounding ? sum : 0.0;
}

/// First time in a step at which the force changes sign, or `to`.
struct SignChange {
  double tau;
  bool pulls_at_once;  ///< Negative from the start.
};
SignChange sign_change(const RegionForce& force, const StepPolynomial& step, double margin) {
  const auto at = [&](const CrushState& y) { return contact_force(force, y.x, y.v, margin); };
  const auto exactly = [&](const CrushState& y) { return force.at(y.x, y.v); };
  const auto slope = [&](double tau, const CrushState& y) {
    return force.by_x(y.x, y.v) * y.v + force.by_v(y.x, y.v) * horner_derivative(step.v, step.degree, tau);
  };
  double start = step.from;
  CrushState from = step.start;
  double first = at(from);
  if (first == 0.0) {  // just turned, or no force yet: what comes next decides
    start += (step.to - step.from) / 64.0;
    from = step.state_at(start);
    first = at(from);
  }
  if (first == 0.0) return {step.to, false};
  const double sign = first > 0.0 ? 1.0 : -1.0;
  double end = step.to;
  const double last = at(step.end);
  if (sign * last >= 0.0) {
    // An excursion inside the step shows as a minimum of the signed force, which the tangents at the ends bound.
    const double fall = sign * slope(start, from), rise = sign * slope(end, step.end);
    if (!(fall < 0.0 && rise > 0.0)) return {step.to, sign < 0.0};
    if (sign * first + fall * (end - start) > 0.0 || sign * last - rise * (end - start) > 0.0)
      return {step.to, sign < 0.0};
    double low = start, high = end;
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (low + high);
      (sign * slope(middle, step.state_at(middle)) < 0.0 ? low : high) = middle;
    }
    end = low;
    if (sign * at(step.state_at(end)) >= 0.0) return {step.to, sign < 0.0};
  }
  const auto f = [&](double tau) {
    const CrushState y = step.state_at(tau);
    return ValueAndDerivative{exactly(y), slope(tau, y)};
  };
  return {bracketed_root(f, start, end), sign < 0.0};
}

/// Narrows `event` to the time the polynomial `c` reaches a bound of its segment, if it does until event.tau. `margin`
/// is the distance that rounding alone makes: nearer to a knot is at it.
void cross_bounds(const ForceAxis& axis, int segment, const Coefficients& c, double CrushState::*variable,
                  double margin, const StepPolynomial& step, EventKind kind, Event& event) {
  const double end = event.tau == step.to ? step.end.*variable : horner(c, step.degree, event.tau);
  // A force that vanishes exactly at a knot changes sign there only in the segment it leaves: the knot comes first.
  const double slope = event.kind == EventKind::none ? 0.0 : horner_derivative(c, step.degree, event.tau);
  const bool below = end < axis.lower(segment) + (slope < 0.0 ? margin : -margin);
  if (!below && !(end > axis.upper(segment) - (slope > 0.0 ? margin : -margin))) return;
  const double level = below ? axis.lower(segment) : axis.upper(segment);
  const double side = below ? 1.0 : -1.0;  // positive times distance: not yet there
  const double start = side * (step.start.*variable - level);
  double tau = event.tau;
  if (start <= 0.0)
    tau = step.from;
  else if (side * (end - level) < 0.0)
    tau = level_crossing(c, step.degree, level, {step.from, step.start.*variable}, {event.tau, end});
  event = {kind, tau, below ? -1 : +1, level};
}

}  // namespace

RegionForce region_force(const CrushProblem& problem, const Region& region) {
  if (region.separated) return {};
  if (region.unloading) return {region.return_line, {}};
  return region_force(problem.force, region.spring, region.damper);
}

Region initial_region(const CrushProblem& problem) {
  // v starts on a knot and can only decrease: its segment is the one below.
  return {problem.force.spring.locate(0.0, +1), problem.force.damper.locate(problem.speed_mps, -1), false};
}

Event first_event(const CrushProblem& problem, const Region& region, const StepPolynomial& step) {
  Event event{EventKind::none, step.to, 0, 0.0};
  if (region.separated) return event;
  const double margin = state_rounding(problem.speed_mps);
  const bool bilateral = problem.unloading.bilateral;
  if (region.unloading && bilateral) return event;  // one line to the end
  const SignChange change = sign_change(region_force(problem, region), step, margin);
  if (!bilateral && change.pulls_at_once)
    event = {EventKind::separation, step.from, 0, 0.0};
  else if (change.tau < step.to)
    event = {bilateral ? EventKind::turn : EventKind::separation, change.tau, 0, 0.0};
  if (region.unloading) return event;
  cross_bounds(problem.force.damper, region.damper, step.v, &CrushState::v, margin, step, EventKind::damper_knot,
               event);
  cross_bounds(problem.force.spring, region.spring, step.x, &CrushState::x, margin * kCrashTime, step,
               EventKind::spring_knot, event);
  return event;
}

Region next_region(const CrushProblem& problem, const Region& region, const Event& event, double x, double v) {
  Region next = region;
  if (event.kind == EventKind::spring_knot) next.spring += event.direction;
  if (event.kind == EventKind::damper_knot) next.damper += event.direction;
  if (is_max_crush(event) && problem.unloading.kind == UnloadingKind::plastic) {
    next.unloading = true;
    next.return_line = return_line(problem, value(region_force(problem, region).spring, x), x);
  }
  if (event.kind == EventKind::separation) next.separated = true;
  if (problem.unloading.bilateral || next.separated) return next;
  const double force = contact_force(region_force(problem, next), x, v, state_rounding(problem.speed_mps));
  next.separated = next.unloading ? force <= 0.0 : force < 0.0;
  return next;
}

std::array<double, 4> stored_energy_polynomial(const CrushProblem& problem, const Region& region, double x) {
  const Quadratic force = region_force(problem, region).spring;
  std::array<double, 4> energy = {0.0, force[0], force[1] / 2.0, force[2] / 3.0};
  energy[0] = stored_energy(problem, region, x) - x * (energy[1] + x * (energy[2] + x * energy[3]));
  return energy;
}

double stored_energy(const CrushProblem& problem, const Region& region, double x) {
  if (region.separated) return 0.0;  // nothing pulls on the structure any more: what it held is lost
  return region.unloading ? return_line_energy(region.return_line, x) : spring_energy(problem.force, x);
}

}  // namespace crashsim
