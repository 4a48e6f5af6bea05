#pragma once
/// Simulation of heave and pitch under the barrier's force.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <crashsim/error.hpp>
#include <crashsim/heave_pitch_model.hpp>
#include <crashsim/named_number.hpp>
#include <crashsim/options.hpp>
#include <crashsim/solver_statistics.hpp>
#include <crashsim/time_series.hpp>

namespace crashsim {

/// What drives heave and pitch, each series on the same clock, the trace's own: time 0 is impact. Forces are zero
/// before their first and after their last sample; the height is held there.
struct PitchForcing {
  TimeSeries vertical_force_n;      ///< F_v on the vehicle [N], downward positive; empty: none.
  TimeSeries longitudinal_force_n;  ///< F_x on the vehicle [N], positive while it stops the vehicle; empty: none.
  TimeSeries force_height_m;        ///< h_F over time [m]; empty: the model's force_height_m.
  double t_m_s = kUnset;            ///< Time of maximum crush on that clock [s]; needed to start there.
};

/// When the motion starts: at maximum crush as in the paper, at impact (time 0), or at a time [s].
enum class PitchStart { t_m, impact, given };
inline constexpr std::string_view kPitchStartNames[] = {"t_m", "impact", "given"};
template <>
inline constexpr std::span<const std::string_view> enum_names<PitchStart>{kPitchStartNames};

/// Which engine: the exact propagator of the linear system, or CVODE.
enum class PitchIntegrator { propagator, cvode };
inline constexpr std::string_view kPitchIntegratorNames[] = {"propagator", "cvode"};
template <>
inline constexpr std::span<const std::string_view> enum_names<PitchIntegrator>{kPitchIntegratorNames};

/// How to simulate heave and pitch. The initial state is the one at the start; until then the body is held in it.
struct PitchOptions {
  Setting<PitchStart> start;
  double end_time_s = kUnset;       ///< On the forcing's clock [s]; unset: 0.3 s.
  double dt_s = 1e-4;               ///< Output interval [s]; samples at 0, dt, ... and at the end.
  double heave_m = 0.0;             ///< Initial heave [m].
  double heave_velocity_mps = 0.0;  ///< Initial heave velocity [m/s].
  double pitch_rad = 0.0;           ///< Initial pitch [rad].
  double pitch_rate_radps = 0.0;    ///< Initial pitch rate [rad/s].
  /// Energy left at the start [J], >= 0; unset: none. The rates are then those that an impulse P of the vertical force,
  /// downward, gives a free body: z' = -P/m, theta' = P l_Q/J with E = P^2/2 (1/m + l_Q^2/J).
  double residual_energy_j = kUnset;
  PitchIntegrator integrator = PitchIntegrator::propagator;
  double rtol = 1e-10;  ///< Relative tolerance of CVODE.

  bool operator==(const PitchOptions&) const = default;
};
inline constexpr std::array<Field<PitchOptions>, 10> kPitchFields = {{
    {"start", "start", "s", "start of the motion: maximum crush, impact, or a time", setting<&PitchOptions::start>()},
    {"end_time_s", "end", "s", "time to simulate to; default 0.3 s", &PitchOptions::end_time_s,
     positive_up_to(kLongestMotion_s)},
    {"dt_s", "dt", "s", "output interval", &PitchOptions::dt_s, positive()},
    {"heave_m", "heave", "m", "initial heave", &PitchOptions::heave_m},
    {"heave_velocity_mps", "heave-velocity", "m/s", "initial heave velocity", &PitchOptions::heave_velocity_mps},
    {"pitch_rad", "pitch", "rad", "initial pitch", &PitchOptions::pitch_rad},
    {"pitch_rate_radps", "pitch-rate", "rad/s", "initial pitch rate", &PitchOptions::pitch_rate_radps},
    {"residual_energy_j", "residual-energy", "J", "energy left at the start, as heave and pitch; default none",
     &PitchOptions::residual_energy_j, at_least(0.0)},
    {"integrator", "integrator", "", "engine", choice<&PitchOptions::integrator>()},
    {"rtol", "rtol", "", "relative tolerance of CVODE", &PitchOptions::rtol, between(1e-13, 1e-2)},
}};
template <>
inline constexpr std::span<const Field<PitchOptions>> fields<PitchOptions>{kPitchFields};

/// How a simulation ended.
enum class PitchOutcome {
  not_run,     ///< Nothing computed yet.
  completed,   ///< End time reached.
  step_limit,  ///< The integrator needed too many steps.
  failed       ///< The integrator failed; see message.
};
inline constexpr std::string_view kPitchOutcomeNames[] = {"not_run", "completed", "step_limit", "failed"};
template <>
inline constexpr std::span<const std::string_view> enum_names<PitchOutcome>{kPitchOutcomeNames};

/// Heave and pitch over time. Numbers are unset and arrays empty until computed.
struct PitchResponse {
  PitchOutcome outcome = PitchOutcome::not_run;
  std::string message;                     ///< Why it is not usable, or empty.
  std::vector<std::string> notes;          ///< What a careful reader should know.
  std::vector<double> time_s;              ///< Output times on the forcing's clock [s], from 0 or an earlier start.
  std::vector<double> heave_m;             ///< z, up positive [m].
  std::vector<double> heave_velocity_mps;  ///< z' [m/s].
  std::vector<double> pitch_rad;           ///< theta, nose-down positive [rad].
  std::vector<double> pitch_rate_radps;    ///< theta' [rad/s].
  std::vector<double> heave_accel_mps2;    ///< z'' [m/s^2].
  std::vector<double> pitch_accel_radps2;  ///< theta'' [rad/s^2].
  std::vector<double> front_deflection_m;  ///< Rise of the body over the front axle, z - lf theta [m].
  std::vector<double> rear_deflection_m;   ///< Rise of the body over the rear axle, z + lr theta [m].
  std::vector<double>
      front_axle_force_n;  ///< Force of the front axle on the body, up positive, less its static load [N].
  std::vector<double> rear_axle_force_n;      ///< The same of the rear axle [N].
  std::vector<double> heave_force_n;          ///< Q_z applied [N].
  std::vector<double> pitch_moment_nm;        ///< Q_theta applied [N m].
  double start_time_s = kUnset;               ///< Start of the motion [s].
  double pitch_max_rad = kUnset;              ///< Largest pitch after the start, between samples [rad].
  double pitch_max_time_s = kUnset;           ///< Its time [s].
  double heave_min_m = kUnset;                ///< Smallest heave [m].
  double heave_min_time_s = kUnset;           ///< Its time [s].
  double heave_velocity_min_mps = kUnset;     ///< Smallest heave velocity [m/s].
  double heave_velocity_min_time_s = kUnset;  ///< Its time [s].
  std::vector<Mode> modes;                    ///< Free motions of the model.
  SolverStatistics statistics;

  /// True when the arrays hold a motion to rely on.
  [[nodiscard]] bool usable() const { return outcome == PitchOutcome::completed; }
  /// One line: outcome, largest pitch and drop.
  [[nodiscard]] std::string brief_report() const;
};

/// Columns of pitch.csv, in order.
struct PitchColumn {
  std::string_view name;
  std::vector<double> PitchResponse::*member;
};
inline constexpr std::array<PitchColumn, 13> kPitchColumns = {{
    {"time_s", &PitchResponse::time_s},
    {"heave_m", &PitchResponse::heave_m},
    {"heave_velocity_mps", &PitchResponse::heave_velocity_mps},
    {"pitch_rad", &PitchResponse::pitch_rad},
    {"pitch_rate_radps", &PitchResponse::pitch_rate_radps},
    {"heave_accel_mps2", &PitchResponse::heave_accel_mps2},
    {"pitch_accel_radps2", &PitchResponse::pitch_accel_radps2},
    {"front_deflection_m", &PitchResponse::front_deflection_m},
    {"rear_deflection_m", &PitchResponse::rear_deflection_m},
    {"front_axle_force_n", &PitchResponse::front_axle_force_n},
    {"rear_axle_force_n", &PitchResponse::rear_axle_force_n},
    {"heave_force_n", &PitchResponse::heave_force_n},
    {"pitch_moment_nm", &PitchResponse::pitch_moment_nm},
}};

/// The summary of a response, in the order in which it is printed.
inline constexpr std::array<NamedNumber<PitchResponse>, 4> kPitchNumbers = {{
    {"pitch_max_rad", &PitchResponse::pitch_max_rad, "largest pitch, nose down"},
    {"pitch_max_time_s", &PitchResponse::pitch_max_time_s, "time of the largest pitch"},
    {"heave_min_m", &PitchResponse::heave_min_m, "lowest heave"},
    {"heave_velocity_min_mps", &PitchResponse::heave_velocity_min_mps, "fastest drop"},
}};

/// Simulates heave and pitch.
/// @throws InvalidInput on a bad model, series or option, or when the model lacks what the forcing needs.
PitchResponse simulate_pitch(const HeavePitchModel& model, const PitchForcing& forcing,
                             const PitchOptions& options = {});

}  // namespace crashsim
