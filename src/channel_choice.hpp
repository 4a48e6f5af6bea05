#pragma once
/// Channels of a file that options name, checked so that numbers can be made of them.

#include <string>
#include <vector>

#include <crashsim/trace.hpp>

namespace crashsim {

/// "force.csv: channel 3 FTZ", for messages.
std::string channel_label(const TraceSet& set, const Trace& trace);

/// Channels that selectors name, in their order, each once. @throws InvalidInput naming file and channel when there is
/// none, or it is flagged bad or has no proper samples.
std::vector<const Trace*> chosen_channels(const TraceSet& set, const std::vector<std::string>& selectors);

}  // namespace crashsim
