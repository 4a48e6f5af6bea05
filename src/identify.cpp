#include <crashsim/identify.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <crashsim/option_values.hpp>
#include <crashsim/simulate.hpp>

#include "optimize/equation_error.hpp"
#include "optimize/identifiability.hpp"
#include "optimize/multistart.hpp"
#include "optimize/verdict.hpp"
#include "solver/crush_motion.hpp"

namespace crashsim {
namespace {

constexpr double kAgreement = 1e-6;    // between the Taylor kernel's E and CVODE's
constexpr double kLeastError = 1e-3;   // E below which the agreement is absolute
constexpr double kBoundFactor = 2.0;   // spring or damper alone may carry this much of the measured force
constexpr double kLeastGap = 0.1;      // between quantile knots, relative to even spacing
constexpr double kRecordRtol = 1e-10;  // of the simulation E is reported from

/// Knots at quantiles of the samples, moved apart where samples crowd: kLeastGap of the even spacing is kept.
std::vector<double> quantile_knots(std::vector<double> samples, double last, int count) {
  std::sort(samples.begin(), samples.end());
  std::vector<double> knots = uniform_knots(last, count);
  const double gap = count > 1 ? kLeastGap * knots[1] : 0.0;
  for (std::size_t i = 1; i + 1 < knots.size(); ++i) {
    const double position =
        static_cast<double>(i) / static_cast<double>(knots.size() - 1) * static_cast<double>(samples.size() - 1);
    knots[i] = std::max(samples[static_cast<std::size_t>(position)], knots[i - 1] + gap);
  }
  for (std::size_t i = knots.size(); i-- > 2;) knots[i - 1] = std::min(knots[i - 1], knots[i] - gap);
  return knots;
}

void check_given_knots(const std::vector<double>& knots) {
  if (knots.empty())
    throw InvalidInput("IdentifyOptions.knots: no numbers given: give the spring's knots in m, from 0");
  for (std::size_t i = 0; i < knots.size(); ++i)
    if (i == 0 ? knots[i] != 0.0 : knots[i] <= knots[i - 1])
      throw InvalidInput(
          fmt::format("IdentifyOptions.knots[{}] = {} m: knots must start at 0 and increase strictly", i, knots[i]));
}

FitStructure make_structure(const IdentifyOptions& options, std::span<const FitTarget> targets) {
  double crush = 0.0, speed = 0.0;
  std::vector<double> x, v;
  for (const FitTarget& target : targets) {
    crush = std::max(crush, target.max_crush_m);
    speed = std::max(speed, target.impact_speed_mps);
    x.insert(x.end(), target.displacement_m.begin(), target.displacement_m.end());
    v.insert(v.end(), target.velocity_mps.begin(), target.velocity_mps.end());
  }
  FitStructure structure{options.law, {}, {}};
  switch (options.knots.rule) {
    case KnotPlacement::uniform:
      structure.spring_knots = uniform_knots(crush, options.spring_knots);
      structure.damper_knots = uniform_knots(speed, options.damper_knots);
      break;
    case KnotPlacement::quantile:
      structure.spring_knots = quantile_knots(x, crush, options.spring_knots);
      structure.damper_knots = quantile_knots(v, speed, options.damper_knots);
      break;
    case KnotPlacement::given:
      check_given_knots(options.knots.numbers);
      if (options.spring_knots > 0) structure.spring_knots = options.knots.numbers;
      if (options.damper_knots > 0)
        for (const double knot : options.knots.numbers)
          structure.damper_knots.push_back(
              options.knots.numbers.size() > 1 ? knot / options.knots.numbers.back() * speed : 0.0);
  }
  if (structure.size() == 0)
    throw InvalidInput("IdentifyOptions.spring_knots = 0 and damper_knots = 0: there is nothing to identify");
  return structure;
}

/// Upper bounds of one curve: what its hat alone needs to carry kBoundFactor times the measured force, wherever the hat
/// stands for at least a quarter of its range from 0 (nearer the ratio force/s says nothing).
void bound_curve(const std::vector<double>& knots, bool multiplied, std::span<const FitTarget> targets,
                 std::vector<double> FitTarget::*variable, double fallback, Eigen::Ref<Eigen::VectorXd> upper) {
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const double low = i > 0 ? knots[i - 1] : 0.0;
    const double high = i + 1 < knots.size() ? knots[i + 1] : std::numeric_limits<double>::infinity();
    double bound = 0.0, range = knots.size() > 1 ? knots[1] : 0.0;
    if (knots.size() == 1)
      for (const FitTarget& target : targets)
        for (const double s : target.*variable) range = std::max(range, s);
    const double least = 0.25 * range;
    for (const FitTarget& target : targets)
      for (std::size_t j = 0; j < target.time_s.size(); ++j) {
        const double s = (target.*variable)[j];
        if (s < low || s > high || s <= least) continue;
        const double force = target.mass_kg * std::fabs(target.accel_mps2[j]);
        bound = std::max(bound, multiplied ? force / s : force);
      }
    upper[static_cast<Eigen::Index>(i)] = kBoundFactor * (bound > 0.0 ? bound : fallback);
  }
}

Eigen::VectorXd upper_bounds(const FitStructure& structure, const IdentifyOptions& options,
                             std::span<const FitTarget> targets) {
  const auto springs = static_cast<Eigen::Index>(structure.spring_knots.size());
  const auto dampers = static_cast<Eigen::Index>(structure.damper_knots.size());
  const ForceScale scale = force_scale(structure.law, targets);
  Eigen::VectorXd upper(springs + dampers);
  bound_curve(structure.spring_knots, structure.law == CrushLaw::stiffness, targets, &FitTarget::displacement_m,
              scale.spring, upper.head(springs));
  bound_curve(structure.damper_knots, true, targets, &FitTarget::velocity_mps, scale.damper, upper.tail(dampers));
  if (!std::isnan(options.spring_upper)) upper.head(springs).setConstant(options.spring_upper);
  if (!std::isnan(options.damper_upper)) upper.tail(dampers).setConstant(options.damper_upper);
  return upper;
}

FitError channel_errors(const CrushResponse& run, const FitTarget& target, Loss loss) {
  const auto sum = [&](const std::vector<double>& model, const std::vector<double>& data, double scale) {
    double total = 0.0;
    for (std::size_t i = 0; i < data.size(); ++i) total += loss_value(loss, scale * (model[i] - data[i]), 0.0).value;
    return target.factor * total;
  };
  FitError error;
  error.accel = sum(run.accel_mps2, target.accel_mps2, target.accel_scale);
  error.velocity = sum(run.velocity_mps, target.velocity_mps, target.velocity_scale);
  error.displacement = sum(run.displacement_m, target.displacement_m, target.displacement_scale);
  error.total = error.accel + error.velocity + error.displacement;
  return error;
}

FitError error_of_record(const CrushModel& model, const FitTarget& target, Loss loss) {
  CrushModel tested = model;
  tested.mass_kg = target.mass_kg;
  SimulateOptions options;
  options.impact_speed_mps = target.impact_speed_mps;
  options.times_s = target.time_s;
  options.rtol = kRecordRtol;
  const CrushResponse run = simulate(tested, options);
  if (run.time_s.size() != target.time_s.size())
    throw NumericalFailure("CVODE could not simulate the model: " + run.message);
  return channel_errors(run, target, loss);
}

FitError mean_error(const CrushModel& model, std::span<const FitTarget> targets, Loss loss) {
  FitError mean{0.0, 0.0, 0.0, 0.0};
  const double weight = 1.0 / static_cast<double>(targets.size());
  for (const FitTarget& target : targets) {
    const FitError error = error_of_record(model, target, loss);
    mean.total += weight * error.total;
    mean.accel += weight * error.accel;
    mean.velocity += weight * error.velocity;
    mean.displacement += weight * error.displacement;
  }
  return mean;
}

bool errors_agree(double kernel, double record) {
  return std::fabs(kernel - record) <= kAgreement * std::max(record, kLeastError);
}

/// What an identification is made from.
struct Study {
  const IdentifyOptions& options;
  std::vector<FitTarget> targets;
  FitStructure structure;
  Eigen::VectorXd upper;

  Study(std::span<const Pulse> pulses, const IdentifyOptions& how) : options(how) {
    for (const Pulse& pulse : pulses) targets.push_back(make_target(pulse, how.mass_kg, how.weights));
    structure = make_structure(how, targets);
    upper = upper_bounds(structure, how, targets);
  }
};

/// E by CVODE, and whether the Taylor kernel, which fitted, agrees.
void record_error(const Study& study, std::span<const double> parameters, Identification& out) {
  FitObjective objective(study.structure, study.targets, study.options.loss, 0.0);
  const double kernel_error = objective.evaluate(parameters, 0.0, {});
  out.error = mean_error(out.model, study.targets, study.options.loss);
  if (!errors_agree(kernel_error, out.error.total)) {
    out.outcome = IdentifyOutcome::engines_disagree;
    out.message =
        fmt::format("the Taylor kernel's E = {:.10g} and CVODE's E = {:.10g} disagree: the model is not usable",
                    kernel_error, out.error.total);
  }
}

/// Model, error and verdict of the parameters found.
void judge(const Study& study, std::span<double> parameters, Identification& out) {
  const auto& [options, targets, structure, upper] = study;
  FitObjective objective(structure, targets, options.loss, options.smooth);
  const Eigen::MatrixXd jacobian = objective.jacobian(parameters);
  if (options.smooth == 0.0) hold_untouched(structure, touched_columns(jacobian, upper), parameters);
  out.model = make_model(structure, parameters, targets.front().mass_kg, targets.front().impact_speed_mps);
  record_error(study, parameters, out);
  FitObjective squared(structure, targets, Loss::l2, 0.0);
  const double freedom = std::max<double>(1.0, static_cast<double>(jacobian.rows() - jacobian.cols()));
  const double variance = squared.evaluate(parameters, 0.0, {}) * static_cast<double>(targets.size()) / freedom;
  Identifiability found = judge_identifiability(structure, parameters, upper, jacobian, objective.roughness_rows(),
                                                variance, targets.size());
  out.verdict = std::move(found.verdict);
  out.ordinates = std::move(found.ordinates);
  out.correlation = std::move(found.correlation);
}

/// Takes the starts into the result. @returns the best one's parameters, none when every start failed.
std::vector<double> best_of(const std::vector<StartResult>& results, Identification& out) {
  const std::string why = fmt::format(
      "their simulations did not reach the end of the pulse within {} steps: check the pulse's times and units, or "
      "lower "
      "the bounds",
      kStepLimit);
  const int best = take_starts(results, 0.0, why, out);
  return best < 0 ? std::vector<double>() : results[static_cast<std::size_t>(best)].parameters;
}

std::vector<double> find_parameters(const Study& study, const Progress& progress, Identification& out) {
  const auto& [options, targets, structure, upper] = study;
  const Eigen::VectorXd linear = solve_equation_error(structure, targets, upper, options.smooth);
  if (options.method == IdentifyMethod::multistart)
    return best_of(run_starts({structure, targets, options, upper, linear}, progress), out);
  std::vector<double> parameters(linear.begin(), linear.end());
  FitObjective objective(structure, targets, options.loss, options.smooth);
  if (std::isfinite(objective.evaluate(parameters, 0.0, {}))) return parameters;
  out.outcome = IdentifyOutcome::every_start_failed;
  out.message = fmt::format(
      "the equation-error model's simulation did not reach the end of the pulse within {} steps: check the pulse's "
      "times and units, or lower the bounds",
      kStepLimit);
  return {};
}

}  // namespace

Identification identify(std::span<const Pulse> pulses, const IdentifyOptions& options, const Progress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  validate_options(options, "IdentifyOptions");
  if (pulses.empty()) throw InvalidInput("identify: no pulse given");
  Identification out;
  out.seed = options.seed;
  for (const Pulse& pulse : pulses) {
    if (pulse.time_s.empty() || !std::isnan(pulse.t_m_s)) continue;
    out.outcome = IdentifyOutcome::no_max_crush;
    out.message = no_max_crush_message(pulse);
    return out;
  }
  const Study study(pulses, options);
  std::vector<double> parameters = find_parameters(study, progress, out);
  if (!parameters.empty()) {
    judge(study, parameters, out);
    if (out.outcome == IdentifyOutcome::not_run) out.outcome = IdentifyOutcome::completed;
  }
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

Identification identify(const Pulse& pulse, const IdentifyOptions& options, const Progress& progress) {
  return identify(std::span(&pulse, 1), options, progress);
}

FitError fit_error(const CrushModel& model, const Pulse& pulse, const Setting<Weights>& weights, Loss loss) {
  return error_of_record(model, make_target(pulse, model.mass_kg, weights), loss);
}

std::string Identification::brief_report() const {
  if (outcome == IdentifyOutcome::not_run) return "not run";
  if (!usable()) return fmt::format("{}: {}", name_of(outcome), message);
  return fmt::format("E = {:.6f}, {} of {} starts at the best; {}", error.total, starts_at_best, starts.size(),
                     verdict.message);
}

}  // namespace crashsim
