#include <crashsim/identify.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <Eigen/LU>

#include <crashsim/option_values.hpp>
#include <crashsim/simulate.hpp>

#include "optimize/fit_errors.hpp"
#include "optimize/fit_study.hpp"
#include "optimize/identifiability.hpp"
#include "optimize/multistart.hpp"
#include "optimize/test_corrections.hpp"
#include "optimize/verdict.hpp"
#include "solver/crush_motion.hpp"

namespace crashsim {
namespace {

constexpr double kAgreement = 1e-6;    // between the Taylor kernel's E and CVODE's
constexpr double kLeastError = 1e-3;   // E below which the agreement is absolute
constexpr double kRecordRtol = 1e-10;  // of the simulation E is reported from

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

/// Mean over the tests, whose weights are in their errors.
FitError mean_error(const std::vector<TestReport>& tests) {
  FitError mean{0.0, 0.0, 0.0, 0.0};
  const double weight = 1.0 / static_cast<double>(tests.size());
  for (const TestReport& test : tests) {
    mean.total += weight * test.error.total;
    mean.accel += weight * test.error.accel;
    mean.velocity += weight * test.error.velocity;
    mean.displacement += weight * test.error.displacement;
  }
  return mean;
}

bool errors_agree(double kernel, double record) {
  return std::fabs(kernel - record) <= kAgreement * std::max(record, kLeastError);
}

/// E by CVODE, and whether the Taylor kernel, which fitted, agrees.
void record_error(const FitStudy& study, std::span<const double> parameters, Identification& out) {
  FitObjective objective(study.structure, study.targets, study.options.loss, 0.0);
  const double kernel_error = objective.evaluate(parameters, 0.0, {});
  for (std::size_t i = 0; i < study.targets.size(); ++i)
    out.tests[i].error = error_of_record(out.model, study.targets[i], study.options.loss);
  out.error = mean_error(out.tests);
  if (!errors_agree(kernel_error, out.error.total)) {
    out.outcome = IdentifyOutcome::engines_disagree;
    out.message =
        fmt::format("the Taylor kernel's E = {:.10g} and CVODE's E = {:.10g} disagree: the model is not usable",
                    kernel_error, out.error.total);
  }
}

/// What is known of the tests before the fit.
std::vector<TestReport> describe_tests(std::span<const Pulse> pulses, const FitStudy& study) {
  std::vector<TestReport> tests(pulses.size());
  double sum = 0.0;
  for (const double weight : study.options.test_weights) sum += weight;
  for (std::size_t i = 0; i < tests.size(); ++i) {
    tests[i].impact_speed_mps = pulses[i].impact_speed_mps;
    tests[i].mass_kg = study.targets[i].mass_kg;
    tests[i].max_crush_m = pulses[i].max_crush_m;
    tests[i].t_m_s = pulses[i].t_m_s;
    if (sum > 0.0) tests[i].weight = study.options.test_weights[i] * static_cast<double>(tests.size()) / sum;
  }
  return tests;
}

/// Sensitivities of the corrections beside those of the parameters, with what is expected of them.
struct Nuisance {
  SoughtCorrections sought;
  std::vector<double> corrections;
  Eigen::MatrixXd rows;

  [[nodiscard]] bool empty() const { return sought.empty(); }
};

/// `matrix` with rows of zeros below it.
Eigen::MatrixXd padded(const Eigen::MatrixXd& matrix, Eigen::Index rows) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, matrix.cols());
  out.topRows(matrix.rows()) = matrix;
  return out;
}

void report_corrections(const Nuisance& nuisance, const Eigen::MatrixXd& jacobian, double variance,
                        std::vector<TestReport>& tests) {
  const Eigen::MatrixXd rows = without_nuisance(nuisance.rows, padded(jacobian, nuisance.rows.rows()));
  const Eigen::MatrixXd covariance = variance * (rows.transpose() * rows).inverse();
  for (std::size_t i = 0; i < nuisance.corrections.size(); ++i) {
    const auto [value, error] = nuisance.sought.reported(i);
    TestReport& test = tests[nuisance.sought.test_of(i)];
    test.*value = nuisance.corrections[i] + (value == &TestReport::gain ? 1.0 : 0.0);
    const auto at = static_cast<Eigen::Index>(i);
    test.*error = std::sqrt(covariance(at, at));
  }
}

/// Model, error and verdict of the parameters found.
void judge(const FitStudy& study, std::span<double> parameters, const Nuisance& nuisance, Identification& out) {
  const std::vector<FitTarget>& targets = study.targets;
  FitObjective objective = study.objective();
  Eigen::MatrixXd jacobian = objective.jacobian(parameters);
  if (study.smooth == 0.0) hold_untouched(study.structure, touched_columns(jacobian, study.upper), parameters);
  out.model = make_model(study.structure, parameters, targets.front().mass_kg, targets.front().impact_speed_mps);
  out.smooth = study.smooth;
  record_error(study, parameters, out);
  FitObjective squared(study.structure, targets, Loss::l2, 0.0);
  const double freedom = std::max<double>(1.0, static_cast<double>(jacobian.rows() - jacobian.cols()));
  const double variance = squared.evaluate(parameters, 0.0, {}) * static_cast<double>(targets.size()) / freedom;
  if (!nuisance.empty()) {
    report_corrections(nuisance, jacobian, variance, out.tests);
    jacobian = without_nuisance(padded(jacobian, nuisance.rows.rows()), nuisance.rows);
  }
  Identifiability found = judge_identifiability(study.structure, parameters, study.upper, jacobian,
                                                objective.penalty_rows(), variance, targets.size());
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

std::vector<double> find_parameters(const FitStudy& study, const Progress& progress, Identification& out) {
  const Eigen::VectorXd linear = study.solve_equation_error();
  if (study.options.method == IdentifyMethod::multistart)
    return best_of(
        run_starts({study.structure, study.targets, study.options, study.upper, linear, study.smooth, study.prior},
                   progress),
        out);
  std::vector<double> parameters(linear.begin(), linear.end());
  FitObjective objective = study.objective();
  if (std::isfinite(objective.evaluate(parameters, 0.0, {}))) return parameters;
  out.outcome = IdentifyOutcome::every_start_failed;
  out.message = fmt::format(
      "the equation-error model's simulation did not reach the end of the pulse within {} steps: check the pulse's "
      "times and units, or lower the bounds",
      kStepLimit);
  return {};
}

/// Descends once more from parameters that are already good.
std::vector<double> descend_from(const FitStudy& study, const std::vector<double>& parameters) {
  IdentifyOptions once = study.options;
  once.starts = 1;
  const Eigen::VectorXd start = Eigen::Map<const Eigen::VectorXd>(parameters.data(), study.upper.size());
  const std::vector<StartResult> results =
      run_starts({study.structure, study.targets, once, study.upper, start, study.smooth, study.prior}, {});
  return results.front().report.failed ? parameters : results.front().parameters;
}

/// Finds the errors of the accelerometers with the parameters, and corrects the study's targets by them.
Nuisance correct_tests(std::span<const Pulse> pulses, std::vector<double>& parameters, FitStudy& study) {
  Nuisance nuisance{SoughtCorrections(study.options, pulses.size()), {}, {}};
  if (nuisance.empty()) return nuisance;
  CorrectedFit fit = fit_corrections(study, pulses, nuisance.sought, parameters);
  const Eigen::MatrixXd jacobian = correction_jacobian(study, pulses, nuisance.sought, fit.corrections);
  const Eigen::MatrixXd expected = correction_rows(study, nuisance.sought);
  nuisance.rows.resize(jacobian.rows() + expected.rows(), jacobian.cols());
  nuisance.rows << jacobian, expected;
  nuisance.corrections = std::move(fit.corrections);
  study.targets = std::move(fit.targets);
  parameters =
      study.options.method == IdentifyMethod::multistart ? descend_from(study, fit.parameters) : fit.parameters;
  return nuisance;
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
  FitStudy study(pulses, options);
  out.tests = describe_tests(pulses, study);
  std::vector<double> parameters = find_parameters(study, progress, out);
  if (!parameters.empty()) {
    const FitStudy measured = study;
    const Nuisance nuisance = correct_tests(pulses, parameters, study);
    judge(study, parameters, nuisance, out);
    if (out.outcome != IdentifyOutcome::engines_disagree) tell_standard_errors(pulses, measured, out);
    if (out.outcome == IdentifyOutcome::not_run) out.outcome = IdentifyOutcome::completed;
  }
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

Identification identify(const Pulse& pulse, const IdentifyOptions& options, const Progress& progress) {
  return identify(std::span(&pulse, 1), options, progress);
}

Identification equation_error(std::span<const Pulse> pulses, IdentifyOptions options) {
  options.method = IdentifyMethod::equation_error;
  return identify(pulses, options);
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
