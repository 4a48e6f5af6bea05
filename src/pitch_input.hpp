#pragma once
/// What must hold of a heave-pitch model, its forcing and its options together.

#include <string>
#include <vector>

#include <crashsim/simulate_pitch.hpp>

#include "solver/propagator.hpp"

namespace crashsim {

/// @throws InvalidInput when a series is bad or the model lacks what the forcing needs.
void check_pitch_input(const HeavePitchModel& model, const PitchForcing& forcing);

/// Time at which the motion starts [s]. @throws InvalidInput when the rule needs what is not there.
double start_of_motion(const PitchForcing& forcing, const PitchOptions& options);

/// State in which the motion starts. @throws InvalidInput when the residual energy comes with initial rates, or the
/// model lacks the arm it needs.
PitchState initial_state(const HeavePitchModel& model, const PitchOptions& options);

/// What a careful reader should know of a simulation from start to end.
std::vector<std::string> notes_on_pitch_input(const HeavePitchModel& model, const PitchForcing& forcing,
                                              const PitchOptions& options, double start_s, double end_s);

}  // namespace crashsim
