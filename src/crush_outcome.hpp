#pragma once
/// How a motion ended, as results say it.

#include <cmath>

#include <crashsim/simulate.hpp>

#include "solver/crush_motion.hpp"

namespace crashsim {

inline CrushOutcome outcome_of(const MotionSummary& summary) {
  switch (summary.end) {
    case MotionEnd::left_knot_range:
      return CrushOutcome::left_knot_range;
    case MotionEnd::unloading_too_soft:
      return CrushOutcome::unloading_too_soft;
    case MotionEnd::step_limit:
      return CrushOutcome::step_limit;
    case MotionEnd::diverged:
      return CrushOutcome::failed;
    case MotionEnd::end_time:
    case MotionEnd::max_crush:
      break;
  }
  return std::isnan(summary.t_m_s) ? CrushOutcome::no_max_crush : CrushOutcome::completed;
}

}  // namespace crashsim
