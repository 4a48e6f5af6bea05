#include <cmath>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include <crashsim/metrics.hpp>

namespace crashsim {
namespace {

constexpr double kFrom_m = 0.025;
constexpr double kTo_m = 0.400;

/// Integral of y over x from the first sample to where x first reaches `end`; NaN when it does not.
double integral_to(std::span<const double> x, std::span<const double> y, double end) {
  double sum = 0.0;
  if (x[0] > end) return kUnset;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    if (x[i + 1] >= end) {
      const double part = x[i + 1] > x[i] ? (end - x[i]) / (x[i + 1] - x[i]) : 0.0;
      return sum + (y[i] + std::lerp(y[i], y[i + 1], part)) / 2.0 * (end - x[i]);
    }
    sum += (y[i] + y[i + 1]) / 2.0 * (x[i + 1] - x[i]);
  }
  return kUnset;
}

double integral_25_400(std::span<const double> crush, std::span<const double> y) {
  return integral_to(crush, y, kTo_m) - integral_to(crush, y, kFrom_m);
}

void check_lengths(std::size_t crush, std::size_t other, std::string_view name) {
  if (crush != other || crush < 2)
    throw InvalidInput(fmt::format("{} crush samples but {} {} samples: the numbers must be equal and at least 2",
                                   crush, other, name));
}

void check_positive(double value, std::string_view name, std::string_view unit) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw InvalidInput(fmt::format("{} = {} {}: must be > 0", name, value, unit));
}

}  // namespace

double kw400(std::span<const double> displacement_m, std::span<const double> force_n) {
  check_lengths(displacement_m.size(), force_n.size(), "force");
  return 2.0 * integral_25_400(displacement_m, force_n) / (kTo_m * kTo_m - kFrom_m * kFrom_m);
}

double ahof400(std::span<const double> displacement_m, std::span<const double> force_n,
               std::span<const double> height_m) {
  check_lengths(displacement_m.size(), force_n.size(), "force");
  check_lengths(displacement_m.size(), height_m.size(), "height");
  std::vector<double> moment(force_n.size());
  for (std::size_t i = 0; i < moment.size(); ++i) moment[i] = force_n[i] * height_m[i];
  return integral_25_400(displacement_m, moment) / integral_25_400(displacement_m, force_n);
}

Crash3 crash3_stiffness(double mass_kg, double impact_speed_mps, double residual_crush_m, double damage_width_m,
                        double no_damage_speed_mps) {
  check_positive(mass_kg, "mass_kg", "kg");
  check_positive(residual_crush_m, "residual_crush_m", "m");
  check_positive(damage_width_m, "damage_width_m", "m");
  check_positive(no_damage_speed_mps, "no_damage_speed_mps", "m/s");
  if (!(impact_speed_mps > no_damage_speed_mps))
    throw InvalidInput(fmt::format("impact_speed_mps = {} m/s: must be > no_damage_speed_mps = {} m/s",
                                   impact_speed_mps, no_damage_speed_mps));
  const double slope = (impact_speed_mps - no_damage_speed_mps) / residual_crush_m;
  Crash3 result;
  result.a_n_per_m = mass_kg * no_damage_speed_mps * slope / damage_width_m;
  result.b_n_per_m2 = mass_kg * slope * slope / damage_width_m;
  result.g_n = result.a_n_per_m * result.a_n_per_m / (2.0 * result.b_n_per_m2);
  return result;
}

double energy_equivalent_speed(double energy_j, double mass_kg) {
  check_positive(mass_kg, "mass_kg", "kg");
  if (!(energy_j >= 0.0)) throw InvalidInput(fmt::format("energy_j = {} J: must be >= 0", energy_j));
  return std::sqrt(2.0 * energy_j / mass_kg);
}

}  // namespace crashsim
