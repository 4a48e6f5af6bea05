#include "keywords.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <pybind11/stl.h>

#include "arrays.hpp"

namespace crashsim::python {
namespace {

bool is_text(const py::handle& object) { return py::isinstance<py::str>(object); }

OptionValue list_value(const py::handle& object, const std::string& what) {
  if (!py::isinstance<py::array>(object)) {
    std::vector<std::string> texts;
    bool all_texts = true;
    for (const py::handle item : object.cast<py::iterable>()) {
      all_texts = all_texts && is_text(item);
      texts.push_back(py::str(item));
    }
    if (all_texts) return texts;
  }
  const py::array array = py::array::ensure(object);
  if (array && array.ndim() == 1 && std::string_view("OSU").find(array.dtype().kind()) != std::string_view::npos) {
    std::vector<std::string> texts;  // numbers and texts together: channels=[93, "SEAT"]
    for (const py::handle item : object.cast<py::iterable>()) texts.push_back(py::str(item));
    return texts;
  }
  if (!array) throw py::error_already_set();
  return Doubles(array, what).copy();
}

}  // namespace

OptionValue option_value(const py::handle& object, const std::string& what) {
  if (object.is_none()) return std::monostate{};
  if (py::isinstance<py::bool_>(object)) return object.cast<bool>();
  if (is_text(object)) return object.cast<std::string>();
  if (py::hasattr(object, "__fspath__")) return py::str(object.attr("__fspath__")()).cast<std::string>();
  if (PyIndex_Check(object.ptr()) != 0 && !py::isinstance<py::array>(object)) {
    const py::int_ integer = py::reinterpret_steal<py::int_>(PyNumber_Index(object.ptr()));
    if (!integer) throw py::error_already_set();
    try {
      return integer.cast<std::int64_t>();
    } catch (const py::cast_error&) {
      throw InvalidInput(what + " = " + std::string(py::str(integer)) + ": too large a number");
    }
  }
  if (py::hasattr(object, "__float__") && (!py::isinstance<py::array>(object) || py::len(object.attr("shape")) == 0))
    return py::float_(py::reinterpret_borrow<py::object>(object)).cast<double>();
  if (py::isinstance<py::iterable>(object)) return list_value(object, what);
  throw py::type_error(what + ": " + std::string(py::repr(object)) + " is no number, text or list of them");
}

std::string names_in_braces(std::span<const std::string_view> names) {
  std::string text;
  for (const std::string_view name : names) text += (text.empty() ? "{'" : ", '") + std::string(name) + "'";
  return text + "}";
}

bool is_unset(const OptionValue& value) {
  const auto* number = std::get_if<double>(&value);
  return number != nullptr && std::isnan(*number);
}

py::object option_object(const OptionValue& value) {
  return std::visit(
      [](const auto& held) -> py::object {
        using T = std::decay_t<decltype(held)>;
        if constexpr (std::is_same_v<T, std::monostate>) {
          return py::float_(std::numeric_limits<double>::quiet_NaN());
        } else if constexpr (std::is_same_v<T, std::vector<double>> || std::is_same_v<T, std::vector<std::string>>) {
          return py::tuple(py::cast(held));
        } else {
          return py::cast(held);
        }
      },
      value);
}

double number_or_unset(const py::handle& object, std::string_view unit, const std::string& what) {
  return object.is_none() ? kUnset : detail::to_number(option_value(object, what), unit, what);
}

std::string unit_of_name(std::string_view name) {
  using Suffix = std::array<std::string_view, 2>;
  constexpr Suffix kSuffixes[] = {{"_n_per_m", "N/m"}, {"_mps2", "m/s^2"},  {"_mps", "m/s"},
                                  {"_rad", "rad"},     {"_radps", "rad/s"}, {"_radps2", "rad/s^2"},
                                  {"_nm", "N m"},      {"_ns", "N s"},      {"_n", "N"},
                                  {"_s", "s"},         {"_m", "m"},         {"_g", "g"},
                                  {"_j", "J"}};
  for (const auto& [suffix, symbol] : kSuffixes)
    if (name.ends_with(suffix)) return std::string(symbol);
  return "";
}

void throw_unexpected_keyword(std::string_view function, const std::string& keyword,
                              const std::vector<std::string_view>& valid) {
  const std::string_view near = nearest_name(keyword, valid);
  throw py::type_error(std::string(function) + "() got an unexpected keyword argument '" + keyword + "'" +
                       (near.empty() ? "" : "; did you mean '" + std::string(near) + "'?"));
}

}  // namespace crashsim::python
