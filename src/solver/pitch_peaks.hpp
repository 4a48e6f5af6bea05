#pragma once
/// Largest pitch, smallest heave and smallest heave velocity of a motion, found between the grid's times.

#include <span>

#include <crashsim/error.hpp>

#include "solver/pitch_grid.hpp"

namespace crashsim {

struct Peak {
  double time_s = kUnset, value = kUnset;
};
struct PitchPeaks {
  Peak pitch_max, heave_min, heave_velocity_min;
};

/// @param states, accelerations at the grid's times, whose steps are short against the motion.
PitchPeaks find_peaks(const LinearSystem& system, const PitchGrid& grid, std::span<const PitchState> states,
                      std::span<const Eigen::Vector2d> accelerations);

}  // namespace crashsim
