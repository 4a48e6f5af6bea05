#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

#include <crashsim/batch.hpp>
#include <crashsim/batch_folder.hpp>

#include "bindings.hpp"
#include "long_call.hpp"
#include "paths.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

/// The folder of a batch until it is closed.
class OpenFolder {
 public:
  OpenFolder(const std::string& path, const std::vector<BatchCase>& plan, const BatchOptions& options)
      : folder_(std::make_unique<BatchFolder>(path, plan, options)) {}

  [[nodiscard]] BatchFolder& get() const {
    if (!folder_) throw InvalidInput("BatchFolder: is closed");
    return *folder_;
  }
  [[nodiscard]] const BatchCase& at(std::size_t index) const {
    const std::vector<BatchCase>& cases = get().cases();
    if (index >= cases.size())
      throw py::index_error("case " + std::to_string(index) + " of " + std::to_string(cases.size()));
    return cases[index];
  }
  void close() { folder_.reset(); }

 private:
  std::unique_ptr<BatchFolder> folder_;
};

std::vector<std::string> path_texts(const py::object& given) {
  if (py::isinstance<py::str>(given) || py::hasattr(given, "__fspath__")) return {path_text(given)};
  std::vector<std::string> paths;
  for (const py::handle path : given.cast<py::iterable>())
    paths.push_back(path_text(py::reinterpret_borrow<py::object>(path)));
  return paths;
}

void bind_rows(py::module_& module) {
  ValueClass<StageTimes> stages(module, "StageTimes", "Wall time of the steps of a case, or sums of it over cases.");
  for (const auto& stage : kStageTimes)
    stages.field(std::string(stage.name).c_str(), stage.member, (std::string(stage.doc) + " [s]").c_str());
  ValueClass<BatchCase>(module, "BatchCase", "One case of a batch.")
      .field("name", &BatchCase::name, "Of its folder and its row.")
      .field("path", &BatchCase::path, "Case file, as seen from where the program runs.");
  ValueClass<BatchRow>(module, "BatchRow", "One case's row of the results table of a batch.")
      .field("name", &BatchRow::name, "Of the case.")
      .field("outcome", &BatchRow::outcome,
             "Of its results; or, when there are none, 'invalid_input', 'numerical_failure', 'system_failure', "
             "'out_of_memory', 'time_limit' or 'crashed'.")
      .field("message", &BatchRow::message, "What failed; '' when nothing did.")
      .field("exit_code", &BatchRow::exit_code,
             "Of `crashsim run`: 0 done, 2 the user can fix it, 3 the numbers failed, 4 the machine did.")
      .field("values", &BatchRow::values, "The summary without its outcome, a dict.")
      .field("parts", &BatchRow::parts, "Its other parts, a dict of dicts: 'pulse', 'identification', ...")
      .field("identity", &BatchRow::identity, "SHA-256 of the record; '' without results.")
      .field("bytes", &BatchRow::bytes, "Of the case's files.")
      .field("stages", &BatchRow::stages, "StageTimes.")
      .field("seconds", &BatchRow::seconds, "Wall time [s].")
      .def_property_readonly("failed", &BatchRow::failed, "True when there is something to look at.")
      .def(
          "to_json", [](const BatchRow& self) { return to_json(self); },
          "The row as one line of JSON, which batch_row_from_json() reads.");
}

void bind_report(py::module_& module) {
  ValueClass<BatchReport>(module, "BatchReport", "How a batch went. The lists are short however many cases there are.")
      .field("total", &BatchReport::total, "Cases asked for.")
      .field("done", &BatchReport::done, "Of these, with a row.")
      .field("unchanged", &BatchReport::unchanged, "Of these, done before.")
      .field("failed", &BatchReport::failed, "Of these.")
      .field("retried", &BatchReport::retried, "How often a case was run again since its worker had died.")
      .field("left_over", &BatchReport::left_over, "Cases in the folder that were not asked for.")
      .field("interrupted", &BatchReport::interrupted, "Stopped by the progress function.")
      .field("seconds", &BatchReport::seconds, "Wall time [s].")
      .field("stages", &BatchReport::stages, "StageTimes, sums over the cases run.")
      .field("slowest", &BatchReport::slowest, "(name, seconds) of cases run, slowest first, 10 at most.")
      .field("failures", &BatchReport::failures, "BatchRow of the first 10 that failed, in the order of the plan.")
      .field("exit_code", &BatchReport::exit_code, "Of `crashsim batch`: 0, 3 when a case failed, 130 interrupted.");
}

void bind_folder(py::module_& module) {
  py::class_<OpenFolder>(module, "BatchFolder",
                         R"(The folder of a batch: what is done is kept there, whatever happens. While it is open nobody
else can open it; close it or use it in a with statement. For ways of your own to run the cases of a batch:
run_batch_case() anywhere, then record() here. Raises InvalidInput when the folder holds results (without `resume`),
other things or another shard, or is in use, SystemFailure when it cannot be written.)")
      .def(py::init(
               [](const py::object& path, const std::vector<BatchCase>& plan, const std::string& shard, bool resume) {
                 BatchOptions options;
                 options.shard = shard;
                 options.resume = resume;
                 const std::string folder = path_text(path);
                 return unlocked([&] { return std::make_unique<OpenFolder>(folder, plan, options); });
               }),
           py::arg("path"), py::arg("plan"), py::kw_only(), py::arg("shard") = "1/1", py::arg("resume") = false)
      .def_property_readonly(
          "path", [](const OpenFolder& self) { return self.get().path(); }, "As given.")
      .def_property_readonly(
          "left_over", [](const OpenFolder& self) { return self.get().left_over(); },
          "Cases with a row that are not in the plan.")
      .def("__len__", [](const OpenFolder& self) { return self.get().cases().size(); })
      .def(
          "case", [](const OpenFolder& self, std::size_t index) { return self.at(index); }, py::arg("index"),
          "A BatchCase of this shard, in the order of the plan.")
      .def(
          "row_of", [](const OpenFolder& self, std::size_t index) { return self.get().row_of(index); },
          py::arg("index"), "BatchRow of a case from an earlier run or this one, or None.")
      .def(
          "record",
          [](const OpenFolder& self, std::size_t index, const BatchRow& row) {
            unlocked([&] { self.get().record(index, row); });
          },
          py::arg("index"), py::arg("row"),
          "Keeps a row: from now on the case is done, whatever happens. Removes the files of a case without results.")
      .def(
          "write_tables", [](const OpenFolder& self) { unlocked([&] { self.get().write_tables(); }); },
          "Writes results.csv, results.jsonl and timings.csv of the rows there are.")
      .def("close", &OpenFolder::close, "Lets others open it.")
      .def("__enter__", [](const py::object& self) { return self; })
      .def("__exit__", [](OpenFolder& self, const py::args&) { self.close(); });
}

void bind_work(py::module_& module) {
  module.def(
      "run_batch_case",
      [](const BatchCase& one, const py::object& folder) {
        const std::string path = path_text(folder);
        return unlocked([&] { return run_batch_case(one, path); });
      },
      py::arg("case"), py::arg("folder"),
      R"(Runs one case of a batch with one thread, in any process that sees the files.

Writes its files to ``folder/cases/NAME``, whole or not at all, in place of earlier ones. BatchFolder.record() keeps the
row.

Parameters
----------
case : BatchCase
folder : str or os.PathLike
    Of the batch.

Returns
-------
BatchRow
    What fails in the case is told by the row; then there are no files, except where only the numbers failed.

Raises
------
SystemFailure
    When the files cannot be written.
InvalidInput
    When files of somebody else would be lost.
)");
  module.def(
      "is_batch_case_done",
      [](const BatchCase& one, const py::object& folder, const BatchRow& done) {
        const std::string path = path_text(folder);
        return unlocked([&] { return is_batch_case_done(one, path, done); });
      },
      py::arg("case"), py::arg("folder"), py::arg("row"),
      R"(Tells whether a row is what running the case would give: same options, inputs and version, its files all there.

Parameters
----------
case : BatchCase
folder : str or os.PathLike
    Of the batch.
row : BatchRow
    Of an earlier run.

Returns
-------
bool

Raises
------
TypeError
    On other types.
)");
  module.def(
      "batch_row_from_json", [](const std::string& text) { return batch_row_from_json(text); }, py::arg("text"),
      R"(Reads a row that BatchRow.to_json() wrote.

Parameters
----------
text : str

Returns
-------
BatchRow

Raises
------
InvalidInput
    When the text is no row.
)");
}

void bind_plan_and_merge(py::module_& module) {
  module.def(
      "plan_batch",
      [](const py::object& cases) {
        const std::vector<std::string> paths = path_texts(cases);
        return py::tuple(py::cast(unlocked([&] { return plan_batch(paths); })));
      },
      py::arg("cases"),
      R"(The cases that paths name, in their order.

Parameters
----------
cases : str, os.PathLike or sequence of them
    Case files (.toml), records of cases (.json), globs, or manifests: text files with a case file or glob a line,
    relative to the manifest, ``name = file`` to name it.

Returns
-------
tuple of BatchCase

Raises
------
InvalidInput
    When there is no such file, no case, a case twice, or two of one name.
)");
  module.def(
      "merge_batches",
      [](const py::object& shards, const py::object& folder) {
        const std::vector<std::string> paths = path_texts(shards);
        const std::string path = path_text(folder);
        return unlocked([&] { return merge_batches(paths, path); });
      },
      py::arg("shards"), py::arg("folder"),
      R"(Joins the folders of all shards of a batch: the same bytes as without shards.

Parameters
----------
shards : sequence of str or os.PathLike
    Folders, each of run_batch(shard="I/N") or ``crashsim batch --shard I/N``.
folder : str or os.PathLike
    To write, not there yet.

Returns
-------
BatchReport

Raises
------
InvalidInput
    When a shard is missing, there twice, unfinished or of another batch.
SystemFailure
    When the folder cannot be written.
)");
}

}  // namespace

void bind_batch(py::module_& module) {
  bind_rows(module);
  bind_report(module);
  bind_folder(module);
  bind_work(module);
  bind_plan_and_merge(module);
}

}  // namespace crashsim::python
