#include <crashsim/identify_vertical.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <crashsim/option_values.hpp>

#include "optimize/fit_target.hpp"
#include "optimize/parameter_verdict.hpp"
#include "optimize/starts.hpp"
#include "optimize/vertical_objective.hpp"

namespace crashsim {
namespace {

constexpr double kAgreement = 1e-9;  // between the fit's E and that of the law's own function, and at least this
constexpr double kNoError = 1e-9;    // E of a perfect fit
constexpr double kLimited = 1e-12;   // below the bound of friction, relative: at it

/// What an identification is made from. All but the starts is checked here.
struct Study {
  VerticalForceLaw first;  ///< The given law with the values of start 0.
  const IdentifyVerticalOptions& options;
  VerticalFitTarget target;
  std::vector<VerticalParameter> parameters;

  Study(const VerticalForceTarget& measured, const VerticalForceLaw& guess, const IdentifyVerticalOptions& how,
        std::vector<std::string>& warnings)
      : first(guess), options(how) {
    validate_options(how, "IdentifyVerticalOptions");
    validate(guess);
    target = make_vertical_target(measured, how);
    parameters = vertical_parameters(guess, target.largest_crush_m, how, warnings);
    for (const VerticalParameter& parameter : parameters) first.*parameter.member = parameter.first;
    if (target.samples.size() <= parameters.size())
      throw InvalidInput(
          fmt::format("VerticalForceTarget: {} samples cannot determine {} parameters: free fewer or give more",
                      target.samples.size(), parameters.size()));
  }

  [[nodiscard]] VerticalObjective objective(Loss loss) const { return {first, target, parameters, loss}; }
};

std::vector<StartResult> run_all_starts(const Study& study, const VerticalObjective& objective,
                                        const Progress& progress) {
  const auto error = [&](std::span<const double> values, double smoothing, std::span<double> gradient) {
    return objective.evaluate(values, smoothing, gradient);
  };
  return run_starts(plan_of_starts(ranges_of(study.parameters), error, study.options), progress);
}

/// Takes the starts into the result. @returns the best one's values, none when every start failed.
std::vector<double> best_of(const Study& study, const std::vector<StartResult>& results, VerticalIdentification& out) {
  const std::string why = fmt::format(
      "the angle is beyond {} rad without friction to bound the force: give friction or closer bounds", kSteepestAngle);
  const int best = take_starts(results, kNoError, why, out);
  if (best < 0) return {};
  return values_at(ranges_of(study.parameters), results[static_cast<std::size_t>(best)].parameters);
}

/// E as the law's own function gives it, and whether the fit agrees.
void record_error(const Study& study, double fitted, VerticalIdentification& out) {
  out.samples = static_cast<int>(study.target.samples.size());
  double sum = 0.0;
  for (const VerticalSample& sample : study.target.samples) {
    const double ratio = vertical_ratio(out.law, sample.crush_m);
    const double residual = sample.longitudinal_n * ratio - sample.vertical_n;
    sum += loss_value(study.options.loss, study.target.scale * residual, 0.0).value;
    if (std::fabs(ratio) >= (1.0 - kLimited) * out.law.friction) ++out.limited_samples;
  }
  out.error = study.target.factor * sum;
  if (std::fabs(fitted - out.error) <= kAgreement * std::max(out.error, 1.0)) return;
  out.outcome = IdentifyOutcome::engines_disagree;
  out.message =
      fmt::format("the fit's E = {:.10g} and the law's E = {:.10g} disagree: the law is not usable", fitted, out.error);
}

/// Law, error and verdict of the values found.
void judge(const Study& study, const VerticalObjective& objective, std::span<const double> values,
           VerticalIdentification& out) {
  out.law = with_values<VerticalForceLaw>(study.first, study.parameters, values);
  record_error(study, objective.evaluate(values, 0.0, {}), out);
  judge_values(ranges_of(study.parameters), objective, study.objective(Loss::l2), values, out);
}

}  // namespace

VerticalIdentification identify_vertical(const VerticalForceTarget& target, const VerticalForceLaw& guess,
                                         const IdentifyVerticalOptions& options, const Progress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  VerticalIdentification out;
  out.seed = options.seed;
  const Study study(target, guess, options, out.warnings);
  const VerticalObjective objective = study.objective(options.loss);
  const std::vector<double> values = best_of(study, run_all_starts(study, objective, progress), out);
  if (!values.empty()) {
    judge(study, objective, values, out);
    if (out.outcome == IdentifyOutcome::not_run) out.outcome = IdentifyOutcome::completed;
  }
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

std::string VerticalIdentification::brief_report() const {
  if (outcome == IdentifyOutcome::not_run) return "not run";
  if (!usable()) return fmt::format("{}: {}", name_of(outcome), message);
  return fmt::format("E = {:.6g}, friction bounds {} of {} samples, {} of {} starts at the best; {}", error,
                     limited_samples, samples, starts_at_best, starts.size(), verdict.message);
}

}  // namespace crashsim
