#include "pitch_input.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include <crashsim/option_values.hpp>
#include <crashsim/signal.hpp>

namespace crashsim {
namespace {

constexpr double kNegligibleForce = 0.01;  // of the largest: what may be cut off unnoticed

void check(const TimeSeries& series, std::string_view name) {
  if (!series.empty()) check_series(series.time_s, series.values, fmt::format("PitchForcing.{}", name), 2);
}

void note_cut_force(const TimeSeries& force, std::string_view name, double start_s, double end_s,
                    std::vector<std::string>& notes) {
  if (force.empty()) return;
  double largest = 0.0;
  for (const double f : force.values) largest = std::max(largest, std::abs(f));
  if (largest > 0.0 && force.time_s.back() <= start_s)
    notes.push_back(
        fmt::format("{} ends at {:.6g} s, before the motion starts: it does nothing", name, force.time_s.back()));
  const auto note = [&](double t, double f, std::string_view verb, std::string_view side) {
    if (t <= start_s || t >= end_s || std::abs(f) <= kNegligibleForce * largest) return;
    notes.push_back(fmt::format("{} {} at {:.6g} s with {:.6g} N, {:.0f} % of its largest: it is zero {} that", name,
                                verb, t, f, 100.0 * std::abs(f) / largest, side));
  };
  note(force.time_s.front(), force.values.front(), "begins", "before");
  note(force.time_s.back(), force.values.back(), "ends", "after");
}

}  // namespace

void check_pitch_input(const HeavePitchModel& model, const PitchForcing& forcing) {
  check(forcing.vertical_force_n, "vertical_force_n");
  check(forcing.longitudinal_force_n, "longitudinal_force_n");
  check(forcing.force_height_m, "force_height_m");
  if (model.formulation == PitchFormulation::as_printed) return;
  using M = HeavePitchModel;
  if (!forcing.vertical_force_n.empty())
    require_set(model, &M::force_arm_m, "HeavePitchModel", "there is a vertical force");
  if (forcing.longitudinal_force_n.empty()) return;
  require_set(model, &M::cg_height_m, "HeavePitchModel", "there is a longitudinal force");
  if (forcing.force_height_m.empty())
    require_set(model, &M::force_height_m, "HeavePitchModel",
                "there is a longitudinal force without a series of its height");
}

double start_of_motion(const PitchForcing& forcing, const PitchOptions& options) {
  if (options.start.rule == PitchStart::impact) return 0.0;
  if (options.start.rule == PitchStart::given) {
    const auto& numbers = options.start.numbers;
    if (numbers.size() == 1 && std::isfinite(numbers[0])) return numbers[0];
    throw InvalidInput(fmt::format("PitchOptions.start = {}: must be one finite time in s", fmt::join(numbers, ",")));
  }
  if (std::isfinite(forcing.t_m_s)) return forcing.t_m_s;
  throw InvalidInput(
      "PitchOptions.start = t_m: PitchForcing.t_m_s, the time of maximum crush, is not set: give it, or start = impact "
      "or a time");
}

PitchState initial_state(const HeavePitchModel& model, const PitchOptions& options) {
  if (std::isnan(options.residual_energy_j))
    return {options.heave_m, options.pitch_rad, options.heave_velocity_mps, options.pitch_rate_radps};
  if (options.heave_velocity_mps != 0.0 || options.pitch_rate_radps != 0.0)
    throw InvalidInput(
        fmt::format("PitchOptions.residual_energy_j = {:g} J comes with heave_velocity_mps = {:g} m/s and "
                    "pitch_rate_radps = {:g} rad/s: the energy gives the initial rates: leave out one or the other",
                    options.residual_energy_j, options.heave_velocity_mps, options.pitch_rate_radps));
  const bool as_printed = model.formulation == PitchFormulation::as_printed;
  if (!as_printed) require_set(model, &HeavePitchModel::force_arm_m, "HeavePitchModel", "there is a residual energy");
  const double arm = as_printed ? 1.0 : model.force_arm_m;
  const double compliance = 1.0 / model.mass_kg + arm * arm / model.pitch_inertia_kgm2;
  const double impulse = std::sqrt(2.0 * options.residual_energy_j / compliance);
  return {options.heave_m, options.pitch_rad, -impulse / model.mass_kg, impulse * arm / model.pitch_inertia_kgm2};
}

std::vector<std::string> notes_on_pitch_input(const HeavePitchModel& model, const PitchForcing& forcing,
                                              const PitchOptions& options, double start_s, double end_s) {
  std::vector<std::string> notes;
  if (!std::isnan(options.residual_energy_j)) {
    const PitchState state = initial_state(model, options);
    notes.push_back(
        fmt::format("residual energy of {:g} J: the motion starts with a heave velocity of {:.4g} m/s and a pitch "
                    "rate of {:.4g} rad/s, as an impulse of {:.4g} N s at the force's arm gives a free body",
                    options.residual_energy_j, state[2], state[3], -model.mass_kg * state[2]));
  }
  note_cut_force(forcing.vertical_force_n, "vertical_force_n", start_s, end_s, notes);
  note_cut_force(forcing.longitudinal_force_n, "longitudinal_force_n", start_s, end_s, notes);
  if (model.formulation == PitchFormulation::derived) return notes;
  notes.emplace_back("as_printed: the vertical force acts at a lever arm of 1 m, whatever force_arm_m says");
  if (!forcing.longitudinal_force_n.empty())
    notes.emplace_back("as_printed: the longitudinal force is not in the printed equations and is left out");
  if (!is_dissipative(model))
    notes.emplace_back("as_printed: the damping matrix is not positive semidefinite: some motions gain energy");
  return notes;
}

}  // namespace crashsim
