#include "number.hpp"

#include <charconv>
#include <cmath>
#include <limits>

namespace crashsim {

const char* scan_any_number(const char* p, const char* end, double& value) {
  const char* first = p != end && *p == '+' && end - p > 1 && p[1] != '-' ? p + 1 : p;
  const auto [last, error] = std::from_chars(first, end, value);
  if (error == std::errc::invalid_argument) return p;
  if (error == std::errc::result_out_of_range) {
    const std::string text = to_lower({first, last});
    const double size = text.find("e-") != std::string::npos ? 0.0 : std::numeric_limits<double>::infinity();
    value = std::copysign(size, text.front() == '-' ? -1.0 : 1.0);
  }
  return last;
}

}  // namespace crashsim
