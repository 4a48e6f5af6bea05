#pragma once
/// For files of random numbers, which no vehicle would have.

#include <string>
#include <utility>
#include <vector>

#include <crashsim/trace.hpp>

namespace crashsim::test {

/// A set without the warnings that its units may be others, because of the sizes of its numbers.
inline TraceSet without_unit_warnings(TraceSet set) {
  std::erase_if(set.warnings, [](const std::string& warning) {
    return warning.find("too much for a vehicle") != std::string::npos ||
           warning.find("too long for a crash") != std::string::npos;
  });
  return set;
}

}  // namespace crashsim::test
