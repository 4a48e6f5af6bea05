#include <algorithm>
#include <string>
#include <vector>

#include <pybind11/stl.h>

#include <crashsim/trace.hpp>
#include <crashsim/trace_io.hpp>

#include "bindings.hpp"
#include "keywords.hpp"
#include "long_call.hpp"
#include "paths.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

std::vector<std::string> selectors(const py::object& channels) {
  if (channels.is_none()) return {};
  if (py::isinstance<py::str>(channels) || !py::isinstance<py::iterable>(channels)) return {py::str(channels)};
  std::vector<std::string> out;
  for (const py::handle item : channels.cast<py::iterable>()) out.push_back(py::str(item));
  return out;
}

ReadOptions read_options(const py::object& channels, const std::string& columns, const std::string& units) {
  return {selectors(channels), columns, units};
}

py::object trace_at(const py::object& self, std::size_t index) {
  return py::cast(&self.cast<const TraceSet&>().traces[index], py::return_value_policy::reference_internal, self);
}

py::object trace_of(const py::object& self, const py::object& key) {
  const TraceSet& set = self.cast<const TraceSet&>();
  if (py::isinstance<py::int_>(key)) {
    auto index = key.cast<py::ssize_t>();
    const auto count = static_cast<py::ssize_t>(set.traces.size());
    if (index < 0) index += count;
    if (index < 0 || index >= count)
      throw py::index_error("traces[" + std::string(py::str(key)) + "]: there are " + std::to_string(count));
    return trace_at(self, static_cast<std::size_t>(index));
  }
  std::vector<std::size_t> found;
  try {
    found = select_channels(set, key.cast<std::string>());
  } catch (const InvalidInput& error) {
    throw py::key_error(error.what());
  }
  if (found.size() > 1)
    throw py::key_error("'" + key.cast<std::string>() + "' is " + std::to_string(found.size()) +
                        " channels: use their ids, or select()");
  return trace_at(self, found.front());
}

void bind_trace(py::module_& module) {
  ValueClass<Trace>(module, "Trace", "A measured or computed time history of one channel, in SI units.")
      .field("id", &Trace::id, "Number or code in its file.")
      .field("name", &Trace::name, "What its file calls it.")
      .field("database", &Trace::database, "Which of a file's histories it belongs to, '' where there is one only.")
      .field("location", &Trace::location, "Sensor location or node, '' when the file does not say.")
      .field("axis", &Trace::axis, "'X', 'Y', 'Z' (SAE J1733: forward, right, down) or ' '.")
      .field("dimension", &Trace::dimension, "What it measures: 'acceleration', 'force', ..., 'unknown'.")
      .field("source_unit", &Trace::source_unit, "Unit in the file, before conversion to SI.")
      .field("problem", &Trace::problem, "Why it must not be used, '' when its source has no doubt.")
      .field("has_samples", &Trace::has_samples, "False when the samples are absent or were not asked for.")
      .field("time_s", &Trace::time_s, "Sample times [s], read-only array of n.")
      .field("values", &Trace::values, "Samples [SI], read-only array of n.")
      .def_property_readonly(
          "unit", [](const Trace& self) { return std::string(si_symbol(self.dimension)); },
          "SI symbol of the values, '' when the dimension is unknown or none.");
}

void bind_trace_set(py::module_& module) {
  ValueClass<TraceSet>(
      module, "TraceSet",
      "Everything read from one file or folder: a mapping of channel ids, names or unique globs to Trace.")
      .field("path", &TraceSet::path, "As given by the caller.")
      .field("format", &TraceSet::format, "'csv', 'nhtsa_ev5', 'lsdyna_binout', ...")
      .field("title", &TraceSet::title, "Run or test title, '' when there is none.")
      .field("mass_kg", &TraceSet::mass_kg, "Test mass [kg], NaN when the file does not say.")
      .field("impact_speed_mps", &TraceSet::impact_speed_mps, "Impact speed [m/s], NaN when the file does not say.")
      .field("metadata", &TraceSet::metadata, "Pairs of key and value that the file says beside its channels.")
      .field("input_files", &TraceSet::input_files, "Every file read.")
      .field("warnings", &TraceSet::warnings, "What a careful reader should know.")
      .field("compartment_x", &TraceSet::compartment_x, "Ids of the channels of the compartment's longitudinal motion.")
      .field("traces", &TraceSet::traces, "Every Trace, in file order.")
      .def("__len__", [](const TraceSet& self) { return self.traces.size(); })
      .def("__getitem__", &trace_of, py::arg("key"))
      .def("__contains__",
           [](const TraceSet& self, const py::object& key) {
             if (!py::isinstance<py::str>(key)) return false;
             const auto name = key.cast<std::string>();
             return std::any_of(self.traces.begin(), self.traces.end(),
                                [&](const Trace& trace) { return trace.id == name || trace.name == name; });
           })
      .def("__iter__", [](const py::object& self) { return py::iter(self.attr("keys")()); })
      .def(
          "keys",
          [](const TraceSet& self) {
            py::list names;
            for (const Trace& trace : self.traces) names.append(trace.name.empty() ? trace.id : trace.name);
            return names;
          },
          "Names of the channels, in file order (the id of a channel without name).")
      .def(
          "select",
          [](const py::object& self, const std::string& selector) {
            py::list found;
            for (const std::size_t index : select_channels(self.cast<const TraceSet&>(), selector))
              found.append(trace_at(self, index));
            return found;
          },
          py::arg("selector"),
          "The traces that an id, a name or a glob (``*``, ``?``, ``[..]``) names. Raises InvalidInput when none "
          "does.");
}

void bind_info(py::module_& module) {
  ValueClass<ChannelInfo>(module, "ChannelInfo", "A channel without its samples: one line of `crashsim info`.")
      .field("id", &ChannelInfo::id, "Number or code in its file.")
      .field("name", &ChannelInfo::name, "What its file calls it.")
      .field("database", &ChannelInfo::database, "Which of a file's histories it belongs to.")
      .field("location", &ChannelInfo::location, "Sensor location or node.")
      .field("unit", &ChannelInfo::unit, "SI symbol, or the file's own when it is unknown.")
      .field("status", &ChannelInfo::status, "'ok', or why not.")
      .field("axis", &ChannelInfo::axis, "'X', 'Y', 'Z' or ' '.")
      .field("samples", &ChannelInfo::samples, "Number of samples.")
      .field("first_s", &ChannelInfo::first_s, "Time of the first sample [s].")
      .field("last_s", &ChannelInfo::last_s, "Time of the last sample [s].")
      .field("rate_hz", &ChannelInfo::rate_hz, "Sampling rate [Hz], the mean one when steps are not uniform.")
      .field("uniform", &ChannelInfo::uniform, "Whether the time steps are uniform.")
      .field("min", &ChannelInfo::min, "Smallest sample [SI].")
      .field("max", &ChannelInfo::max, "Largest sample [SI].");
  ValueClass<TraceFileInfo>(module, "TraceFileInfo", "What a trace file holds.")
      .field("set", &TraceFileInfo::set, "What the file says of itself; no traces.")
      .field("channels", &TraceFileInfo::channels, "Every channel chosen, in file order.");
}

}  // namespace

void bind_traces(py::module_& module) {
  bind_trace(module);
  bind_trace_set(module);
  bind_info(module);
  module.def(
      "read_traces",
      [](const py::object& path, const py::object& channels, const std::string& units, const std::string& columns) {
        const std::string file = path_text(path);
        const ReadOptions options = read_options(channels, columns, units);
        TraceSet set = unlocked([&] { return read_traces(file, options); });
        log_warnings(set.warnings);
        return set;
      },
      py::arg("path"), py::arg("channels") = py::none(), py::arg("units") = "", py::arg("columns") = "",
      R"(Reads a trace file or folder of any supported format, detected from its content, into SI units.

Parameters
----------
path : str or os.PathLike
    NHTSA EV5, UDS or tab-separated; ISO-MME; LS-DYNA ASCII or binout; OpenRadioss T01 or CSV; any CSV.
channels : str, int or list of them, optional
    Ids, names or globs of the channels to keep; all by default.
units : str, optional
    Unit system of finite-element output: ``kg-m-s``, ``t-mm-s``, ``kg-mm-ms`` or ``g-mm-ms``.
columns : str, optional
    Columns of a CSV file: ``"time:ms,accel:g"``.

Returns
-------
TraceSet

Raises
------
InvalidInput
    Names file, line and channel when the file is missing, of no known format, or would give wrong numbers.
)");
  module.def(
      "inspect_traces",
      [](const py::object& path, const py::object& channels, const std::string& units, const std::string& columns) {
        const std::string file = path_text(path);
        const ReadOptions options = read_options(channels, columns, units);
        return unlocked([&] { return inspect_traces(file, options); });
      },
      py::arg("path"), py::arg("channels") = py::none(), py::arg("units") = "", py::arg("columns") = "",
      R"(Describes a trace file in one pass, without keeping samples.

Parameters
----------
path : str or os.PathLike
    As of read_traces.
channels : str, int or list of them, optional
    Ids, names or globs of the channels to describe; all by default.
units : str, optional
    Unit system of finite-element output, as of read_traces.
columns : str, optional
    Columns of a CSV file: ``"time:ms,accel:g"``.

Returns
-------
TraceFileInfo

Raises
------
InvalidInput
    As read_traces.
)");
}

}  // namespace crashsim::python
