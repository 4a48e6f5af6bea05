#include "optimize/multistart.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>

#include "optimize/nlopt_minimize.hpp"
#include "parallel.hpp"

namespace crashsim {
namespace {

/// Rounding of |u| on the way to the true loss, relative to each channel's largest u: from nearly quadratic to well
/// below the residuals of a real test. Each rung is followed until E changes by less than `ftol`.
struct Rung {
  double smoothing, ftol;
};
constexpr Rung kLadder[] = {{3e-1, 1e-5}, {3e-2, 1e-6}, {3e-3, 1e-7}, {3e-4, 1e-7}};
constexpr double kFtolPolish = 1e-6;   // on the true |u|, where starts agree within 1e-3
constexpr double kFtolSmooth = 1e-9;   // on losses that need no ladder
constexpr int kMaxEvaluations = 2000;  // on a rung

std::uint64_t mix(std::uint64_t z) {  // SplitMix64's output function
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

struct Stopped {};  // thrown out of a start that is to end at once

/// One start; as if never begun when `stop` is set meanwhile.
StartResult run_start(const MultistartProblem& problem, FitObjective& objective, int index,
                      const std::atomic<bool>& stop) {
  const auto n = objective.size();
  std::vector<double> parameters(n);
  const auto ordinates = [&](std::span<const double> unit) {
    for (std::size_t i = 0; i < n; ++i) parameters[i] = unit[i] * problem.upper[static_cast<Eigen::Index>(i)];
  };
  double smoothing = 0.0;
  const GradientFunction function = [&](std::span<const double> unit, std::span<double> gradient) {
    if (stop) throw Stopped{};
    ordinates(unit);
    const double value = objective.evaluate(parameters, smoothing, gradient);
    for (std::size_t i = 0; i < n; ++i) gradient[i] *= problem.upper[static_cast<Eigen::Index>(i)];
    return value;
  };
  std::vector<double> unit = initial_ordinates(problem, index);
  for (std::size_t i = 0; i < n; ++i) unit[i] /= problem.upper[static_cast<Eigen::Index>(i)];
  StartResult result;
  const auto descend = [&](double rounding, double ftol) {
    smoothing = rounding;
    const Minimum minimum = minimize_in_unit_box(problem.options.algorithm, function, unit, ftol, kMaxEvaluations);
    unit = minimum.point;
    result.report.evaluations += minimum.evaluations;
    return minimum.value;
  };
  const bool has_corner = problem.options.loss == Loss::l1;
  if (has_corner)
    for (const Rung& rung : kLadder)
      if (!std::isfinite(descend(rung.smoothing, rung.ftol))) break;
  result.report.error = descend(0.0, has_corner ? kFtolPolish : kFtolSmooth);
  result.report.failed = !std::isfinite(result.report.error);
  ordinates(unit);
  result.parameters = parameters;
  return result;
}

}  // namespace

double uniform_random(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15ULL;
  const std::uint64_t bits = mix(mix(mix(seed + kGolden) ^ (stream * kGolden + kGolden)) + index * kGolden);
  return static_cast<double>(bits >> 11) * 0x1.0p-53;
}

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
  const int starts = problem.options.starts;
  const int threads = std::min(thread_count(problem.options.jobs), starts);
  std::vector<StartResult> results(static_cast<std::size_t>(starts));
  std::vector<std::unique_ptr<FitObjective>> objectives(static_cast<std::size_t>(threads));
  std::atomic<bool> stop{false};
  parallel_for(
      starts, threads,
      [&](int worker, int index) {
        auto& objective = objectives[static_cast<std::size_t>(worker)];
        if (!objective)
          objective = std::make_unique<FitObjective>(problem.structure, problem.targets, problem.options.loss,
                                                     problem.options.smooth);
        try {
          results[static_cast<std::size_t>(index)] = run_start(problem, *objective, index, stop);
        } catch (const Stopped&) {
          return;
        }
      },
      [&](int done, int count) {
        if (progress && !progress(done, count)) stop = true;
        return !stop;
      });
  return results;
}

}  // namespace crashsim
