#pragma once
/// The motion from impact, step by step, with every knot, turning point and separation met exactly. Integrators differ
/// only in how they make a step.

#include "solver/crush_events.hpp"

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

/// Error allowed of a step, of what is asked of the result: the errors of a motion's steps add up, and CVODE's global
/// error is 10-300 times its local one here.
inline constexpr double kLocalPerGlobal = 1e-3;

inline constexpr long kStepLimit = 100'000;  // a crash takes some tens to some thousands

/// How long to go.
struct MotionLimits {
  double end_time_s;
  bool to_max_crush;  ///< End at maximum crush, if that is earlier.
};

/// Where a motion is between two steps.
struct MotionState {
  Region region;
  double t = 0.0, x = 0.0, v = 0.0;
  MotionSummary summary;
  bool ended = false;
};

/// State at impact.
MotionState start_motion(const CrushProblem& problem);

/// Takes the motion to the end of a step at time `t` and state (x, v): over its event, or on when there is none. What
/// ends the motion is in the summary.
void end_step(const CrushProblem& problem, const MotionLimits& limits, const Event& event, double t, double x, double v,
              MotionState& state);

/// An event before any of its step: there is no piece to look at.
inline bool is_at_once(const Event& event, const StepPolynomial& step) {
  return event.kind != EventKind::none && event.tau <= step.from;
}

/// Integrates to the limits.
/// Stepper: `restart(problem, region, t, x, v, dissipated)`, `const StepPolynomial& advance(end_time)`.
/// Visitor: `on_piece(region, step, tau_end)` for every smooth piece, `on_event(before, after, x, v)` between pieces.
template <class Stepper, class Visitor>
MotionSummary integrate_motion(const CrushProblem& problem, const MotionLimits& limits, Stepper& stepper,
                               Visitor& visitor) {
  MotionState state = start_motion(problem);
  if (!state.ended) stepper.restart(problem, state.region, 0.0, 0.0, problem.speed_mps, 0.0);
  while (!state.ended) {
    const StepPolynomial& step = stepper.advance(limits.end_time_s);
    if (!std::isfinite(step.v[static_cast<std::size_t>(step.degree)])) {  // what overflows does so here first
      state.summary.end = MotionEnd::diverged;
      break;
    }
    const Event event = first_event(problem, state.region, step);
    if (!is_at_once(event, step)) visitor.on_piece(state.region, step, event.tau);
    const Region before = state.region;
    const auto [x, v] = step.state_at(event.tau);
    end_step(problem, limits, event, step.base + event.tau, x, v, state);
    if (event.kind == EventKind::none) continue;
    visitor.on_event(before, state.region, state.x, state.v);
    if (state.ended) break;
    double dissipated = step.dissipated_at(event.tau);
    if (state.region.unloading != before.unloading || state.region.separated)
      dissipated += stored_energy(problem, before, state.x) - stored_energy(problem, state.region, state.x);
    stepper.restart(problem, state.region, state.t, state.x, state.v, dissipated);
  }
  return state.summary;
}

}  // namespace crashsim
