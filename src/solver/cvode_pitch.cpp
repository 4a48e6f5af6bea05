#include <array>
#include <cmath>

#include <fmt/format.h>

#include "solver/cvode.hpp"
#include "solver/pitch_grid.hpp"

namespace crashsim {
namespace {

constexpr long kMostStepsPerPiece = 100'000;
constexpr double kAbsolutePerRelative = 1e-3;  // absolute tolerance, per relative one and scale of the motion

using ConstState = Eigen::Map<const PitchState>;

/// Absolute tolerances from how fast and far the force and the initial state can move the body.
std::array<double, 4> absolute_tolerances(const PitchGrid& grid, const PitchState& initial, double rtol) {
  const double duration = grid.times.back() - grid.times.front();
  Eigen::Vector2d rate = initial.tail<2>().cwiseAbs() + initial.head<2>().cwiseAbs() / duration;
  for (std::size_t i = 0; i + 1 < grid.times.size(); ++i)
    rate += grid.forces[i].col(0).cwiseAbs() * (grid.times[i + 1] - grid.times[i]);
  rate = rate.cwiseMax(rate.maxCoeff() * kAbsolutePerRelative) * kAbsolutePerRelative * rtol;
  return {rate[0] * duration, rate[1] * duration, rate[0], rate[1]};
}

/// States from one knot of the force to the next, where the integrator stops and starts anew.
void run_piece(Cvode& cvode, const PitchGrid& grid, std::size_t knot, std::vector<PitchState>& states,
               PitchWork& work) {
  std::size_t at = grid.knots[knot];
  const std::size_t last = grid.knots[knot + 1];
  cvode.start(grid.times[at], {states[at].data(), 4});
  cvode.set_stop_time(grid.times[last]);
  for (long steps = 0; at < last; ++steps, ++work.statistics.steps) {
    if (steps == kMostStepsPerPiece) {
      work.outcome = PitchOutcome::step_limit;
      work.message = fmt::format("CVODE needs more than {} steps after t = {:.6g} s: loosen rtol or use the propagator",
                                 kMostStepsPerPiece, grid.times[at]);
      return;
    }
    const double reached = cvode.step();
    for (; at < last && grid.times[at + 1] <= reached; ++at)
      states[at + 1] = ConstState(cvode.derivative(grid.times[at + 1], 0).data());
  }
}

}  // namespace

PitchWork integrate_by_cvode(const LinearSystem& system, const PitchGrid& grid, double rtol,
                             std::vector<PitchState>& states) {
  std::size_t knot = 0;
  Cvode cvode(4, [&](double t, const double* y, double* ydot) {
    const std::size_t at = grid.knots[knot];
    const ConstState state(y);
    Eigen::Map<PitchState> rate(ydot);
    rate << state.tail<2>(), system.acceleration(state, value(grid.forces[at], t - grid.times[at]));
  });
  cvode.set_tolerances(rtol, absolute_tolerances(grid, states[0], rtol));
  states.resize(grid.times.size());
  PitchWork work{.outcome = PitchOutcome::completed};
  try {
    for (; knot + 1 < grid.knots.size() && work.outcome == PitchOutcome::completed; ++knot)
      run_piece(cvode, grid, knot, states, work);
  } catch (const SolverError& error) {
    work.outcome = PitchOutcome::failed;
    work.message = error.what();
  }
  work.statistics.force_evaluations = cvode.rhs_evaluations();
  return work;
}

}  // namespace crashsim
