#pragma once
/// The ASCII databases of LS-DYNA: "nodout", "rcforc", "glstat" and others, one in each file.

#include <span>
#include <string>
#include <string_view>

#include "io/lsdyna_slots.hpp"
#include "io/lsdyna_text.hpp"
#include "io/reader.hpp"
#include "io/unit_system.hpp"

namespace crashsim::io {

/// An opened file of a database.
struct LsdynaInput {
  std::string_view text;
  LsdynaHeader header;
  std::size_t states = 0;  ///< Where the preamble ends in the text.
  UnitSystem units;
};

struct LsdynaDatabase {
  std::string_view name;
  /// Whether a line, without blanks at its ends, can only be of this database.
  bool (*marks)(std::string_view line);
  /// Adds the traces and reads the chosen ones. @throws InvalidInput when there is no whole state.
  void (*read)(const LsdynaInput& input, TraceSet& set, const Choose& choose);
};

extern const LsdynaDatabase kNodout, kRcforc, kRwforc, kSecforc, kRbdout, kGlstat, kMatsum;

/// How a database that is no table of fixed columns is read.
struct LsdynaLines {
  /// Finds the values of the lines.
  void (*parse)(CompleteLines& lines, LsdynaSlots& slots);
  Trace (*describe)(LsdynaSlot slot, const LsdynaHeader& header);
};
void read_lsdyna_lines(const LsdynaLines& database, const LsdynaInput& input, TraceSet& set, const Choose& choose);

/// LsdynaDatabase::read of such a database.
template <auto Parse, auto Describe>
void read_lines(const LsdynaInput& input, TraceSet& set, const Choose& choose) {
  read_lsdyna_lines({Parse, Describe}, input, set, choose);
}

}  // namespace crashsim::io
