#pragma once
/// The barrier's vertical force on the vehicle, as a law of the crush force.

#include <array>

#include <crashsim/error.hpp>
#include <crashsim/options.hpp>
#include <crashsim/simulate.hpp>
#include <crashsim/time_series.hpp>

namespace crashsim {

/// The crush force comes at an angle alpha that changes as the structure crushes, and the vehicle's front slides along
/// the barrier once friction is exceeded:
///     F_v = F_x tan(alpha(s)),   alpha(s) = alpha0 + alpha' max(0, s - s_b),   |F_v| <= mu |F_x|
/// F_v is downward positive on the vehicle, F_x positive while it stops the vehicle, s is crush [m].
struct VerticalForceLaw {
  double angle_rad = 0.0;             ///< alpha0 [rad]; positive: the force pushes the front down.
  double angle_rate_rad_per_m = 0.0;  ///< alpha', change of the angle with crush [rad/m].
  double angle_start_m = 0.0;         ///< s_b, crush from which the angle changes [m], >= 0.
  double friction = kUnset;           ///< mu, bound of |F_v| / |F_x|; unset: none.

  bool operator==(const VerticalForceLaw&) const = default;
};
inline constexpr double kSteepestAngle = 1.5;  ///< Beyond it tan(alpha) means nothing [rad].
inline constexpr std::array<Field<VerticalForceLaw>, 4> kVerticalForceFields = {{
    {"angle_rad", "angle", "rad", "angle of the crush force below the horizontal at impact",
     &VerticalForceLaw::angle_rad, between(-kSteepestAngle, kSteepestAngle)},
    {"angle_rate_rad_per_m", "angle-rate", "rad/m", "change of that angle with crush",
     &VerticalForceLaw::angle_rate_rad_per_m},
    {"angle_start_m", "angle-start", "m", "crush from which the angle changes", &VerticalForceLaw::angle_start_m,
     at_least(0.0)},
    {"friction", "friction", "", "bound of vertical to longitudinal force; default none", &VerticalForceLaw::friction,
     between(0.0, 10.0)},
}};
template <>
inline constexpr std::span<const Field<VerticalForceLaw>> fields<VerticalForceLaw>{kVerticalForceFields};

/// True when the law gives any force.
bool is_active(const VerticalForceLaw& law);

/// @throws InvalidInput naming the field, its value and the rule.
void validate(const VerticalForceLaw& law);

/// F_v / F_x at a crush [m]. @throws InvalidInput when no friction bounds an angle beyond kSteepestAngle.
double vertical_ratio(const VerticalForceLaw& law, double crush_m);

/// F_v over the output times of a crush motion, to drive heave and pitch [N]. Linear between samples: choose dt_s short
/// against the pulse. @throws InvalidInput on a bad law or a response without motion.
TimeSeries vertical_force(const VerticalForceLaw& law, const CrushResponse& response);

}  // namespace crashsim
