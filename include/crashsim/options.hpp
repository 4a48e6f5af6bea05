#pragma once
/// An options struct is described once, by a constexpr table of fields. Validation, command-line flags, case-file keys,
/// Python keywords, records and help all come from that table.

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <crashsim/error.hpp>

namespace crashsim {

/// Allowed range of a number.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open_min = false;  ///< True when min itself is not allowed.
};
constexpr Range any_number() { return {}; }
constexpr Range positive() { return {.min = 0.0, .open_min = true}; }
constexpr Range at_least(double min) { return {.min = min}; }
constexpr Range positive_up_to(double max) { return {.min = 0.0, .max = max, .open_min = true}; }
constexpr Range between(double min, double max) { return {.min = min, .max = max}; }

/// A named rule, or numbers given instead of it (`E::given`): `weights = normalised` or `weights = 1,1,1`.
template <class E>
struct Setting {
  E rule{};
  std::vector<double> numbers;

  bool operator==(const Setting&) const = default;
};

/// Spelling of an enum's values, in their order; specialised beside each enum.
template <class E>
inline constexpr std::span<const std::string_view> enum_names{};

/// Another spelling of an enum's value, accepted where its name is.
struct NameAlias {
  std::string_view alias;
  int value;
};
template <class E>
inline constexpr std::span<const NameAlias> enum_aliases{};

/// Name of an enum value.
template <class E>
constexpr std::string_view name_of(E value) {
  return enum_names<E>[static_cast<std::size_t>(value)];
}

/// An enum member of S without its type.
template <class S>
struct ChoiceMember {
  std::span<const std::string_view> names;
  std::span<const NameAlias> aliases;
  int (*get)(const S&);
  void (*set)(S&, int);
};

/// A Setting member of S without its type; the last name stands for "numbers given".
template <class S>
struct SettingMember {
  std::span<const std::string_view> names;
  int (*get)(const S&);
  void (*set)(S&, int);
  std::vector<double>& (*numbers)(S&);
};

template <class S>
using Member = std::variant<double S::*, int S::*, std::uint64_t S::*, bool S::*, std::string S::*,
                            std::vector<double> S::*, std::vector<std::string> S::*, ChoiceMember<S>, SettingMember<S>>;

namespace detail {
template <class S, class T>
S struct_of(T S::*);
template <class S, class T>
T type_of(T S::*);
template <class E>
E rule_of(const Setting<E>&);
}  // namespace detail

/// Field member for an enum.
template <auto M>
constexpr auto choice() {
  using S = decltype(detail::struct_of(M));
  using E = decltype(detail::type_of(M));
  return Member<S>(ChoiceMember<S>{enum_names<E>, enum_aliases<E>, [](const S& s) { return static_cast<int>(s.*M); },
                                   [](S& s, int i) { s.*M = static_cast<E>(i); }});
}

/// Field member for a Setting.
template <auto M>
constexpr auto setting() {
  using S = decltype(detail::struct_of(M));
  using E = decltype(detail::rule_of(std::declval<decltype(detail::type_of(M))>()));
  return Member<S>(SettingMember<S>{enum_names<E>, [](const S& s) { return static_cast<int>((s.*M).rule); },
                                    [](S& s, int i) { (s.*M).rule = static_cast<E>(i); },
                                    [](S& s) -> std::vector<double>& { return (s.*M).numbers; }});
}

/// One option.
template <class S>
struct Field {
  std::string_view name;  ///< Spelling in C++, JSON and Python: "impact_speed_mps".
  std::string_view flag;  ///< Spelling on the command line and in case files: "speed".
  std::string_view unit;  ///< SI symbol, "" for a pure number or text.
  std::string_view doc;   ///< One line: what it does.
  Member<S> member;
  Range range = any_number();
};

/// The table of an options struct: specialised as a constexpr array of `Field<S>` beside each struct.
template <class S>
inline constexpr std::span<const Field<S>> fields{};

/// Value of an option on its way to or from text, TOML, JSON or Python. monostate: unset.
using OptionValue = std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<double>,
                                 std::vector<std::string>>;

}  // namespace crashsim
