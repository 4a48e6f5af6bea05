#pragma once
/// Fingerprints of bytes in memory.

#include <string>
#include <string_view>

namespace crashsim {

/// SHA-256 as 64 hexadecimal digits.
std::string sha256_of(std::string_view bytes);

}  // namespace crashsim
