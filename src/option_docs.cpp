#include <crashsim/option_docs.hpp>

#include <cmath>

namespace crashsim {
namespace {

template <class T>
std::string joined(const std::vector<T>& items) {
  std::string text;
  for (const T& item : items) {
    if (!text.empty()) text += ',';
    if constexpr (std::is_same_v<T, double>)
      text += format_number(item);
    else
      text += item;
  }
  return text;
}

}  // namespace

std::string text_of(const OptionValue& value) {
  return std::visit(
      [](const auto& held) -> std::string {
        using T = std::decay_t<decltype(held)>;
        if constexpr (std::is_same_v<T, std::monostate>)
          return "";
        else if constexpr (std::is_same_v<T, bool>)
          return held ? "true" : "false";
        else if constexpr (std::is_same_v<T, double>)
          return format_number(held);
        else if constexpr (std::is_same_v<T, std::int64_t>)
          return std::to_string(held);
        else if constexpr (std::is_same_v<T, std::string>)
          return held;
        else
          return joined(held);
      },
      value);
}

std::string text_of(const Range& range) {
  std::string text;
  if (std::isfinite(range.min)) text = (range.open_min ? "> " : ">= ") + format_number(range.min);
  if (std::isfinite(range.max)) text += (text.empty() ? "<= " : " and <= ") + format_number(range.max);
  return text;
}

}  // namespace crashsim
