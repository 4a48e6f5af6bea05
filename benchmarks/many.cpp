/// Many models at once: a sweep over the random models of W1.

#include <fmt/format.h>

#include <crashsim/simulate_many.hpp>

#include "json_lines.hpp"
#include "workloads.hpp"

namespace crashsim::bench {
namespace {

/// Achieved by the models that W1 has references for.
double achieved_error(const CrushResponses& responses, const ForwardWorkload& workload) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < workload.models.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const auto channel = [row](const RowMatrix& all) {
      return std::vector<double>(all.row(row).begin(), all.row(row).end());
    };
    const Channels channels = {channel(responses.displacement_m), channel(responses.velocity_mps),
                               channel(responses.accel_mps2)};
    errors.push_back(largest_error(channels, workload.reference[i]));
  }
  return ninetieth_percentile(errors);
}

void simulate_models(benchmark::State& state, SimulateManyOptions options, int count) {
  const ForwardWorkload workload = forward_workload();
  const CrushModels models = random_models(count);
  options.times_s = workload.options.times_s;
  CrushResponses responses;
  for (auto _ : state) simulate_many(models, options, responses);
  state.counters["models"] = count;
  state.counters["items"] = count;
  if (options.samples) state.counters["error"] = achieved_error(responses, workload);
}

}  // namespace

void register_many() {
  const auto measure_many = [](const std::string& engine, ManyIntegrator integrator, double rtol, bool samples,
                               int count) {
    measure("many", engine, [=](benchmark::State& state) {
      SimulateManyOptions options;
      options.integrator = integrator;
      options.rtol = rtol;
      options.samples = samples;
      options.jobs = 1;
      simulate_models(state, options, count);
      state.counters["rtol"] = rtol;
    });
  };
  for (const double rtol : {1e-6, 1e-8, 1e-10}) {
    measure_many("crashsim simulate_many, taylor", ManyIntegrator::taylor, rtol, true, 1000);
    measure_many("crashsim simulate_many, cvode", ManyIntegrator::cvode, rtol, true, 200);
    measure_many("crashsim simulate_many, cvode_batch", ManyIntegrator::cvode_batch, rtol, true, 200);
  }
  measure_many("crashsim simulate_many, taylor", ManyIntegrator::taylor, 1e-8, true, 100);  // results that fit a cache
  measure_many("crashsim simulate_many, taylor, metrics alone", ManyIntegrator::taylor, 1e-8, false, 1000);
}

}  // namespace crashsim::bench
