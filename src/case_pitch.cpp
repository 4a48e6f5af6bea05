#include "case_pitch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/option_values.hpp>

#include "case_sections.hpp"
#include "case_traces.hpp"

namespace crashsim {
namespace {

void append(const std::vector<std::string>& more, std::vector<std::string>& all) {
  all.insert(all.end(), more.begin(), more.end());
}

/// The vehicle with the mass of the crush.
HeavePitchModel vehicle_of(const Case& study, const CaseResult& out) {
  HeavePitchModel vehicle = study.vehicle;
  vehicle.mass_kg = out.model.mass_kg;
  return vehicle;
}

/// Time of impact in a trace that is the pulse's, too.
void set_time_zero(const Case& study, const std::string& file, const CaseResult& out, double& time_zero_s) {
  const bool is_pulse = out.pulse && file == resolved(study, study.what.pulse_file);
  if (std::isnan(time_zero_s) && is_pulse) time_zero_s = out.pulse->time_zero_s;
}

/// The force that the case names. The simulated crush force acts where there is no file, and beside a vertical force
/// where the vehicle says at which height.
PitchForcing find_forcing(const Case& study, CaseResult& out) {
  const PitchForcing simulated = forcing_of(out.response);
  PitchForcing forcing;
  if (study.forcing.file.empty()) {
    forcing = simulated;
  } else {
    ForcingOptions options = study.forcing;
    options.file = resolved(study, study.forcing.file);
    set_time_zero(study, options.file, out, options.time_zero_s);
    if (!out.forcing) out.forcing = read_forcing(options);  // samples bring it along
    append(out.forcing->input_files, out.input_files);
    forcing = out.forcing->forcing;
    const HeavePitchModel& vehicle = study.vehicle;
    if (forcing.longitudinal_force_n.empty() && !std::isnan(vehicle.cg_height_m) &&
        !std::isnan(vehicle.force_height_m)) {
      forcing.longitudinal_force_n = simulated.longitudinal_force_n;
      out.forcing->steps.emplace_back("longitudinal force: of the simulated crush, at force_height");
    }
    if (std::isnan(forcing.t_m_s)) forcing.t_m_s = simulated.t_m_s;
  }
  if (!is_active(study.vertical)) return forcing;
  if (!forcing.vertical_force_n.empty())
    throw InvalidInput(fmt::format("{}: [pitch] has a vertical force from {} and an angle or friction: leave one out",
                                   study.path, study.forcing.file));
  forcing.vertical_force_n = vertical_force(study.vertical, out.response);
  return forcing;
}

CoupledResponse run_coupled(const Case& study, double impact_speed_mps, const PitchForcing& forcing,
                            const CaseResult& out) {
  CoupledOptions options;
  options.impact_speed_mps = impact_speed_mps;
  options.end_time_s = study.motion.end_time_s;
  options.dt_s = study.motion.dt_s;
  options.rtol = std::max(study.motion.rtol, 1e-10);  // the tightest it takes
  const CoupledModel model{out.model, vehicle_of(study, out), study.vertical, study.ground};
  return simulate_coupled(model, options, is_active(study.vertical) ? TimeSeries{} : forcing.vertical_force_n);
}

/// What the case says of the two phases only.
std::vector<std::string> left_out(const Case& study, const CaseResult& out) {
  std::vector<std::string> lines;
  const PitchOptions& motion = study.motion;
  if (motion.heave_m != 0.0 || motion.heave_velocity_mps != 0.0 || motion.pitch_rad != 0.0 ||
      motion.pitch_rate_radps != 0.0)
    lines.emplace_back("coupled: starts at impact in static equilibrium, without the initial motion of [pitch]");
  if (!study.forcing.longitudinal_channels.empty())
    lines.emplace_back("coupled: the longitudinal force is that of the crush model, not the one measured");
  if (out.forcing && !out.forcing->forcing.force_height_m.empty())
    lines.emplace_back("coupled: the force acts at force_height all the time, not at the height measured");
  return lines;
}

/// Where the two phases and the coupled motion differ, and why.
std::vector<std::string> differences(const PitchResponse& phases, const CoupledResponse& coupled, double max_crush_m) {
  std::vector<std::string> lines;
  const auto at = static_cast<std::size_t>(
      std::lower_bound(coupled.time_s.begin(), coupled.time_s.end(), phases.start_time_s) - coupled.time_s.begin());
  if (phases.start_time_s > 0.0 && at < coupled.time_s.size())
    lines.push_back(fmt::format(
        "two phases: the body starts at {:.4g} s as the case says; coupled it has pitched {:.3g} "
        "rad by then, at {:.3g} rad/s, and heaves at {:.3g} m/s",
        phases.start_time_s, coupled.pitch_rad[at], coupled.pitch_rate_radps[at], coupled.heave_velocity_mps[at]));
  lines.push_back(fmt::format(
      "coupled: pitching moves the front where the force acts, so the crush there is {:.4f} m instead of {:.4f} m",
      coupled.max_crush_m, max_crush_m));
  return lines;
}

bool has_ground_contact(const GroundContact& ground) {
  const auto is_set = [&](const Field<GroundContact>& field) {
    return get_option(ground, field) != get_option(GroundContact(), field);
  };
  return std::any_of(fields<GroundContact>.begin(), fields<GroundContact>.end(), is_set);
}

template <class Motion>
TraceSet motion_set(const char* path, const Motion& motion) {
  return trace_set(path, {{"heave_m", Dimension::length, motion.time_s, motion.heave_m},
                          {"pitch_rad", Dimension::angle, motion.time_s, motion.pitch_rad},
                          {"heave_velocity_mps", Dimension::speed, motion.time_s, motion.heave_velocity_mps},
                          {"pitch_rate_radps", Dimension::angular_rate, motion.time_s, motion.pitch_rate_radps}});
}

TraceSet measured_set(const MeasuredMotion& m) {
  return trace_set(
      "measured motion",
      {{"heave_m", Dimension::length, m.heave_m.time_s, m.heave_m.values},
       {"pitch_rad", Dimension::angle, m.pitch_rad.time_s, m.pitch_rad.values},
       {"heave_velocity_mps", Dimension::speed, m.heave_velocity_mps.time_s, m.heave_velocity_mps.values},
       {"pitch_rate_radps", Dimension::angular_rate, m.pitch_rate_radps.time_s, m.pitch_rate_radps.values}});
}

}  // namespace

void simulate_heave_and_pitch(const Case& study, double impact_speed_mps, CaseResult& out) {
  const PitchForcing forcing = find_forcing(study, out);
  out.pitch = simulate_pitch(vehicle_of(study, out), forcing, study.motion);
  if (!study.what.coupled && has_ground_contact(study.ground))
    out.notes.emplace_back("lift_off and bump stops act in the coupled model only: set [pitch] coupled");
  if (!study.what.coupled) return;
  out.coupled = run_coupled(study, impact_speed_mps, forcing, out);
  append(left_out(study, out), out.notes);
  if (out.pitch->usable() && out.coupled->usable())
    append(differences(*out.pitch, *out.coupled, out.response.max_crush_m), out.notes);
}

void compare_heave_and_pitch(const Case& study, CaseResult& out) {
  MotionOptions options = study.measured;
  options.file = resolved(study, study.measured.file);
  set_time_zero(study, options.file, out, options.time_zero_s);
  const MeasuredMotion measured = read_motion(options);
  append(measured.input_files, out.input_files);
  append(measured.warnings, out.notes);
  const TraceSet test = measured_set(measured);
  CompareOptions compared = study.comparison;
  compared.channels.clear();
  if (out.coupled && out.coupled->usable())
    out.comparisons.push_back({"heave_and_pitch_coupled", "heave and pitch, coupled",
                               compare(test, motion_set("coupled", *out.coupled), compared)});
  if (!out.pitch->usable()) return;
  compared.start_s = std::fmax(compared.start_s, out.pitch->start_time_s);
  out.comparisons.push_back(
      {"heave_and_pitch", "heave and pitch", compare(test, motion_set("pitch", *out.pitch), compared)});
}

}  // namespace crashsim
