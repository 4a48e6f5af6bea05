#include "summaries.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include <pybind11/stl.h>

namespace crashsim::python {
namespace {

bool same_values(const SummaryValue& a, const SummaryValue& b) {
  const auto* x = std::get_if<double>(&a);
  const auto* y = std::get_if<double>(&b);
  return a == b || (x != nullptr && y != nullptr && std::isnan(*x) && std::isnan(*y));
}

/// bool before int: in Python one is the other.
SummaryValue value_from(const py::handle& object) {
  if (py::isinstance<py::bool_>(object)) return object.cast<bool>();
  if (py::isinstance<py::int_>(object)) return object.cast<std::int64_t>();
  if (py::isinstance<py::str>(object)) return object.cast<std::string>();
  return object.cast<double>();
}

}  // namespace

py::dict dict_of(const Summary& summary) {
  py::dict out;
  for (const SummaryItem& item : summary) out[py::str(item.name)] = py::cast(item.value);
  return out;
}

py::dict dict_of(const SummaryParts& parts) {
  py::dict out;
  for (const auto& [name, summary] : parts) out[py::str(name)] = dict_of(summary);
  return out;
}

Summary summary_from(const py::handle& object) {
  Summary summary;
  for (const auto& [name, value] : object.cast<py::dict>())
    summary.push_back({name.cast<std::string>(), value_from(value), ""});
  return summary;
}

SummaryParts summary_parts_from(const py::handle& object) {
  SummaryParts parts;
  for (const auto& [name, part] : object.cast<py::dict>())
    parts.emplace_back(name.cast<std::string>(), summary_from(part));
  return parts;
}

bool same_summaries(const Summary& a, const Summary& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const SummaryItem& x, const SummaryItem& y) {
    return x.name == y.name && same_values(x.value, y.value);
  });
}

bool same_summaries(const SummaryParts& a, const SummaryParts& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.first == y.first && same_summaries(x.second, y.second);
  });
}

}  // namespace crashsim::python
