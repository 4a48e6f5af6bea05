#pragma once
/// Delimited text as it comes: how a file is laid out, and its columns of numbers.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <crashsim/trace.hpp>

namespace crashsim::io {

/// How a delimited text file is laid out.
struct CsvLayout {
  char separator = ',';            ///< ',', ';', tab, or ' ' for runs of blanks.
  std::size_t columns = 0;         ///< Cells of the first row of numbers.
  std::vector<std::string> names;  ///< Header cells, unquoted; empty when there is no header that fits.
  std::vector<std::string> units;  ///< Cells of a row of units under the header, unbracketed, if there is one.
  std::vector<std::pair<std::string, std::string>> comments;  ///< `# key = value` lines.
  std::size_t odd_line = 0;            ///< Line just before the numbers that fits no header (its number), 0 when none.
  std::vector<std::string> odd_names;  ///< Its cells.
  std::size_t data_offset = 0;         ///< Where the first row of numbers starts in the text.
  std::size_t data_line = 0;           ///< Its line number, from 1.
};

/// Finds the first row of at least two numbers and what stands before it; empty when there is none within the first
/// lines, or the text is binary. Of a row with more cells than most_channels() only one more is counted.
std::optional<CsvLayout> find_layout(std::string_view text);

/// Reads the wanted columns; the others stay empty. Empty cells are NaN. With any separator but ',' a decimal comma is
/// understood.
/// @param time_column its numbers must increase.
/// @throws InvalidInput with path and line when a row has too few or too many cells, a wanted cell is
///         no number, or time does not increase.
std::vector<std::vector<double>> read_columns(std::string_view text, const CsvLayout& layout,
                                              const std::vector<bool>& wanted, std::size_t time_column,
                                              const std::string& path);

/// Warns when the last line has no end: a file cut off within its last number looks like one that ends there.
void warn_when_open_ended(std::string_view text, TraceSet& set);

}  // namespace crashsim::io
