#pragma once
/// Samples of a case: what went in, what came out, and what they say together.

#include <cstdint>
#include <string>
#include <vector>

#include <crashsim/distribution.hpp>
#include <crashsim/sample_statistics.hpp>
#include <crashsim/sampling.hpp>

namespace crashsim {

/// A number that varies.
struct SampleInput {
  std::string name;           ///< Its key in the case, with the unit: "vehicle.mass_kg", "crush.k3_n_per_m".
  std::string unit;           ///< SI symbol.
  Distribution distribution;  ///< In SI; of a number that varies relatively: of the factor.
  double base = kUnset;       ///< What the factor multiplies [SI]; unset: no factor.
};

/// Samples, each a row of numbers: the inputs, then the outputs.
struct SampleTable {
  std::vector<SampleInput> inputs;
  bool is_grid = false;                ///< Every combination of the inputs' tables, instead of `design`.
  SampleDesign design;                 ///< Of which the rows are samples.
  std::uint64_t planned = 0;           ///< Samples of the whole study.
  std::vector<std::string> outputs;    ///< Names of the summary: "max_crush_m"; of the coupled motion "coupled_..".
  std::vector<std::uint64_t> samples;  ///< Index of each row's sample, increasing.
  std::vector<std::string> outcomes;   ///< "completed", or why a row is not to be relied on.
  std::vector<double> numbers;         ///< Row after row; NaN where a quantity does not exist.

  [[nodiscard]] std::size_t rows() const { return samples.size(); }
  [[nodiscard]] std::size_t columns() const { return inputs.size() + outputs.size(); }
  [[nodiscard]] double at(std::size_t row, std::size_t column) const { return numbers[row * columns() + column]; }
  /// True when every sample of the study is there, and one of them completed.
  [[nodiscard]] bool usable() const;
};

/// Rows of the same study put together, by index. @throws InvalidInput when their columns differ or a sample is there
/// twice.
SampleTable join_samples(const std::vector<SampleTable>& parts);

/// How one output depends on one input. Unset: not known, or one of both does not vary.
struct SampleEffect {
  double pearson = kUnset, spearman = kUnset;  ///< Correlation of the numbers, of their ranks.
  SobolIndex first_order;  ///< Part of the variance by this input alone; no error: from any samples.
  SobolIndex total;        ///< With all that it acts together with; of `saltelli` only.
};

/// One output over the samples that completed.
struct SampleOutput {
  std::string name;
  SampleStatistics statistics;        ///< Its min_at and max_at are indices of samples.
  std::size_t left_out = 0;           ///< Samples that failed or have no such number.
  std::vector<SampleEffect> effects;  ///< Of each input.
};

/// What the samples say together.
struct SampleSummary {
  std::vector<std::pair<std::string, std::size_t>> outcomes;  ///< How many samples ended so, by name.
  std::vector<SampleStatistics> inputs;                       ///< Of the samples that completed.
  std::vector<SampleOutput> outputs;
};
SampleSummary summarize_samples(const SampleTable& table);

}  // namespace crashsim
