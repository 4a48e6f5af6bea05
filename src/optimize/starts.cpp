#include "optimize/starts.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

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
StartResult run_start(const StartPlan& plan, const SmoothedFunction& smoothed, int index,
                      const std::atomic<bool>& stop) {
  double smoothing = 0.0;
  const GradientFunction function = [&](std::span<const double> point, std::span<double> gradient) {
    if (stop) throw Stopped{};
    return smoothed(point, smoothing, gradient);
  };
  StartResult result;
  result.parameters = plan.initial_point(index);
  const auto descend = [&](double rounding, double ftol) {
    smoothing = rounding;
    const Minimum minimum = minimize_in_unit_box(plan.algorithm, function, result.parameters, ftol, kMaxEvaluations);
    result.parameters = minimum.point;
    result.report.evaluations += minimum.evaluations;
    return minimum.value;
  };
  const bool has_corner = plan.loss == Loss::l1;
  if (has_corner)
    for (const Rung& rung : kLadder)
      if (!std::isfinite(descend(rung.smoothing, rung.ftol))) break;
  result.report.error = descend(0.0, has_corner ? kFtolPolish : kFtolSmooth);
  result.report.failed = !std::isfinite(result.report.error);
  return result;
}

}  // namespace

double uniform_random(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15ULL;
  const std::uint64_t bits = mix(mix(mix(seed + kGolden) ^ (stream * kGolden + kGolden)) + index * kGolden);
  return static_cast<double>(bits >> 11) * 0x1.0p-53;
}

std::vector<StartResult> run_starts(const StartPlan& plan, const Progress& progress) {
  const int threads = std::min(thread_count(plan.jobs), plan.starts);
  std::vector<StartResult> results(static_cast<std::size_t>(plan.starts));
  std::vector<SmoothedFunction> functions(static_cast<std::size_t>(threads));
  std::atomic<bool> stop{false};
  parallel_for(
      plan.starts, threads,
      [&](int worker, int index) {
        SmoothedFunction& function = functions[static_cast<std::size_t>(worker)];
        if (!function) function = plan.make_function();
        try {
          results[static_cast<std::size_t>(index)] = run_start(plan, function, index, stop);
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

StartSummary summarize_starts(const std::vector<StartResult>& results, double no_error) {
  StartSummary summary;
  const auto error_of = [&](int index) { return results[static_cast<std::size_t>(index)].report.error; };
  for (std::size_t i = 0; i < results.size(); ++i) {
    const StartReport& report = results[i].report;
    if (report.evaluations == 0) continue;
    summary.reports.push_back(report);
    summary.evaluations += report.evaluations;
    if (!report.failed && (summary.best < 0 || report.error < error_of(summary.best)))
      summary.best = static_cast<int>(i);
  }
  if (summary.best < 0) return summary;
  for (const StartReport& report : summary.reports)
    if (report.error <= std::max(no_error, (1.0 + kBest) * error_of(summary.best))) ++summary.at_best;
  return summary;
}

}  // namespace crashsim
