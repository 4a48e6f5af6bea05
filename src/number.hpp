#pragma once
/// Numbers in text, correctly rounded and fast.

#include <cstdint>

#include "text.hpp"

namespace crashsim {

/// Any number std::from_chars knows (also `nan`, `inf`), with an optional `+`; too large or too small ones become
/// infinite or zero. Returns where it ends, `p` when there is none.
const char* scan_any_number(const char* p, const char* end, double& value);

/// As scan_any_number(). Short decimals, all that measurements need, take a quick way: up to 2^53 the digits are an
/// exact double and up to 10^22 so is the power of ten, so one multiplication or division rounds correctly.
inline const char* scan_number(const char* p, const char* end, double& value) {
  constexpr double kPowers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  constexpr int kLargestPower = 22;
  constexpr std::uint64_t kLargestExact = std::uint64_t{1} << 53;
  constexpr std::ptrdiff_t kDigitsThatFit = 19;

  const char* at = p;
  const bool negative = at != end && *at == '-';
  if (at != end && (*at == '-' || *at == '+')) ++at;
  std::uint64_t mantissa = 0;
  const auto read_digits = [&at, end](auto& into) {
    const char* first = at;
    for (; at != end && is_digit(*at); ++at) into = into * 10 + static_cast<unsigned>(*at - '0');
    return at - first;
  };
  std::ptrdiff_t digits = read_digits(mantissa), decimals = 0;
  if (at != end && *at == '.') ++at, decimals = read_digits(mantissa);
  digits += decimals;
  if (digits == 0 || digits > kDigitsThatFit || mantissa > kLargestExact) return scan_any_number(p, end, value);

  std::ptrdiff_t power = -decimals;
  if (at != end && (*at == 'e' || *at == 'E')) {
    const char* before = at++;
    const bool down = at != end && *at == '-';
    if (at != end && (*at == '-' || *at == '+')) ++at;
    unsigned exponent = 0;
    const std::ptrdiff_t exponent_digits = read_digits(exponent);
    if (exponent_digits > 3) return scan_any_number(p, end, value);
    if (exponent_digits == 0) at = before;
    power += down ? -static_cast<std::ptrdiff_t>(exponent) : static_cast<std::ptrdiff_t>(exponent);
  }
  if (power < -kLargestPower || power > kLargestPower) return scan_any_number(p, end, value);
  const auto exact = static_cast<double>(mantissa);
  const double size = power < 0 ? exact / kPowers[-power] : exact * kPowers[power];
  value = negative ? -size : size;
  return at;
}

}  // namespace crashsim
