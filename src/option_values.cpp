#include <crashsim/option_values.hpp>

#include <algorithm>
#include <charconv>
#include <limits>

#include <fmt/format.h>

#include "nearest.hpp"
#include "text.hpp"

namespace crashsim {
namespace {

std::string kind_of(const OptionValue& value) {
  static constexpr std::string_view kNames[] = {"nothing", "true or false",     "a whole number", "a number",
                                                "text",    "a list of numbers", "a list of texts"};
  return std::string(kNames[value.index()]);
}

[[noreturn]] void throw_kind(std::string_view what, std::string_view wanted, const OptionValue& value) {
  throw InvalidInput(fmt::format("{}: must be {}, not {}", what, wanted, kind_of(value)));
}

std::vector<std::string> listed(std::string_view text) {
  const auto parts = split(text, ',');
  return {parts.begin(), parts.end()};
}

Dimension dimension_of_field(std::string_view unit) { return unit.empty() ? Dimension::none : dimension_of(unit); }

}  // namespace

std::string_view nearest_name(std::string_view name, const std::vector<std::string_view>& valid) {
  constexpr std::size_t kFewestLetters = 3;  // "mass" of "mass_kg"
  constexpr std::size_t kMostLetters = 200;  // nobody meant a name of this with more
  if (name.size() > kMostLetters) return {};
  std::string_view best;
  std::size_t best_distance = std::max<std::size_t>(name.size() / 2, 2) + 1;
  for (const std::string_view candidate : valid) {
    const bool lacks_unit = name.size() >= kFewestLetters && candidate.find(name) != std::string_view::npos;
    const std::size_t distance = lacks_unit ? 1 : edit_distance(name, candidate);
    if (distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

namespace detail {

bool in_range(double value, const Range& range) {
  if (!(value <= range.max) && range.max < std::numeric_limits<double>::infinity()) return false;
  return std::isfinite(value) && (range.open_min ? value > range.min : value >= range.min);
}

void throw_out_of_range(std::string_view what, double value, std::string_view unit, const Range& range) {
  const std::string with_unit = unit.empty() ? format_number(value) : fmt::format("{} {}", format_number(value), unit);
  std::string rule = "must be finite";
  if (std::isfinite(range.max))
    rule = fmt::format("must be {} {} and <= {}", range.open_min ? ">" : ">=", format_number(range.min),
                       format_number(range.max));
  else if (std::isfinite(range.min))
    rule = fmt::format("must be {} {}", range.open_min ? ">" : ">=", format_number(range.min));
  throw InvalidInput(fmt::format("{} = {}: {}", what, with_unit, rule));
}

void throw_not_set(std::string_view what, std::string_view why, std::string_view doc, std::string_view unit) {
  throw InvalidInput(fmt::format("{} is not set{}{}: give the {}{}{}", what, why.empty() ? "" : " but ", why, doc,
                                 unit.empty() ? "" : " in ", unit));
}

double to_number(const OptionValue& value, std::string_view unit, std::string_view what) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* number = std::get_if<std::int64_t>(&value)) return static_cast<double>(*number);
  if (const auto* text = std::get_if<std::string>(&value)) return quantity(*text, dimension_of_field(unit), what);
  throw_kind(what, unit.empty() ? "a number" : fmt::format("a number in {} or text with a unit", unit), value);
}

std::int64_t to_integer(const OptionValue& value, std::string_view what) {
  if (const auto* number = std::get_if<std::int64_t>(&value)) return *number;
  if (const auto* text = std::get_if<std::string>(&value)) {
    std::int64_t whole = 0;  // every digit counts in a seed
    const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), whole);
    if (error == std::errc() && end == text->data() + text->size()) return whole;
  }
  const double number = to_number(value, "", what);
  constexpr double kLargest = 9007199254740992.0;  // 2^53: beyond it doubles skip whole numbers
  if (number != std::floor(number))
    throw InvalidInput(fmt::format("{} = {}: must be a whole number", what, format_number(number)));
  if (std::fabs(number) > kLargest)
    throw InvalidInput(fmt::format("{} = {}: is too large for a whole number", what, format_number(number)));
  return static_cast<std::int64_t>(number);
}

bool to_bool(const OptionValue& value, std::string_view what) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag;
  if (const auto* text = std::get_if<std::string>(&value)) {
    if (*text == "true") return true;
    if (*text == "false") return false;
  }
  throw_kind(what, "true or false", value);
}

std::string to_text(const OptionValue& value, std::string_view what) {
  if (std::holds_alternative<std::monostate>(value)) return {};
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  throw_kind(what, "text", value);
}

std::vector<double> to_numbers(const OptionValue& value, std::string_view unit, std::string_view what) {
  if (const auto* numbers = std::get_if<std::vector<double>>(&value)) return *numbers;
  std::vector<std::string> parts;
  if (const auto* texts = std::get_if<std::vector<std::string>>(&value))
    parts = *texts;
  else if (const auto* text = std::get_if<std::string>(&value))
    parts = listed(*text);
  else
    return {to_number(value, unit, what)};
  std::vector<double> numbers;
  for (const std::string& part : parts) numbers.push_back(to_number(part, unit, what));
  return numbers;
}

std::vector<std::string> to_texts(const OptionValue& value, std::string_view what) {
  if (std::holds_alternative<std::monostate>(value)) return {};
  if (const auto* texts = std::get_if<std::vector<std::string>>(&value)) return *texts;
  if (const auto* text = std::get_if<std::string>(&value)) return listed(*text);
  std::vector<std::string> texts;
  if (const auto* number = std::get_if<std::int64_t>(&value)) return {fmt::format("{}", *number)};
  if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
    for (const double number : *numbers) texts.push_back(format_number(number));
    return texts;
  }
  throw_kind(what, "text or a list of texts", value);
}

int to_choice(const OptionValue& value, std::span<const std::string_view> names, std::span<const NameAlias> aliases,
              std::string_view what) {
  const std::string text = to_text(value, what);
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == text) return static_cast<int>(i);
  for (const NameAlias& alias : aliases)
    if (alias.alias == text) return alias.value;
  throw_unknown_name(what, text, {names.begin(), names.end()});
}

int to_setting(const OptionValue& value, std::span<const std::string_view> names, std::string_view unit,
               std::string_view what, std::vector<double>& numbers) {
  const auto rules = names.first(names.size() - 1);
  if (const auto* text = std::get_if<std::string>(&value)) {
    numbers.clear();
    for (std::size_t i = 0; i < rules.size(); ++i)
      if (rules[i] == *text) return static_cast<int>(i);
    const bool is_numeric = text->find_first_of("0123456789") != std::string::npos;
    if (!is_numeric) {
      throw InvalidInput(fmt::format("{} = '{}': must be {} or numbers{}", what, *text, fmt::join(rules, ", "),
                                     unit.empty() ? "" : fmt::format(" in {}", unit)));
    }
  }
  numbers = to_numbers(value, unit, what);
  for (const double number : numbers)
    if (!std::isfinite(number)) throw InvalidInput(fmt::format("{} = {}: must be finite", what, format_number(number)));
  return static_cast<int>(rules.size());
}

void throw_unknown_name(std::string_view what, std::string_view name, const std::vector<std::string_view>& valid) {
  const std::string_view nearest = nearest_name(name, valid);
  const std::string hint = nearest.empty() ? "" : fmt::format(", did you mean '{}'?", nearest);
  throw InvalidInput(fmt::format("{}: unknown name '{}'{} (known: {})", what, name, hint, fmt::join(valid, ", ")));
}

}  // namespace detail
}  // namespace crashsim
