/// The samples of a case as files.

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <crashsim/sweep.hpp>
#include <crashsim/units.hpp>

#include "json.hpp"
#include "record_json.hpp"
#include "sample_runner.hpp"

namespace crashsim {
namespace {

std::string method_of(const SampleTable& table) {
  return table.is_grid ? "grid" : std::string(name_of(table.design.method));
}

std::string outcome_of(const SampleTable& table) {
  if (table.rows() < table.planned) return "interrupted";
  return table.usable() ? "completed" : "every_sample_failed";
}

Json statistics_json(const SampleStatistics& s) {
  Json json = {{"count", s.count},          {"mean", json_number(s.mean)}, {"sd", json_number(s.sd)},
               {"q05", json_number(s.q05)}, {"q50", json_number(s.q50)},   {"q95", json_number(s.q95)},
               {"min", json_number(s.min)}, {"max", json_number(s.max)}};
  json["min_sample"] = s.count > 0 ? Json(s.min_at) : Json();
  json["max_sample"] = s.count > 0 ? Json(s.max_at) : Json();
  return json;
}

Json input_json(const SampleInput& input, const SampleStatistics& statistics) {
  const Distribution& d = input.distribution;
  Json json = {{"unit", input.unit}, {"distribution", name_of(d.kind)}, {"numbers", json_numbers(d.numbers)}};
  if (!d.weights.empty()) json["weights"] = json_numbers(d.weights);
  if (!std::isnan(d.lower)) json["lower"] = d.lower;
  if (!std::isnan(d.upper)) json["upper"] = d.upper;
  if (!std::isnan(input.base)) json["factor_of"] = input.base;
  json["statistics"] = statistics_json(statistics);
  return json;
}

/// A table of outputs by inputs.
template <class Value>
Json effect_table(const SampleTable& table, const SampleSummary& summary, Value value) {
  Json rows = Json::object();
  for (const SampleOutput& output : summary.outputs) {
    Json row = Json::object();
    for (std::size_t i = 0; i < table.inputs.size(); ++i) row[table.inputs[i].name] = value(output.effects[i]);
    rows[output.name] = row;
  }
  return rows;
}

Json index_json(const SobolIndex& index) {
  Json json = {{"value", json_number(index.value)}};
  if (!std::isnan(index.error)) json["error"] = index.error;
  return json;
}

Json sobol_json(const SampleTable& table, const SampleSummary& summary) {
  Json json = {
      {"first_order", effect_table(table, summary, [](const SampleEffect& e) { return index_json(e.first_order); })}};
  if (table.design.method == SampleMethod::saltelli)
    json["total"] = effect_table(table, summary, [](const SampleEffect& e) { return index_json(e.total); });
  return json;
}

}  // namespace

std::string sample_header(const SampleTable& table) {
  std::string header = "sample";
  for (const SampleInput& input : table.inputs) header += "," + input.name;
  header += ",outcome";
  for (const std::string& name : table.outputs) header += "," + name;
  return header;
}

std::string format_samples(const SampleTable& table, const Record& record) {
  const auto cell = [](double value) { return std::isnan(value) ? std::string() : format_number(value); };
  std::string text = fmt::format("# crashsim = {}\n# method = {}\n# planned = {}\n# record = {}\n{}\n", record.version,
                                 method_of(table), table.planned, to_json(record), sample_header(table));
  for (std::size_t row = 0; row < table.rows(); ++row) {
    text += std::to_string(table.samples[row]);
    for (std::size_t column = 0; column < table.columns(); ++column) {
      if (column == table.inputs.size()) text += "," + table.outcomes[row];
      text += "," + cell(table.at(row, column));
    }
    text += '\n';
  }
  return text;
}

std::string format_sample_summary(const SampleTable& table, const SampleSummary& summary, const Record& record) {
  Json outcomes = Json::object(), inputs = Json::object(), statistics = Json::object();
  for (const auto& [outcome, count] : summary.outcomes) outcomes[outcome] = count;
  for (std::size_t i = 0; i < table.inputs.size(); ++i)
    inputs[table.inputs[i].name] = input_json(table.inputs[i], summary.inputs[i]);
  for (const SampleOutput& output : summary.outputs) {
    statistics[output.name] = statistics_json(output.statistics);
    statistics[output.name]["left_out"] = output.left_out;
  }
  Json json = {{"outcome", outcome_of(table)}, {"method", method_of(table)}, {"planned", table.planned},
               {"samples", table.rows()},      {"outcomes", outcomes},       {"inputs", inputs},
               {"statistics", statistics}};
  json["pearson"] = effect_table(table, summary, [](const SampleEffect& e) { return json_number(e.pearson); });
  json["spearman"] = effect_table(table, summary, [](const SampleEffect& e) { return json_number(e.spearman); });
  if (!table.is_grid) json["sobol"] = sobol_json(table, summary);
  json["record"] = record_json(record);
  return format_json(json);
}

}  // namespace crashsim
