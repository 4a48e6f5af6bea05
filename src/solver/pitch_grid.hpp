#pragma once
/// The times at which a heave and pitch simulation stops, with the force between them.

#include <span>
#include <string>
#include <vector>

#include <crashsim/simulate_pitch.hpp>

#include "solver/propagator.hpp"

namespace crashsim {

/// Knots of the force and output samples, merged. times[0] is the start, times.back() the end.
struct PitchGrid {
  std::vector<double> times;         ///< Strictly increasing [s].
  std::vector<ForcePiece> forces;    ///< Force per unit mass from times[i] to times[i + 1]; the last: at the end.
  std::vector<std::size_t> knots;    ///< Indices of the times at which the force changes its law; the last: the end.
  std::vector<std::size_t> samples;  ///< Index in times of each sample.
};

/// Times that differ by no more are the same: rounding of numbers as large as the end time.
double time_rounding(double start_s, double end_s);

/// @param samples output times, strictly increasing, from the start on; the last is the end.
/// @param longest_step_s longer ones are divided evenly.
PitchGrid make_grid(const HeavePitchModel& model, const PitchForcing& forcing, double start_s,
                    std::span<const double> samples, double longest_step_s);

LinearSystem linear_system(const HeavePitchModel& model);

/// What an integrator did.
struct PitchWork {
  PitchOutcome outcome = PitchOutcome::not_run;
  std::string message = {};
  SolverStatistics statistics = {};
};

/// States at the grid's times, from states[0] at the start: by the propagator, or by CVODE.
PitchWork integrate_by_propagator(const LinearSystem& system, const PitchGrid& grid, std::vector<PitchState>& states);
PitchWork integrate_by_cvode(const LinearSystem& system, const PitchGrid& grid, double rtol,
                             std::vector<PitchState>& states);

}  // namespace crashsim
