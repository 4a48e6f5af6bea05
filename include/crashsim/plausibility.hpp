#pragma once
/// Whether a motion obeys what holds of every motion, and looks like those of its kind.

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <crashsim/error.hpp>
#include <crashsim/named_number.hpp>

namespace crashsim {

/// Percentiles of a number over 675 NHTSA frontal tests into a rigid wall.
struct FleetRange {
  std::string_view name;  ///< As in Metrics: "max_crush_m".
  std::string_view doc, unit;
  double percentile_5, median, percentile_95;
};
inline constexpr std::array<FleetRange, 2> kFleetRanges = {{
    {"max_crush_m", "maximum crush", "m", 0.442, 0.653, 0.796},
    {"peak_decel_g", "peak deceleration", "g", 25.5, 39.6, 56.3},
}};

/// What lies outside the 5th to 95th percentile of the fleet, one sentence each; what is unset does not.
std::vector<std::string> check_fleet(double max_crush_m, double peak_decel_g);

/// How acceleration, velocity and displacement of one motion from time 0 on agree, mass left out. Deviations are the
/// largest over the samples, with the time of each; integrals by trapezoids.
struct MotionBalance {
  double velocity_deviation = kUnset;        ///< |v - v0 - integral of a dt|, of v0.
  double velocity_deviation_s = kUnset;      ///< Where [s].
  double displacement_deviation = kUnset;    ///< |x - x0 - integral of v dt|, of the largest |x - x0|.
  double displacement_deviation_s = kUnset;  ///< Where [s].
  double energy_deviation = kUnset;          ///< |v^2/2 - v0^2/2 - integral of a dx|, of v0^2/2.
  double energy_deviation_s = kUnset;        ///< Where [s].
  double work_ratio = kUnset;                ///< Work of -a over the crush to t_m, of v0^2/2; unset without t_m.
  double centroid_ratio = kUnset;            ///< Time centroid of a over 0..t_m, of C/v0; unset without t_m.
};
inline constexpr std::array<NamedNumber<MotionBalance>, 8> kMotionBalanceNumbers = {{
    {"velocity_deviation", &MotionBalance::velocity_deviation, "velocity against the integral of acceleration"},
    {"velocity_deviation_s", &MotionBalance::velocity_deviation_s, "where"},
    {"displacement_deviation", &MotionBalance::displacement_deviation, "displacement against the integral of velocity"},
    {"displacement_deviation_s", &MotionBalance::displacement_deviation_s, "where"},
    {"energy_deviation", &MotionBalance::energy_deviation, "kinetic energy against the work of the deceleration"},
    {"energy_deviation_s", &MotionBalance::energy_deviation_s, "where"},
    {"work_ratio", &MotionBalance::work_ratio, "work of the deceleration over the crush / (v0^2/2)"},
    {"centroid_ratio", &MotionBalance::centroid_ratio, "time centroid of the deceleration / (C/v0)"},
}};

/// The balance of a motion; samples before time 0 are left out.
/// @throws InvalidInput when lengths differ, a value is not finite, times do not increase, there are fewer than 3
///         samples from time 0 on or the first velocity is not > 0.
MotionBalance motion_balance(std::span<const double> time_s, std::span<const double> accel_mps2,
                             std::span<const double> velocity_mps, std::span<const double> displacement_m);

/// Deviations from balance larger than this are told.
inline constexpr double kBalanced = 0.01;

/// What is out of balance by more than kBalanced, one sentence each: which two channels disagree, where and by how
/// much.
std::vector<std::string> check_balance(const MotionBalance& balance);

}  // namespace crashsim
