#pragma once
/// Crush, heave and pitch as one model of three degrees of freedom.

#include <array>

#include <crashsim/crush_model.hpp>
#include <crashsim/error.hpp>
#include <crashsim/heave_pitch_model.hpp>
#include <crashsim/options.hpp>
#include <crashsim/vertical_force.hpp>

namespace crashsim {

/// What the suspension does beyond its linear range. With all defaults it is linear.
///
/// Lift-off: the ground cannot pull. An axle's load is max(0, static load - k d - c d'), where d is the rise of the
/// body over the axle and the static loads are m g lr/(lf + lr) in front and m g lf/(lf + lr) at the rear.
/// Bump stop: d < -gap, the axle compressed by more than the gap, adds the stop's stiffness times (-d - gap).
struct GroundContact {
  bool lift_off = false;                         ///< The wheels leave the ground instead of being pulled down by it.
  double front_bump_gap_m = kUnset;              ///< Compression from static load to the front bump stop [m], >= 0.
  double front_bump_stiffness_n_per_m = kUnset;  ///< Added stiffness of the front axle beyond it [N/m], >= 0.
  double rear_bump_gap_m = kUnset;               ///< The same of the rear axle [m]; unset, with its stiffness: no stop.
  double rear_bump_stiffness_n_per_m = kUnset;   ///< The same of the rear axle [N/m].

  bool operator==(const GroundContact&) const = default;
};
inline constexpr std::array<Field<GroundContact>, 5> kGroundContactFields = {{
    {"lift_off", "lift-off", "", "wheels leave the ground instead of being pulled down by it",
     &GroundContact::lift_off},
    {"front_bump_gap_m", "front-bump-gap", "m", "compression of the front axle from static load to its bump stop",
     &GroundContact::front_bump_gap_m, at_least(0.0)},
    {"front_bump_stiffness_n_per_m", "front-bump-stiffness", "N/m", "stiffness that the front axle's bump stop adds",
     &GroundContact::front_bump_stiffness_n_per_m, at_least(0.0)},
    {"rear_bump_gap_m", "rear-bump-gap", "m", "compression of the rear axle from static load to its bump stop",
     &GroundContact::rear_bump_gap_m, at_least(0.0)},
    {"rear_bump_stiffness_n_per_m", "rear-bump-stiffness", "N/m", "stiffness that the rear axle's bump stop adds",
     &GroundContact::rear_bump_stiffness_n_per_m, at_least(0.0)},
}};
template <>
inline constexpr std::span<const Field<GroundContact>> fields<GroundContact>{kGroundContactFields};

/// Travel x of the centre of gravity towards the barrier, heave z (up positive, from static equilibrium) and pitch
/// theta (nose-down positive, small), together from impact:
///     s = x + (h_F - h_cg) theta                      crush where the force acts
///     F_x = F_k(s) + F_c(s')                          of the crush model
///     m x'' = -F_x
///     m z'' = -F_v + P_1 + P_2
///     J theta'' = F_x (h_cg - h_F) + F_v l_Q - lf P_1 + lr P_2
/// F_v is the barrier's vertical force, downward positive, by the law or as a given series; P_1 = -k1 d - c1 d' with
/// d = z - lf theta is the front axle's load less its static one, P_2 the rear's with d = z + lr theta. Forces follow
/// from virtual work, so the energies balance.
struct CoupledModel {
  CrushModel crush;
  HeavePitchModel body;       ///< Heights needed; the arm needed with a vertical force; derived equations only.
  VerticalForceLaw vertical;  ///< Default: no vertical force.
  GroundContact ground;       ///< Values of an axle, also where the body's are one wheel's.
};

/// The same model with its mass in both parts: crush and body may leave it unset, but not both, and must not differ.
/// @throws InvalidInput
CoupledModel with_one_mass(const CoupledModel& model);

/// @throws InvalidInput naming the field, its value and the rule, on a bad part, masses that
///         differ, a height that is not set, half a bump stop,
///         or printed equations.
void validate(const CoupledModel& model);

}  // namespace crashsim
