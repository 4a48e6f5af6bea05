/// W1, model by model and all in one problem.

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

int crushes_rhs(sunrealtype, N_Vector y, N_Vector ydot, void* data) {
  const double* state = N_VGetArrayPointer(y);
  double* rate = N_VGetArrayPointer(ydot);
  for (const Crush& crush : *static_cast<const std::vector<Crush>*>(data)) {
    rate[0] = state[1];
    rate[1] = acceleration(crush, state[0], state[1]);
    state += 2;
    rate += 2;
  }
  return 0;
}

std::vector<Channels> simulate_together(std::vector<Crush>& crushes, const std::vector<double>& times,
                                        double tolerance) {
  std::vector<double> initial;
  for (const Crush& crush : crushes) initial.insert(initial.end(), {0.0, crush.speed});
  Solver solver(initial, crushes_rhs, &crushes, tolerance);
  std::vector<Channels> out(crushes.size(), Channels(3, std::vector<double>(times.size())));
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double* state = solver.at(times[i]);
    for (std::size_t m = 0; m < crushes.size(); ++m, state += 2) {
      out[m][0][i] = state[0];
      out[m][1][i] = state[1];
      out[m][2][i] = acceleration(crushes[m], state[0], state[1]);
    }
  }
  return out;
}

void measure_together(std::vector<Crush>& models, const nlohmann::json& workload, double tolerance, bool quick) {
  const std::vector<double> times = workload.at("times");
  const std::vector<Channels> results = simulate_together(models, times, tolerance);
  std::vector<double> errors;
  for (std::size_t i = 0; i < models.size(); ++i)
    errors.push_back(largest_error(results[i], workload.at("reference").at(i)));
  const double seconds = median_seconds(quick ? 5 : 15, [&] { simulate_together(models, times, tolerance); });
  report({{"workload", "many"},
          {"engine", "CVODE, straightforward, all models in one problem"},
          {"rtol", tolerance},
          {"models", models.size()},
          {"seconds", seconds / static_cast<double>(models.size())},
          {"error", ninetieth_percentile(errors)}});
}

}  // namespace

void run_forward(const std::string& folder, bool quick) {
  const nlohmann::json workload = read(folder, "w1.json");
  const std::vector<double> times = workload.at("times");
  std::vector<Crush> models;
  for (const auto& model : workload.at("models")) models.push_back(crush_from(model));
  for (const double tolerance : {1e-6, 1e-8}) measure_together(models, workload, tolerance, quick);
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
