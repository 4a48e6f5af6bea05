#include <optional>
#include <string>
#include <vector>

#include <pybind11/stl.h>

#include <crashsim/export.hpp>
#include <crashsim/files.hpp>
#include <crashsim/iso_mme.hpp>
#include <crashsim/model_io.hpp>
#include <crashsim/outputs.hpp>
#include <crashsim/record.hpp>
#include <crashsim/vehicle_io.hpp>

#include "bindings.hpp"
#include "keywords.hpp"
#include "paths.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

Record record_of(const std::string& function, const std::vector<std::string>& inputs) {
  return make_record("python " + function, {}, {}, inputs);
}

/// The files that a result was read from.
std::vector<std::string> inputs_of(const Pulse& pulse) { return pulse.input_files; }
std::vector<std::string> inputs_of(const LoadCellWall& wall) { return wall.input_files; }
std::vector<std::string> inputs_of(const SensorCorrection& correction) { return correction.input_files; }
template <class Result>
std::vector<std::string> inputs_of(const Result&) {
  return {};
}

/// What every writer of a file takes and raises.
constexpr const char* kFileDoc = R"(
path : str or os.PathLike
    File to write, whole or not at all.
overwrite : bool
    Replace a file that is there.

Raises
------
InvalidInput
    When the file is there and `overwrite` is false.
SystemFailure
    With path and reason when it cannot be written.
)";

/// Binds `function(result, path, *, overwrite)`, which writes the text that `format(result, record)` makes of it.
template <class Result, class Format>
void bind_writer(py::module_& module, const char* function, const std::string& doc, Format format) {
  module.def(
      function,
      [function, format](const Result& result, const py::object& path, bool overwrite) {
        write_file_atomically(path_text(path), format(result, record_of(function, inputs_of(result))), overwrite);
      },
      py::arg("result"), py::arg("path"), py::kw_only(), py::arg("overwrite") = false, (doc + kFileDoc).c_str());
}

std::string taking(const std::string& what, const std::string& type) {
  return what + "\n\nParameters\n----------\nresult : " + type;
}

void bind_motion_writers(py::module_& module) {
  bind_writer<Pulse>(module, "write_pulse",
                     taking("Writes a pulse as ``pulse.csv``, which read_pulse gives back.", "Pulse"),
                     [](const Pulse& pulse, const Record& record) { return format_pulse(pulse, record); });
  bind_writer<PitchResponse>(
      module, "write_pitch", taking("Writes heave and pitch as ``pitch.csv``.", "PitchResponse"),
      [](const PitchResponse& response, const Record& record) { return format_pitch(response, record); });
  bind_writer<CoupledResponse>(
      module, "write_coupled", taking("Writes a coupled motion as ``coupled.csv``.", "CoupledResponse"),
      [](const CoupledResponse& response, const Record& record) { return format_coupled(response, record); });
  bind_writer<LoadCellWall>(module, "write_wall",
                            taking("Writes the forces of a wall as ``wall.csv``.", "LoadCellWall"),
                            [](const LoadCellWall& wall, const Record& record) { return format_wall(wall, record); });
  bind_writer<SensorCorrection>(
      module, "write_sensor_correction",
      taking("Writes the corrected channels as ``corrected.csv``, of whose mean read_pulse makes a pulse.",
             "SensorCorrection"),
      [](const SensorCorrection& correction, const Record& record) { return format_correction(correction, record); });
  bind_writer<Comparison>(
      module, "write_comparison", taking("Writes a comparison as ``rating.json``.", "Comparison"),
      [](const Comparison& comparison, const Record& record) { return format_comparison(comparison, record); });
}

void bind_model_writers(py::module_& module) {
  bind_writer<py::object>(
      module, "write_model",
      taking("Writes a model as ``model.json``, which read_model gives back; of an identification also what it says of "
             "the model.",
             "CrushModel or Identification"),
      [](const py::object& model, const Record& record) {
        if (!py::isinstance<Identification>(model))
          return format_model(model.cast<const CrushModel&>(), nullptr, &record);
        const auto& fit = model.cast<const Identification&>();
        return format_model(fit.model, &fit, &record);
      });
  bind_writer<py::object>(
      module, "write_vehicle",
      taking(
          "Writes a vehicle as ``vehicle.json``, which read_vehicle gives back; of an identification also what it says "
          "of the vehicle.",
          "HeavePitchModel or PitchIdentification"),
      [](const py::object& model, const Record& record) {
        if (!py::isinstance<PitchIdentification>(model))
          return format_vehicle(model.cast<const HeavePitchModel&>(), nullptr, &record);
        const auto& fit = model.cast<const PitchIdentification&>();
        return format_vehicle(fit.model, &fit, &record);
      });
  module.def(
      "read_vehicle", [](const py::object& path) { return read_vehicle(path_text(path)); }, py::arg("path"),
      R"(Reads a vehicle from a ``vehicle.json`` or the [vehicle] table of a TOML file; what it does not say stays unset.

Parameters
----------
path : str or os.PathLike

Returns
-------
HeavePitchModel

Raises
------
InvalidInput
    With path, key, value and rule when it is missing, another kind of file, or has a bad value.
)");
}

void bind_response_writer(py::module_& module) {
  module.def(
      "write_response",
      [](const CrushResponse& response, const py::object& path, double mass_kg, bool overwrite) {
        write_file_atomically(path_text(path), format_response(response, mass_kg, record_of("write_response", {})),
                              overwrite);
      },
      py::arg("result"), py::arg("path"), py::arg("mass_kg") = kUnset, py::kw_only(), py::arg("overwrite") = false,
      (taking("Writes a simulation as ``response.csv``.", "CrushResponse") +
       "\nmass_kg : float, optional\n    Test mass [kg]." + kFileDoc)
          .c_str());
}

void bind_iso_mme(py::module_& module) {
  module.def(
      "write_iso_mme",
      [](const TraceSet& traces, const py::object& folder, const std::string& name, bool overwrite) {
        IsoMmeTest test = make_iso_mme_test(traces, name);
        test.record = to_json(record_of("write_iso_mme", traces.input_files));
        write_iso_mme(test, path_text(folder), overwrite);
        return test.notes;
      },
      py::arg("traces"), py::arg("folder"), py::kw_only(), py::arg("name"), py::arg("overwrite") = false,
      R"(Writes traces as an ISO-MME test (ISO/TS 13499).

Parameters
----------
traces : TraceSet
folder : str or os.PathLike
    Folder to write, whole or not at all.
name : str
    Name of the test and its files.
overwrite : bool
    Replace the folder when it holds nothing but what is written anew.

Returns
-------
list of str
    Channels left out, and why.

Raises
------
InvalidInput
    When no channel can be written, or the folder is there.
SystemFailure
    With path and reason when it cannot be written.
)");
}

}  // namespace

void bind_files(py::module_& module) {
  bind_motion_writers(module);
  bind_response_writer(module);
  bind_model_writers(module);
  bind_iso_mme(module);
  module.def(
      "export_model",
      [](const CrushModel& model, const py::kwargs& keywords) {
        const auto options = options_from<ExportOptions>(keywords, "export_model");
        return export_model(model, options, record_of("export_model", {})).text;
      },
      py::arg("model"),
      with_options_doc<ExportOptions>(R"(A model as cards of LS-DYNA or OpenRadioss, or as a table.

Parameters
----------
model : CrushModel
**options
    See below; `to` is needed.

Returns
-------
str
    The text of the include file or table.

Raises
------
InvalidInput
    On a bad model or option.)")
          .c_str());
  module.def(
      "find_record",
      [](const py::object& path) -> py::object {
        const std::optional<Record> record = find_record(path_text(path));
        return record ? py::module_::import("json").attr("loads")(to_json(*record)) : py::none();
      },
      py::arg("path"), R"(The record of what made an output of crashsim: command, options, inputs, version.

Parameters
----------
path : str or os.PathLike
    Any file that crashsim wrote.

Returns
-------
dict or None
    None when the file holds no record.

Raises
------
InvalidInput
    When the file is missing or its record is damaged.
)");
}

}  // namespace crashsim::python
