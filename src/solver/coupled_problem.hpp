#pragma once
/// The coupled motion of crush, heave and pitch as equations: forces and rates at a state, by the mode it is in. Inside
/// one mode everything is smooth, and a mode's forces are defined beyond the bounds that end it.

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <crashsim/coupled_model.hpp>
#include <crashsim/time_series.hpp>

#include "solver/crush_events.hpp"

namespace crashsim {

/// Unknowns in order: positions, their rates, and the energies that only integration gives.
namespace coupled {
inline constexpr std::size_t kTravel = 0, kHeave = 1, kPitch = 2, kSpeed = 3, kHeaveRate = 4, kPitchRate = 5,
                             kCrushLoss = 6, kSuspensionLoss = 7, kVerticalWork = 8, kUnknowns = 9;
}  // namespace coupled
using CoupledState = std::array<double, coupled::kUnknowns>;

/// constant + weights . (positions, rates).
struct LinearFunction {
  std::array<double, 6> weights{};
  double constant = 0.0;
};
double value(const LinearFunction& f, const CoupledState& y);

/// An axle, at which the body rises by d = z + place theta.
struct Axle {
  double place_m = 0.0;  ///< Behind the centre of gravity.
  double stiffness = 0.0, damping = 0.0, static_load_n = 0.0;
  double bump_gap_m = std::numeric_limits<double>::infinity(), bump_stiffness = 0.0;
};

/// F_v / F_x along the crush: the angle is constant, changes from `start_m` to `end_m`, and is constant again.
struct ForceAngle {
  double first_rad = 0.0, rate_rad_per_m = 0.0, last_rad = 0.0;
  double start_m = std::numeric_limits<double>::infinity(), end_m = std::numeric_limits<double>::infinity();
  bool end_is_error = false;  ///< Too steep, and no friction bounds the force.
};

/// The given vertical force from `start_s` on, to the next line.
struct ForceLine {
  double start_s = -std::numeric_limits<double>::infinity(), value_n = 0.0, slope_n_per_s = 0.0;
};

struct CoupledProblem {
  CrushForce force;
  double mass_kg, inertia_kgm2, speed_mps;
  Unloading unloading;
  bool lift_off;
  double height_m;   ///< h_F - h_cg.
  double arm_m;      ///< l_Q.
  bool follows_law;  ///< The vertical force is by `angle`, otherwise by `lines`.
  ForceAngle angle;
  std::vector<ForceLine> lines;  ///< At least one.
  std::array<Axle, 2> axles;     ///< Front, rear.

  /// The crush part, on crush s and its rate in place of travel and speed.
  [[nodiscard]] CrushProblem crush() const { return {force, mass_kg, speed_mps, unloading}; }
};
/// @param model valid, its mass in both parts.
CoupledProblem coupled_problem(const CoupledModel& model, double speed_mps, const TimeSeries& vertical_force_n);

/// What is on or off, each by the sign of a linear function of the state.
enum class AxleSwitch : std::size_t {
  bump_stop,  ///< The bump stop is reached.
  droop,      ///< The spring alone would carry nothing: d beyond static load / stiffness.
  lift_off    ///< Spring and damper together would pull.
};
inline constexpr std::size_t kAngleChanges = 0, kAngleEnds = 1, kSwitches = 8;
constexpr std::size_t index_of(std::size_t axle, AxleSwitch which) {
  return 2 + 3 * axle + static_cast<std::size_t>(which);
}

struct CoupledMode {
  Region crush;
  std::array<bool, kSwitches> on{};
  std::size_t line = 0;  ///< Of the given vertical force.

  [[nodiscard]] bool is_on(std::size_t axle, AxleSwitch which) const { return on[index_of(axle, which)]; }
};
/// Mode at impact.
CoupledMode initial_mode(const CoupledProblem& problem);

/// Crush s where the force acts, its rate, and load of an axle in a mode, as functions of the state.
LinearFunction crush_function(const CoupledProblem& problem);
LinearFunction crush_rate_function(const CoupledProblem& problem);
LinearFunction load_function(const CoupledProblem& problem, const CoupledMode& mode, std::size_t axle);
/// Positive where the switch is on.
LinearFunction switch_function(const CoupledProblem& problem, const CoupledMode& mode, std::size_t which);

struct CoupledForces {
  double spring_n = 0.0, damper_n = 0.0;  ///< F_k, F_c.
  double vertical_n = 0.0;                ///< F_v.
  std::array<double, 2> load_n{};         ///< Of front and rear axle.

  [[nodiscard]] double longitudinal_n() const { return spring_n + damper_n; }
};
CoupledForces forces(const CoupledProblem& problem, const CoupledMode& mode, double t, const CoupledState& y);

/// dy/dt.
CoupledState rates(const CoupledProblem& problem, const CoupledMode& mode, double t, const CoupledState& y);

/// Energy of an axle at d = z + place theta, gravity included: 0 at static load [J].
double axle_energy(const CoupledProblem& problem, std::size_t axle, const CoupledState& y);

}  // namespace crashsim
