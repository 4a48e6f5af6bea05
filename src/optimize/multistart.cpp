#include "optimize/multistart.hpp"

#include <memory>

namespace crashsim {
namespace {

/// E over ordinates divided by their bounds. Holds its workspace: one object per thread.
SmoothedFunction make_function(const MultistartProblem& problem) {
  const auto objective =
      std::make_shared<FitObjective>(problem.structure, problem.targets, problem.options.loss, problem.options.smooth);
  std::vector<double> ordinates(objective->size());
  return [&upper = problem.upper, objective, ordinates](std::span<const double> point, double smoothing,
                                                        std::span<double> gradient) mutable {
    for (std::size_t i = 0; i < point.size(); ++i) ordinates[i] = point[i] * upper[static_cast<Eigen::Index>(i)];
    const double value = objective->evaluate(ordinates, smoothing, gradient);
    for (std::size_t i = 0; i < point.size(); ++i) gradient[i] *= upper[static_cast<Eigen::Index>(i)];
    return value;
  };
}

}  // namespace

std::vector<double> initial_ordinates(const MultistartProblem& problem, int index) {
  const Eigen::VectorXd& upper = problem.upper;
  std::vector<double> start(static_cast<std::size_t>(upper.size()));
  for (Eigen::Index i = 0; i < upper.size(); ++i) {
    const double random =
        uniform_random(problem.options.seed, static_cast<std::uint64_t>(index), static_cast<std::uint64_t>(i));
    start[static_cast<std::size_t>(i)] = index == 0 ? problem.equation_error[i] : upper[i] * random;
  }
  return start;
}

std::vector<StartResult> run_starts(const MultistartProblem& problem, const Progress& progress) {
  const IdentifyOptions& options = problem.options;
  StartPlan plan{options.starts, options.jobs, options.loss, options.algorithm, {}, {}};
  plan.make_function = [&problem] { return make_function(problem); };
  plan.initial_point = [&problem](int index) {
    std::vector<double> point = initial_ordinates(problem, index);
    for (std::size_t i = 0; i < point.size(); ++i) point[i] /= problem.upper[static_cast<Eigen::Index>(i)];
    return point;
  };
  std::vector<StartResult> results = run_starts(plan, progress);
  for (StartResult& result : results)
    for (std::size_t i = 0; i < result.parameters.size(); ++i)
      result.parameters[i] *= problem.upper[static_cast<Eigen::Index>(i)];
  return results;
}

}  // namespace crashsim
