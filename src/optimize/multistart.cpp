#include "optimize/multistart.hpp"

#include <memory>

#include "random.hpp"

namespace crashsim {
namespace {

/// E over ordinates divided by their bounds. Holds its workspace: one object per thread.
class ScaledObjective {
 public:
  explicit ScaledObjective(const MultistartProblem& problem)
      : upper_(problem.upper),
        objective_(problem.structure, problem.targets, problem.options.loss, problem.smooth, problem.prior),
        ordinates_(objective_.size()) {}

  double value(std::span<const double> point, double smoothing, std::span<double> gradient) {
    set(point);
    const double value = objective_.evaluate(ordinates_, smoothing, gradient);
    scale(gradient);
    return value;
  }

  double normal_equations(std::span<const double> point, double smoothing, std::span<double> gradient,
                          Eigen::MatrixXd& hessian) {
    set(point);
    const double value = objective_.normal_equations(ordinates_, smoothing, gradient, hessian);
    scale(gradient);
    hessian = upper_.asDiagonal() * hessian * upper_.asDiagonal();
    return value;
  }

 private:
  void set(std::span<const double> point) {
    for (std::size_t i = 0; i < point.size(); ++i) ordinates_[i] = point[i] * upper_[static_cast<Eigen::Index>(i)];
  }
  void scale(std::span<double> gradient) const {
    for (std::size_t i = 0; i < gradient.size(); ++i) gradient[i] *= upper_[static_cast<Eigen::Index>(i)];
  }

  const Eigen::VectorXd& upper_;
  FitObjective objective_;
  std::vector<double> ordinates_;
};

StartFunctions make_functions(const MultistartProblem& problem) {
  const auto objective = std::make_shared<ScaledObjective>(problem);
  return {[objective](std::span<const double> point, double smoothing, std::span<double> gradient) {
            return objective->value(point, smoothing, gradient);
          },
          [objective](std::span<const double> point, double smoothing, std::span<double> gradient,
                      Eigen::MatrixXd& hessian) {
            return objective->normal_equations(point, smoothing, gradient, hessian);
          }};
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
  plan.make_functions = [&problem] { return make_functions(problem); };
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
