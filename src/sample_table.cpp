#include <crashsim/sample_table.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include <crashsim/error.hpp>

namespace crashsim {
namespace {

constexpr std::string_view kCompleted = "completed";

std::vector<double> column_of(const SampleTable& table, std::size_t column, const std::vector<std::size_t>& rows) {
  std::vector<double> numbers;
  numbers.reserve(rows.size());
  for (const std::size_t row : rows) numbers.push_back(table.at(row, column));
  return numbers;
}

/// The inputs of some rows and their ranks.
struct RankedInputs {
  std::vector<std::size_t> rows;
  std::vector<std::vector<double>> numbers, ranks;

  RankedInputs(const SampleTable& table, std::vector<std::size_t> of_rows) : rows(std::move(of_rows)) {
    for (std::size_t i = 0; i < table.inputs.size(); ++i) {
      numbers.push_back(column_of(table, i, rows));
      ranks.push_back(ranks_of(numbers.back()));
    }
  }
};

std::vector<SampleEffect> effects_of(const SampleTable& table, std::size_t column, const RankedInputs& inputs) {
  const std::vector<double> output = column_of(table, column, inputs.rows), ranks = ranks_of(output);
  std::vector<SampleEffect> effects;
  for (std::size_t i = 0; i < inputs.numbers.size(); ++i) {
    SampleEffect effect{correlation(inputs.numbers[i], output), correlation(inputs.ranks[i], ranks), {}, {}};
    if (!table.is_grid) effect.first_order.value = first_order_index(inputs.ranks[i], output);
    effects.push_back(effect);
  }
  return effects;
}

/// Sobol' indices from the groups of a table, whole or not; samples that are not there or failed are NaN.
void take_sobol_indices(const SampleTable& table, std::size_t column, std::vector<SampleEffect>& effects) {
  std::vector<double> outputs(table.planned, kUnset);
  for (std::size_t row = 0; row < table.rows(); ++row)
    if (table.outcomes[row] == kCompleted) outputs[table.samples[row]] = table.at(row, column);
  const std::vector<SobolIndices> indices = sobol_indices(outputs, static_cast<int>(effects.size()));
  for (std::size_t i = 0; i < effects.size(); ++i) {
    effects[i].first_order = indices[i].first_order;
    effects[i].total = indices[i].total;
  }
}

SampleStatistics statistics_of_rows(const SampleTable& table, std::size_t column,
                                    const std::vector<std::size_t>& rows) {
  SampleStatistics statistics = statistics_of(column_of(table, column, rows));
  if (statistics.count == 0) return statistics;
  statistics.min_at = table.samples[rows[statistics.min_at]];
  statistics.max_at = table.samples[rows[statistics.max_at]];
  return statistics;
}

void append(const SampleTable& part, SampleTable& all) {
  all.samples.insert(all.samples.end(), part.samples.begin(), part.samples.end());
  all.outcomes.insert(all.outcomes.end(), part.outcomes.begin(), part.outcomes.end());
  all.numbers.insert(all.numbers.end(), part.numbers.begin(), part.numbers.end());
}

bool has_same_columns(const SampleTable& a, const SampleTable& b) {
  const auto is_same = [](const SampleInput& x, const SampleInput& y) { return x.name == y.name; };
  return std::equal(a.inputs.begin(), a.inputs.end(), b.inputs.begin(), b.inputs.end(), is_same) &&
         a.outputs == b.outputs && a.planned == b.planned;
}

}  // namespace

bool SampleTable::usable() const {
  return rows() == planned && std::find(outcomes.begin(), outcomes.end(), kCompleted) != outcomes.end();
}

SampleTable join_samples(const std::vector<SampleTable>& parts) {
  if (parts.empty()) return {};
  std::vector<const SampleTable*> ordered;
  for (const SampleTable& part : parts) {
    if (!has_same_columns(part, parts.front()))
      throw InvalidInput("samples of different studies cannot be joined: their columns or numbers of samples differ");
    if (part.rows() > 0) ordered.push_back(&part);
  }
  std::sort(ordered.begin(), ordered.end(),
            [](const SampleTable* a, const SampleTable* b) { return a->samples.front() < b->samples.front(); });
  SampleTable all = parts.front();
  all.samples.clear();
  all.outcomes.clear();
  all.numbers.clear();
  for (const SampleTable* part : ordered) append(*part, all);
  const auto twice = std::adjacent_find(all.samples.begin(), all.samples.end(), std::greater_equal());
  if (twice != all.samples.end())
    throw InvalidInput(fmt::format("parts of samples overlap: sample {} follows sample {}", *(twice + 1), *twice));
  return all;
}

SampleSummary summarize_samples(const SampleTable& table) {
  SampleSummary summary;
  std::vector<std::size_t> completed;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string& outcome = table.outcomes[row];
    auto at = std::find_if(summary.outcomes.begin(), summary.outcomes.end(),
                           [&](const auto& count) { return count.first == outcome; });
    if (at == summary.outcomes.end()) at = summary.outcomes.insert(at, {outcome, 0});
    ++at->second;
    if (outcome == kCompleted) completed.push_back(row);
  }
  std::sort(summary.outcomes.begin(), summary.outcomes.end());
  for (std::size_t i = 0; i < table.inputs.size(); ++i)
    summary.inputs.push_back(statistics_of_rows(table, i, completed));
  RankedInputs inputs(table, completed);
  for (std::size_t i = 0; i < table.outputs.size(); ++i) {
    const std::size_t column = table.inputs.size() + i;
    std::vector<std::size_t> rows;
    for (const std::size_t row : completed)
      if (!std::isnan(table.at(row, column))) rows.push_back(row);
    const std::size_t left_out = table.rows() - rows.size();
    if (rows != inputs.rows) inputs = RankedInputs(table, std::move(rows));
    SampleOutput output{table.outputs[i], statistics_of_rows(table, column, inputs.rows), left_out,
                        effects_of(table, column, inputs)};
    if (!table.is_grid && table.design.method == SampleMethod::saltelli)
      take_sobol_indices(table, column, output.effects);
    summary.outputs.push_back(std::move(output));
  }
  return summary;
}

}  // namespace crashsim
