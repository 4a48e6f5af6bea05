/// W3.

#include <algorithm>
#include <array>

#include "problem.hpp"
#include "solver.hpp"

namespace peer {
namespace {

using Matrix = std::array<std::array<double, 2>, 2>;

/// M q'' + C q' + K q = Q(t), Q from a table of uniform times.
struct Pitch {
  Matrix mass, damping, stiffness;
  std::vector<double> times;
  Channels forces;
};

int pitch_rhs(sunrealtype t, N_Vector y, N_Vector ydot, void* data) {
  const Pitch& pitch = *static_cast<const Pitch*>(data);
  const double* state = N_VGetArrayPointer(y);
  double* rate = N_VGetArrayPointer(ydot);
  const double place = std::clamp(t / pitch.times[1], 0.0, static_cast<double>(pitch.times.size() - 1));
  const std::size_t i = std::min(static_cast<std::size_t>(place), pitch.times.size() - 2);
  const double weight = place - static_cast<double>(i);
  for (std::size_t r = 0; r < 2; ++r) {
    double force = (1.0 - weight) * pitch.forces[r][i] + weight * pitch.forces[r][i + 1];
    for (std::size_t c = 0; c < 2; ++c) force -= pitch.damping[r][c] * state[2 + c] + pitch.stiffness[r][c] * state[c];
    rate[r] = state[2 + r];
    rate[2 + r] = force / pitch.mass[r][r];
  }
  return 0;
}

Channels simulate(Pitch& pitch, double tolerance) {
  Solver solver({0.0, 0.0, 0.0, 0.0}, pitch_rhs, &pitch, tolerance);
  Channels out(4, std::vector<double>(pitch.times.size()));
  for (std::size_t i = 0; i < pitch.times.size(); ++i) {
    const double* state = solver.at(pitch.times[i]);
    for (std::size_t c = 0; c < 4; ++c) out[c][i] = state[c];
  }
  return out;
}

}  // namespace

void run_pitch(const std::string& folder, bool quick) {
  const nlohmann::json workload = read(folder, "w3.json");
  Pitch pitch{workload.at("mass"),
              workload.at("damping"),
              workload.at("stiffness"),
              workload.at("times"),
              {workload.at("heave_force"), workload.at("pitch_moment")}};
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    const double seconds = median_seconds(quick ? 5 : 51, [&] { simulate(pitch, tolerance); });
    report({{"workload", "W3"},
            {"engine", "CVODE, straightforward"},
            {"rtol", tolerance},
            {"seconds", seconds},
            {"error", largest_error(simulate(pitch, tolerance), workload.at("reference"))}});
  }
}

}  // namespace peer
