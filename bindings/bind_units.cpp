#include <string>

#include <crashsim/error.hpp>
#include <crashsim/units.hpp>

#include "bindings.hpp"

namespace crashsim::python {
namespace {

/// A dimension by its SI symbol, or what the text's own unit measures.
double quantity_of(const std::string& text, const std::string& unit) {
  if (!unit.empty()) return quantity(text, dimension_of(unit));
  const std::size_t start = text.find_first_not_of("+-.0123456789eE \t");
  const std::string name = start == std::string::npos ? "" : text.substr(start);
  const auto known = find_unit(name);
  if (!known)
    throw InvalidInput("quantity = \"" + text + "\": " + (name.empty() ? "no unit" : "unknown unit \"" + name + "\"") +
                       "; write a number and a unit, such as 56 km/h, 1.719 t or 120 ms");
  return quantity(text, known->dimension);
}

}  // namespace

void bind_units(py::module_& module) {
  module.attr("STANDARD_GRAVITY_MPS2") = kStandardGravity;
  module.def("quantity", &quantity_of, py::arg("text"), py::arg("unit") = "",
             R"(A quantity with its unit as an SI number: ``quantity("56 km/h")`` is 15.555... m/s.

Parameters
----------
text : str
    A number and a unit as crash files and people spell them: ``35 mph``, ``1.719t``, ``120 ms``, ``30 g``.
unit : str, optional
    SI symbol of what it must measure (``"m/s"``, ``"kg"``); a bare number is then taken as SI.

Returns
-------
float
    The value in SI units.

Raises
------
InvalidInput
    When it is no number, the unit is unknown, or it measures something else than `unit`.
)");
}

}  // namespace crashsim::python
