/// W3: heave and pitch.

#include <fmt/format.h>

#include "json_lines.hpp"
#include "solver/pitch_grid.hpp"
#include "workloads.hpp"

namespace crashsim::bench {
namespace {

void simulate_pitch_by(benchmark::State& state, PitchIntegrator integrator, double rtol) {
  const PitchWorkload workload = pitch_workload();
  PitchOptions options = workload.options;
  options.integrator = integrator;
  options.rtol = rtol;
  PitchResponse response;
  for (auto _ : state) response = simulate_pitch(workload.model, workload.forcing, options);
  state.counters["error"] = largest_error(channels_of(response), workload.reference);
  if (integrator == PitchIntegrator::cvode) state.counters["rtol"] = rtol;
}

Channels channels_of(const PitchGrid& grid, const std::vector<PitchState>& states) {
  Channels channels(4);
  for (const std::size_t i : grid.samples)
    for (int c = 0; c < 4; ++c) channels[static_cast<std::size_t>(c)].push_back(states[i][c]);
  return channels;
}

/// The integration alone, without accelerations, axle forces and peaks.
void propagate(benchmark::State& state) {
  const PitchWorkload workload = pitch_workload();
  const std::vector<double> times = simulate_pitch(workload.model, workload.forcing, workload.options).time_s;
  const LinearSystem system = linear_system(workload.model);
  const PitchGrid grid = make_grid(workload.model, workload.forcing, 0.0, times, 1.0);
  std::vector<PitchState> states(grid.times.size(), PitchState::Zero());
  for (auto _ : state) {
    integrate_by_propagator(system, grid, states);
    benchmark::DoNotOptimize(states.data());
  }
  state.counters["error"] = largest_error(channels_of(grid, states), workload.reference);
}

}  // namespace

void register_pitch() {
  measure("W3", "crashsim: exact propagator, integration alone", propagate);
  measure("W3", "crashsim simulate_pitch, propagator",
          [](benchmark::State& s) { simulate_pitch_by(s, PitchIntegrator::propagator, 1e-10); });
  for (const double rtol : {1e-6, 1e-10})
    measure("W3", "crashsim simulate_pitch, cvode",
            [rtol](benchmark::State& s) { simulate_pitch_by(s, PitchIntegrator::cvode, rtol); });
}

}  // namespace crashsim::bench
