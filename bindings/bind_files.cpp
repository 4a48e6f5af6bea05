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

#include "bindings.hpp"
#include "keywords.hpp"
#include "paths.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

Record record_of(const std::string& function, const std::vector<std::string>& inputs) {
  return make_record("python " + function, {}, {}, inputs);
}

void bind_writers(py::module_& module) {
  const char* common = R"(
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
  module.def(
      "write_pulse",
      [](const Pulse& pulse, const py::object& path, bool overwrite) {
        write_file_atomically(path_text(path), format_pulse(pulse, record_of("write_pulse", pulse.input_files)),
                              overwrite);
      },
      py::arg("pulse"), py::arg("path"), py::kw_only(), py::arg("overwrite") = false,
      (std::string(
           "Writes a pulse as ``pulse.csv``, which read_pulse gives back.\n\nParameters\n----------\npulse : Pulse") +
       common)
          .c_str());
  module.def(
      "write_response",
      [](const CrushResponse& response, const py::object& path, double mass_kg, bool overwrite) {
        write_file_atomically(path_text(path), format_response(response, mass_kg, record_of("write_response", {})),
                              overwrite);
      },
      py::arg("response"), py::arg("path"), py::arg("mass_kg") = kUnset, py::kw_only(), py::arg("overwrite") = false,
      (std::string("Writes a simulation as ``response.csv``.\n\nParameters\n----------\nresponse : CrushResponse\n"
                   "mass_kg : float, optional\n    Test mass [kg].") +
       common)
          .c_str());
  module.def(
      "write_model",
      [](const py::object& model, const py::object& path, bool overwrite) {
        const Record record = record_of("write_model", {});
        const std::string text =
            py::isinstance<Identification>(model)
                ? format_model(model.cast<const Identification&>().model, &model.cast<const Identification&>(), &record)
                : format_model(model.cast<const CrushModel&>(), nullptr, &record);
        write_file_atomically(path_text(path), text, overwrite);
      },
      py::arg("model"), py::arg("path"), py::kw_only(), py::arg("overwrite") = false,
      (std::string("Writes a model as ``model.json``, which read_model gives back; of an identification also what it "
                   "says of the model.\n\nParameters\n----------\nmodel : CrushModel or Identification") +
       common)
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
  bind_writers(module);
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
