#pragma once
/// The names a mistyped one may have meant, for messages.

#include <string>
#include <string_view>
#include <vector>

namespace crashsim {

/// Fewest letters to insert, delete or replace that make one text of the other.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// Up to `count` candidates in order of likeness: fewest edits, letter case ignored; a candidate that contains the text
/// counts as near.
std::vector<std::string> nearest(std::string_view text, const std::vector<std::string>& candidates, std::size_t count);

}  // namespace crashsim
