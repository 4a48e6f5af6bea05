#include "series.hpp"

#include <crashsim/error.hpp>
#include <crashsim/trace.hpp>

#include "arrays.hpp"

namespace crashsim::python {

TimeSeries series_from(const py::handle& object, const std::string& what) {
  if (object.is_none()) return {};
  if (py::isinstance<TimeSeries>(object)) return object.cast<TimeSeries>();
  if (py::isinstance<Trace>(object)) {
    const Trace& trace = object.cast<const Trace&>();
    return {{trace.times().begin(), trace.times().end()}, trace.values};
  }
  if (!py::isinstance<py::sequence>(object) || py::isinstance<py::str>(object) || py::len(object) != 2)
    throw py::type_error(what + ": must be a TimeSeries, a Trace or a pair (time_s, values), is " +
                         std::string(py::str(py::type::of(object))));
  const auto pair = py::reinterpret_borrow<py::sequence>(object);
  TimeSeries series{Doubles(pair[0], what + ".time_s").copy(), Doubles(pair[1], what + ".values").copy()};
  if (series.time_s.size() != series.values.size())
    throw InvalidInput(what + ": " + std::to_string(series.time_s.size()) + " times but " +
                       std::to_string(series.values.size()) + " values");
  return series;
}

}  // namespace crashsim::python
