#pragma once
/// Results as traces, to be compared.

#include <string>
#include <vector>

#include <crashsim/trace.hpp>

namespace crashsim {

struct CaseChannel {
  std::string name;
  Dimension dimension;
  std::vector<double> time_s, values;
};

/// A set of the channels that have values.
TraceSet trace_set(std::string path, std::vector<CaseChannel> channels);

}  // namespace crashsim
