#include <string>
#include <vector>

#include <pybind11/stl.h>

#include <crashsim/case.hpp>
#include <crashsim/design_case.hpp>
#include <crashsim/files.hpp>
#include <crashsim/summary.hpp>

#include "bindings.hpp"
#include "long_call.hpp"
#include "paths.hpp"
#include "summaries.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

py::dict options_of(const Case& study) {
  py::dict out;
  for (const ConfigEntry& entry : entries_of(study))
    out[py::str(entry.section.empty() ? entry.key : entry.section + "." + entry.key)] = option_object(entry.value);
  return out;
}

Case case_of(const py::object& given, const py::object& jobs) {
  Case study = py::isinstance<Case>(given) ? given.cast<Case>() : read_case(path_text(given));
  if (!jobs.is_none()) study.identify.jobs = jobs.cast<int>();
  return study;
}

/// What the functions that run a case take, and what ends them.
constexpr const char* kRunDoc = R"(
Parameters
----------
case : Case, str or os.PathLike
    A case or the path of its file.
output : str or os.PathLike, optional
    Folder for the files that the program writes, whole or not at all.
overwrite : bool
    Replace the folder when it holds nothing but what is written anew.
jobs : int, optional
    Threads; 0: all cores. The result does not depend on it.
progress : callable or tqdm bar, optional
    ``progress(done, total)`` is called now and then with the starts done; return False to stop. A tqdm bar is moved.

Raises
------
InvalidInput
    On bad options, files or values, or when `output` is there already.
SystemFailure
    When it cannot be written.
KeyboardInterrupt
    On Ctrl-C; nothing is written.

Returns
-------
)";

/// Binds a function that runs a case and, given an output folder, writes its files there: not before Ctrl-C had its
/// say.
template <class Run, class Files>
void bind_run(py::module_& module, const char* function, const std::string& doc, const char* result, Run run,
              Files files) {
  module.def(
      function,
      [run, files](const py::object& given, const py::object& output, bool overwrite, const py::object& jobs,
                   const py::object& progress) {
        const Case study = case_of(given, jobs);
        auto done = watched(progress, [&](const Progress& told) { return run(study, told); });
        if (!output.is_none()) {
          const std::string folder = path_text(output);
          unlocked([&] { write_folder_atomically(folder, files(study, done), overwrite); });
        }
        return done;
      },
      py::arg("case"), py::arg("output") = py::none(), py::kw_only(), py::arg("overwrite") = false,
      py::arg("jobs") = py::none(), py::arg("progress") = py::none(), (doc + "\n" + kRunDoc + result + "\n").c_str());
}

void bind_case_classes(py::module_& module) {
  py::class_<Case>(module, "Case", "One study, as read from a case file: inputs, options, outputs. See read_case().")
      .def_property_readonly(
          "path", [](const Case& self) { return self.path; }, "As given by the caller.")
      .def_property_readonly("options", &options_of, "Every option, set or default, as a dict: 'crush.knots', ...")
      .def("__repr__", [](const Case& self) { return "<Case " + self.path + ">"; });
  ValueClass<Prediction>(module, "Prediction", "Simulation of a case's model at another speed.")
      .field("name", &Prediction::name, "'40kmh'")
      .field("response", &Prediction::response, "CrushResponse.");
  ValueClass<CaseResult>(module, "CaseResult", "What a case gives; None where it does not ask for a part.")
      .field("pulse", &CaseResult::pulse, "Pulse of the test, or None.")
      .field("identification", &CaseResult::identification, "Identification, or None.")
      .field("model", &CaseResult::model, "CrushModel identified or read.")
      .field("response", &CaseResult::response, "CrushResponse of the model.")
      .field("forcing", &CaseResult::forcing, "MeasuredForcing where the case names a file, or None.")
      .field("pitch", &CaseResult::pitch, "PitchResponse, or None.")
      .field("coupled", &CaseResult::coupled, "CoupledResponse, or None.")
      .field("predictions", &CaseResult::predictions, "A Prediction each.")
      .field("comparisons", &CaseResult::comparisons, "A NamedComparison each.")
      .field("samples", &CaseResult::samples, "SampleTable of ``[sweep]`` or ``[monte_carlo]``, or None.")
      .field("input_files", &CaseResult::input_files, "Every file read.")
      .field("notes", &CaseResult::notes, "What the case did not say and was taken from elsewhere.")
      .def_property_readonly("usable", &CaseResult::usable, "True when every step gave a result to rely on.")
      .def(
          "summary", [](const CaseResult& self) { return dict_of(summarize(self)); },
          "Numbers of the model's response and its heave and pitch, under their names in summary.json.")
      .def(
          "parts", [](const CaseResult& self) { return dict_of(summary_parts(self)); },
          "The other summaries: 'pulse', 'identification', 'coupled', ``rating_*``, ``prediction_*``.");
}

void bind_design_case(py::module_& module) {
  ValueClass<DesignCaseResult>(module, "DesignCaseResult", "What the design study of a case gives.")
      .field("base", &DesignCaseResult::base, "CaseResult: what the crush model comes from.")
      .field("model", &DesignCaseResult::model, "CoupledModel before the design.")
      .field("design", &DesignCaseResult::design, "DesignResult.")
      .field("response", &DesignCaseResult::response, "CoupledResponse of the optimum.")
      .field("notes", &DesignCaseResult::notes, "What a careful reader should know.")
      .def_property_readonly("usable", &DesignCaseResult::usable, "True when the optimum is one to rely on.");
  bind_run(
      module, "run_design", "Runs a case and the design study that it asks for in ``[design]``.", "DesignCaseResult",
      [](const Case& study, const Progress& told) { return run_design(study, told); },
      [](const Case& study, const DesignCaseResult& result) { return design_files(study, result); });
}

}  // namespace

void bind_case(py::module_& module) {
  bind_case_classes(module);
  bind_design_case(module);
  module.def(
      "read_case", [](const py::object& path) { return read_case(path_text(path)); }, py::arg("path"),
      R"(Reads a case: TOML, or the record ``case.lock.json`` of a case that was run, whose inputs are checked.

Parameters
----------
path : str or os.PathLike

Returns
-------
Case

Raises
------
InvalidInput
    With path, line, key and rule, or the nearest known key.
)");
  bind_run(
      module, "run_case", "Runs a case: pulse, identification, simulation, heave and pitch, comparison.", "CaseResult",
      [](const Case& study, const Progress& told) { return run_case(study, told); },
      [](const Case& study, const CaseResult& result) { return case_files(study, result); });
  module.def(
      "summarize", [](const Pulse& pulse) { return dict_of(summarize(pulse)); }, py::arg("result"));
  module.def(
      "summarize", [](const CrushResponse& response, double mass_kg) { return dict_of(summarize(response, mass_kg)); },
      py::arg("result"), py::arg("mass_kg") = kUnset);
  module.def(
      "summarize", [](const PitchResponse& response) { return dict_of(summarize(response)); }, py::arg("result"));
  module.def(
      "summarize", [](const CoupledResponse& response) { return dict_of(summarize(response)); }, py::arg("result"));
  module.def(
      "summarize", [](const Identification& fit) { return dict_of(summarize(fit)); }, py::arg("result"),
      R"(The numbers of a result under the names that command line, files and tables share.

Parameters
----------
result : Pulse, CrushResponse, PitchResponse, CoupledResponse or Identification
mass_kg : float, optional
    Of a CrushResponse: for energy and stiffness [kg].

Returns
-------
dict
    ``'outcome'`` and every number, NaN where a quantity does not exist.

Raises
------
TypeError
    When `result` is none of these.
)");
}

}  // namespace crashsim::python
