#include <crashsim/design_case.hpp>

#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/sweep.hpp>

namespace crashsim {
namespace {

CoupledOptions coupled_options(const Case& study, const CaseResult& base) {
  CoupledOptions options;
  options.impact_speed_mps = base.response.impact_speed_mps;
  options.end_time_s = std::isnan(study.motion.end_time_s) ? study.simulation.end_time_s : study.motion.end_time_s;
  options.dt_s = study.simulation.dt_s;
  return options;
}

/// What a library message calls an option of DesignOptions is a key of [design] here.
std::string in_words_of(const Case& study, std::string_view message) {
  constexpr std::string_view kOptions = "DesignOptions.", kVehicle = "HeavePitchModel.";
  if (message.starts_with(kOptions)) return fmt::format("{}: [design] {}", study.path, message.substr(kOptions.size()));
  if (message.starts_with(kVehicle))
    return fmt::format("{}: [vehicle] {}", study.path, message.substr(kVehicle.size()));
  return fmt::format("{}: {}", study.path, message);
}

}  // namespace

DesignCaseResult run_design(const Case& study, const Progress& progress) {
  DesignCaseResult out;
  out.base = run_case(without_samples(study), progress);
  if (out.base.response.outcome == CrushOutcome::not_run) return out;
  if (!study.forcing.file.empty())
    out.notes.emplace_back("the force file of [pitch] is not used: a design changes the force, which the model gives");
  out.model.crush = out.base.model;
  out.model.body = study.vehicle;
  out.model.body.mass_kg = out.base.model.mass_kg;
  out.model.vertical = study.vertical;
  const CoupledOptions simulation = coupled_options(study, out.base);
  try {
    out.design = design(out.model, study.design, simulation, progress);
  } catch (const InvalidInput& error) {
    throw InvalidInput(in_words_of(study, error.what()));
  }
  if (out.design.usable()) out.response = simulate_coupled(out.design.optimum, simulation);
  return out;
}

}  // namespace crashsim
