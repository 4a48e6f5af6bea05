#pragma once
/// Descents from many starting points.

#include <functional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Core>

#include <crashsim/identify.hpp>

namespace crashsim {

/// E at a point of the unit box with its gradient by the point.
/// @param smoothing rounding of the corner of |u|, relative to each channel's largest u; 0 for the true loss.
using SmoothedFunction =
    std::function<double(std::span<const double> point, double smoothing, std::span<double> gradient)>;

/// The same with Gauss-Newton's Hessian, by the point.
using SmoothedNormalEquations = std::function<double(std::span<const double> point, double smoothing,
                                                     std::span<double> gradient, Eigen::MatrixXd& hessian)>;

/// What a thread evaluates; the normal equations may be missing.
struct StartFunctions {
  SmoothedFunction value;
  SmoothedNormalEquations normal_equations;
};

/// Everything the starts depend on.
struct StartPlan {
  int starts = 1;
  int jobs = 0;
  Loss loss = Loss::l1;
  Algorithm algorithm = Algorithm::lbfgs;
  std::function<StartFunctions()> make_functions;               ///< Called once on each thread.
  std::function<std::vector<double>(int index)> initial_point;  ///< In the unit box; depends on the index only.
};

struct StartResult {
  std::vector<double> parameters;
  StartReport report;
  int further_evaluations = 0;  ///< By which the best start has gone on.
};

/// Descends from every start, and from the best one further; parameters are points of the unit box. The outcome does
/// not depend on the number of threads. Starts that `progress` kept from ending have no evaluations.
std::vector<StartResult> run_starts(const StartPlan& plan, const Progress& progress);

/// What the starts that ended came to.
struct StartSummary {
  int best = -1;  ///< Index of the best, the first of equals; -1 when all failed.
  std::vector<StartReport> reports;
  int at_best = 0;  ///< Starts with E within 0.1 % of the best.
  long evaluations = 0;
};
/// @param no_error starts with E up to this are at the best, too.
StartSummary summarize_starts(const std::vector<StartResult>& results, double no_error);

/// Takes the starts into what a fit reports: Identification or one like it.
/// @param why_all_failed the end of the message when none came to a result. @returns the best one's index, -1 for none.
template <class Fit>
int take_starts(const std::vector<StartResult>& results, double no_error, std::string_view why_all_failed, Fit& out) {
  StartSummary summary = summarize_starts(results, no_error);
  out.starts = std::move(summary.reports);
  out.starts_at_best = summary.at_best;
  out.evaluations = summary.evaluations;
  if (out.starts.size() < results.size()) {
    out.outcome = IdentifyOutcome::interrupted;
    out.message = fmt::format("stopped after {} of {} starts", out.starts.size(), results.size());
  } else if (summary.best < 0) {
    out.outcome = IdentifyOutcome::every_start_failed;
    out.message = fmt::format("all {} starts failed: {}", results.size(), why_all_failed);
  }
  return summary.best;
}

}  // namespace crashsim
