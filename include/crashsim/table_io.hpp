#pragma once
/// Writing time series as CSV: `#` comments, one header row, numbers that read back as the same doubles.

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace crashsim {

/// One column: a name with its unit suffix ("velocity_mps") and its cells.
struct Column {
  std::string name;
  std::span<const double> values;
};

/// Lines `# key = value` before the header.
using Comments = std::vector<std::pair<std::string, std::string>>;

/// The text of a CSV file; NaN makes an empty cell. @throws InvalidInput when the columns' lengths differ.
std::string format_csv(const Comments& comments, const std::vector<Column>& columns);

/// Writes format_csv() to a file, whole or not at all, or to standard output when `path` is "-".
/// @throws InvalidInput when the file exists and `overwrite` is false; SystemFailure when it cannot be written.
void write_csv(const std::string& path, const Comments& comments, const std::vector<Column>& columns,
               bool overwrite = false);

}  // namespace crashsim
