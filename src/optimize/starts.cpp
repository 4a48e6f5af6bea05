#include "optimize/starts.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>

#include "optimize/gauss_newton.hpp"
#include "optimize/nlopt_minimize.hpp"
#include "parallel.hpp"

namespace crashsim {
namespace {

constexpr double kBest = 1e-3;  // starts within this of the best E, relative, are at the best

/// Rounding of |u| on the way to the true loss, relative to each channel's largest u: from nearly quadratic to well
/// below the residuals of a real test. Each rung is followed until E changes by less than `ftol`.
struct Rung {
  double smoothing, ftol;
};
constexpr Rung kLadder[] = {{3e-1, 1e-5}, {3e-2, 1e-6}, {3e-3, 1e-7}, {3e-4, 1e-7}};
/// The same by Gauss and Newton's steps, which NLopt's descent on the true loss ends.
constexpr Rung kNewtonLadder[] = {{3e-1, 1e-4}, {1e-1, 1e-4}, {3e-2, 1e-4}, {1e-2, 1e-4},
                                  {3e-3, 1e-4}, {1e-3, 1e-4}, {3e-4, 1e-5}};
constexpr Rung kNewtonSmooth[] = {{0.0, 1e-6}};  // of losses that need no ladder
constexpr double kFtolPolish = 1e-5;             // on the true |u|, where starts agree within 1e-3
constexpr double kFtolBest = 1e-8;               // on the true loss, by the best start alone
constexpr double kFtolSmooth = 1e-9;             // on losses that need no ladder
constexpr int kMaxEvaluations = 2000;            // on a rung
constexpr int kMaxNewtonEvaluations = 100;       // on a rung

struct Stopped {};  // thrown out of a start that is to end at once

/// The descents of one start, which is as if never begun when `stop` is set meanwhile.
class Descent {
 public:
  Descent(const StartPlan& plan, const StartFunctions& functions, const std::atomic<bool>& stop, StartResult& result)
      : plan_(plan), functions_(functions), stop_(stop), result_(result) {}

  /// @returns E reached.
  double by_nlopt(const Rung& rung) {
    const GradientFunction function = [&](std::span<const double> point, std::span<double> gradient) {
      if (stop_) throw Stopped{};
      return functions_.value(point, rung.smoothing, gradient);
    };
    return take(minimize_in_unit_box(plan_.algorithm, function, result_.parameters, rung.ftol, kMaxEvaluations));
  }

  double by_gauss_newton(const Rung& rung) {
    const NormalEquations function = [&](std::span<const double> point, std::span<double> gradient,
                                         Eigen::MatrixXd& hessian) {
      if (stop_) throw Stopped{};
      return functions_.normal_equations(point, rung.smoothing, gradient, hessian);
    };
    return take(minimize_by_gauss_newton(function, result_.parameters, rung.ftol, kMaxNewtonEvaluations));
  }

 private:
  double take(const Minimum& minimum) {
    result_.parameters = minimum.point;
    result_.report.evaluations += minimum.evaluations;
    return minimum.value;
  }

  const StartPlan& plan_;
  const StartFunctions& functions_;
  const std::atomic<bool>& stop_;
  StartResult& result_;
};

StartResult run_start(const StartPlan& plan, const StartFunctions& functions, int index,
                      const std::atomic<bool>& stop) {
  StartResult result;
  result.parameters = plan.initial_point(index);
  Descent descent(plan, functions, stop, result);
  const bool has_corner = plan.loss == Loss::l1;
  if (functions.normal_equations) {
    for (const Rung& rung : has_corner ? std::span<const Rung>(kNewtonLadder) : std::span<const Rung>(kNewtonSmooth))
      if (!std::isfinite(descent.by_gauss_newton(rung))) break;
  } else if (has_corner) {
    for (const Rung& rung : kLadder)
      if (!std::isfinite(descent.by_nlopt(rung))) break;
  }
  result.report.error = descent.by_nlopt({0.0, has_corner ? kFtolPolish : kFtolSmooth});
  result.report.failed = !std::isfinite(result.report.error);
  return result;
}

/// Index of the least E, the first of equals; -1 when all failed.
int best_of(const std::vector<StartResult>& results) {
  int best = -1;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const StartReport& report = results[i].report;
    if (report.evaluations == 0 || report.failed) continue;
    if (best < 0 || report.error < results[static_cast<std::size_t>(best)].report.error) best = static_cast<int>(i);
  }
  return best;
}

/// Lets the best start descend to the end of the way. Its report stays that of the start alone, which must not depend
/// on the others.
void go_on(const StartPlan& plan, const Progress& progress, StartResult& best) {
  constexpr auto kLookAround = std::chrono::milliseconds(100);
  std::atomic<bool> stop{false};
  StartFunctions functions = plan.make_functions();
  functions.value = [&, value = functions.value, last = std::chrono::steady_clock::now()](
                        std::span<const double> point, double smoothing, std::span<double> gradient) mutable {
    const auto now = std::chrono::steady_clock::now();
    if (progress && now - last > kLookAround) {
      last = now;
      if (!progress(plan.starts, plan.starts)) stop = true;
    }
    return value(point, smoothing, gradient);
  };
  StartResult further = best;
  try {
    Descent(plan, functions, stop, further).by_nlopt({0.0, kFtolBest});
  } catch (const Stopped&) {
    return;
  }
  best.parameters = further.parameters;
  best.further_evaluations = further.report.evaluations - best.report.evaluations;
}

}  // namespace

std::vector<StartResult> run_starts(const StartPlan& plan, const Progress& progress) {
  const int threads = std::min(thread_count(plan.jobs), plan.starts);
  std::vector<StartResult> results(static_cast<std::size_t>(plan.starts));
  std::vector<StartFunctions> functions(static_cast<std::size_t>(threads));
  std::atomic<bool> stop{false};
  parallel_for(
      plan.starts, threads,
      [&](int worker, int index) {
        StartFunctions& mine = functions[static_cast<std::size_t>(worker)];
        if (!mine.value) mine = plan.make_functions();
        try {
          results[static_cast<std::size_t>(index)] = run_start(plan, mine, index, stop);
        } catch (const Stopped&) {
          return;
        }
      },
      [&](int done, int count) {
        if (progress && !progress(done, count)) stop = true;
        return !stop;
      });
  if (const int best = best_of(results); best >= 0 && !stop)
    go_on(plan, progress, results[static_cast<std::size_t>(best)]);
  return results;
}

StartSummary summarize_starts(const std::vector<StartResult>& results, double no_error) {
  StartSummary summary;
  summary.best = best_of(results);
  for (const StartResult& result : results) {
    if (result.report.evaluations == 0) continue;
    summary.reports.push_back(result.report);
    summary.evaluations += result.report.evaluations + result.further_evaluations;
  }
  if (summary.best < 0) return summary;
  const double least = results[static_cast<std::size_t>(summary.best)].report.error;
  for (const StartReport& report : summary.reports)
    if (report.error <= std::max(no_error, (1.0 + kBest) * least)) ++summary.at_best;
  return summary;
}

}  // namespace crashsim
