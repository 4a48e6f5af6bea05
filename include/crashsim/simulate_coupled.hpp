#pragma once
/// Simulation of crush, heave and pitch together.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <crashsim/coupled_model.hpp>
#include <crashsim/named_number.hpp>
#include <crashsim/options.hpp>
#include <crashsim/solver_statistics.hpp>
#include <crashsim/time_series.hpp>

namespace crashsim {

/// How to simulate. The body starts in static equilibrium.
struct CoupledOptions {
  double impact_speed_mps = kUnset;  ///< Unset: the crush model's own.
  double end_time_s = kUnset;        ///< Unset: 0.3 s.
  double dt_s = 1e-4;                ///< Output interval; samples at 0, dt, ... and at the end.
  double rtol = 1e-8;                ///< Relative accuracy of the result.

  bool operator==(const CoupledOptions&) const = default;
};
inline constexpr std::array<Field<CoupledOptions>, 4> kCoupledFields = {{
    {"impact_speed_mps", "speed", "m/s", "impact speed; default: the crush model's", &CoupledOptions::impact_speed_mps,
     positive()},
    {"end_time_s", "end", "s", "time to simulate to; default 0.3 s", &CoupledOptions::end_time_s,
     positive_up_to(kLongestMotion_s)},
    {"dt_s", "dt", "s", "output interval", &CoupledOptions::dt_s, positive()},
    {"rtol", "rtol", "", "relative accuracy", &CoupledOptions::rtol, between(1e-10, 1e-2)},
}};
template <>
inline constexpr std::span<const Field<CoupledOptions>> fields<CoupledOptions>{kCoupledFields};

/// How a simulation ended.
enum class CoupledOutcome {
  not_run,             ///< Nothing computed yet.
  completed,           ///< Maximum crush found, end time reached.
  no_max_crush,        ///< The crush rate did not reach zero within the window: there is no t_m.
  left_knot_range,     ///< Extrapolation `error`: the motion left a curve's knots.
  unloading_too_soft,  ///< The return line would give back more than there is; see message.
  step_limit,          ///< The integrator needed too many steps.
  failed               ///< The numbers failed; see message.
};
inline constexpr std::string_view kCoupledOutcomeNames[] = {
    "not_run", "completed", "no_max_crush", "left_knot_range", "unloading_too_soft", "step_limit", "failed"};
template <>
inline constexpr std::span<const std::string_view> enum_names<CoupledOutcome>{kCoupledOutcomeNames};

/// Crush, heave and pitch over time. Numbers are unset and arrays empty until computed.
struct CoupledResponse {
  CoupledOutcome outcome = CoupledOutcome::not_run;
  std::string message;                       ///< Why it is not usable, or empty.
  std::vector<std::string> notes;            ///< What a careful reader should know.
  std::vector<double> time_s;                ///< Output times [s], uniform but for the last interval.
  std::vector<double> displacement_m;        ///< Travel x of the centre of gravity [m].
  std::vector<double> velocity_mps;          ///< x' [m/s].
  std::vector<double> accel_mps2;            ///< x'' [m/s^2].
  std::vector<double> crush_m;               ///< s, where the force acts [m].
  std::vector<double> heave_m;               ///< z, up positive [m].
  std::vector<double> heave_velocity_mps;    ///< z' [m/s].
  std::vector<double> heave_accel_mps2;      ///< z'' [m/s^2].
  std::vector<double> pitch_rad;             ///< theta, nose-down positive [rad].
  std::vector<double> pitch_rate_radps;      ///< theta' [rad/s].
  std::vector<double> pitch_accel_radps2;    ///< theta'' [rad/s^2].
  std::vector<double> longitudinal_force_n;  ///< F_x, positive while it stops the vehicle [N].
  std::vector<double> vertical_force_n;      ///< F_v on the vehicle, downward positive [N].
  std::vector<double> front_axle_load_n;  ///< Force of the ground on the front axle, up positive, static included [N].
  std::vector<double> rear_axle_load_n;   ///< The same of the rear axle [N].
  std::vector<double>
      energy_residual_j;  ///< All energies + work done - initial energy [J]; 0 up to the integration error.

  double impact_speed_mps = kUnset;         ///< Speed simulated [m/s].
  double t_m_s = kUnset;                    ///< Time of maximum crush, the first zero of s' [s].
  double max_crush_m = kUnset;              ///< Crush s at t_m [m].
  double separation_s = kUnset;             ///< Time contact with the barrier was lost [s]; unset: never.
  double static_crush_m = kUnset;           ///< Crush at separation after maximum crush [m].
  double rebound_velocity_mps = kUnset;     ///< x' at separation after maximum crush [m/s].
  double displacement_max_m = kUnset;       ///< Largest travel, between samples [m]; its time and the following alike.
  double displacement_max_time_s = kUnset;  ///< [s]
  double peak_decel_g = kUnset;             ///< Largest deceleration -x'' [g].
  double pitch_max_rad = kUnset;            ///< Largest pitch [rad].
  double pitch_max_time_s = kUnset;         ///< [s]
  double heave_min_m = kUnset;              ///< Smallest heave [m].
  double heave_min_time_s = kUnset;         ///< [s]
  double heave_velocity_min_mps = kUnset;   ///< Smallest heave velocity [m/s].
  double front_axle_load_max_n = kUnset;    ///< Largest load of the front axle [N].
  double front_axle_load_min_n = kUnset;    ///< Smallest load of the front axle [N].
  double rear_axle_load_min_n = kUnset;     ///< Smallest load of the rear axle [N].
  double front_lift_off_s = kUnset;         ///< First time the front wheels leave the ground [s]; unset: never.
  double rear_lift_off_s = kUnset;          ///< The same of the rear wheels [s].
  double kinetic_energy_j = kUnset;         ///< Of travel, heave and pitch at the end [J].
  double crush_energy_j = kUnset;           ///< Absorbed by the structure until the end, less what it gave back [J].
  double suspension_energy_j = kUnset;      ///< Of springs, bump stops and gravity at the end, 0 at rest [J].
  double suspension_dissipated_j = kUnset;  ///< By the suspension until the end [J].
  double vertical_work_j = kUnset;          ///< Done by the vehicle against the vertical force until the end [J].
  SolverStatistics statistics;

  /// True when the arrays hold a motion to rely on.
  [[nodiscard]] bool usable() const { return outcome == CoupledOutcome::completed; }
  /// One line: outcome, maximum crush, largest pitch and drop.
  [[nodiscard]] std::string brief_report() const;
};

/// Simulates a model from impact.
/// @param vertical_force_n F_v [N] over time from impact, downward positive, linear between samples and zero outside
///        them, whatever the contact; instead of the model's law. Empty: none.
/// @throws InvalidInput on a bad model, series or option, without an impact speed, or with a law and a series.
CoupledResponse simulate_coupled(const CoupledModel& model, const CoupledOptions& options = {},
                                 const TimeSeries& vertical_force_n = {});

}  // namespace crashsim
