/// bench_instructions PATH: goes through a hot path once in `hot_path()`, for callgrind to count its instructions
/// (script/bench instructions). What comes before warms up.

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
  return [kept = std::make_shared<Kept>()] {
    kept->objective.evaluate(kept->workload.points[0], 0.0, kept->gradient);
  };
}

/// With two starts the second is a random one; the first, from the equation error, is short.
Work identify_starts(int starts) {
  return [workload = fit_workload(), starts] {
    IdentifyOptions options = workload.options;
    options.starts = starts;
    identify(workload.pulse, options);
  };
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
    {"pitch_propagator", pitch_once},
};

}  // namespace
}  // namespace crashsim::bench

/// What callgrind counts; not inlined, and found by its name.
extern "C" [[gnu::noinline]] void hot_path(const crashsim::bench::Work& work) {
  work();
  asm volatile("");  // no tail call: the function ends after its work
}

int main(int argc, char** argv) {
  using namespace crashsim::bench;
  const std::string path = argc == 2 ? argv[1] : "";
  if (path == "--list") {
    for (const auto& [name, make] : kPaths) fmt::print("{}\n", name);
    return 0;
  }
  if (!kPaths.contains(path)) {
    fmt::print(stderr, "usage: bench_instructions PATH, one of --list\n");
    return 2;
  }
  const Work work = kPaths.at(path)();
  work();
  hot_path(work);
}
