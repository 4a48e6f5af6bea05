#pragma once
/// Binds a value struct: its members, each listed once, give read-only attributes, the keywords of the constructor and
/// of replace(), repr, equality, copies and pickles.
#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>

#include <crashsim/named_number.hpp>

#include "keywords.hpp"
#include "value_members.hpp"

namespace crashsim::python {

/// One member of S without its type.
template <class S>
struct BoundField {
  std::string name;
  std::function<py::object(const S&, const py::handle& owner)> get;
  std::function<void(S&, const py::handle&)> set;
  std::function<bool(const S&, const S&)> same;
};

template <class S>
struct BoundFields {
  static inline std::vector<BoundField<S>> list;
  static inline std::string name;

  static bool same(const S& a, const S& b) {
    for (const BoundField<S>& field : list)
      if (!field.same(a, b)) return false;
    return true;
  }

  static const BoundField<S>& find(const std::string& wanted) {
    std::vector<std::string_view> valid;
    for (const BoundField<S>& field : list) {
      if (field.name == wanted) return field;
      valid.push_back(field.name);
    }
    throw_unexpected_keyword(name, wanted, valid);
  }

  /// `base` with what positional and keyword arguments say.
  static S with(S base, const py::args& args, const py::kwargs& kwargs) {
    if (args.size() > list.size())
      throw py::type_error(name + "() takes at most " + std::to_string(list.size()) + " arguments");
    for (std::size_t i = 0; i < args.size(); ++i) list[i].set(base, args[i]);
    for (const auto& [key, value] : kwargs) {
      const BoundField<S>& field = find(py::cast<std::string>(key));
      for (std::size_t i = 0; i < args.size(); ++i)
        if (list[i].name == field.name)
          throw py::type_error(name + "() got multiple values for argument '" + field.name + "'");
      field.set(base, value);
    }
    return base;
  }

  static py::tuple state_of(const py::object& self) {
    const S& value = self.cast<const S&>();
    py::tuple state(list.size());
    for (std::size_t i = 0; i < list.size(); ++i) state[i] = list[i].get(value, self);
    return state;
  }

  static S from_state(const py::tuple& state) {
    if (state.size() != list.size()) throw InvalidInput(name + ": a pickle of another version of crashsim");
    S value;
    for (std::size_t i = 0; i < list.size(); ++i) list[i].set(value, state[i]);
    return value;
  }
};

template <class S>
class ValueClass : public py::class_<S> {
 public:
  ValueClass(const py::handle& module, const char* name, const char* doc) : py::class_<S>(module, name, doc) {
    BoundFields<S>::name = name;
    BoundFields<S>::list.clear();
    this->def(py::init(
        [](const py::args& args, const py::kwargs& kwargs) { return BoundFields<S>::with(S{}, args, kwargs); }));
    this->def(
        "replace",
        [](const S& self, const py::kwargs& changes) { return BoundFields<S>::with(self, py::args(), changes); },
        "A copy with the fields that keywords name changed.");
    this->def("__eq__", [](const S& a, const py::object& b) -> py::object {
      if (!py::isinstance<S>(b)) return py::reinterpret_borrow<py::object>(Py_NotImplemented);
      return py::bool_(BoundFields<S>::same(a, b.cast<const S&>()));
    });
    this->attr("__hash__") = py::none();
    this->def("__copy__", [](const S& self) { return self; });
    this->def("__deepcopy__", [](const S& self, const py::dict&) { return self; });
    this->def(py::pickle([](const py::object& self) { return BoundFields<S>::state_of(self); },
                         [](const py::tuple& state) { return BoundFields<S>::from_state(state); }));
  }

  /// `doc`: meaning and unit.
  template <class T>
  ValueClass& field(const char* name, T S::*member, const char* doc) {
    const std::string what = BoundFields<S>::name + "." + name;
    BoundFields<S>::list.push_back(
        {name, [member](const S& value, const py::handle& owner) { return to_python(value.*member, owner); },
         [member, what](S& value, const py::handle& given) { value.*member = from_python<T>(given, what); },
         [member](const S& a, const S& b) { return same(a.*member, b.*member); }});
    this->def_property_readonly(
        name, [member](const py::object& self) { return to_python(self.cast<const S&>().*member, self); }, doc);
    list(name, type_name<T>());
    return *this;
  }

  /// Every number of a result's table.
  template <std::size_t N>
  ValueClass& numbers(const std::array<NamedNumber<S>, N>& table) {
    for (const NamedNumber<S>& number : table)
      field(std::string(number.name).c_str(), number.member, doc_of(number).c_str());
    return *this;
  }

  /// Every number of a table, of each struct of a list: arrays over its memory.
  template <class T, std::size_t N>
  ValueClass& columns(std::vector<T> S::*member, const std::array<NamedNumber<T>, N>& table) {
    for (const NamedNumber<T>& number : table) {
      const std::string name(number.name), what = BoundFields<S>::name + "." + name;
      const double T::*of = number.member;
      BoundFields<S>::list.push_back(
          {name, [member, of](const S& value, const py::handle& owner) { return column_of(value.*member, of, owner); },
           [member, &number, what](S& value, const py::handle& given) {
             set_column(value.*member, number.member, Doubles(given, what));
           },
           [member, of](const S& a, const S& b) {
             return std::equal((a.*member).begin(), (a.*member).end(), (b.*member).begin(), (b.*member).end(),
                               [of](const T& x, const T& y) { return same(x.*of, y.*of); });
           }});
      this->def_property_readonly(
          name.c_str(),
          [member, of](const py::object& self) { return column_of(self.cast<const S&>().*member, of, self); },
          doc_of(number).c_str());
      list(name, "Array");
    }
    return *this;
  }

  /// Every field of the struct's option table, with its names, units, ranges and docs.
  ValueClass& option_fields() {
    for (const Field<S>& option : fields<S>) {
      const std::string name(option.name), what = BoundFields<S>::name + "." + name;
      BoundFields<S>::list.push_back(
          {name, [&option](const S& value, const py::handle&) { return option_object(get_option(value, option)); },
           [&option, what](S& value, const py::handle& given) {
             const OptionValue number = option_value(given, what);
             set_option(value, option, is_unset(number) ? OptionValue() : number, what);
           },
           [&option](const S& a, const S& b) { return get_option(a, option) == get_option(b, option); }});
      this->def_property_readonly(
          name.c_str(), [&option](const S& self) { return option_object(get_option(self, option)); },
          doc_of(option).c_str());
      list(name, annotation_of(option));
    }
    return *this;
  }

  /// usable and the one-line report, of results.
  ValueClass& result() {
    this->def_property_readonly("usable", &S::usable, "True when the result is one to rely on.");
    this->def("brief_report", &S::brief_report, "One line: how it ended and its main numbers.");
    return *this;
  }

 private:
  /// Fields and their types, for what is made of them in Python: repr, tables, stubs.
  void list(const std::string& name, const std::string& annotation) {
    types_[py::str(name)] = annotation;
    this->attr("_fields") = py::tuple(types_.attr("keys")());
    this->attr("_field_types") = types_;
  }

  static std::string annotation_of(const Field<S>& option) {
    return std::visit(
        [](const auto& member) -> std::string {
          using M = std::decay_t<decltype(member)>;
          if constexpr (std::is_same_v<M, ChoiceMember<S>>)
            return literal_of(member.names);
          else if constexpr (std::is_same_v<M, SettingMember<S>>)
            return literal_of(member.names.first(member.names.size() - 1)) + " | tuple[float, ...]";
          else
            return annotation_of_member(member);
        },
        option.member);
  }

  template <class T>
  static std::string annotation_of_member(T S::*) {
    if constexpr (std::is_same_v<T, std::vector<double>>)
      return "tuple[float, ...]";
    else
      return type_name<T>();
  }

  template <class T>
  static py::object column_of(const std::vector<T>& structs, const double T::*member, const py::handle& owner) {
    if (structs.empty()) return view_of(std::span<const double>(), owner);
    py::array_t<double> array({structs.size()}, {sizeof(T)}, &(structs.front().*member), owner);
    array.attr("setflags")(py::arg("write") = false);
    return array;
  }

  template <class T>
  static void set_column(std::vector<T>& structs, double T::*member, const Doubles& given) {
    const std::span<const double> values = given.view();
    if (structs.empty()) structs.resize(values.size());
    if (structs.size() != values.size())
      throw InvalidInput(given.what() + ": has " + std::to_string(values.size()) + " values, another array has " +
                         std::to_string(structs.size()));
    for (std::size_t i = 0; i < values.size(); ++i) structs[i].*member = values[i];
  }

  py::dict types_;
};

}  // namespace crashsim::python
