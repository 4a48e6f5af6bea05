#pragma once
/// A comparison as a table that can be pasted into a report.

#include <string>
#include <vector>

#include <crashsim/comparison.hpp>

namespace crashsim::cli {

/// Its lines: range, header, one line a channel, and why a channel has no rating.
std::vector<std::string> table_of(const Comparison& comparison);

}  // namespace crashsim::cli
