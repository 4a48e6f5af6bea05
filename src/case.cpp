#include <crashsim/case.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/model_io.hpp>
#include <crashsim/sweep.hpp>
#include <crashsim/units.hpp>

#include "case_pitch.hpp"
#include "case_sections.hpp"
#include "case_steps.hpp"
#include "case_traces.hpp"
#include "stage_clock.hpp"

namespace crashsim {
namespace {

Pulse read_case_pulse(const Case& study, const std::string& file, double impact_speed_mps, CaseResult& out) {
  PulseOptions options = study.pulse;
  options.mass_kg = study.what.mass_kg;
  options.impact_speed_mps = impact_speed_mps;
  Pulse pulse = read_pulse(resolved(study, file), options);
  out.input_files.insert(out.input_files.end(), pulse.input_files.begin(), pulse.input_files.end());
  return pulse;
}

/// Identifies the model. False when there is none to go on with.
bool identify_model(const Case& study, const Progress& progress, CaseResult& out) {
  std::vector<Pulse> pulses = {*out.pulse};
  for (const std::string& file : study.what.further_pulses) pulses.push_back(read_case_pulse(study, file, kUnset, out));
  IdentifyOptions options = study.identify;
  options.mass_kg = study.what.mass_kg;
  out.identification = identify(pulses, options, progress);
  out.model = out.identification->model;
  return !out.identification->ordinates.empty();
}

/// What the case says of unloading; a plastic one without numbers has the restitution of the test.
Unloading unloading_of(const Case& study, CaseResult& out) {
  const CaseOptions& what = study.what;
  Unloading unloading{what.unloading, what.bilateral, what.unloading_stiffness_n_per_m, what.restitution};
  if (unloading.kind != UnloadingKind::plastic || !std::isnan(unloading.restitution) ||
      !std::isnan(unloading.unloading_stiffness_n_per_m))
    return unloading;
  const std::string key = fmt::format("{}: [crush] unloading = \"plastic\"", study.path);
  constexpr const char* kRemedy = "give restitution or unloading_stiffness";
  if (!out.pulse) throw InvalidInput(fmt::format("{}: there is no pulse to take a restitution from: {}", key, kRemedy));
  unloading.restitution = metrics_of(*out.pulse).restitution;
  if (std::isnan(unloading.restitution))
    throw InvalidInput(
        fmt::format("{}: the pulse has no restitution, it ends before the rebound does: {}", key, kRemedy));
  if (unloading.restitution > 1.0)
    throw InvalidInput(
        fmt::format("{}: the pulse's restitution = {:.4g} is above 1: {}", key, unloading.restitution, kRemedy));
  out.notes.push_back(fmt::format("restitution {:.4g} of plastic unloading is the pulse's", unloading.restitution));
  return unloading;
}

/// Unloading of a model that was read: its own where the case says nothing.
void overrule(Unloading& own, const Unloading& asked) {
  const bool bilateral = own.bilateral || asked.bilateral;
  if (asked.kind != UnloadingKind::elastic) own = asked;
  own.bilateral = bilateral;
}

template <class Motion>
TraceSet motion_set(std::string path, const Motion& motion) {
  return trace_set(std::move(path), {{"accel_mps2", Dimension::acceleration, motion.time_s, motion.accel_mps2},
                                     {"velocity_mps", Dimension::speed, motion.time_s, motion.velocity_mps},
                                     {"displacement_m", Dimension::length, motion.time_s, motion.displacement_m}});
}

/// The test against the model: up to maximum crush, which the identification looks at, and over the whole record.
void compare_with_test(const Case& study, CaseResult& out) {
  const TraceSet test = motion_set("pulse", *out.pulse), model = motion_set("response", out.response);
  CompareOptions to_max_crush = study.comparison;
  to_max_crush.end_s = std::fmin(study.comparison.end_s, out.pulse->t_m_s);
  if (!std::isnan(out.pulse->t_m_s))
    out.comparisons.push_back({"to_max_crush", "to maximum crush", compare(test, model, to_max_crush)});
  out.comparisons.push_back({"whole_record", "whole record", compare(test, model, study.comparison)});
}

SimulateOptions at_speed(const Case& study, double impact_speed_mps) {
  SimulateOptions options = study.simulation;
  options.impact_speed_mps = impact_speed_mps;
  return options;
}

/// The model that the case names.
void use_model(const Case& study, const Unloading& unloading, CaseResult& out) {
  const std::string path = resolved(study, study.what.model_file);
  out.model = read_model(path);
  out.input_files.push_back(path);
  if (!std::isnan(study.what.mass_kg)) out.model.mass_kg = study.what.mass_kg;
  overrule(out.model.unloading, unloading);
}

}  // namespace

bool CaseResult::usable() const {
  const auto is_usable = [](const Prediction& prediction) { return prediction.response.usable(); };
  return (!identification || identification->usable()) && response.usable() && (!pitch || pitch->usable()) &&
         (!coupled || coupled->usable()) && (!samples || samples->usable()) &&
         std::all_of(predictions.begin(), predictions.end(), is_usable);
}

bool find_model(const Case& study, const Progress& progress, CaseResult& out) {
  StageClock clock;
  if (!study.what.pulse_file.empty())
    out.pulse = read_case_pulse(study, study.what.pulse_file, study.what.impact_speed_mps, out);
  const Unloading unloading = unloading_of(study, out);
  if (!study.what.model_file.empty()) use_model(study, unloading, out);
  out.stages.pulse_s = clock.lap();
  if (!study.what.model_file.empty()) return true;
  const bool is_found = identify_model(study, progress, out);
  out.stages.identify_s = clock.lap();
  if (!is_found) return false;
  out.model.extrapolation = study.what.extrapolation;
  out.model.unloading = unloading;
  return true;
}

double speed_of(const Case& study, const CaseResult& out) {
  const double speed = study.what.impact_speed_mps;
  return std::isnan(speed) && out.pulse ? out.pulse->impact_speed_mps : speed;
}

void simulate_model(const Case& study, double impact_speed_mps, CaseResult& out) {
  StageClock clock;
  SimulateOptions options = at_speed(study, impact_speed_mps);
  if (std::isnan(options.end_time_s) && !options.to_max_crush && out.pulse)
    options.end_time_s = out.pulse->time_s.back();
  out.response = simulate(out.model, options);
  out.stages.simulate_s = clock.lap();
  if (out.response.usable() && has_pitch(study)) simulate_heave_and_pitch(study, impact_speed_mps, out);
  out.stages.pitch_s = clock.lap();
}

CaseResult run_case(const Case& study, const Progress& progress) {
  CaseResult out;
  if (!find_model(study, progress, out)) return out;
  simulate_model(study, speed_of(study, out), out);
  StageClock clock;
  for (const double predicted : study.what.speeds_mps)
    out.predictions.push_back({prediction_name(predicted), simulate(out.model, at_speed(study, predicted))});
  out.stages.simulate_s += clock.lap();
  if (out.pulse && !out.response.time_s.empty()) compare_with_test(study, out);
  if (out.pitch && !study.measured.file.empty()) compare_heave_and_pitch(study, out);
  out.stages.compare_s = clock.lap();
  const bool is_stopped = out.identification && out.identification->outcome == IdentifyOutcome::interrupted;
  if (!has_samples(study) || is_stopped) return out;
  const SamplePlan plan = plan_samples(study, out);
  out.samples = run_samples(plan, 0, plan.table.planned, progress);
  out.stages.samples_s = clock.lap();
  return out;
}

}  // namespace crashsim
