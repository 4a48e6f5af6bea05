#pragma once
/// The channel files of an NHTSA test: `time<TAB>value` or one value a line, with or without lines of text before.

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include <crashsim/trace.hpp>

#include "io/nhtsa_header.hpp"

namespace crashsim::io {

/// The rows of a channel file.
struct NhtsaRows {
  std::vector<double> times, values;  ///< As in the file; no times when it has one value a line.
  bool last_is_dropped = false;       ///< The last line may be cut short, and is left out.
  std::string problem;                ///< What is wrong with the file, "" when nothing is.
};
NhtsaRows parse_nhtsa_rows(std::string_view text, const std::string& path);

/// Sample times by the header, shared between channels of one clock.
class NhtsaClocks {
 public:
  std::shared_ptr<const std::vector<double>> of(const NhtsaChannel& channel, std::size_t count);

 private:
  std::map<std::tuple<long, std::size_t, double>, std::shared_ptr<const std::vector<double>>> clocks_;
};

/// Fills in a trace's samples, or why they cannot be had.
void read_nhtsa_samples(const NhtsaChannel& channel, const std::string& path, NhtsaClocks& clocks, Trace& trace,
                        TraceSet& set);

}  // namespace crashsim::io
