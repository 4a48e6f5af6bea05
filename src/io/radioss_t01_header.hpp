#pragma once
/// What the binary time history of OpenRadioss says before its first state: the run, its parts and groups, and so the
/// channels and how a state is laid out.
///
/// The file is Fortran records of big-endian 4-byte words, each with its length before and after it. The header's are
/// the title with the number of the format; date and program; from format 3050 on the length of titles and the units;
/// counts; codes of the global variables; parts, materials, properties, subsets; groups of entities. Titles are as long
/// as their records say: 40, 80 or 100 characters by the version.

#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <crashsim/trace.hpp>

#include "io/unit_system.hpp"

namespace crashsim::io {

/// Big-endian words.
inline std::uint32_t big_endian_word(const char* p) {
  std::uint32_t word = 0;
  std::memcpy(&word, p, sizeof word);
  return std::endian::native == std::endian::big ? word : __builtin_bswap32(word);
}
inline float big_endian_float(const char* p) { return std::bit_cast<float>(big_endian_word(p)); }

/// One record of a state.
struct RadiossT01Record {
  std::string what;        ///< "time", "global variables", "group 'TH RWALL'".
  std::size_t values = 0;  ///< Of 4 bytes each.
};

struct RadiossT01Header {
  std::string title;
  std::vector<std::pair<std::string, std::string>> metadata;  ///< For TraceSet::metadata.
  std::optional<UnitSystem> units;                            ///< Where the file says them.
  std::vector<Trace> traces;                                  ///< In the order of the values of a state, after time.
  std::vector<RadiossT01Record> state;                        ///< The records of one state, time first.
  std::size_t bytes = 0;                                      ///< Where the first state starts.
};

/// Whether the bytes start as such a file does.
bool is_radioss_t01(std::string_view bytes);

/// @throws InvalidInput with path, byte and what was expected there.
RadiossT01Header read_radioss_t01_header(std::string_view bytes, const std::string& path);

}  // namespace crashsim::io
