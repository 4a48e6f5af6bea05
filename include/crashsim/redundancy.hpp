#pragma once
/// Channels that should say the same: redundant beside primary sensors, and the two sides of the compartment.

#include <string>
#include <vector>

#include <crashsim/trace.hpp>

namespace crashsim {

/// When two channels are said to differ. Signals are filtered by CFC60 where their rate allows, and compared without
/// their means before time 0.
inline constexpr double kSameSignal = 0.10;  ///< Root mean square of the difference, of the primary's.
inline constexpr double kSameOffset = 0.02;  ///< Means before time 0, of the primary's largest value.
inline constexpr double kSameTime_s = 1e-3;  ///< Shift at which they agree best [s], looked for within 10 ms.
inline constexpr double kSameDeltaV = 0.05;  ///< Changes of speed over 150 ms from time 0, of the larger one.

/// What differs, one sentence a finding: each redundant channel (CHSTAT R) against the primary one of the same vehicle,
/// seat, sensor, place, axis and unit, of several the one with the same comment; and the longitudinal channels of the
/// compartment against each other by their change of speed. Only channels that were read and are not flagged bad are
/// compared.
std::vector<std::string> check_redundant(const TraceSet& set);

}  // namespace crashsim
