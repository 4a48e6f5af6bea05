#include "case_traces.hpp"

#include <memory>
#include <utility>

namespace crashsim {

TraceSet trace_set(std::string path, std::vector<CaseChannel> channels) {
  TraceSet set;
  set.path = std::move(path);
  for (CaseChannel& channel : channels) {
    if (channel.values.empty()) continue;
    Trace trace;
    trace.name = std::move(channel.name);
    trace.id = std::to_string(set.traces.size() + 2);
    trace.dimension = channel.dimension;
    trace.time_s = std::make_shared<const std::vector<double>>(std::move(channel.time_s));
    trace.values = std::move(channel.values);
    set.traces.push_back(std::move(trace));
  }
  return set;
}

}  // namespace crashsim
