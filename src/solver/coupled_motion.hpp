#pragma once
/// The coupled motion from impact by CVODE, which stops and starts anew at every kink of the forces.

#include <array>
#include <functional>

#include "solver/coupled_events.hpp"

namespace crashsim {

/// Why a motion ended.
enum class CoupledEnd { end_time, left_knot_range, unloading_too_soft, too_steep, step_limit, diverged };

struct CoupledSummary {
  CoupledEnd end = CoupledEnd::end_time;
  double t_m_s = kUnset, max_crush_m = kUnset, max_crush_force_n = kUnset;
  double separation_s = kUnset, static_crush_m = kUnset, rebound_velocity_mps = kUnset;
  std::array<double, 2> lift_off_s = {kUnset, kUnset};  ///< First time of front and rear axle.
  double end_time_s = 0.0;
  CoupledState last{};  ///< State at the end.
  CoupledMode mode;     ///< Mode at the end.
  long steps = 0, events = 0, rhs_evaluations = 0;
};

/// Called for every smooth piece: the step is valid from its `from` to `tau_end`.
using PieceVisitor = std::function<void(const CoupledMode& mode, const CoupledStep& step, double tau_end)>;

/// @param local_rtol relative tolerance of CVODE's local error. @throws SolverError.
CoupledSummary integrate_coupled(const CoupledProblem& problem, double end_time_s, double local_rtol,
                                 const PieceVisitor& on_piece);

}  // namespace crashsim
