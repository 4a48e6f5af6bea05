#include "io/lsdyna_text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "number.hpp"
#include "text.hpp"

namespace crashsim::io {
namespace {

constexpr std::string_view kLegendStart = "{BEGIN LEGEND", kLegendEnd = "{END LEGEND}";
constexpr std::string_view kDate = " date ";

bool is_sign(char c) { return c == '-' || c == '+'; }

/// LSTC's l2a leaves out the brace at the end.
bool starts_legend(std::string_view line) { return trimmed(line).starts_with(kLegendStart); }

/// Where an exponent without its E ends: a sign and three digits, of which no further number can begin.
const char* end_of_bare_exponent(const char* p, const char* end) {
  constexpr std::ptrdiff_t kLength = 4;
  if (end - p < kLength || !is_sign(*p) || !std::all_of(p + 1, p + kLength, is_digit)) return p;
  const char* after = p + kLength;
  return after != end && (is_digit(*after) || *after == '.') ? p : after;
}

}  // namespace

bool CompleteLines::next(std::string_view& line) {
  const std::size_t end = text_.find('\n', next_);
  if (end == std::string_view::npos) return false;
  offset_ = std::exchange(next_, end + 1);
  line = text_.substr(offset_, end - offset_);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return true;
}

std::size_t scan_fortran(std::string_view text, double& value) {
  if (text.starts_with('*')) {
    value = std::numeric_limits<double>::quiet_NaN();
    return std::min(text.find_first_not_of('*'), text.size());
  }
  const char *p = text.data(), *const end = p + text.size();
  const char* last = scan_number(p, end, value);
  if (last == p) return 0;
  if (const char* after = end_of_bare_exponent(last, end); after != last) {
    const std::string_view mantissa(p, static_cast<std::size_t>(last - p));
    if (mantissa.find('.') != std::string_view::npos && mantissa.find_first_of("eE") == std::string_view::npos) {
      const std::string number = std::string(mantissa) + 'E' + std::string(last, after);
      scan_number(number.data(), number.data() + number.size(), value);
      last = after;
    }
  }
  if (!std::isfinite(value)) value = std::numeric_limits<double>::quiet_NaN();
  return static_cast<std::size_t>(last - p);
}

bool is_fortran_number(std::string_view text, double& value) {
  text = trimmed(text);
  return !text.empty() && scan_fortran(text, value) == text.size();
}

std::size_t scan_numbers(std::string_view text, std::span<double> numbers) {
  text = trimmed(text);
  for (std::size_t count = 0;; ++count) {
    if (text.empty()) return count;
    if (count == numbers.size()) return 0;
    const std::size_t length = scan_fortran(text, numbers[count]);
    text.remove_prefix(length);
    const bool has_end = text.empty() || is_blank(text[0]) || is_sign(text[0]) || text[0] == '*';
    if (length == 0 || !has_end) return 0;
    text = trimmed(text);
  }
}

std::string snake_case(std::string_view label) {
  std::string name;
  for (const char c : label) {
    const char small = lower(c);
    if (is_digit(small) || (small >= 'a' && small <= 'z'))
      name += small;
    else if (!name.empty() && name.back() != '_')
      name += '_';
  }
  if (name.ends_with('_')) name.pop_back();
  return name;
}

std::string_view LsdynaHeader::title_of(std::string_view entity) const {
  const auto found = legend.find(entity);
  return found == legend.end() ? std::string_view() : found->second;
}

bool is_version_line(std::string_view line) {
  return trimmed(line).starts_with("ls-dyna") && line.find(kDate) != std::string_view::npos;
}

std::size_t end_of_legend(std::string_view text, const CompleteLines& lines, std::string_view line) {
  if (!starts_legend(line)) return std::string_view::npos;
  CompleteLines rest(text, lines.position());
  for (std::string_view next; rest.next(next) && !starts_legend(next) && !is_version_line(next);)
    if (trimmed(next) == kLegendEnd) return rest.offset();
  return std::string_view::npos;
}

LsdynaHeader parse_lsdyna_header(std::string_view text, std::size_t states) {
  LsdynaHeader header;
  text = text.substr(0, states);
  CompleteLines lines(text, 0);
  bool in_legend = false;
  std::string_view before;
  for (std::string_view line; lines.next(line); before = line) {
    const std::string_view words = trimmed(line);
    if (starts_legend(line) || words == kLegendEnd) {
      in_legend = words != kLegendEnd;
    } else if (in_legend && !words.empty() && is_digit(words.front())) {
      const std::size_t end = std::min(words.find_first_not_of("0123456789"), words.size());
      header.legend.emplace(words.substr(0, end), trimmed(words.substr(end)));
    } else if (header.version.empty() && is_version_line(line)) {
      const std::size_t date = words.rfind(kDate);
      header.title = trimmed(before);
      header.version = trimmed(words.substr(0, date));
      if (date != std::string_view::npos) header.date = trimmed(words.substr(date + kDate.size()));
    }
  }
  return header;
}

}  // namespace crashsim::io
