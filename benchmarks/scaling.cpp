/// How time grows with what there is to do: each measurement has a counter `n`, to fit an exponent to.

#include <initializer_list>
#include <string>

#include "json_lines.hpp"
#include "optimize/fit_objective.hpp"
#include "workloads.hpp"

namespace crashsim::bench {
namespace {

/// Work of a size `n`.
using SizedWork = void (*)(benchmark::State& state, int n);

void measure_over(const std::string& what, std::initializer_list<int> sizes, SizedWork work) {
  for (const int n : sizes)
    measure("scaling", what, [=](benchmark::State& state) {
      work(state, n);
      state.counters["n"] = n;
    });
}

void simulate_samples(benchmark::State& state, Integrator integrator, int samples) {
  const CrushModel model = random_model(0);
  SimulateOptions options;
  options.integrator = integrator;
  options.end_time_s = 0.12;
  options.dt_s = 0.12 / (samples - 1);
  for (auto _ : state) benchmark::DoNotOptimize(simulate(model, options));
}

void gradient(benchmark::State& state, int samples, int knots) {
  const FitWorkload workload = fit_workload(samples, knots);
  const FitStructure structure{CrushLaw::stiffness, workload.truth.spring.knots, workload.truth.damper.knots};
  const std::vector<FitTarget> targets{make_target(workload.pulse, kUnset, {})};
  FitObjective objective(structure, targets, Loss::l1, 0.0);
  std::vector<double> gradient(objective.size());
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(objective.evaluate(workload.points[i], 0.0, gradient));
    i = (i + 1) % workload.points.size();
  }
}

void identify_starts(benchmark::State& state, int samples, int starts, int jobs) {
  const FitWorkload workload = fit_workload(samples);
  IdentifyOptions options = workload.options;
  options.starts = starts;
  options.jobs = jobs;
  for (auto _ : state) benchmark::DoNotOptimize(identify(workload.pulse, options));
}

void pitch_samples(benchmark::State& state, int samples) {
  const PitchWorkload workload = pitch_workload(samples);
  for (auto _ : state) benchmark::DoNotOptimize(simulate_pitch(workload.model, workload.forcing, workload.options));
}

void many_models(benchmark::State& state, int models, int jobs) {
  const CrushModels all = random_models(models);
  SimulateManyOptions options;
  options.end_time_s = 0.12;
  options.jobs = jobs;
  CrushResponses responses;
  for (auto _ : state) simulate_many(all, options, responses);
}

}  // namespace

void register_scaling() {
  using State = benchmark::State;
  const auto samples = {601, 1201, 2401, 4801, 9601, 19201};
  measure_over("simulate, cvode: samples", samples, [](State& s, int n) { simulate_samples(s, Integrator::cvode, n); });
  measure_over("simulate, taylor: samples", samples,
               [](State& s, int n) { simulate_samples(s, Integrator::taylor, n); });
  measure_over("simulate_pitch: samples", samples, pitch_samples);
  measure_over("E and gradient: samples", {310, 620, 1240, 2480, 4960, 9920},
               [](State& s, int n) { gradient(s, n, 7); });
  measure_over("E and gradient: knots of each curve", {4, 7, 14, 28, 56}, [](State& s, int n) { gradient(s, 620, n); });
  measure_over("identify, 25 starts: samples", {310, 620, 1240, 2480},
               [](State& s, int n) { identify_starts(s, n, 25, 1); });
  measure_over("identify: starts", {12, 25, 50, 100, 200}, [](State& s, int n) { identify_starts(s, 620, n, 1); });
  measure_over("simulate_many: models", {100, 200, 400, 800, 1600, 3200},
               [](State& s, int n) { many_models(s, n, 1); });
  measure_over("simulate_many, 1600 models: threads", {1, 2}, [](State& s, int n) { many_models(s, 1600, n); });
  measure_over("identify, 100 starts: threads", {1, 2}, [](State& s, int n) { identify_starts(s, 620, 100, n); });
}

}  // namespace crashsim::bench
