#pragma once
/// Summaries as dicts.
#include <string>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>

#include <crashsim/summary.hpp>

namespace crashsim::python {

namespace py = pybind11;

/// Summaries by name: "pulse", "identification", ..
using SummaryParts = std::vector<std::pair<std::string, Summary>>;

py::dict dict_of(const Summary& summary);
py::dict dict_of(const SummaryParts& parts);

/// @throws py::cast_error when it is no dict of names and values.
Summary summary_from(const py::handle& object);
SummaryParts summary_parts_from(const py::handle& object);

/// Equality of names and values in which unset numbers are equal.
bool same_summaries(const Summary& a, const Summary& b);
bool same_summaries(const SummaryParts& a, const SummaryParts& b);

}  // namespace crashsim::python
