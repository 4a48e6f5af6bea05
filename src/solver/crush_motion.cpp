#include "solver/crush_motion.hpp"

#include "solver/return_line.hpp"

namespace crashsim {
namespace {

bool left_knots(const CrushProblem& problem, const Region& region) {
  return problem.force.spring.forbidden(region.spring) || problem.force.damper.forbidden(region.damper);
}

void end_motion(MotionEnd why, MotionState& state) {
  state.summary.end = why;
  state.ended = true;
}

/// Notes maximum crush; the force there is that of the region before.
void reach_max_crush(const CrushProblem& problem, const MotionLimits& limits, const Region& before,
                     MotionState& state) {
  MotionSummary& summary = state.summary;
  summary.t_m_s = state.t;
  summary.max_crush_m = state.x;
  summary.max_crush_force_n = value(region_force(problem, before).spring, state.x);
  if (limits.to_max_crush)
    end_motion(MotionEnd::max_crush, state);
  else if (state.region.unloading && returns_too_much(problem, state.region, state.x))
    end_motion(MotionEnd::unloading_too_soft, state);
}

void note_separation(MotionState& state) {
  state.summary.separation_s = state.t;
  if (std::isnan(state.summary.t_m_s)) return;
  state.summary.static_crush_m = state.x;
  state.summary.rebound_velocity_mps = state.v;
}

}  // namespace

MotionState start_motion(const CrushProblem& problem) {
  MotionState state;
  state.region = initial_region(problem);
  state.v = problem.speed_mps;
  if (left_knots(problem, state.region)) end_motion(MotionEnd::left_knot_range, state);
  return state;
}

void end_step(const CrushProblem& problem, const MotionLimits& limits, const Event& event, double t, double x, double v,
              MotionState& state) {
  MotionSummary& summary = state.summary;
  ++summary.steps;
  summary.end_time_s = state.t = t;
  // A knot that was reached is reached exactly, so that no rounding can cross it twice.
  state.x = event.kind == EventKind::spring_knot ? event.level : x;
  state.v = event.kind == EventKind::damper_knot ? event.level : v;
  if (event.kind != EventKind::none) {
    ++summary.events;
    const Region before = state.region;
    state.region = next_region(problem, before, event, state.x, state.v);
    if (is_max_crush(event) && std::isnan(summary.t_m_s)) reach_max_crush(problem, limits, before, state);
    if (state.ended) return;
    if (state.region.separated) note_separation(state);
    if (left_knots(problem, state.region)) return end_motion(MotionEnd::left_knot_range, state);
  }
  if (t >= limits.end_time_s) return end_motion(MotionEnd::end_time, state);
  if (summary.steps >= kStepLimit) end_motion(MotionEnd::step_limit, state);
}

}  // namespace crashsim
