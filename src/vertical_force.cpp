#include <crashsim/vertical_force.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <crashsim/option_values.hpp>

namespace crashsim {

bool is_active(const VerticalForceLaw& law) {
  return (law.angle_rad != 0.0 || law.angle_rate_rad_per_m != 0.0) && law.friction != 0.0;
}

void validate(const VerticalForceLaw& law) { validate_options(law, "VerticalForceLaw"); }

double vertical_ratio(const VerticalForceLaw& law, double crush_m) {
  const double angle = law.angle_rad + law.angle_rate_rad_per_m * std::max(0.0, crush_m - law.angle_start_m);
  if (!std::isnan(law.friction)) {
    const double limit = std::atan(law.friction);
    return std::tan(std::clamp(angle, -limit, limit));
  }
  if (std::abs(angle) > kSteepestAngle)
    throw InvalidInput(
        fmt::format("VerticalForceLaw: the angle is {:.4g} rad at a crush of {:.4g} m: must stay within {} rad where "
                    "no friction bounds the force: give friction, or a smaller angle_rate_rad_per_m",
                    angle, crush_m, kSteepestAngle));
  return std::tan(angle);
}

TimeSeries vertical_force(const VerticalForceLaw& law, const CrushResponse& response) {
  validate(law);
  if (response.time_s.empty())
    throw InvalidInput(fmt::format("vertical_force: the crush response holds no motion ({}): simulate it first",
                                   name_of(response.outcome)));
  TimeSeries force{response.time_s, {}};
  force.values.reserve(force.time_s.size());
  for (std::size_t i = 0; i < force.time_s.size(); ++i)
    force.values.push_back((response.spring_force_n[i] + response.damper_force_n[i]) *
                           vertical_ratio(law, response.displacement_m[i]));
  return force;
}

}  // namespace crashsim
