#pragma once
/// Headers of ISO-MME files (ISO/TS 13499): lines of a name, padded to 28 characters, a colon and a value.

#include <string>
#include <string_view>
#include <vector>

namespace crashsim::io {

/// Which file of a test a text is: TEST.mme, TEST.chn or TEST.001; none when it is of another format.
enum class IsoMmeFile { none, test, channel_list, channel };

/// Tells by the names in its first lines; `path` only decides for a TEST.mme whose names are unusual.
IsoMmeFile iso_mme_file(std::string_view text, const std::string& path);

/// One line: name with single blanks, value as UTF-8.
struct IsoMmeLine {
  std::string name, value;
  bool whole = true;  ///< False where the file ends within the line.
};

/// The lines of a header, and where the samples after it start.
struct IsoMmeHeader {
  std::vector<IsoMmeLine> lines;
  std::size_t data_offset = 0,
              data_line = 0;  ///< Offset of the first sample, and its line, from 1; past the end: none.

  /// The first value of that name, ignoring case; "" when there is none or it is NOVALUE.
  [[nodiscard]] std::string_view value(std::string_view name) const;
  /// The first value as a number; kUnset when there is none, it is no number, or the file ends within it.
  [[nodiscard]] double number(std::string_view name) const;
};

/// @param has_samples whether a line that is a sample ends the header, as in channel files.
/// @throws InvalidInput with path and reason when it is UTF-16 or far longer than any header.
IsoMmeHeader parse_iso_mme_header(std::string_view text, const std::string& path, bool has_samples);

/// Whether a value says that there is none: empty or NOVALUE.
bool is_no_value(std::string_view value);

}  // namespace crashsim::io
