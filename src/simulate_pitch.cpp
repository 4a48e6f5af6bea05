#include <crashsim/simulate_pitch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <crashsim/option_values.hpp>
#include <crashsim/signal.hpp>

#include "output_times.hpp"
#include "pitch_input.hpp"
#include "solver/pitch_peaks.hpp"

namespace crashsim {
namespace {

constexpr double kDefaultEnd = 0.3;        // [s]
constexpr double kLongestStepAngle = 0.1;  // of the fastest motion, so that peaks between samples are found [rad]
constexpr double kFewestSteps = 100.0, kMostDivisions = 20000.0;

/// What the motion is at one output time.
struct Sample {
  PitchState y = PitchState::Zero();
  Eigen::Vector2d accel = Eigen::Vector2d::Zero(), force = Eigen::Vector2d::Zero();
};

void set_sample(PitchResponse& r, std::size_t i, const HeavePitchModel& axle, const Sample& sample) {
  const double z = sample.y[0], theta = sample.y[1], dz = sample.y[2], dtheta = sample.y[3];
  const double lf = axle.front_axle_m, lr = axle.rear_axle_m;
  r.heave_m[i] = z;
  r.pitch_rad[i] = theta;
  r.heave_velocity_mps[i] = dz;
  r.pitch_rate_radps[i] = dtheta;
  r.heave_accel_mps2[i] = sample.accel[0];
  r.pitch_accel_radps2[i] = sample.accel[1];
  r.front_deflection_m[i] = z - lf * theta;
  r.rear_deflection_m[i] = z + lr * theta;
  r.front_axle_force_n[i] =
      -axle.front_stiffness_n_per_m * (z - lf * theta) - axle.front_damping_ns_per_m * (dz - lf * dtheta);
  r.rear_axle_force_n[i] =
      -axle.rear_stiffness_n_per_m * (z + lr * theta) - axle.rear_damping_ns_per_m * (dz + lr * dtheta);
  r.heave_force_n[i] = axle.mass_kg * sample.force[0];
  r.pitch_moment_nm[i] = axle.pitch_inertia_kgm2 * sample.force[1];
}

void set_peaks(PitchResponse& r, const PitchPeaks& peaks) {
  r.pitch_max_rad = peaks.pitch_max.value;
  r.pitch_max_time_s = peaks.pitch_max.time_s;
  r.heave_min_m = peaks.heave_min.value;
  r.heave_min_time_s = peaks.heave_min.time_s;
  r.heave_velocity_min_mps = peaks.heave_velocity_min.value;
  r.heave_velocity_min_time_s = peaks.heave_velocity_min.time_s;
}

/// Steps short enough for the fastest free motion, but not more of them than anybody needs.
double longest_step(const std::vector<Mode>& free_motions, double duration_s) {
  const double fastest = 2.0 * std::numbers::pi * free_motions.back().frequency_hz;
  return std::clamp(kLongestStepAngle / fastest, duration_s / kMostDivisions, duration_s / kFewestSteps);
}

/// Fills the channels: the initial position before the start, the grid's samples after it.
void set_channels(PitchResponse& r, const HeavePitchModel& model, const PitchOptions& options, const PitchGrid& grid,
                  std::span<const PitchState> states, std::span<const Eigen::Vector2d> accelerations) {
  const HeavePitchModel axle = with_axle_values(model);
  const std::size_t count = r.time_s.size();
  for (const PitchColumn& column : kPitchColumns) (r.*column.member).resize(count);
  const std::size_t held = count - grid.samples.size();
  for (std::size_t i = 0; i < held; ++i) set_sample(r, i, axle, {.y = {options.heave_m, options.pitch_rad, 0.0, 0.0}});
  for (std::size_t i = held; i < count; ++i) {
    const std::size_t at = grid.samples[i - held];
    set_sample(r, i, axle, {states[at], accelerations[at], grid.forces[at].col(0)});
  }
}

/// Integrates on the grid, then fills the channels and the peaks.
void run(PitchResponse& r, const HeavePitchModel& model, const PitchOptions& options, const PitchGrid& grid) {
  const LinearSystem system = linear_system(model);
  std::vector<PitchState> states{initial_state(model, options)};
  PitchWork work = options.integrator == PitchIntegrator::cvode ? integrate_by_cvode(system, grid, options.rtol, states)
                                                                : integrate_by_propagator(system, grid, states);
  r.outcome = work.outcome;
  r.message = std::move(work.message);
  r.statistics = work.statistics;
  if (!r.usable()) {
    r.time_s.clear();
    return;
  }
  std::vector<Eigen::Vector2d> accelerations(states.size());
  for (std::size_t i = 0; i < states.size(); ++i)
    accelerations[i] = system.acceleration(states[i], grid.forces[i].col(0));
  set_channels(r, model, options, grid, states, accelerations);
  set_peaks(r, find_peaks(system, grid, states, accelerations));
}

}  // namespace

PitchResponse simulate_pitch(const HeavePitchModel& model, const PitchForcing& forcing, const PitchOptions& options) {
  validate(model);
  validate_options(options, "PitchOptions");
  check_pitch_input(model, forcing);
  const double start_s = start_of_motion(forcing, options);
  const double end_s = std::isnan(options.end_time_s) ? kDefaultEnd : options.end_time_s;
  if (end_s <= start_s)
    throw InvalidInput(
        fmt::format("PitchOptions.end_time_s = {} s: must be after the start of the motion, {} s", end_s, start_s));

  PitchResponse response;
  response.start_time_s = start_s;
  response.modes = modes(model);
  response.notes = notes_on_pitch_input(model, forcing, options, start_s, end_s);
  response.time_s = output_times(std::min(0.0, start_s), end_s, options.dt_s, "PitchOptions.dt_s");
  const auto first = std::ranges::lower_bound(response.time_s, start_s - time_rounding(start_s, end_s));
  const std::span samples(first, response.time_s.end());
  run(response, model, options,
      make_grid(model, forcing, start_s, samples, longest_step(response.modes, end_s - start_s)));
  return response;
}

std::string PitchResponse::brief_report() const {
  if (!usable()) return fmt::format("{}: {}", name_of(outcome), message);
  return fmt::format(
      "{}: largest pitch {:.4g} rad ({:.3g} deg) at {:.4f} s, lowest heave {:.4g} m at {:.4f} s, heave velocity down "
      "to "
      "{:.4g} m/s at {:.4f} s",
      name_of(outcome), pitch_max_rad, pitch_max_rad * 180.0 / std::numbers::pi, pitch_max_time_s, heave_min_m,
      heave_min_time_s, heave_velocity_min_mps, heave_velocity_min_time_s);
}

}  // namespace crashsim
