/// bench_workloads FOLDER: writes w1.json, w2.json and w3.json there, for peers in other languages. SI throughout.

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "workloads.hpp"

namespace crashsim::bench {
namespace {

using nlohmann::json;

json to_json(const PiecewiseLinear& curve) { return {{"knots", curve.knots}, {"ordinates", curve.ordinates}}; }

json to_json(const CrushModel& model) {
  return {{"mass", model.mass_kg},
          {"speed", model.impact_speed_mps},
          {"spring", to_json(model.spring)},
          {"damper", to_json(model.damper)}};
}

json forward_json() {
  const ForwardWorkload workload = forward_workload();
  json models = json::array();
  for (const CrushModel& model : workload.models) models.push_back(to_json(model));
  return {{"times", workload.options.times_s}, {"models", models}, {"reference", workload.reference}};
}

json fit_json() {
  const FitWorkload workload = fit_workload();
  const Pulse& pulse = workload.pulse;
  return {{"truth", to_json(workload.truth)},
          {"times", pulse.time_s},
          {"target", Channels{pulse.displacement_m, pulse.velocity_mps, pulse.accel_mps2}},
          {"spring_upper", workload.options.spring_upper},
          {"damper_upper", workload.options.damper_upper},
          {"starts", workload.starts},
          {"points", workload.points}};
}

json matrix_json(const Eigen::Matrix2d& m) { return {{m(0, 0), m(0, 1)}, {m(1, 0), m(1, 1)}}; }

json pitch_json() {
  const PitchWorkload workload = pitch_workload();
  const PitchResponse response = simulate_pitch(workload.model, workload.forcing, workload.options);
  return {{"times", response.time_s},
          {"mass", matrix_json(mass_matrix(workload.model))},
          {"damping", matrix_json(damping_matrix(workload.model))},
          {"stiffness", matrix_json(stiffness_matrix(workload.model))},
          {"heave_force", response.heave_force_n},
          {"pitch_moment", response.pitch_moment_nm},
          {"reference", workload.reference}};
}

void write(const std::filesystem::path& path, const json& content) {
  std::ofstream file(path);
  file << content << '\n';
  file.close();
  if (!file) throw std::runtime_error(fmt::format("{}: cannot be written", path.string()));
}

}  // namespace
}  // namespace crashsim::bench

int main(int argc, char** argv) {
  namespace bench = crashsim::bench;
  if (argc != 2) {
    fmt::print(stderr, "usage: bench_workloads FOLDER\n");
    return 2;
  }
  try {
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    bench::write(folder / "w1.json", bench::forward_json());
    bench::write(folder / "w2.json", bench::fit_json());
    bench::write(folder / "w3.json", bench::pitch_json());
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_workloads: {}\n", error.what());
    return 1;
  }
}
