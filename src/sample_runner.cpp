#include "sample_runner.hpp"

#include <algorithm>
#include <cmath>

#include <crashsim/option_values.hpp>

#include "case_sections.hpp"
#include "case_steps.hpp"

namespace crashsim {
namespace {

/// Numbers of the vehicle that is simulated, not of the test that its model comes from.
bool is_of_model(std::string_view key) {
  return key == kMassKey || key == kSpeedKey || key == kRestitutionKey || key == kUnloadingStiffnessKey ||
         ordinate_key(key);
}

bool makes_model(std::string_view key) {
  return !is_of_model(key) && (key.starts_with("pulse.") || key.starts_with("identify.") || key.starts_with("crush."));
}

bool makes_forcing(std::string_view key) {
  const auto names_it = [&](const Field<ForcingOptions>& field) {
    const Place place = place_of("pitch", field);
    return key == place.section + "." + place.key;
  };
  return std::any_of(kForcingFields.begin(), kForcingFields.end(), names_it);
}

void set_ordinate(CrushModel& model, const OrdinateKey& ordinate, double value) {
  const std::span<double> ordinates = ordinates_of(model, ordinate);
  if (ordinate.number > 0)
    ordinates[ordinate.number - 1] = value;
  else
    for (double& each : ordinates) each *= value;
}

/// Sets a number of the model.
void set_of_model(CrushModel& model, const std::string& key, double value) {
  if (const auto ordinate = ordinate_key(key)) set_ordinate(model, *ordinate, value);
  if (key == kMassKey) model.mass_kg = value;
  if (key == kSpeedKey) model.impact_speed_mps = value;
  if (key == kRestitutionKey) model.unloading = {UnloadingKind::plastic, model.unloading.bilateral, kUnset, value};
  if (key == kUnloadingStiffnessKey)
    model.unloading = {UnloadingKind::plastic, model.unloading.bilateral, value, kUnset};
}

}  // namespace

std::span<double> ordinates_of(CrushModel& model, const OrdinateKey& ordinate) {
  if (ordinate.curve == 'r') return {&model.rate_coefficient, model.law == CrushLaw::rate ? 1U : 0U};
  return (ordinate.curve == 'k' ? model.spring : model.damper).ordinates;
}

bool is_whole_chain(const SamplePlan& plan) { return std::ranges::any_of(plan.keys, makes_model); }

bool is_identified_anew(const SamplePlan& plan) { return plan.study.what.model_file.empty() && is_whole_chain(plan); }

bool is_crush_alone(const SamplePlan& plan) {
  const auto is_of_crush = [](const std::string& key) { return is_of_model(key) && key != kUnloadingStiffnessKey; };
  return std::ranges::all_of(plan.keys, is_of_crush) && !has_pitch(plan.study) && !plan.study.simulation.to_max_crush;
}

CrushModel sample_model(const SamplePlan& plan, std::span<const double> inputs) {
  CrushModel model = plan.base.model;
  model.impact_speed_mps = plan_speed(plan);
  for (std::size_t i = 0; i < inputs.size(); ++i) set_of_model(model, plan.keys[i], inputs[i]);
  return model;
}

double plan_speed(const SamplePlan& plan) {
  const double speed = speed_of(plan.study, plan.base);
  return std::isnan(speed) ? plan.base.model.impact_speed_mps : speed;
}

CaseResult run_sample(const SamplePlan& plan, std::span<const double> inputs, const std::atomic<bool>& stop) {
  Case study = plan.study;
  study.simulation.integrator = Integrator::taylor;
  study.identify.jobs = 1;
  for (std::size_t i = 0; i < inputs.size(); ++i)
    if (!is_of_model(plan.keys[i])) set_number(study, plan.keys[i], inputs[i]);
  CaseResult out;
  if (is_whole_chain(plan)) {
    const auto go_on = [&](int, int) { return !stop; };
    if (!find_model(study, go_on, out)) return out;
  } else {
    out = plan.base;
    if (std::ranges::any_of(plan.keys, makes_forcing)) out.forcing.reset();
  }
  if (const double speed = speed_of(study, out); !std::isnan(speed)) out.model.impact_speed_mps = speed;
  for (std::size_t i = 0; i < inputs.size(); ++i) set_of_model(out.model, plan.keys[i], inputs[i]);
  simulate_model(study, out.model.impact_speed_mps, out);
  return out;
}

}  // namespace crashsim
