#pragma once
/// Output times of a simulation.

#include <string_view>
#include <vector>

namespace crashsim {

inline constexpr double kDefaultEnd_s = 0.2;  ///< Of a crush: longer than any frontal crash.

/// @throws InvalidInput when given times do not increase from >= 0 to an end > 0. `what` names them.
void check_output_times(const std::vector<double>& times_s, std::string_view what);

/// Uniform times from `first_s` and the end; the last interval may be shorter.
/// @param what names the interval in messages. @throws InvalidInput when there would be too many.
std::vector<double> output_times(double first_s, double end_s, double dt_s, std::string_view what);

}  // namespace crashsim
