#pragma once
/// The first part of making a pulse: channels picked, checked and brought onto one uniform clock.

#include <string>
#include <vector>

#include <crashsim/pulse.hpp>
#include <crashsim/trace.hpp>

namespace crashsim {

/// One channel on the common clock.
struct PulseChannel {
  std::string label;  ///< "93 LEFT REAR SEAT CROSSMEMBER X".
  std::vector<double> values;
};

/// Channels of one dimension on one uniform clock, and what was done to get there.
struct PulseChannels {
  std::vector<double> time_s;
  double dt_s = kUnset;
  Dimension dimension = Dimension::unknown;  ///< acceleration or speed.
  std::vector<PulseChannel> channels;
  std::vector<std::string> steps, warnings;
};

/// Indices of the channels to use when nobody names any: those of the compartment, else the only acceleration, else the
/// only velocity; empty when that decides nothing.
std::vector<std::size_t> default_channels(const TraceSet& set);

/// Picks the channels that `options` name (or the default ones), checks them and resamples where their clocks are not
/// uniform or not the same. @throws InvalidInput naming file, channel and rule.
PulseChannels prepare_channels(const TraceSet& set, const PulseOptions& options);

}  // namespace crashsim
