/// W1.

#include "problem.hpp"
#include "solver.hpp"

namespace peer {
namespace {

int crush_rhs(sunrealtype, N_Vector y, N_Vector ydot, void* data) {
  const double* state = N_VGetArrayPointer(y);
  double* rate = N_VGetArrayPointer(ydot);
  rate[0] = state[1];
  rate[1] = acceleration(*static_cast<const Crush*>(data), state[0], state[1]);
  return 0;
}

Channels simulate(Crush& crush, const std::vector<double>& times, double tolerance) {
  Solver solver({0.0, crush.speed}, crush_rhs, &crush, tolerance);
  Channels out(3, std::vector<double>(times.size()));
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double* state = solver.at(times[i]);
    out[0][i] = state[0];
    out[1][i] = state[1];
    out[2][i] = acceleration(crush, state[0], state[1]);
  }
  return out;
}

}  // namespace

void run_forward(const std::string& folder, bool quick) {
  const nlohmann::json workload = read(folder, "w1.json");
  const std::vector<double> times = workload.at("times");
  std::vector<Crush> models;
  for (const auto& model : workload.at("models")) models.push_back(crush_from(model));
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < models.size(); ++i)
      errors.push_back(largest_error(simulate(models[i], times, tolerance), workload.at("reference").at(i)));
    const double seconds = median_seconds(quick ? 5 : 15, [&] {
      for (Crush& model : models) simulate(model, times, tolerance);
    });
    report({{"workload", "W1"},
            {"engine", "CVODE, straightforward"},
            {"rtol", tolerance},
            {"seconds", seconds / static_cast<double>(models.size())},
            {"error", ninetieth_percentile(errors)}});
  }
}

}  // namespace peer
