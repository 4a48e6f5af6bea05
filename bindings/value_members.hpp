#pragma once
/// One member of a bound value struct on its way to Python and back, and its comparison. Unset numbers are NaN in
/// results and None where a caller gives them.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <pybind11/complex.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <crashsim/error.hpp>
#include <crashsim/option_values.hpp>
#include <crashsim/options.hpp>
#include <crashsim/units.hpp>

#include "arrays.hpp"
#include "series.hpp"
#include "summaries.hpp"

namespace crashsim::python {

template <class T>
inline constexpr bool is_named_enum = std::is_enum_v<T>;

template <class T>
struct IsSetting : std::false_type {};
template <class E>
struct IsSetting<Setting<E>> : std::true_type {};

template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};

template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::true_type {};

using SharedTimes = std::shared_ptr<const std::vector<double>>;

/// A text and something.
template <class T>
struct IsPair : std::false_type {};
template <class T>
struct IsPair<std::pair<std::string, T>> : std::true_type {};

template <class T>
inline constexpr bool is_summary = std::is_same_v<T, Summary> || std::is_same_v<T, SummaryParts>;

/// Names, one of a list of enumerators each.
template <class T>
inline constexpr bool is_enum_vector = false;
template <class E>
inline constexpr bool is_enum_vector<std::vector<E>> = std::is_enum_v<E>;

/// A struct bound by ValueClass.
template <class T>
inline constexpr bool is_bound =
    std::is_class_v<T> && !IsSetting<T>::value && !IsOptional<T>::value && !IsVector<T>::value &&
    !std::is_same_v<T, std::string> && !std::is_same_v<T, SharedTimes> && !std::is_same_v<T, std::complex<double>> &&
    !std::is_same_v<T, RowMatrix> && !IsPair<T>::value;

/// The names of enumerators as an array of texts.
template <class E>
py::array array_of_names(const std::vector<E>& values) {
  py::list names;
  for (const std::string_view name : enum_names<E>) names.append(py::str(std::string(name)));
  py::array_t<int> codes(static_cast<py::ssize_t>(values.size()));
  std::transform(values.begin(), values.end(), codes.mutable_data(), [](E value) { return static_cast<int>(value); });
  const py::array array = py::module_::import("numpy").attr("array")(names)[codes];
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// `owner` keeps alive what the Python object may refer to.
template <class T>
py::object to_python(const T& value, const py::handle& owner) {
  if constexpr (std::is_same_v<T, Dimension>) {
    return py::str(std::string(dimension_name(value)));
  } else if constexpr (is_named_enum<T>) {
    return py::str(std::string(name_of(value)));
  } else if constexpr (std::is_same_v<T, std::vector<double>> || std::is_same_v<T, RowMatrix>) {
    return view_of(value, owner);
  } else if constexpr (std::is_same_v<T, std::vector<std::uint64_t>>) {
    return view_of(value, owner);
  } else if constexpr (is_summary<T>) {
    return dict_of(value);
  } else if constexpr (is_enum_vector<T>) {
    return array_of_names(value);
  } else if constexpr (std::is_same_v<T, std::vector<std::vector<double>>>) {
    return array_of(value);
  } else if constexpr (std::is_same_v<T, SharedTimes>) {
    return view_of(value ? std::span<const double>(*value) : std::span<const double>(), owner);
  } else if constexpr (std::is_same_v<T, char>) {
    return py::str(std::string(1, value));
  } else if constexpr (IsSetting<T>::value) {
    const auto rule = static_cast<std::size_t>(value.rule);
    constexpr auto names = enum_names<decltype(value.rule)>;
    if (rule + 1 < names.size()) return py::str(std::string(names[rule]));
    return py::tuple(py::cast(value.numbers));
  } else if constexpr (IsOptional<T>::value) {
    return value ? to_python(*value, owner) : py::none();
  } else if constexpr (IsVector<T>::value) {
    py::tuple items(value.size());
    for (std::size_t i = 0; i < value.size(); ++i) items[i] = to_python(value[i], owner);
    return items;
  } else if constexpr (is_bound<T>) {
    return py::cast(&value, py::return_value_policy::reference_internal, owner);
  } else {
    return py::cast(value);
  }
}

/// "Literal['l1', 'l2']"
inline std::string literal_of(std::span<const std::string_view> names) {
  std::string text = "Literal";
  for (const std::string_view name : names) text += (text.size() == 7 ? "['" : ", '") + std::string(name) + "'";
  return text + "]";
}

inline Dimension dimension_named(const std::string& name, const std::string& what) {
  for (int i = 0; i <= static_cast<int>(Dimension::angle_per_length); ++i)
    if (dimension_name(static_cast<Dimension>(i)) == name) return static_cast<Dimension>(i);
  throw InvalidInput(what + " = \"" + name + "\": is not the name of a dimension, such as acceleration");
}

/// @throws InvalidInput or TypeError naming `what`.
template <class T>
T from_python(const py::handle& object, const std::string& what) {
  try {
    if constexpr (std::is_same_v<T, Dimension>) {
      return dimension_named(object.cast<std::string>(), what);
    } else if constexpr (is_named_enum<T>) {
      return static_cast<T>(detail::to_choice(object.cast<std::string>(), enum_names<T>, enum_aliases<T>, what));
    } else if constexpr (std::is_same_v<T, double>) {
      return object.is_none() ? kUnset : object.cast<double>();
    } else if constexpr (std::is_same_v<T, std::vector<double>>) {
      return Doubles(object, what).copy();
    } else if constexpr (std::is_same_v<T, RowMatrix>) {
      return matrix_from(object, what);
    } else if constexpr (std::is_same_v<T, std::vector<std::uint64_t>>) {
      return integers_from(object);
    } else if constexpr (std::is_same_v<T, Summary>) {
      return summary_from(object);
    } else if constexpr (std::is_same_v<T, SummaryParts>) {
      return summary_parts_from(object);
    } else if constexpr (std::is_same_v<T, TimeSeries>) {
      return series_from(object, what);
    } else if constexpr (std::is_same_v<T, SharedTimes>) {
      return std::make_shared<const std::vector<double>>(Doubles(object, what).copy());
    } else if constexpr (std::is_same_v<T, char>) {
      const auto text = object.cast<std::string>();
      if (text.size() != 1) throw InvalidInput(what + " = \"" + text + "\": must be one letter");
      return text.front();
    } else if constexpr (IsSetting<T>::value) {
      T out;
      using E = decltype(out.rule);
      const OptionValue given = py::isinstance<py::str>(object) ? OptionValue(object.cast<std::string>())
                                                                : OptionValue(Doubles(object, what).copy());
      out.rule = static_cast<E>(detail::to_setting(given, enum_names<E>, "", what, out.numbers));
      return out;
    } else if constexpr (IsOptional<T>::value) {
      if (object.is_none()) return std::nullopt;
      return from_python<typename T::value_type>(object, what);
    } else if constexpr (IsVector<T>::value) {
      if (py::isinstance<py::str>(object)) throw py::cast_error();
      T out;
      for (const py::handle item : object.cast<py::iterable>())
        out.push_back(from_python<typename T::value_type>(item, what));
      return out;
    } else {
      return object.cast<T>();
    }
  } catch (const py::cast_error&) {
    throw py::type_error(what + ": " + std::string(py::repr(object)) + " is of the wrong type");
  }
}

template <class S>
struct BoundFields;

/// The type of a member in the words of Python's annotations; `class_name` of a bound struct.
template <class T>
std::string type_name() {
  if constexpr (std::is_same_v<T, Dimension> || std::is_same_v<T, char> || std::is_same_v<T, std::string>) {
    return "str";
  } else if constexpr (is_named_enum<T>) {
    return literal_of(enum_names<T>);
  } else if constexpr (std::is_same_v<T, std::vector<double>> || std::is_same_v<T, std::vector<std::vector<double>>> ||
                       std::is_same_v<T, SharedTimes> || std::is_same_v<T, RowMatrix>) {
    return "Array";
  } else if constexpr (std::is_same_v<T, std::vector<std::uint64_t>>) {
    return "NDArray[numpy.uint64]";
  } else if constexpr (is_enum_vector<T>) {
    return "NDArray[numpy.str_]";
  } else if constexpr (std::is_same_v<T, Summary>) {
    return "dict[str, Any]";
  } else if constexpr (std::is_same_v<T, SummaryParts>) {
    return "dict[str, dict[str, Any]]";
  } else if constexpr (IsSetting<T>::value) {
    constexpr auto names = enum_names<decltype(T::rule)>;
    return literal_of(names.first(names.size() - 1)) + " | tuple[float, ...]";
  } else if constexpr (IsOptional<T>::value) {
    return type_name<typename T::value_type>() + " | None";
  } else if constexpr (IsVector<T>::value) {
    return "tuple[" + type_name<typename T::value_type>() + ", ...]";
  } else if constexpr (IsPair<T>::value) {
    return "tuple[str, " + type_name<typename T::second_type>() + "]";
  } else if constexpr (std::is_same_v<T, std::complex<double>>) {
    return "complex";
  } else if constexpr (is_bound<T>) {
    return BoundFields<T>::name;
  } else if constexpr (std::is_same_v<T, bool>) {
    return "bool";
  } else {
    return std::is_floating_point_v<T> ? "float" : "int";
  }
}

/// Equality in which unset numbers are equal.
template <class T>
bool same(const T& a, const T& b) {
  if constexpr (std::is_same_v<T, double>) {
    return a == b || (std::isnan(a) && std::isnan(b));
  } else if constexpr (std::is_same_v<T, SharedTimes>) {
    const std::vector<double> none;
    return a == b || same(a ? *a : none, b ? *b : none);
  } else if constexpr (std::is_same_v<T, RowMatrix>) {
    return a.rows() == b.rows() && a.cols() == b.cols() &&
           std::equal(a.data(), a.data() + a.size(), b.data(), same<double>);
  } else if constexpr (is_summary<T>) {
    return same_summaries(a, b);
  } else if constexpr (IsSetting<T>::value) {
    return a.rule == b.rule && same(a.numbers, b.numbers);
  } else if constexpr (IsOptional<T>::value) {
    return a.has_value() == b.has_value() && (!a || same(*a, *b));
  } else if constexpr (IsVector<T>::value) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
      if (!same(a[i], b[i])) return false;
    return true;
  } else if constexpr (is_bound<T>) {
    return BoundFields<T>::same(a, b);
  } else {
    return a == b;
  }
}

}  // namespace crashsim::python
