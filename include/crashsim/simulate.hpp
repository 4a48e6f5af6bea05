#pragma once
/// Simulation of the crush model.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <crashsim/crush_model.hpp>
#include <crashsim/error.hpp>
#include <crashsim/options.hpp>
#include <crashsim/solver_statistics.hpp>

namespace crashsim {

/// Which engine integrates: CVODE, the integrator of record, or the Taylor kernel.
enum class Integrator { cvode, taylor };
inline constexpr std::string_view kIntegratorNames[] = {"cvode", "taylor"};
template <>
inline constexpr std::span<const std::string_view> enum_names<Integrator>{kIntegratorNames};

/// How to simulate.
struct SimulateOptions {
  double impact_speed_mps = kUnset;  ///< Unset: the model's own.
  double end_time_s = kUnset;        ///< Unset: 0.2 s, or maximum crush with to_max_crush.
  bool to_max_crush = false;         ///< End at the time of maximum crush.
  double dt_s = 1e-4;                ///< Output interval; samples at 0, dt, ... and at the end.
  std::vector<double> times_s;       ///< Output times instead, increasing from >= 0; the last one is the end.
  double rtol = 1e-8;                ///< Relative accuracy of the result.
  Integrator integrator = Integrator::cvode;

  bool operator==(const SimulateOptions&) const = default;
};
inline constexpr std::array<Field<SimulateOptions>, 7> kSimulateFields = {{
    {"impact_speed_mps", "speed", "m/s", "impact speed; default: the model's", &SimulateOptions::impact_speed_mps,
     positive()},
    {"end_time_s", "end", "s", "time to simulate to; default 0.2 s", &SimulateOptions::end_time_s,
     positive_up_to(kLongestMotion_s)},
    {"to_max_crush", "to-max-crush", "", "end at the time of maximum crush", &SimulateOptions::to_max_crush},
    {"dt_s", "dt", "s", "output interval", &SimulateOptions::dt_s, positive()},
    {"times_s", "times", "s", "output times instead of an interval", &SimulateOptions::times_s},
    {"rtol", "rtol", "", "relative accuracy", &SimulateOptions::rtol, between(1e-12, 1e-2)},
    {"integrator", "integrator", "", "engine", choice<&SimulateOptions::integrator>()},
}};
template <>
inline constexpr std::span<const Field<SimulateOptions>> fields<SimulateOptions>{kSimulateFields};

/// How a simulation ended.
enum class CrushOutcome {
  not_run,             ///< Nothing computed yet.
  completed,           ///< Maximum crush found, end time reached.
  no_max_crush,        ///< v did not reach zero within the window: there is no t_m.
  left_knot_range,     ///< Extrapolation `error`: the motion left a curve's knots.
  unloading_too_soft,  ///< The plastic return line would give back more than was absorbed: the motion ends at t_m.
  step_limit,          ///< The integrator needed too many steps.
  failed               ///< The integrator failed; see message.
};
inline constexpr std::string_view kCrushOutcomeNames[] = {
    "not_run", "completed", "no_max_crush", "left_knot_range", "unloading_too_soft", "step_limit", "failed"};
template <>
inline constexpr std::span<const std::string_view> enum_names<CrushOutcome>{kCrushOutcomeNames};

/// What a simulation gives. Numbers are unset and arrays empty until computed.
struct CrushResponse {
  CrushOutcome outcome = CrushOutcome::not_run;
  std::string message;                    ///< Why it is not usable, or empty.
  std::vector<double> time_s;             ///< Output times [s], uniform but for the last interval.
  std::vector<double> accel_mps2;         ///< dv/dt [m/s^2].
  std::vector<double> velocity_mps;       ///< [m/s]
  std::vector<double> displacement_m;     ///< Crush [m].
  std::vector<double> spring_force_n;     ///< F_k [N]; after t_m of plastic unloading the return line's.
  std::vector<double> damper_force_n;     ///< F_c [N]; 0 there.
  std::vector<double> energy_residual_j;  ///< Kinetic + absorbed - initial energy [J]; 0 up to the integration error.
  double impact_speed_mps = kUnset;       ///< Speed simulated [m/s].
  double t_m_s = kUnset;                  ///< Time of maximum crush [s].
  double max_crush_m = kUnset;            ///< Crush at t_m [m].
  double separation_s = kUnset;           ///< Time contact was lost [s]; unset: never.
  double static_crush_m = kUnset;         ///< Crush at separation after maximum crush [m].
  double rebound_velocity_mps = kUnset;   ///< Velocity at separation after maximum crush, <= 0 [m/s].
  double kinetic_energy_j = kUnset;       ///< At the end [J].
  double spring_energy_j = kUnset;        ///< Stored in the spring at the end [J].
  double dissipated_energy_j = kUnset;    ///< Dissipated until the end, with what plastic crush keeps [J].
  SolverStatistics statistics;

  /// True when the arrays hold a motion to rely on.
  [[nodiscard]] bool usable() const { return outcome == CrushOutcome::completed; }
  /// One line: outcome, t_m, C.
  [[nodiscard]] std::string brief_report() const;
};

/// Simulates a model from impact.
/// @throws InvalidInput on a bad model or option, or without an impact speed.
CrushResponse simulate(const CrushModel& model, const SimulateOptions& options = {});

}  // namespace crashsim
