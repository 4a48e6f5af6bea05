#pragma once
/// Reading traces: one function for every format, told apart by their content.

#include <string>
#include <vector>

#include <crashsim/trace.hpp>

namespace crashsim {

/// What to read and how to understand it.
struct ReadOptions {
  std::vector<std::string>
      channels;         ///< Selectors as in select_channels(); samples of others are not kept. Empty: all.
  std::string columns;  ///< For CSV without header, or to correct one: "time:ms,accel:g", in column order.
  std::string units;    ///< Unit system of FE output: "kg-m-s", "t-mm-s", "kg-mm-ms", "g-mm-ms"; "" when files say it.
};

/// Reads a file in any supported format (detected from its content, then its name) into SI units.
/// @throws InvalidInput naming file, line and channel when it is missing, of no known format, or would give wrong
/// numbers.
TraceSet read_traces(const std::string& path, const ReadOptions& options = {});

/// One line of `crashsim info`: a channel without its samples.
struct ChannelInfo {
  std::string id, name, database, location;
  std::string unit;    ///< SI symbol, or the file's own when it is unknown.
  std::string status;  ///< "ok" or why not.
  char axis = ' ';
  std::size_t samples = 0;
  double first_s = kUnset, last_s = kUnset;  ///< Time range [s].
  double rate_hz = kUnset;                   ///< Sampling rate [Hz]; mean rate when steps are not uniform.
  bool uniform = true;                       ///< Whether the time steps are uniform.
  double min = kUnset, max = kUnset;         ///< Range of the samples [SI].
};

/// What a file holds, with the channels described but no samples kept.
struct TraceFileInfo {
  TraceSet set;                       ///< `traces` is empty.
  std::vector<ChannelInfo> channels;  ///< Those that the options choose.
};

/// Describes a file, in one pass over it. @throws InvalidInput as read_traces().
TraceFileInfo inspect_traces(const std::string& path, const ReadOptions& options = {});

}  // namespace crashsim
