#pragma once
/// Encodings of text that files do not declare.

#include <string>
#include <string_view>

namespace crashsim::io {

/// The text as UTF-8: as it is where it is valid UTF-8, else taken as Windows-1252, of which Latin-1 is a part.
std::string to_utf8(std::string_view text);

}  // namespace crashsim::io
