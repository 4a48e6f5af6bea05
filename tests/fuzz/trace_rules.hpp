#pragma once
/// What holds for the traces of any file.

#include <cstdlib>

#include <crashsim/trace.hpp>

namespace crashsim::fuzz {

inline void require(bool holds) {
  if (!holds) std::abort();
}

/// Samples have as many times, which never decrease unless the trace's `problem` says so.
inline void check_traces(const TraceSet& set) {
  for (const Trace& trace : set.traces) {
    if (!trace.has_samples) continue;
    require(trace.times().size() == trace.values.size());
    if (!trace.problem.empty()) continue;
    for (std::size_t i = 1; i < trace.values.size(); ++i) require(trace.times()[i] >= trace.times()[i - 1]);
  }
}

}  // namespace crashsim::fuzz
