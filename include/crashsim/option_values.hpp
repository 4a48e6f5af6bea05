#pragma once
/// Reading, writing and checking options through their field tables.

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include <crashsim/options.hpp>
#include <crashsim/units.hpp>

namespace crashsim {

namespace detail {
[[noreturn]] void throw_out_of_range(std::string_view what, double value, std::string_view unit, const Range& range);
bool in_range(double value, const Range& range);
double to_number(const OptionValue& value, std::string_view unit, std::string_view what);
std::int64_t to_integer(const OptionValue& value, std::string_view what);
bool to_bool(const OptionValue& value, std::string_view what);
std::string to_text(const OptionValue& value, std::string_view what);
std::vector<double> to_numbers(const OptionValue& value, std::string_view unit, std::string_view what);
std::vector<std::string> to_texts(const OptionValue& value, std::string_view what);
int to_choice(const OptionValue& value, std::span<const std::string_view> names, std::span<const NameAlias> aliases,
              std::string_view what);
/// Index of the rule named, or of the last one with `numbers` filled.
int to_setting(const OptionValue& value, std::span<const std::string_view> names, std::string_view unit,
               std::string_view what, std::vector<double>& numbers);
[[noreturn]] void throw_not_set(std::string_view what, std::string_view why, std::string_view doc,
                                std::string_view unit);
[[noreturn]] void throw_unknown_name(std::string_view what, std::string_view name,
                                     const std::vector<std::string_view>& valid);
}  // namespace detail

/// Value of an option: number, text, list or choice name; monostate when unset.
template <class S>
OptionValue get_option(const S& options, const Field<S>& field) {
  return std::visit(
      [&](auto member) -> OptionValue {
        using M = decltype(member);
        if constexpr (std::is_same_v<M, ChoiceMember<S>>) {
          return std::string(member.names[static_cast<std::size_t>(member.get(options))]);
        } else if constexpr (std::is_same_v<M, SettingMember<S>>) {
          const auto rule = static_cast<std::size_t>(member.get(options));
          if (rule + 1 < member.names.size()) return std::string(member.names[rule]);
          S copy = options;
          return member.numbers(copy);
        } else if constexpr (std::is_same_v<M, double S::*>) {
          if (std::isnan(options.*member)) return std::monostate{};
          return options.*member;
        } else if constexpr (std::is_same_v<M, int S::*> || std::is_same_v<M, std::uint64_t S::*>) {
          return static_cast<std::int64_t>(options.*member);
        } else {
          return options.*member;
        }
      },
      field.member);
}

/// Sets an option; text is read with units (`56km/h`), lists also from `a,b,c`. `what` names the option in messages.
/// @throws InvalidInput when it is not of the option's kind or out of range.
template <class S>
void set_option(S& options, const Field<S>& field, const OptionValue& value, std::string_view what) {
  std::visit(
      [&](auto member) {
        using M = decltype(member);
        if constexpr (std::is_same_v<M, ChoiceMember<S>>) {
          member.set(options, detail::to_choice(value, member.names, member.aliases, what));
        } else if constexpr (std::is_same_v<M, SettingMember<S>>) {
          member.set(options, detail::to_setting(value, member.names, field.unit, what, member.numbers(options)));
        } else if constexpr (std::is_same_v<M, double S::*>) {
          const bool unset = std::holds_alternative<std::monostate>(value);
          const double number = unset ? kUnset : detail::to_number(value, field.unit, what);
          if (!unset && !detail::in_range(number, field.range))
            detail::throw_out_of_range(what, number, field.unit, field.range);
          options.*member = number;
        } else if constexpr (std::is_same_v<M, int S::*> || std::is_same_v<M, std::uint64_t S::*>) {
          const std::int64_t number = detail::to_integer(value, what);
          Range range = field.range;
          if constexpr (std::is_same_v<M, std::uint64_t S::*>) range.min = std::max(range.min, 0.0);
          if (!detail::in_range(static_cast<double>(number), range))
            detail::throw_out_of_range(what, static_cast<double>(number), field.unit, range);
          options.*member = static_cast<std::remove_cvref_t<decltype(options.*member)>>(number);
        } else if constexpr (std::is_same_v<M, bool S::*>) {
          options.*member = detail::to_bool(value, what);
        } else if constexpr (std::is_same_v<M, std::string S::*>) {
          options.*member = detail::to_text(value, what);
        } else if constexpr (std::is_same_v<M, std::vector<double> S::*>) {
          options.*member = detail::to_numbers(value, field.unit, what);
        } else {
          options.*member = detail::to_texts(value, what);
        }
      },
      field.member);
}

/// Whether a key names a field: its flag or its name, '-' and '_' alike.
template <class S>
bool is_key_of(std::string_view key, const Field<S>& field) {
  const auto same = [key](std::string_view spelling) {
    return std::equal(key.begin(), key.end(), spelling.begin(), spelling.end(),
                      [](char a, char b) { return (a == '-' ? '_' : a) == (b == '-' ? '_' : b); });
  };
  return same(field.flag) || same(field.name);
}

/// Field whose flag or name this is. @throws InvalidInput naming the nearest known one; `what` names the table.
template <class S>
const Field<S>& find_field(std::string_view name, std::string_view what) {
  for (const Field<S>& field : fields<S>)
    if (is_key_of(name, field)) return field;
  std::vector<std::string_view> valid;
  for (const Field<S>& field : fields<S>) valid.push_back(field.flag);
  detail::throw_unknown_name(what, name, valid);
}

/// @throws InvalidInput naming `what`, the field, its value and the rule, when a number is out of range.
template <class S>
void validate_options(const S& options, std::string_view what) {
  for (const Field<S>& field : fields<S>) {
    S copy;
    set_option(copy, field, get_option(options, field), std::string(what) + "." + std::string(field.name));
  }
}

/// @throws InvalidInput naming `what`, the field and what to give, when a number is unset; `why` is what needs it.
template <class S>
void require_set(const S& options, double S::*member, std::string_view what, std::string_view why = "") {
  if (!std::isnan(options.*member)) return;
  for (const Field<S>& field : fields<S>) {
    const auto* described = std::get_if<double S::*>(&field.member);
    if (described != nullptr && *described == member)
      detail::throw_not_set(std::string(what) + "." + std::string(field.name), why, field.doc, field.unit);
  }
}

/// Nearest of `valid` to a mistyped name by edit distance, "" when none is near.
std::string_view nearest_name(std::string_view name, const std::vector<std::string_view>& valid);

}  // namespace crashsim
