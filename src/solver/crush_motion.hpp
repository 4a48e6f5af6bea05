#pragma once
/// The motion from impact, step by step, with every knot, turning point and separation met exactly. Integrators differ
/// only in how they make a step.

#include "solver/crush_events.hpp"
#include "solver/return_line.hpp"

namespace crashsim {

/// Why a motion ended.
enum class MotionEnd { end_time, max_crush, left_knot_range, unloading_too_soft, step_limit, diverged };

struct MotionSummary {
  MotionEnd end = MotionEnd::end_time;
  double t_m_s = kUnset, max_crush_m = kUnset, max_crush_force_n = kUnset;
  double separation_s = kUnset, static_crush_m = kUnset, rebound_velocity_mps = kUnset;
  double end_time_s = 0.0;
  long steps = 0, events = 0;
};

inline constexpr long kStepLimit = 100'000;  // a crash takes some tens to some thousands

/// Integrates to `end_time_s`, or to maximum crush when `to_max_crush`.
/// Stepper: `restart(problem, region, t, x, v, dissipated)`, `const StepPolynomial& advance(end_time)`.
/// Visitor: `on_piece(region, step, tau_end)` for every smooth piece, `on_event(before, after, x, v)` between pieces.
template <class Stepper, class Visitor>
MotionSummary integrate_motion(const CrushProblem& problem, double end_time_s, bool to_max_crush, Stepper& stepper,
                               Visitor& visitor) {
  MotionSummary summary;
  Region region = initial_region(problem);
  const auto left_knots = [&] {
    return problem.force.spring.forbidden(region.spring) || problem.force.damper.forbidden(region.damper);
  };
  if (left_knots()) {
    summary.end = MotionEnd::left_knot_range;
    return summary;
  }
  stepper.restart(problem, region, 0.0, 0.0, problem.speed_mps, 0.0);
  while (summary.steps < kStepLimit) {
    const StepPolynomial& step = stepper.advance(end_time_s);
    ++summary.steps;
    if (!std::isfinite(step.v[static_cast<std::size_t>(step.degree)])) {  // what overflows does so here first
      summary.end = MotionEnd::diverged;
      return summary;
    }
    const Event event = first_event(problem, region, step);
    const bool at_once = event.kind != EventKind::none && event.tau <= step.from;  // no piece of this region at all
    if (!at_once) visitor.on_piece(region, step, event.tau);
    const double t = step.base + event.tau;
    summary.end_time_s = t;
    if (event.kind == EventKind::none) {
      if (t >= end_time_s) return summary;
      continue;
    }
    ++summary.events;
    // A knot that was reached is reached exactly, so that no rounding can cross it twice.
    const double x = event.kind == EventKind::spring_knot ? event.level : step.x_at(event.tau);
    const double v = event.kind == EventKind::damper_knot ? event.level : step.v_at(event.tau);
    const Region before = region;
    region = next_region(problem, before, event, x, v);
    visitor.on_event(before, region, x, v);
    if (is_max_crush(event) && std::isnan(summary.t_m_s)) {
      summary.t_m_s = t;
      summary.max_crush_m = x;
      summary.max_crush_force_n = value(region_force(problem, before).spring, x);
      if (to_max_crush) {
        summary.end = MotionEnd::max_crush;
        return summary;
      }
      if (region.unloading && returns_too_much(problem, region, x)) {
        summary.end = MotionEnd::unloading_too_soft;
        return summary;
      }
    }
    if (region.separated) {
      summary.separation_s = t;
      if (!std::isnan(summary.t_m_s)) {
        summary.static_crush_m = x;
        summary.rebound_velocity_mps = v;
      }
    }
    if (left_knots()) {
      summary.end = MotionEnd::left_knot_range;
      return summary;
    }
    if (t >= end_time_s) return summary;
    double dissipated = step.dissipated_at(event.tau);
    if (region.unloading != before.unloading || region.separated)
      dissipated += stored_energy(problem, before, x) - stored_energy(problem, region, x);
    stepper.restart(problem, region, t, x, v, dissipated);
  }
  summary.end = MotionEnd::step_limit;
  return summary;
}

}  // namespace crashsim
