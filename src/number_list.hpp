#pragma once
/// Numbers as people list them.

#include <string>
#include <string_view>
#include <vector>

namespace crashsim {

/// The numbers of a list, each with a unit or in SI; "0.5 m..0.7 m:5" are 5 of them, evenly spaced, ends included.
/// @param what names the list in messages. @throws InvalidInput when one is no number, or a range has no count.
std::vector<double> listed_numbers(const std::vector<std::string>& texts, std::string_view unit, std::string_view what);

}  // namespace crashsim
