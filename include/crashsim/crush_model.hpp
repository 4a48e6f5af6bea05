#pragma once
/// Phase I: crush of a vehicle against a rigid barrier, one degree of freedom.

#include <string>
#include <string_view>

#include <crashsim/error.hpp>
#include <crashsim/options.hpp>
#include <crashsim/piecewise_linear.hpp>

namespace crashsim {

/// What spring and damper are curves of; the force F = F_k + F_c.
///     stiffness      F_k = k(|x|) x,          F_c = c(|v|) v
///     force          F_k = f(|x|) sign(x),    F_c = c(|v|) v
///     crush_damping  F_k = f(|x|) sign(x),    F_c = c(|x|) v: the rate effect belongs to what is being crushed
///     rate           F_k = f(|x|) sign(x),    F_c = F_k r ln(1 + |v| / v_ref): strain-rate hardening, without a damper
enum class CrushLaw { stiffness, force, crush_damping, rate };
inline constexpr std::string_view kCrushLawNames[] = {"stiffness", "force", "crush_damping", "rate"};
template <>
inline constexpr std::span<const std::string_view> enum_names<CrushLaw>{kCrushLawNames};

/// What a curve does beyond its last knot: hold the last ordinate, continue the last line, or end the run.
enum class Extrapolation { constant, linear, error };
inline constexpr std::string_view kExtrapolationNames[] = {"constant", "linear", "error"};
template <>
inline constexpr std::span<const std::string_view> enum_names<Extrapolation>{kExtrapolationNames};

/// What the structure does after maximum crush: the same path back, or down a straight line.
enum class UnloadingKind { elastic, plastic };
inline constexpr std::string_view kUnloadingKindNames[] = {"elastic", "plastic"};
template <>
inline constexpr std::span<const std::string_view> enum_names<UnloadingKind>{kUnloadingKindNames};

/// Behaviour after maximum crush C. Plastic: the damper is off and the whole force is that of the return line,
///     F = F_m - k_u (C - x),   F_m the force at C,
/// so that contact is lost at the static crush C_s = C - F_m / k_u. One of k_u and e says how steep the line is:
///     k_u = F_m^2 / (e^2 m v0^2)
/// With e = 0 or F_m = 0 nothing comes back: contact is lost at C. A bilateral motion stays on the line and swings
/// about C_s.
struct Unloading {
  UnloadingKind kind = UnloadingKind::elastic;
  bool bilateral =
      false;  ///< False: contact is lost, for good, when the force would pull. True: the barrier pulls too.
  double unloading_stiffness_n_per_m = kUnset;  ///< Plastic: k_u [N/m], > 0.
  double restitution = kUnset;                  ///< Plastic: rebound velocity / impact speed e, 0..1.

  /// Unset numbers are equal.
  bool operator==(const Unloading& other) const;
};

/// One-degree-of-freedom crush, [Noorsumar2021] eq. (1)-(3):
///     m x'' + F_k + F_c = 0,   x(0) = 0,   v(0) = impact speed,   F_k and F_c as CrushLaw says
/// x is crush [m], positive while the front shortens; v = x' [m/s], positive towards the barrier.
struct CrushModel {
  double mass_kg = kUnset;           ///< Test mass [kg], > 0.
  double impact_speed_mps = kUnset;  ///< Speed it was identified at, the default of simulate() [m/s], > 0 or unset.
  CrushLaw law = CrushLaw::stiffness;
  Extrapolation extrapolation = Extrapolation::constant;
  PiecewiseLinear spring;  ///< Knots [m], ordinates >= 0: law `stiffness` k(|x|) [N/m], the others f(|x|) [N].
  PiecewiseLinear damper;  ///< c(|v|): knots [m/s], ordinates [N s/m], >= 0; law `crush_damping`: c(|x|), knots [m].
  double rate_coefficient = kUnset;     ///< Law `rate`: r [-], >= 0.
  double reference_speed_mps = kUnset;  ///< Law `rate`: v_ref [m/s], > 0.
  Unloading unloading;
};

/// @throws InvalidInput naming the field, its value and the rule.
void validate(const CrushModel& model);

/// F_k(x) [N], extrapolated as the model says (`error` extrapolates as `constant` here).
double spring_force(const CrushModel& model, double x);

/// F_c at crush x and velocity v [N].
double damper_force(const CrushModel& model, double x, double v);
/// F_c(v) [N]. @throws InvalidInput for a law whose F_c depends on the crush, too.
double damper_force(const CrushModel& model, double v);

/// Work of the spring from 0 to x, exactly [J].
double spring_energy(const CrushModel& model, double x);

}  // namespace crashsim
