#pragma once
/// Phase II: heave and pitch of the vehicle body on its axles, two degrees of freedom.

#include <array>
#include <complex>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <crashsim/error.hpp>
#include <crashsim/options.hpp>

namespace crashsim {

/// Which equations: Lagrange's for the energies of the model, or those the paper prints, which differ.
enum class PitchFormulation { derived, as_printed };
inline constexpr std::string_view kPitchFormulationNames[] = {"derived", "as_printed"};
template <>
inline constexpr std::span<const std::string_view> enum_names<PitchFormulation>{kPitchFormulationNames};

/// Heave z (up positive, from static equilibrium) and pitch theta (nose-down positive), [Noorsumar2021] eq. (5)-(10):
///     M q'' + C q' + K q = Q,   q = (z, theta),   M = diag(m, J)
///     Q_z = -F_v,   Q_theta = F_v l_Q + F_x (h_cg - h_F)
/// F_v is the barrier's vertical force on the vehicle, downward positive, l_Q = force_arm_m ahead of the centre of
/// gravity; F_x is the longitudinal crush force, positive while it stops the vehicle, at the height h_F.
///
/// `as_printed` keeps the paper's equation (10): first row of C = (c1 lf + c2 lr, c1 + c2) where Lagrange gives
/// (c1 + c2, c2 lr - c1 lf), so C is not symmetric and its units do not match; and Q_theta = F_v times 1 m.
struct HeavePitchModel {
  double mass_kg = kUnset;                  ///< Mass m [kg], > 0.
  double pitch_inertia_kgm2 = kUnset;       ///< Pitch moment of inertia J about the centre of gravity [kg m^2], > 0.
  double front_axle_m = kUnset;             ///< Centre of gravity to front axle, lf [m], > 0.
  double rear_axle_m = kUnset;              ///< Centre of gravity to rear axle, lr [m], > 0.
  double front_stiffness_n_per_m = kUnset;  ///< k1 [N/m], >= 0.
  double rear_stiffness_n_per_m = kUnset;   ///< k2 [N/m], >= 0.
  double front_damping_ns_per_m = kUnset;   ///< c1 [N s/m], >= 0.
  double rear_damping_ns_per_m = kUnset;    ///< c2 [N s/m], >= 0.
  bool per_wheel = false;                   ///< The four values are one wheel's: an axle has twice as much.
  double force_arm_m = kUnset;              ///< l_Q [m], ahead of the centre of gravity; needed with a vertical force.
  double cg_height_m = kUnset;              ///< h_cg [m], >= 0; needed with a longitudinal force.
  double force_height_m = kUnset;           ///< h_F [m], >= 0; needed with a longitudinal force without own heights.
  PitchFormulation formulation = PitchFormulation::derived;
};
inline constexpr std::array<Field<HeavePitchModel>, 13> kHeavePitchFields = {{
    {"mass_kg", "mass", "kg", "vehicle mass", &HeavePitchModel::mass_kg, positive()},
    {"pitch_inertia_kgm2", "pitch-inertia", "kg m^2", "pitch moment of inertia about the centre of gravity",
     &HeavePitchModel::pitch_inertia_kgm2, positive()},
    {"front_axle_m", "front-axle", "m", "centre of gravity to front axle", &HeavePitchModel::front_axle_m, positive()},
    {"rear_axle_m", "rear-axle", "m", "centre of gravity to rear axle", &HeavePitchModel::rear_axle_m, positive()},
    {"front_stiffness_n_per_m", "front-stiffness", "N/m", "suspension stiffness of the front axle",
     &HeavePitchModel::front_stiffness_n_per_m, at_least(0.0)},
    {"rear_stiffness_n_per_m", "rear-stiffness", "N/m", "suspension stiffness of the rear axle",
     &HeavePitchModel::rear_stiffness_n_per_m, at_least(0.0)},
    {"front_damping_ns_per_m", "front-damping", "N s/m", "suspension damping of the front axle",
     &HeavePitchModel::front_damping_ns_per_m, at_least(0.0)},
    {"rear_damping_ns_per_m", "rear-damping", "N s/m", "suspension damping of the rear axle",
     &HeavePitchModel::rear_damping_ns_per_m, at_least(0.0)},
    {"per_wheel", "per-wheel", "", "stiffness and damping are one wheel's: double them", &HeavePitchModel::per_wheel},
    {"force_arm_m", "force-arm", "m", "lever arm of the vertical force ahead of the centre of gravity",
     &HeavePitchModel::force_arm_m},
    {"cg_height_m", "cg-height", "m", "height of the centre of gravity", &HeavePitchModel::cg_height_m, at_least(0.0)},
    {"force_height_m", "force-height", "m", "height at which the longitudinal force acts",
     &HeavePitchModel::force_height_m, at_least(0.0)},
    {"formulation", "formulation", "", "equations: derived from the energies, or as the paper prints them",
     choice<&HeavePitchModel::formulation>()},
}};
template <>
inline constexpr std::span<const Field<HeavePitchModel>> fields<HeavePitchModel>{kHeavePitchFields};

/// @throws InvalidInput naming the field, its value and the rule. force_arm_m, cg_height_m and force_height_m may be
///         unset.
void validate(const HeavePitchModel& model);

/// The same model with axle values: per_wheel resolved.
HeavePitchModel with_axle_values(const HeavePitchModel& model);

/// M, C and K over (z, theta) [SI]; C depends on the formulation.
Eigen::Matrix2d mass_matrix(const HeavePitchModel& model);
Eigen::Matrix2d damping_matrix(const HeavePitchModel& model);
Eigen::Matrix2d stiffness_matrix(const HeavePitchModel& model);

/// True when damping takes energy from every motion: the symmetric part of C is positive semidefinite. Always so for
/// `derived`, not for `as_printed`.
bool is_dissipative(const HeavePitchModel& model);

/// One free motion exp(lambda t): a conjugate pair of eigenvalues, or a real one.
struct Mode {
  std::complex<double> eigenvalue;  ///< lambda [1/s], imaginary part >= 0.
  double frequency_hz = kUnset;     ///< |lambda| / (2 pi), undamped natural frequency [Hz].
  double damping_ratio = kUnset;    ///< -Re(lambda) / |lambda|; unset for a rigid-body mode (lambda = 0).
  double pitch_per_heave = kUnset;  ///< |theta / z| of the shape [rad/m]; infinite for pure pitch.
};

/// The free motions in order of frequency: two when both oscillate, up to four when overdamped.
std::vector<Mode> modes(const HeavePitchModel& model);

}  // namespace crashsim
