#pragma once
/// Output times of a simulation.

#include <string_view>
#include <vector>

namespace crashsim {

/// Uniform times from `first_s` and the end; the last interval may be shorter.
/// @param what names the interval in messages. @throws InvalidInput when there would be too many.
std::vector<double> output_times(double first_s, double end_s, double dt_s, std::string_view what);

}  // namespace crashsim
