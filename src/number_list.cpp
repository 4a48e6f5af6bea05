#include "number_list.hpp"

#include <fmt/format.h>

#include <crashsim/option_values.hpp>

namespace crashsim {
namespace {

void append_numbers(std::string_view text, std::string_view unit, const std::string& what,
                    std::vector<double>& numbers) {
  const auto number = [&](std::string_view part) { return detail::to_number(std::string(part), unit, what); };
  const std::size_t dots = text.find(".."), colon = text.rfind(':');
  if (dots == std::string_view::npos) {
    numbers.push_back(number(text));
    return;
  }
  constexpr Range kCount = between(2, 1000);
  if (colon == std::string_view::npos || colon < dots)
    throw InvalidInput(fmt::format("{} = '{}': a range needs a count: \"0.5..0.7:5\"", what, text));
  const double first = number(text.substr(0, dots)), last = number(text.substr(dots + 2, colon - dots - 2));
  const auto count = static_cast<double>(detail::to_integer(std::string(text.substr(colon + 1)), what + " count"));
  if (!detail::in_range(count, kCount)) detail::throw_out_of_range(what + " count", count, "", kCount);
  for (int i = 0; i < static_cast<int>(count); ++i) numbers.push_back(first + (last - first) * i / (count - 1.0));
}

}  // namespace

std::vector<double> listed_numbers(const std::vector<std::string>& texts, std::string_view unit,
                                   std::string_view what) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < texts.size(); ++i)
    append_numbers(texts[i], unit, fmt::format("{}[{}]", what, i), numbers);
  return numbers;
}

}  // namespace crashsim
