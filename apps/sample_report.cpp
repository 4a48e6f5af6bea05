#include "sample_report.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace crashsim::cli {
namespace {

std::string cell(double value) { return std::isnan(value) ? "-" : fmt::format("{:.5g}", value); }

std::string counts_of(const SampleTable& table, const SampleSummary& summary) {
  std::string text = fmt::format("samples: {} of {}, {}", table.rows(), table.planned,
                                 table.is_grid ? "grid" : name_of(table.design.method));
  for (const auto& [outcome, count] : summary.outcomes) text += fmt::format(", {} {}", count, outcome);
  return text;
}

/// The measure by which inputs are compared: the best one there is.
std::pair<const char*, double (*)(const SampleEffect&)> measure_of(const SampleTable& table) {
  if (table.is_grid) return {"rank correlation", [](const SampleEffect& effect) { return effect.spearman; }};
  if (table.design.method == SampleMethod::saltelli)
    return {"total index", [](const SampleEffect& effect) { return effect.total.value; }};
  return {"first-order index", [](const SampleEffect& effect) { return effect.first_order.value; }};
}

}  // namespace

std::vector<std::string> table_of(const SampleTable& table) {
  const SampleSummary summary = summarize_samples(table);
  const auto [name, measure] = measure_of(table);
  std::vector<std::string> lines = {counts_of(table, summary)};
  lines.push_back(fmt::format("  {:<26} {:>11} {:>11} {:>11} {:>11} {:>11}  {}", "", "mean", "deviation", "5 %",
                              "median", "95 %", "driven by (" + std::string(name) + ")"));
  for (const SampleOutput& output : summary.outputs) {
    const SampleStatistics& s = output.statistics;
    if (s.count == 0) continue;
    double largest = 0.0;
    std::string driver;
    for (std::size_t i = 0; i < output.effects.size(); ++i) {
      const double value = measure(output.effects[i]);
      if (!(std::fabs(value) > std::fabs(largest))) continue;
      largest = value;
      driver = fmt::format("  {} ({:.2f})", table.inputs[i].name, value);
    }
    lines.push_back(fmt::format("  {:<26} {:>11} {:>11} {:>11} {:>11} {:>11}{}", output.name, cell(s.mean), cell(s.sd),
                                cell(s.q05), cell(s.q50), cell(s.q95), driver));
  }
  return lines;
}

}  // namespace crashsim::cli
