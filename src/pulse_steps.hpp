#pragma once
/// The second part of making a pulse: offset, time zero, filter, direction, average.

#include <string>
#include <vector>

#include <crashsim/pulse.hpp>

#include "pulse_channels.hpp"

namespace crashsim {

/// Finds time zero and takes offsets off every channel. Returns time zero [s on the channels' clock].
/// @throws InvalidInput naming the file, the channel and the rule.
double set_zero(PulseChannels& channels, const PulseOptions& options, const std::string& path);

/// Filters every channel. @throws InvalidInput naming the file, the channel and the rule.
void filter(PulseChannels& channels, const PulseOptions& options, const std::string& path);

/// Turns channels whose axis points backward, so that the vehicle moves along +x before it hits.
void turn_forward(PulseChannels& channels, double t0_s, double speed_mps);

/// Mean of the channels, turned so that the vehicle moves along +x before it hits.
struct Average {
  std::vector<double> accel_mps2;
  double impact_speed_mps = kUnset;
};

/// @param speed_mps impact speed; unset: taken from velocity channels.
/// @throws InvalidInput when the speed is not known.
Average average_channels(PulseChannels& channels, double t0_s, double speed_mps, const std::string& path);

}  // namespace crashsim
