#pragma once
/// Samples as a table that can be pasted into a report.

#include <string>
#include <vector>

#include <crashsim/sample_table.hpp>

namespace crashsim::cli {

/// Its lines: how many samples ended how, then a line an output: spread, and the input that drives it most.
std::vector<std::string> table_of(const SampleTable& table);

}  // namespace crashsim::cli
