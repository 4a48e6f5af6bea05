#include <string>
#include <vector>

#include <pybind11/stl.h>

#include <crashsim/sweep.hpp>

#include "bindings.hpp"
#include "long_call.hpp"
#include "value_class.hpp"

namespace crashsim::python {
namespace {

/// One column of the numbers, without a copy.
py::array column_of(const py::object& owner, std::size_t column) {
  const auto& table = owner.cast<const SampleTable&>();
  if (table.rows() == 0) return view_of(std::span<const double>(), owner);
  py::array_t<double> array({table.rows()}, {table.columns() * sizeof(double)}, table.numbers.data() + column, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

std::vector<std::string> column_names(const SampleTable& table) {
  std::vector<std::string> names;
  for (const SampleInput& input : table.inputs) names.push_back(input.name);
  names.insert(names.end(), table.outputs.begin(), table.outputs.end());
  return names;
}

py::array column_named(const py::object& self, const std::string& name) {
  const std::vector<std::string> names = column_names(self.cast<const SampleTable&>());
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return column_of(self, i);
  const std::string_view near = nearest_name(name, {names.begin(), names.end()});
  throw py::key_error("no column \"" + name + "\"" +
                      (near.empty() ? "" : "; did you mean \"" + std::string(near) + "\"?"));
}

/// As in samples.csv: the sample, what went in, how it ended, what came out.
py::dict table_of(const py::object& self) {
  const auto& table = self.cast<const SampleTable&>();
  const std::vector<std::string> names = column_names(table);
  py::dict columns;
  columns["sample"] = view_of(table.samples, self);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i == table.inputs.size()) columns["outcome"] = py::cast(table.outcomes);
    columns[py::str(names[i])] = column_of(self, i);
  }
  return columns;
}

void bind_inputs(py::module_& module) {
  ValueClass<Distribution>(module, "Distribution", "How a number varies.")
      .field("kind", &Distribution::kind, "'normal', 'lognormal', 'uniform', 'triangular' or 'table'.")
      .field("numbers", &Distribution::numbers,
             "Mean and standard deviation; least and largest; least, most likely, largest; or those of a table.")
      .field("weights", &Distribution::weights, "Of a table's numbers; empty: all the same.")
      .field("lower", &Distribution::lower, "Where it is cut off below, NaN: nowhere.")
      .field("upper", &Distribution::upper, "Where it is cut off above, NaN: nowhere.");
  ValueClass<SampleInput>(module, "SampleInput", "A number of a case that varies.")
      .field("name", &SampleInput::name, "Its key in the case, with the unit: 'vehicle.mass_kg'.")
      .field("unit", &SampleInput::unit, "SI symbol.")
      .field("distribution", &SampleInput::distribution, "Distribution, in SI or of a factor.")
      .field("base", &SampleInput::base, "What the factor multiplies [SI]; NaN: no factor.");
  ValueClass<SampleDesign>(module, "SampleDesign", "Points at which a case is sampled.")
      .field("method", &SampleDesign::method, "'random', 'latin_hypercube', 'sobol' or 'saltelli'.")
      .field("samples", &SampleDesign::samples, "Points; of saltelli groups of points.")
      .field("seed", &SampleDesign::seed, "A point depends on it and on its own index only.")
      .field("dimensions", &SampleDesign::dimensions, "Numbers that vary.");
}

void bind_statistics(py::module_& module) {
  ValueClass<SampleStatistics>(module, "SampleStatistics", "Spread of one number over the samples that have it.")
      .field("count", &SampleStatistics::count, "Samples that have it.")
      .field("mean", &SampleStatistics::mean, "Arithmetic mean.")
      .field("sd", &SampleStatistics::sd, "Standard deviation, of count - 1.")
      .field("q05", &SampleStatistics::q05, "5 % quantile.")
      .field("q50", &SampleStatistics::q50, "Median.")
      .field("q95", &SampleStatistics::q95, "95 % quantile.")
      .field("min", &SampleStatistics::min, "Smallest.")
      .field("max", &SampleStatistics::max, "Largest.")
      .field("min_at", &SampleStatistics::min_at, "Sample that has the smallest.")
      .field("max_at", &SampleStatistics::max_at, "Sample that has the largest.");
  ValueClass<SobolIndex>(module, "SobolIndex", "A part of an output's variance.")
      .field("value", &SobolIndex::value, "0..1, NaN when not known.")
      .field("error", &SobolIndex::error, "Standard error, as independent points would have it.");
  ValueClass<SampleEffect>(module, "SampleEffect", "How one output depends on one input; NaN where not known.")
      .field("pearson", &SampleEffect::pearson, "Correlation of the numbers.")
      .field("spearman", &SampleEffect::spearman, "Correlation of their ranks.")
      .field("first_order", &SampleEffect::first_order, "SobolIndex: part of the variance by this input alone.")
      .field("total", &SampleEffect::total, "SobolIndex: with all that it acts together with; of saltelli only.");
  ValueClass<SampleOutput>(module, "SampleOutput", "One output over the samples that completed.")
      .field("name", &SampleOutput::name, "Of the summary.")
      .field("statistics", &SampleOutput::statistics, "SampleStatistics.")
      .field("left_out", &SampleOutput::left_out, "Samples that failed or have no such number.")
      .field("effects", &SampleOutput::effects, "A SampleEffect of each input.");
  ValueClass<SampleSummary>(module, "SampleSummary", "What samples say together.")
      .field("outcomes", &SampleSummary::outcomes, "(outcome, samples that ended so).")
      .field("inputs", &SampleSummary::inputs, "SampleStatistics of each input, over the samples that completed.")
      .field("outputs", &SampleSummary::outputs, "A SampleOutput each.");
}

void bind_table(py::module_& module) {
  ValueClass<SampleTable>(module, "SampleTable",
                          R"(Samples of a case, a row each: what went in, how it ended, what came out.
``to_dataframe()`` has the columns of ``samples.csv``.)")
      .field("inputs", &SampleTable::inputs, "SampleInput of each number that varies.")
      .field("is_grid", &SampleTable::is_grid, "Every combination of the inputs' tables, instead of `design`.")
      .field("design", &SampleTable::design, "SampleDesign of random samples.")
      .field("planned", &SampleTable::planned, "Samples of the whole study.")
      .field("outputs", &SampleTable::outputs, "Names of the summary: 'max_crush_m'.")
      .field("samples", &SampleTable::samples, "Index of each row's sample, increasing.")
      .field("outcomes", &SampleTable::outcomes, "'completed', or why a row is not to be relied on.")
      .field("numbers", &SampleTable::numbers, "Row after row: inputs, then outputs; see column().")
      .def_property_readonly("usable", &SampleTable::usable,
                             "True when every sample of the study is there, and one of them completed.")
      .def("__len__", &SampleTable::rows)
      .def("column", &column_named, py::arg("name"),
           "The numbers of an input or output, read-only and without a copy. Raises KeyError when there is none.")
      .def("_table", &table_of)
      .def(
          "statistics", [](const SampleTable& self) { return unlocked([&] { return summarize_samples(self); }); },
          "SampleSummary: spread, correlations and Sobol' indices.");
}

void bind_runs(py::module_& module) {
  py::class_<SamplePlan>(module, "SamplePlan", "What every sample of a case shares. See plan_samples().")
      .def_property_readonly(
          "keys", [](const SamplePlan& self) { return self.keys; }, "What varies: 'vehicle.mass'.")
      .def_property_readonly(
          "table", [](const SamplePlan& self) { return self.table; }, "SampleTable without rows.")
      .def("__len__", [](const SamplePlan& self) { return self.table.planned; })
      .def("__repr__",
           [](const SamplePlan& self) { return "<SamplePlan of " + std::to_string(self.table.planned) + " samples>"; });
  module.def(
      "plan_samples",
      [](const Case& study, const CaseResult& base) { return unlocked([&] { return plan_samples(study, base); }); },
      py::arg("case"), py::arg("base"),
      R"(Plans the samples of a case with ``[sweep]`` or ``[monte_carlo]``, to run parts of them anywhere.

Parameters
----------
case : Case
base : CaseResult
    Of run_case(); it must have a model.

Returns
-------
SamplePlan

Raises
------
InvalidInput
    Names the key that cannot vary, or its number and the rule.
)");
  module.def(
      "run_samples",
      [](const SamplePlan& plan, std::uint64_t first, std::uint64_t count, const py::object& progress) {
        return watched(progress, [&](const Progress& told) { return run_samples(plan, first, count, told); });
      },
      py::arg("plan"), py::arg("first"), py::arg("count"), py::kw_only(), py::arg("progress") = py::none(),
      R"(Runs some samples of a case. A row depends on the plan and its index only.

Parameters
----------
plan : SamplePlan
first, count : int
    The samples first .. first + count - 1, fewer where the study ends.
progress : callable or tqdm bar, optional
    ``progress(done, total)`` is called now and then; return False to stop: the samples that are done are kept.

Returns
-------
SampleTable

Raises
------
KeyboardInterrupt
    On Ctrl-C.
)");
  module.def(
      "join_samples",
      [](const std::vector<SampleTable>& parts) { return unlocked([&] { return join_samples(parts); }); },
      py::arg("parts"), R"(Puts rows of the same study together, by index.

Parameters
----------
parts : sequence of SampleTable

Returns
-------
SampleTable

Raises
------
InvalidInput
    When their columns differ or a sample is there twice.
)");
}

}  // namespace

void bind_samples(py::module_& module) {
  bind_inputs(module);
  bind_statistics(module);
  bind_table(module);
}

void bind_sweep(py::module_& module) { bind_runs(module); }

}  // namespace crashsim::python
