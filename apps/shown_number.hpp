#pragma once
/// Numbers as people read them: in the unit that their names end in, scaled.

#include <string>
#include <string_view>

namespace crashsim::cli {

/// How numbers of a name are shown.
struct Shown {
  std::string_view suffix;
  double factor;  ///< From SI.
  std::string_view unit;
};

/// How numbers of a name are shown: "max_crush_m" in mm; as they are when the name ends in no unit.
Shown shown_as(std::string_view name);

/// "823.24 mm"; "-" when unset.
std::string shown_number(std::string_view name, double value);

}  // namespace crashsim::cli
