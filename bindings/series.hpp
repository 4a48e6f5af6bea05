#pragma once
/// Time series that callers give.
#include <string>

#include <pybind11/pybind11.h>

#include <crashsim/time_series.hpp>

namespace crashsim::python {

/// A TimeSeries, a Trace, a pair of times and values, or None for an empty one.
/// @throws TypeError or InvalidInput naming `what` when it is none of them.
TimeSeries series_from(const pybind11::handle& object, const std::string& what);

}  // namespace crashsim::python
