#pragma once
/// Whether the last line of a text, which has no end, was cut short.

#include <string_view>

namespace crashsim::io {

/// Whether the last line must be whole: were its last number cut short, it would have other decimals or another
/// exponent than the last number of every line before it. Needs at least 20 such lines; a one-digit exponent proves
/// nothing, as it may be the first digit of two, nor does a number without decimals.
/// @param before the lines of numbers before it, each with its end; blank ones do not count.
bool is_last_line_whole(std::string_view before, std::string_view last);

}  // namespace crashsim::io
