#pragma once
/// Keyword options of Python functions, from the options' field tables.
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>

#include <crashsim/named_number.hpp>
#include <crashsim/option_docs.hpp>
#include <crashsim/option_values.hpp>

namespace crashsim::python {

namespace py = pybind11;

/// A Python value as an option's: None, bool, number, text (with a unit: "56 km/h"), list or array of numbers or texts.
/// @throws TypeError naming `what` when it is none of them.
OptionValue option_value(const py::handle& object, const std::string& what);

/// A number or a text with a unit as an SI number, None as unset.
/// @throws InvalidInput or TypeError naming `what`.
double number_or_unset(const py::handle& object, std::string_view unit, const std::string& what);

/// Symbol of the unit that a name ends in: "m/s" of "delta_v_mps", "" for none.
std::string unit_of_name(std::string_view name);

/// "{'l1', 'l2', 'huber'}"
std::string names_in_braces(std::span<const std::string_view> names);

/// True for NaN, as which Python sees an unset number.
bool is_unset(const OptionValue& value);

/// An option's value for Python; NaN when unset.
py::object option_object(const OptionValue& value);

[[noreturn]] void throw_unexpected_keyword(std::string_view function, const std::string& keyword,
                                           const std::vector<std::string_view>& valid);

/// "impact speed [m/s]; > 0": a field's doc with unit, choices, range and default.
template <class S>
std::string doc_of(const Field<S>& field) {
  const FieldDescription about = describe_field(field);
  std::string text = about.doc;
  if (!about.unit.empty()) text += " [" + about.unit + "]";
  for (const std::string& part : {about.choices, about.range})
    if (!part.empty()) text += "; " + part;
  if (!about.default_value.empty()) text += "; default " + about.default_value;
  return text;
}

/// A field's type in the words of docstrings: "float or str", "{'j211', 'iso6487'}".
template <class S>
std::string type_of(const Field<S>& field) {
  return std::visit(
      [](const auto& member) -> std::string {
        using M = std::decay_t<decltype(member)>;
        if constexpr (std::is_same_v<M, ChoiceMember<S>>)
          return names_in_braces(member.names);
        else if constexpr (std::is_same_v<M, SettingMember<S>>)
          return names_in_braces(member.names.first(member.names.size() - 1)) + " or array_like";
        else if constexpr (std::is_same_v<M, double S::*>)
          return "float or str";
        else if constexpr (std::is_same_v<M, bool S::*>)
          return "bool";
        else if constexpr (std::is_same_v<M, std::string S::*>)
          return "str";
        else if constexpr (std::is_same_v<M, std::vector<double> S::*>)
          return "array_like";
        else if constexpr (std::is_same_v<M, std::vector<std::string> S::*>)
          return "str, int or sequence of them";
        else
          return "int";
      },
      field.member);
}

/// "largest pitch, nose down [rad]; NaN where it does not exist": a result's number, its unit by its name.
template <class S>
std::string doc_of(const NamedNumber<S>& number) {
  const std::string unit = unit_of_name(number.name);
  return std::string(number.doc) + (unit.empty() ? "" : " [" + unit + "]") + "; NaN where it does not exist";
}

/// Sets the field that a keyword names; false when there is none. `valid` gets all names on the way.
template <class S>
bool set_keyword(S& options, const std::string& name, const py::handle& value, std::vector<std::string_view>& valid) {
  for (const Field<S>& field : fields<S>) {
    valid.push_back(field.name);
    if (field.name != name) continue;
    set_option(options, field, option_value(value, name), name);
    return true;
  }
  return false;
}

/// `options`, one struct or several, with what the keywords say.
/// @throws TypeError on a keyword that no field has, InvalidInput on a bad value.
template <class... S>
std::tuple<S...> with_keywords_of(std::tuple<S...> options, const py::dict& keywords, std::string_view function) {
  for (const auto& [key, value] : keywords) {
    const auto name = py::cast<std::string>(key);
    std::vector<std::string_view> valid;
    const bool known = std::apply(
        [&, &given = value](S&... structs) { return (set_keyword(structs, name, given, valid) || ...); }, options);
    if (!known) throw_unexpected_keyword(function, name, valid);
  }
  return options;
}

template <class S>
S with_keywords(S options, const py::dict& keywords, std::string_view function) {
  return std::get<0>(with_keywords_of(std::tuple<S>(std::move(options)), keywords, function));
}

/// Several options structs from the keywords of one function.
template <class... S>
std::tuple<S...> options_of(const py::dict& keywords, std::string_view function) {
  return with_keywords_of(std::tuple<S...>(), keywords, function);
}

template <class S>
S options_from(const py::kwargs& keywords, std::string_view function) {
  return with_keywords(S{}, keywords, function);
}

/// A docstring with a section for the keywords of options structs; a `file` is a parameter of its own.
template <class... S>
std::string with_options_doc(std::string text) {
  text += "\n\nOther Parameters\n----------------\n";
  const auto describe = [&text](const auto& table) {
    for (const auto& field : table)
      if (field.name != "file")
        text += std::string(field.name) + " : " + type_of(field) + ", optional\n    " + doc_of(field) + "\n";
  };
  (describe(fields<S>), ...);
  return text;
}

}  // namespace crashsim::python
