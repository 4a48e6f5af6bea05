#pragma once
/// Numbers of a heave-pitch model that are sought, and the range in which they are.

#include <string>
#include <vector>

#include <crashsim/identify_pitch.hpp>

#include "optimize/sought_numbers.hpp"

namespace crashsim {

using PitchParameter = SoughtNumber<HeavePitchModel>;

/// Reads options.free with its bounds. Notes in `warnings` where the given model lies outside.
/// @throws InvalidInput naming the name or bound that is not allowed.
std::vector<PitchParameter> pitch_parameters(const HeavePitchModel& guess, const IdentifyPitchOptions& options,
                                             std::vector<std::string>& warnings);

}  // namespace crashsim
