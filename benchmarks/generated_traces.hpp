#pragma once
/// Trace files of any size, as crash codes and laboratories write them, to time their reading.

#include <cstddef>
#include <string>

namespace crashsim::bench {

/// Each writes about `megabytes` into a folder and returns the path to read. Values are random, files well-formed.
std::string write_ev5(const std::string& folder, std::size_t megabytes);     ///< A test of many channel files.
std::string write_nodout(const std::string& folder, std::size_t megabytes);  ///< 500 nodes with rotations.
std::string write_binout(const std::string& folder, std::size_t megabytes);  ///< nodout of 500 nodes, single precision.
std::string write_csv_table(const std::string& folder, std::size_t megabytes);  ///< Time and 20 channels.

}  // namespace crashsim::bench
