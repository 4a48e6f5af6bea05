#include <crashsim/identify_pitch.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <crashsim/option_values.hpp>

#include "optimize/parameter_verdict.hpp"
#include "optimize/pitch_objective.hpp"
#include "optimize/starts.hpp"
#include "pitch_input.hpp"

namespace crashsim {
namespace {

constexpr double kAgreement = 1e-6;   // between the fit's E and the engine's of record
constexpr double kLeastError = 1e-3;  // E below which the agreement is absolute
constexpr double kNoError = 1e-9;     // E of a perfect fit

/// The motion that a residual energy starts with is the same for all values.
void check_free_with_energy(const HeavePitchModel& model, const std::vector<PitchParameter>& parameters,
                            const PitchOptions& simulation) {
  if (std::isnan(simulation.residual_energy_j)) return;
  using M = HeavePitchModel;
  for (const PitchParameter& parameter : parameters)
    if (parameter.member == &M::mass_kg || parameter.member == &M::pitch_inertia_kgm2 ||
        (parameter.member == &M::force_arm_m && model.formulation == PitchFormulation::derived))
      throw InvalidInput(
          fmt::format("IdentifyPitchOptions.free names {}, which sets the motion that PitchOptions.residual_energy_j "
                      "starts with: keep it as it is, or give the initial rates instead",
                      parameter.name));
}

/// What an identification is made from. All but the starts is checked here.
struct Study {
  HeavePitchModel first;  ///< The given model with the values of start 0.
  const PitchForcing& forcing;
  const PitchOptions& simulation;
  const IdentifyPitchOptions& options;
  std::vector<PitchParameter> parameters;
  PitchFitTarget target;

  Study(const HeavePitchModel& guess, const PitchForcing& forces, const PitchTarget& measured,
        const PitchOptions& simulated, const IdentifyPitchOptions& how, std::vector<std::string>& warnings)
      : first(guess), forcing(forces), simulation(simulated), options(how) {
    validate_options(how, "IdentifyPitchOptions");
    validate_options(simulated, "PitchOptions");
    parameters = pitch_parameters(guess, how, warnings);
    for (const PitchParameter& parameter : parameters) first.*parameter.member = parameter.first;
    validate(first);
    check_pitch_input(first, forcing);
    check_free_with_energy(first, parameters, simulation);
    target = make_pitch_target(first, forcing, measured, simulated, how);
    if (target.samples.size() <= parameters.size())
      throw InvalidInput(fmt::format("PitchTarget: {} samples cannot determine {} parameters: free fewer or give more",
                                     target.samples.size(), parameters.size()));
    const auto notes = notes_on_pitch_input(first, forcing, simulation, target.start_s, target.times.back());
    warnings.insert(warnings.end(), notes.begin(), notes.end());
  }

  [[nodiscard]] PitchObjective objective(Loss loss) const { return {first, forcing, target, parameters, loss}; }
};

std::vector<StartResult> run_all_starts(const Study& study, const PitchObjective& objective, const Progress& progress) {
  const auto error = [&](std::span<const double> values, double smoothing, std::span<double> gradient) {
    return objective.evaluate(values, smoothing, gradient);
  };
  return run_starts(plan_of_starts(ranges_of(study.parameters), error, study.options), progress);
}

/// Takes the starts into the result. @returns the best one's values, none when every start failed.
std::vector<double> best_of(const Study& study, const std::vector<StartResult>& results, PitchIdentification& out) {
  const std::string why = fmt::format(
      "the motion grows beyond all bounds before the last sample, at {:g} s: check units, bounds and formulation",
      study.target.times.back());
  const int best = take_starts(results, kNoError, why, out);
  if (best < 0) return {};
  return values_at(ranges_of(study.parameters), results[static_cast<std::size_t>(best)].parameters);
}

/// E as the engine of record simulates the model, and whether the fit agrees.
void record_error(const Study& study, double fitted, PitchIdentification& out) {
  const PitchFitTarget& target = study.target;
  const LinearSystem system = linear_system(out.model);
  const PitchGrid grid =
      make_grid(out.model, study.forcing, target.start_s, target.times, std::numeric_limits<double>::infinity());
  std::vector<PitchState> states{target.initial};
  const PitchWork work = study.simulation.integrator == PitchIntegrator::cvode
                             ? integrate_by_cvode(system, grid, study.simulation.rtol, states)
                             : integrate_by_propagator(system, grid, states);
  if (work.outcome != PitchOutcome::completed) {
    out.outcome = IdentifyOutcome::engines_disagree;
    out.message =
        fmt::format("{} could not simulate the model: {}", name_of(study.simulation.integrator), work.message);
    return;
  }
  std::vector<PitchState> motion;
  for (const std::size_t at : grid.samples) motion.push_back(states[at]);
  out.error = pitch_fit_error(target, motion, study.options.loss);
  if (std::fabs(fitted - out.error.total) <= kAgreement * std::max(out.error.total, kLeastError)) return;
  out.outcome = IdentifyOutcome::engines_disagree;
  out.message = fmt::format("the fit's E = {:.10g} and the {}'s E = {:.10g} disagree: the model is not usable", fitted,
                            name_of(study.simulation.integrator), out.error.total);
}

/// Model, error and verdict of the values found.
void judge(const Study& study, const PitchObjective& objective, std::span<const double> values,
           PitchIdentification& out) {
  out.model = with_values<HeavePitchModel>(study.first, study.parameters, values);
  record_error(study, objective.evaluate(values, 0.0, {}), out);
  judge_values(ranges_of(study.parameters), objective, study.objective(Loss::l2), values, out);
}

}  // namespace

PitchIdentification identify_pitch(const HeavePitchModel& guess, const PitchForcing& forcing, const PitchTarget& target,
                                   const PitchOptions& simulation, const IdentifyPitchOptions& options,
                                   const Progress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  PitchIdentification out;
  out.seed = options.seed;
  const Study study(guess, forcing, target, simulation, options, out.warnings);
  const PitchObjective objective = study.objective(options.loss);
  const std::vector<double> values = best_of(study, run_all_starts(study, objective, progress), out);
  if (!values.empty()) {
    judge(study, objective, values, out);
    if (out.outcome == IdentifyOutcome::not_run) out.outcome = IdentifyOutcome::completed;
  }
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

std::string PitchIdentification::brief_report() const {
  if (outcome == IdentifyOutcome::not_run) return "not run";
  if (!usable()) return fmt::format("{}: {}", name_of(outcome), message);
  return fmt::format("E = {:.6g}, {} of {} starts at the best; {}", error.total, starts_at_best, starts.size(),
                     verdict.message);
}

}  // namespace crashsim
