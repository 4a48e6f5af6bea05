/// W1: forward runs of the crush.

#include <fmt/format.h>

#include "json_lines.hpp"
#include "workloads.hpp"

namespace crashsim::bench {
namespace {

double achieved_error(const ForwardWorkload& workload, const SimulateOptions& options) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < workload.models.size(); ++i)
    errors.push_back(largest_error(channels_of(simulate(workload.models[i], options)), workload.reference[i]));
  return ninetieth_percentile(errors);
}

void measure_simulate(Integrator integrator, double rtol) {
  measure("W1", fmt::format("crashsim simulate, {}", name_of(integrator)), [=](benchmark::State& state) {
    static const ForwardWorkload workload = forward_workload();
    SimulateOptions options = workload.options;
    options.integrator = integrator;
    options.rtol = rtol;
    std::size_t i = 0;
    for (auto _ : state) {
      benchmark::DoNotOptimize(simulate(workload.models[i], options));
      i = (i + 1) % workload.models.size();
    }
    state.counters["rtol"] = rtol;
    state.counters["error"] = achieved_error(workload, options);
  });
}

}  // namespace

void register_forward() {
  for (const double rtol : {1e-4, 1e-6, 1e-8, 1e-10}) measure_simulate(Integrator::cvode, rtol);
  for (const double rtol : {1e-4, 1e-6, 1e-8, 1e-10}) measure_simulate(Integrator::taylor, rtol);
}

}  // namespace crashsim::bench
