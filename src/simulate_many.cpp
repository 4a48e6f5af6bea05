#include <crashsim/simulate_many.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include <crashsim/option_values.hpp>

#include "crush_outcome.hpp"
#include "event_metrics.hpp"
#include "output_times.hpp"
#include "parallel.hpp"
#include "solver/cvode_batch.hpp"
#include "solver/lane_motions.hpp"

namespace crashsim {
namespace {

constexpr std::size_t kBlock = kBatch;  // models a thread takes at a time
constexpr std::size_t kFewestSamples = 3;
constexpr double kStepPerResult = 0.1;  // error of a Taylor step to that of the result: measured 0.3 rtol and less

struct NamedLength {
  std::string_view name;
  std::size_t length;
};

/// Lengths of the arrays that are there.
std::vector<NamedLength> lengths_of(const CrushModels& models) {
  std::vector<NamedLength> lengths;
  const auto add = [&](std::string_view name, std::size_t length) {
    if (length > 0) lengths.push_back({name, length});
  };
  add("mass_kg", models.mass_kg.size());
  add("impact_speed_mps", models.impact_speed_mps.size());
  add("restitution", models.restitution.size());
  add("spring_ordinates", static_cast<std::size_t>(models.spring_ordinates.rows()));
  add("damper_ordinates", static_cast<std::size_t>(models.damper_ordinates.rows()));
  add("spring_knots", static_cast<std::size_t>(models.spring_knots.rows()));
  add("damper_knots", static_cast<std::size_t>(models.damper_knots.rows()));
  add("rate_coefficient", models.rate_coefficient.size());
  return lengths;
}

std::span<const double> row_of(const RowMatrix& matrix, std::size_t index) {
  const auto columns = static_cast<std::size_t>(matrix.cols());
  return {matrix.data() + index * columns, columns};
}

/// Row of an array, or what all models share.
std::span<const double> row_or(const RowMatrix& matrix, std::size_t index, const std::vector<double>& shared) {
  return matrix.rows() == 0 ? std::span<const double>(shared) : row_of(matrix, index);
}

double entry_or(const std::vector<double>& array, std::size_t index, double shared) {
  return array.empty() ? shared : array[index];
}

/// Makes `model`, which was another of them or is `common`, the one at `index`.
void set_model(const CrushModels& models, std::size_t index, CrushModel& model) {
  const auto set_row = [index](const RowMatrix& matrix, std::vector<double>& values) {
    if (matrix.rows() == 0) return;
    const auto row = row_of(matrix, index);
    values.assign(row.begin(), row.end());
  };
  model.mass_kg = entry_or(models.mass_kg, index, model.mass_kg);
  model.impact_speed_mps = entry_or(models.impact_speed_mps, index, model.impact_speed_mps);
  model.unloading.restitution = entry_or(models.restitution, index, model.unloading.restitution);
  set_row(models.spring_ordinates, model.spring.ordinates);
  set_row(models.spring_knots, model.spring.knots);
  set_row(models.damper_ordinates, model.damper.ordinates);
  set_row(models.damper_knots, model.damper.knots);
  model.rate_coefficient = entry_or(models.rate_coefficient, index, model.rate_coefficient);
}

void check_columns(const RowMatrix& matrix, std::size_t knots, std::string_view name, std::string_view curve) {
  if (matrix.rows() > 0 && static_cast<std::size_t>(matrix.cols()) != knots)
    throw InvalidInput(fmt::format("CrushModels.{} has {} columns, but common.{} has {} knots: give one a knot", name,
                                   matrix.cols(), curve, knots));
}

/// Checks everything; the first bad model is named.
void check(const CrushModels& models) {
  const std::size_t springs = models.common.spring.knots.size(), dampers = models.common.damper.knots.size();
  check_columns(models.spring_ordinates, springs, "spring_ordinates", "spring");
  check_columns(models.spring_knots, springs, "spring_knots", "spring");
  check_columns(models.damper_ordinates, dampers, "damper_ordinates", "damper");
  check_columns(models.damper_knots, dampers, "damper_knots", "damper");
  const std::size_t count = models.count();
  CrushModel model = models.common;
  for (std::size_t i = 0; i < count; ++i) {
    set_model(models, i, model);
    try {
      validate(model);
      if (std::isnan(model.impact_speed_mps))
        throw InvalidInput("CrushModel.impact_speed_mps: not given: give CrushModels.impact_speed_mps");
    } catch (const InvalidInput& error) {
      throw InvalidInput(fmt::format("model {} of {}: {}", i, count, error.what()));
    }
  }
}

std::vector<double> times_of(const SimulateManyOptions& options) {
  check_output_times(options.times_s, "SimulateManyOptions.times_s");
  if (!options.times_s.empty()) return options.times_s;
  const double end = std::isnan(options.end_time_s) ? kDefaultEnd_s : options.end_time_s;
  return output_times(0.0, end, options.dt_s, "SimulateManyOptions.dt_s");
}

/// What every thread works with.
struct Study {
  const CrushModels& models;
  const SimulateManyOptions& options;
  CrushResponses& out;

  [[nodiscard]] std::size_t samples() const { return out.time_s.size(); }
  [[nodiscard]] bool needs_samples() const { return options.samples || options.metrics == ManyMetrics::all; }
};

/// Motions of a block that nobody wants to keep, but for their metrics.
struct Scratch {
  RowMatrix accel, velocity, displacement;
};

LaneRow row_in(RowMatrix& accel, RowMatrix& velocity, RowMatrix& displacement, std::size_t row) {
  const auto at = static_cast<Eigen::Index>(row);
  return {accel.row(at).data(), velocity.row(at).data(), displacement.row(at).data()};
}

Motion motion_of(const Study& study, const LaneRow& row) {
  const std::size_t n = study.samples();
  return {study.out.time_s, {row.accel, n}, {row.velocity, n}, {row.displacement, n}};
}

/// Outcome and metrics of model `index`.
template <class M>
void judge(const Study& study, std::size_t index, CrushOutcome outcome, const M& motion, const LaneRow& row) {
  study.out.outcome[index] = outcome;
  if (outcome != CrushOutcome::completed && outcome != CrushOutcome::no_max_crush) return;
  const CrushModels& models = study.models;
  const double mass = entry_or(models.mass_kg, index, models.common.mass_kg);
  const double speed = entry_or(models.impact_speed_mps, index, models.common.impact_speed_mps);
  Metrics& metrics = study.out.metrics[index];
  if (study.options.metrics == ManyMetrics::all && study.samples() >= kFewestSamples)
    metrics = crashsim::metrics(motion_of(study, row), mass);
  take_events(motion, mass, speed, metrics);
}

void load(const CrushModels& models, std::size_t index, LaneModel& lane) {
  const CrushModel& common = models.common;
  if (models.spring_knots.rows() > 0 || models.damper_knots.rows() > 0 || lane.force.spring.segments.empty())
    lane.force = make_force({common.law, common.extrapolation, row_or(models.spring_knots, index, common.spring.knots),
                             row_or(models.damper_knots, index, common.damper.knots), common.reference_speed_mps});
  lane.force.set_ordinates(row_or(models.spring_ordinates, index, common.spring.ordinates),
                           row_or(models.damper_ordinates, index, common.damper.ordinates));
  lane.mass_kg = entry_or(models.mass_kg, index, common.mass_kg);
  lane.speed_mps = entry_or(models.impact_speed_mps, index, common.impact_speed_mps);
  lane.unloading = common.unloading;
  lane.unloading.restitution = entry_or(models.restitution, index, common.unloading.restitution);
}

/// What a thread keeps from block to block.
struct Worker {
  std::unique_ptr<LaneMotions> lanes;
  std::unique_ptr<CvodeBatch> batch;
  Scratch scratch;
  std::vector<std::size_t> alone;
  long steps = 0;
};

/// Models first..first+count-1 as work for an engine.
LaneWork work_of(const Study& study, std::size_t first, std::size_t count, Scratch& scratch) {
  const auto row = [&study, &scratch, first](std::size_t index) -> LaneRow {
    CrushResponses& out = study.out;
    if (study.options.samples) return row_in(out.accel_mps2, out.velocity_mps, out.displacement_m, first + index);
    if (study.needs_samples()) return row_in(scratch.accel, scratch.velocity, scratch.displacement, index);
    return {};
  };
  return {count, [&study, first](std::size_t index, LaneModel& lane) { load(study.models, first + index, lane); }, row,
          [&study, first, row](std::size_t index, const MotionSummary& summary) {
            judge(study, first + index, outcome_of(summary), summary, row(index));
          }};
}

/// One model by simulate(). @returns steps.
long run_alone(const Study& study, std::size_t index, Integrator integrator) {
  SimulateOptions options;
  options.times_s = study.out.time_s;
  if (!study.needs_samples()) options.times_s = {study.out.time_s.back()};
  options.rtol = study.options.rtol;
  options.integrator = integrator;
  CrushResponse run = simulate(study.models.model(index), options);
  for (auto* column : {&run.accel_mps2, &run.velocity_mps, &run.displacement_m})
    column->resize(study.samples(), kUnset);
  const LaneRow row{run.accel_mps2.data(), run.velocity_mps.data(), run.displacement_m.data()};
  judge(study, index, run.outcome, run, row);
  if (study.options.samples) {
    const LaneRow kept = row_in(study.out.accel_mps2, study.out.velocity_mps, study.out.displacement_m, index);
    std::copy(run.accel_mps2.begin(), run.accel_mps2.end(), kept.accel);
    std::copy(run.velocity_mps.begin(), run.velocity_mps.end(), kept.velocity);
    std::copy(run.displacement_m.begin(), run.displacement_m.end(), kept.displacement);
  }
  return run.statistics.steps;
}

/// A logarithm in the force is nothing for many motions at once.
bool runs_alone(const Study& study) { return study.models.common.law == CrushLaw::rate; }

std::unique_ptr<Worker> make_worker(const Study& study) {
  const double rtol = study.options.rtol;
  auto worker = std::make_unique<Worker>();
  if (runs_alone(study)) return worker;
  if (study.options.integrator == ManyIntegrator::taylor)
    worker->lanes = std::make_unique<LaneMotions>(study.out.time_s, kStepPerResult * rtol, widest_instruction_set());
  if (study.options.integrator == ManyIntegrator::cvode_batch)
    worker->batch = std::make_unique<CvodeBatch>(study.out.time_s, rtol, widest_instruction_set());
  if (study.options.samples || !study.needs_samples()) return worker;
  const auto rows = static_cast<Eigen::Index>(kBlock), columns = static_cast<Eigen::Index>(study.samples());
  for (RowMatrix* matrix : {&worker->scratch.accel, &worker->scratch.velocity, &worker->scratch.displacement})
    matrix->resize(rows, columns);
  return worker;
}

void run_block(const Study& study, std::size_t block, Worker& worker) {
  const std::size_t first = block * kBlock;
  const std::size_t count = std::min(kBlock, study.out.outcome.size() - first);
  if (worker.lanes) {
    worker.steps += worker.lanes->run(work_of(study, first, count, worker.scratch));
  } else if (worker.batch) {
    worker.steps += worker.batch->run(work_of(study, first, count, worker.scratch), worker.alone);
    for (const std::size_t i : worker.alone) worker.steps += run_alone(study, first + i, Integrator::cvode);
  } else {
    const bool by_taylor = study.options.integrator == ManyIntegrator::taylor;
    for (std::size_t i = first; i < first + count; ++i)
      worker.steps += run_alone(study, i, by_taylor ? Integrator::taylor : Integrator::cvode);
  }
}

}  // namespace

std::size_t CrushModels::count() const {
  const std::vector<NamedLength> lengths = lengths_of(*this);
  if (lengths.empty()) return 1;
  for (const NamedLength& other : lengths)
    if (other.length != lengths.front().length)
      throw InvalidInput(fmt::format("CrushModels.{} has {} entries, but {} has {}: give every array one a model",
                                     other.name, other.length, lengths.front().name, lengths.front().length));
  return lengths.front().length;
}

CrushModel CrushModels::model(std::size_t index) const {
  if (index >= count()) throw InvalidInput(fmt::format("CrushModels.model: {} is not below {}", index, count()));
  CrushModel model = common;
  set_model(*this, index, model);
  return model;
}

std::size_t CrushResponses::completed() const {
  return static_cast<std::size_t>(std::count(outcome.begin(), outcome.end(), CrushOutcome::completed));
}

CrushResponses simulate_many(const CrushModels& models, const SimulateManyOptions& options) {
  CrushResponses out;
  simulate_many(models, options, out);
  return out;
}

void simulate_many(const CrushModels& models, const SimulateManyOptions& options, CrushResponses& out) {
  validate_options(options, "SimulateManyOptions");
  check(models);
  out.time_s = times_of(options);
  const std::size_t count = models.count();
  out.outcome.assign(count, CrushOutcome::not_run);
  out.metrics.assign(count, Metrics{});
  out.steps = 0;
  const auto rows = static_cast<Eigen::Index>(options.samples ? count : 0);
  for (RowMatrix* matrix : {&out.accel_mps2, &out.velocity_mps, &out.displacement_m})
    matrix->resize(rows, static_cast<Eigen::Index>(out.time_s.size()));
  const Study study{models, options, out};
  const std::size_t blocks = (count + kBlock - 1) / kBlock;
  const int threads = thread_count(options.jobs);
  std::vector<std::unique_ptr<Worker>> workers(static_cast<std::size_t>(threads));
  parallel_for(static_cast<int>(blocks), threads,
               [&](int worker, int block) {
                 auto& mine = workers[static_cast<std::size_t>(worker)];
                 if (!mine) mine = make_worker(study);
                 run_block(study, static_cast<std::size_t>(block), *mine);
               },
               {});
  for (const auto& worker : workers)
    if (worker) out.steps += worker->steps;
}

}  // namespace crashsim
