/// Running the samples of a case, many at a time.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include <crashsim/coupled_columns.hpp>
#include <crashsim/error.hpp>
#include <crashsim/simulate_many.hpp>
#include <crashsim/sweep.hpp>

#include "case_steps.hpp"
#include "parallel.hpp"
#include "sample_runner.hpp"

namespace crashsim {
namespace {

/// Samples that a thread takes at once.
std::uint64_t block_size(const SamplePlan& plan) {
  constexpr std::uint64_t kCrushAlone = 256, kMotion = 16, kWholeChain = 1;
  if (is_crush_alone(plan)) return kCrushAlone;
  return is_whole_chain(plan) ? kWholeChain : kMotion;
}
constexpr std::string_view kInvalidInput = "invalid_input", kNumericalFailure = "numerical_failure";

/// Rows of consecutive samples.
struct Block {
  std::vector<std::string> outcomes;
  std::vector<double> numbers;
};

/// Numbers of a table; NaN without what holds them.
template <class S, class Table>
void append_numbers(const S* part, const Table& table, std::vector<double>& numbers) {
  for (const auto& number : table) numbers.push_back(part != nullptr ? part->*number.member : kUnset);
}

/// Outputs in the order of the plan's names; NaN for what is not there.
void append_outputs(const CaseResult& result, std::size_t count, std::vector<double>& numbers) {
  const std::size_t end = numbers.size() + count;
  const Metrics metrics = metrics_of(result.response, result.model.mass_kg);
  append_numbers(&metrics, kMetricFields, numbers);
  if (result.pitch) append_numbers(&*result.pitch, kPitchNumbers, numbers);
  if (result.coupled) append_numbers(&*result.coupled, kCoupledNumbers, numbers);
  numbers.resize(end, kUnset);
}

bool is_interrupted(const CaseResult& result) {
  return result.identification && result.identification->outcome == IdentifyOutcome::interrupted;
}

/// One row; false when it was stopped.
bool append_sample(const SamplePlan& plan, std::uint64_t sample, const std::atomic<bool>& stop, Block& block) {
  const std::vector<double> inputs = sample_inputs(plan.table, sample);
  CaseResult result;
  std::string outcome(kInvalidInput);
  try {
    result = run_sample(plan, inputs, stop);
    outcome = outcome_of(result);
  } catch (const InvalidInput&) {
    result = {};
  } catch (const NumericalFailure&) {
    outcome = kNumericalFailure;
    result = {};
  }
  if (stop && is_interrupted(result)) return false;
  block.outcomes.push_back(outcome);
  block.numbers.insert(block.numbers.end(), inputs.begin(), inputs.end());
  append_outputs(result, plan.table.outputs.size(), block.numbers);
  return true;
}

/// What simulate_many() makes of models of one structure.
CrushResponses simulate_all(const SamplePlan& plan, const std::vector<CrushModel>& models) {
  CrushModels all;
  all.common = models.front();
  const auto count = std::ssize(models);
  all.spring_ordinates.resize(count, std::ssize(all.common.spring.ordinates));
  all.damper_ordinates.resize(count, std::ssize(all.common.damper.ordinates));
  const bool has_rate = all.common.law == CrushLaw::rate;
  const bool has_restitution = !std::isnan(all.common.unloading.restitution);
  for (Eigen::Index i = 0; i < count; ++i) {
    const CrushModel& model = models[static_cast<std::size_t>(i)];
    all.mass_kg.push_back(model.mass_kg);
    all.impact_speed_mps.push_back(model.impact_speed_mps);
    if (has_rate) all.rate_coefficient.push_back(model.rate_coefficient);
    if (has_restitution) all.restitution.push_back(model.unloading.restitution);
    std::ranges::copy(model.spring.ordinates, all.spring_ordinates.row(i).begin());
    std::ranges::copy(model.damper.ordinates, all.damper_ordinates.row(i).begin());
  }
  const SimulateOptions& asked = plan.study.simulation;
  SimulateManyOptions options;
  options.end_time_s =
      std::isnan(asked.end_time_s) && plan.base.pulse ? plan.base.pulse->time_s.back() : asked.end_time_s;
  options.dt_s = asked.dt_s;
  options.rtol = asked.rtol;
  options.samples = false;
  options.metrics = ManyMetrics::all;
  options.jobs = 1;
  return simulate_many(all, options);
}

/// Rows of samples that are crush alone.
Block run_crush_block(const SamplePlan& plan, std::uint64_t first, std::uint64_t count) {
  std::vector<std::vector<double>> inputs;
  std::vector<CrushModel> models;
  std::vector<std::optional<std::size_t>> model_of_row;
  for (std::uint64_t i = 0; i < count; ++i) {
    inputs.push_back(sample_inputs(plan.table, first + i));
    CrushModel model = sample_model(plan, inputs.back());
    try {
      validate(model);
      model_of_row.emplace_back(models.size());
      models.push_back(std::move(model));
    } catch (const InvalidInput&) {
      model_of_row.emplace_back();
    }
  }
  const CrushResponses responses = models.empty() ? CrushResponses() : simulate_all(plan, models);
  Block block;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto& model = model_of_row[i];
    block.outcomes.emplace_back(model ? name_of(responses.outcome[*model]) : kInvalidInput);
    block.numbers.insert(block.numbers.end(), inputs[i].begin(), inputs[i].end());
    append_numbers(model ? &responses.metrics[*model] : nullptr, kMetricFields, block.numbers);
  }
  return block;
}

std::optional<Block> run_block(const SamplePlan& plan, std::uint64_t first, std::uint64_t count,
                               const std::atomic<bool>& stop) {
  if (is_crush_alone(plan)) return run_crush_block(plan, first, count);
  Block block;
  for (std::uint64_t i = 0; i < count; ++i)
    if (stop || !append_sample(plan, first + i, stop, block)) return std::nullopt;
  return block;
}

}  // namespace

SampleTable run_samples(const SamplePlan& plan, std::uint64_t first, std::uint64_t count, const Progress& progress) {
  const std::uint64_t end =
      std::min(plan.table.planned, count > plan.table.planned - first ? plan.table.planned : first + count);
  const std::uint64_t total = end > first ? end - first : 0, size = block_size(plan);
  std::vector<std::optional<Block>> blocks((total + size - 1) / size);
  std::atomic<bool> stop{false};
  const auto count_of = [&](std::uint64_t block) { return std::min(size, total - block * size); };
  parallel_for(
      static_cast<int>(blocks.size()), thread_count(plan.study.identify.jobs),
      [&](int, int index) {
        const auto at = static_cast<std::uint64_t>(index);
        blocks[at] = run_block(plan, first + at * size, count_of(at), stop);
      },
      [&](int done, int) {
        const auto samples = static_cast<int>(std::min(total, static_cast<std::uint64_t>(done) * size));
        if (progress && !progress(samples, static_cast<int>(total))) stop = true;
        return !stop;
      });
  SampleTable table = plan.table;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (!blocks[i]) continue;
    for (std::uint64_t j = 0; j < count_of(i); ++j) table.samples.push_back(first + i * size + j);
    table.outcomes.insert(table.outcomes.end(), blocks[i]->outcomes.begin(), blocks[i]->outcomes.end());
    table.numbers.insert(table.numbers.end(), blocks[i]->numbers.begin(), blocks[i]->numbers.end());
    blocks[i].reset();
  }
  return table;
}

}  // namespace crashsim
