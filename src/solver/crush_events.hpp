#pragma once
/// Where the motion is on the force's segments or on the return line, and what ends a step early.

#include "solver/crush_force.hpp"
#include "solver/step_polynomial.hpp"

namespace crashsim {

inline constexpr double kCrashTime = 0.05;  ///< Typical duration [s]: makes a length of the impact speed.

/// The problem: m v' = -F(x, v), x' = v, x(0) = 0, v(0) = speed.
struct CrushProblem {
  const CrushForce& force;
  double mass_kg;
  double speed_mps;
  Unloading unloading;
};

/// What rounding makes of v; of x it is kCrashTime times as much.
inline double state_rounding(double speed_mps) { return 1e-13 * speed_mps; }

/// Segments the motion is in. Inside one region the force is one polynomial of x and v.
struct Region {
  int spring = 0, damper = 0;
  bool separated = false;   ///< Contact is lost: no force any more.
  bool unloading = false;   ///< On the plastic return line, which is all the force there is.
  Quadratic return_line{};  ///< Its force over x.
};

/// Force of a region, none when separated.
RegionForce region_force(const CrushProblem& problem, const Region& region);

enum class EventKind { none, spring_knot, damper_knot, turn, separation };

/// What ends a step at `tau`.
struct Event {
  EventKind kind = EventKind::none;
  double tau = 0.0;
  int direction = 0;   ///< Of the crossing: +1 or -1.
  double level = 0.0;  ///< Exact value of the variable that reached a knot.
};

/// Region at impact.
Region initial_region(const CrushProblem& problem);

/// First event of a step taken with the force of `region`; `none` at the step's end otherwise.
Event first_event(const CrushProblem& problem, const Region& region, const StepPolynomial& step);

/// Maximum crush: v falls through zero.
inline bool is_max_crush(const Event& event) {
  return event.kind == EventKind::damper_knot && event.level == 0.0 && event.direction < 0;
}

/// Region after an event at state (x, v). A force that jumps to a pull loses contact; so does a return line that has
/// nothing to give back.
Region next_region(const CrushProblem& problem, const Region& region, const Event& event, double x, double v);

/// Energy that the structure can give back from crush x.
double stored_energy(const CrushProblem& problem, const Region& region, double x);

/// The same inside one region as a polynomial of x; `x` is where it is told from.
std::array<double, 4> stored_energy_polynomial(const CrushProblem& problem, const Region& region, double x);

}  // namespace crashsim
