#pragma once
/// Messages for people.

#include <cstddef>
#include <string>
#include <string_view>

namespace crashsim {

/// A text without its middle when it is longer: a name of a megabyte in a message helps nobody.
std::string shortened(std::string_view text, std::size_t longest);

}  // namespace crashsim
