#include "io/last_line.hpp"

#include <algorithm>
#include <cstddef>

#include "text.hpp"

namespace crashsim::io {
namespace {

constexpr std::size_t kEnoughLines = 20;

/// How a number is written: digits after its point and of its exponent.
struct Form {
  std::size_t decimals = 0, exponent_digits = 0;
  bool operator==(const Form&) const = default;
};

/// Of the last number of a line.
Form form_of(std::string_view line) {
  const std::string_view text = trimmed(line);
  const std::string_view number = text.substr(text.find_last_of(" \t,") + 1);
  const std::size_t exponent = std::min(number.find_first_of("eE"), number.size());
  const std::size_t point = number.find('.');
  Form form;
  if (point < exponent) form.decimals = exponent - point - 1;
  for (std::size_t i = exponent; i < number.size(); ++i) form.exponent_digits += is_digit(number[i]) ? 1U : 0U;
  return form;
}

}  // namespace

bool is_last_line_whole(std::string_view before, std::string_view last) {
  const Form form = form_of(last);
  if (form.decimals == 0 || form.exponent_digits == 1) return false;
  std::size_t lines = 0;
  while (!before.empty()) {
    const std::size_t end = std::min(before.find('\n'), before.size() - 1);
    const std::string_view line = trimmed(before.substr(0, end + 1));
    before.remove_prefix(end + 1);
    if (line.empty()) continue;
    if (form_of(line) != form) return false;
    ++lines;
  }
  return lines >= kEnoughLines;
}

}  // namespace crashsim::io
