/// W2: E with its gradient, and identification.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "json_lines.hpp"
#include "optimize/fit_objective.hpp"
#include "workloads.hpp"

namespace crashsim::bench {
namespace {

/// What E is computed from: as identify() does.
struct Objective {
  FitStructure structure;
  std::vector<FitTarget> targets;
  FitObjective objective;

  explicit Objective(const FitWorkload& workload)
      : structure{CrushLaw::stiffness, workload.truth.spring.knots, workload.truth.damper.knots},
        targets{make_target(workload.pulse, kUnset, {})},
        objective(structure, targets, Loss::l1, 0.0) {}
};

/// Gradients at the workload's points by an independent integrator: peers/reference.py writes them.
std::vector<std::vector<double>> reference_gradients() {
  const char* folder = std::getenv("CRASHSIM_BENCH_WORKLOADS");
  std::ifstream file(std::string(folder == nullptr ? "." : folder) + "/w2_gradients.json");
  if (!file) return {};
  return nlohmann::json::parse(file).at("gradients");
}

/// Largest error of a gradient by ordinates relative to their bounds, over its largest component.
double gradient_error(std::span<const double> gradient, std::span<const double> reference,
                      const IdentifyOptions& options) {
  double error = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const bool of_spring = i < static_cast<std::size_t>(options.spring_knots);
    const double bound = of_spring ? options.spring_upper : options.damper_upper;
    const double difference = bound * std::fabs(gradient[i] - reference[i]);
    if (!(difference <= error)) error = difference;  // so that what is not a number stays
    largest = std::max(largest, bound * std::fabs(reference[i]));
  }
  return error / largest;
}

double achieved_error(const FitWorkload& workload, FitObjective& objective) {
  const auto reference = reference_gradients();
  if (reference.empty()) return kUnset;
  std::vector<double> errors, gradient(objective.size());
  for (std::size_t i = 0; i < workload.points.size(); ++i) {
    objective.evaluate(workload.points[i], 0.0, gradient);
    errors.push_back(gradient_error(gradient, reference[i], workload.options));
  }
  return ninetieth_percentile(errors);
}

void evaluate(benchmark::State& state, const FitWorkload& workload, bool with_gradient) {
  Objective of(workload);
  std::vector<double> gradient(with_gradient ? of.objective.size() : 0);
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(of.objective.evaluate(workload.points[i], 0.0, gradient));
    i = (i + 1) % workload.points.size();
  }
  if (with_gradient) state.counters["error"] = achieved_error(workload, of.objective);
}

/// A forward run with the samples of the fit, its arrays kept: what E is made from elsewhere.
void simulate_at_points(benchmark::State& state, const FitWorkload& workload) {
  const Objective of(workload);
  SimulateOptions options;
  options.integrator = Integrator::taylor;
  options.times_s = workload.pulse.time_s;
  std::vector<CrushModel> models;
  for (const auto& point : workload.points)
    models.push_back(make_model(of.structure, point, workload.truth.mass_kg, workload.truth.impact_speed_mps));
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(simulate(models[i], options));
    i = (i + 1) % models.size();
  }
}

void identify_as(benchmark::State& state, const FitWorkload& workload, const IdentifyOptions& options) {
  Identification fit;
  for (auto _ : state) fit = identify(workload.pulse, options);
  if (!fit.usable()) state.SkipWithError(fit.message.c_str());
  state.counters["E"] = fit.error.total;
  state.counters["starts"] = static_cast<double>(fit.starts.size());
  state.counters["at_best"] = fit.starts_at_best;
  state.counters["evaluations"] = static_cast<double>(fit.evaluations);
  state.counters["jobs"] = options.jobs;
  state.counters["true_E"] = fit_error(workload.truth, workload.pulse).total;
}

}  // namespace

void register_fit() {
  measure("gradient", "crashsim: E alone, Taylor", [](benchmark::State& s) { evaluate(s, fit_workload(), false); });
  measure("gradient", "crashsim: E and gradient, Taylor",
          [](benchmark::State& s) { evaluate(s, fit_workload(), true); });
  measure("gradient", "crashsim: simulate, taylor", [](benchmark::State& s) { simulate_at_points(s, fit_workload()); });
  const auto measure_identify = [](const std::string& engine, IdentifyMethod method, int starts, int jobs) {
    measure("W2", engine, [=](benchmark::State& state) {
      const FitWorkload workload = fit_workload();
      IdentifyOptions options = workload.options;
      options.method = method;
      options.starts = starts;
      options.jobs = jobs;
      identify_as(state, workload, options);
    });
  };
  measure_identify("crashsim identify, 100 starts", IdentifyMethod::multistart, 100, 1);
  measure_identify("crashsim identify, 100 starts, 2 threads", IdentifyMethod::multistart, 100, 2);
  measure_identify("crashsim equation error + one NLopt run", IdentifyMethod::multistart, 1, 1);
  measure_identify("crashsim equation error alone", IdentifyMethod::equation_error, 1, 1);
  for (int target = 0; target < kTargets; ++target)
    measure("targets", fmt::format("target {}", target),
            [target](benchmark::State& state) {
              const FitWorkload workload = fit_workload(620, 7, target);
              identify_as(state, workload, workload.options);
            })
        ->Repetitions(1)
        ->Iterations(1);
}

}  // namespace crashsim::bench
