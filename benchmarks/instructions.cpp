/// bench_instructions PATH TIMES: goes through a hot path so many times, for callgrind to count its instructions
/// (script/bench instructions). The difference between two runs is what the path costs, on all its threads.

#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "optimize/fit_objective.hpp"
#include "workloads.hpp"

namespace crashsim::bench {
namespace {

using Work = std::function<void()>;

Work simulate_once(Integrator integrator) {
  SimulateOptions options = forward_workload(1).options;
  options.integrator = integrator;
  return [model = random_model(0), options] { simulate(model, options); };
}

Work gradient_once() {
  struct Kept {
    FitWorkload workload = fit_workload();
    FitStructure structure{CrushLaw::stiffness, workload.truth.spring.knots, workload.truth.damper.knots};
    std::vector<FitTarget> targets{make_target(workload.pulse, kUnset, {})};
    FitObjective objective{structure, targets, Loss::l1, 0.0};
    std::vector<double> gradient = std::vector<double>(objective.size());
  };
  return [kept = std::make_shared<Kept>()] { kept->objective.evaluate(kept->workload.points[0], 0.0, kept->gradient); };
}

/// With two starts the second is a random one; the first is from the equation error.
Work identify_starts(int starts) {
  return [workload = fit_workload(), starts] {
    IdentifyOptions options = workload.options;
    options.starts = starts;
    identify(workload.pulse, options);
  };
}

Work simulate_lanes() {
  SimulateManyOptions options;
  options.times_s = forward_workload(1).options.times_s;
  options.jobs = 1;
  return [models = random_models(64), options] { simulate_many(models, options); };
}

Work pitch_once() {
  return [workload = pitch_workload()] { simulate_pitch(workload.model, workload.forcing, workload.options); };
}

const std::map<std::string, std::function<Work()>> kPaths = {
    {"simulate_cvode", [] { return simulate_once(Integrator::cvode); }},
    {"simulate_taylor", [] { return simulate_once(Integrator::taylor); }},
    {"value_and_gradient", gradient_once},
    {"identify_1_start", [] { return identify_starts(1); }},
    {"identify_2_starts", [] { return identify_starts(2); }},
    {"simulate_many_64", simulate_lanes},
    {"pitch_propagator", pitch_once},
};

}  // namespace
}  // namespace crashsim::bench

int main(int argc, char** argv) {
  using namespace crashsim::bench;
  const std::string path = argc > 1 ? argv[1] : "";
  if (path == "--list") {
    for (const auto& [name, make] : kPaths) fmt::print("{}\n", name);
    return 0;
  }
  if (argc != 3 || !kPaths.contains(path)) {
    fmt::print(stderr, "usage: bench_instructions PATH TIMES, a path of --list\n");
    return 2;
  }
  const Work work = kPaths.at(path)();
  for (int i = std::atoi(argv[2]); i > 0; --i) work();
}
