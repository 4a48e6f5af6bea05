#include <crashsim/metrics.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include <crashsim/pulse.hpp>
#include <crashsim/signal.hpp>
#include <crashsim/units.hpp>

namespace crashsim {
namespace {

constexpr double kAsiLimit_g = 12.0;  // of the longitudinal axis
constexpr std::size_t kFewestSamples = 3;

void check(const Motion& motion, double mass_kg) {
  check_series(motion.time_s, motion.accel_mps2, "accel_mps2", kFewestSamples);
  check_series(motion.time_s, motion.velocity_mps, "velocity_mps", kFewestSamples);
  check_series(motion.time_s, motion.displacement_m, "displacement_m", kFewestSamples);
  if (!(motion.velocity_mps.front() > 0.0))
    throw InvalidInput(
        fmt::format("velocity_mps[0] = {} m/s: must be > 0, towards the barrier", motion.velocity_mps.front()));
  if (!std::isnan(mass_kg) && !(std::isfinite(mass_kg) && mass_kg > 0.0))
    throw InvalidInput(fmt::format("mass_kg = {} kg: must be > 0", mass_kg));
}

/// The samples from time 0 on.
Motion from_impact(const Motion& motion) {
  const auto& time_s = motion.time_s;
  const auto before = static_cast<std::size_t>(std::lower_bound(time_s.begin(), time_s.end(), 0.0) - time_s.begin());
  const auto cut = [before](std::span<const double> channel) {
    return channel.subspan(std::min(before, channel.size()));
  };
  return {cut(time_s), cut(motion.accel_mps2), cut(motion.velocity_mps), cut(motion.displacement_m)};
}

void set_indices(const Motion& motion, Metrics& out) {
  const auto sliding_mean_g = [&](double window_s) {
    return sliding_mean_peak(motion.time_s, motion.velocity_mps, window_s) / kStandardGravity;
  };
  out.sm10_g = sliding_mean_g(0.010);
  out.sm25_g = sliding_mean_g(0.025);
  out.sm38_g = sliding_mean_g(0.038);
  out.sm50_g = sliding_mean_g(0.050);
  out.asi = out.sm50_g / kAsiLimit_g;
  out.olc_g = occupant_load_criterion(motion.time_s, motion.velocity_mps, motion.displacement_m).olc_g;
  out.vpi_g = vehicle_pulse_index(motion) / kStandardGravity;
}

/// What happens at and after maximum crush.
void set_rebound(const Motion& motion, Metrics& out) {
  const auto smallest = std::min_element(motion.velocity_mps.begin(), motion.velocity_mps.end());
  const double speed = motion.velocity_mps.front();
  out.delta_v_mps = speed - *smallest;
  if (std::isnan(out.t_m_s) || *smallest > 0.0) return;
  if (smallest + 1 == motion.velocity_mps.end()) return;  // still falling
  out.rebound_velocity_mps = *smallest;
  out.restitution = -*smallest / speed;
  out.static_crush_m = motion.displacement_m[static_cast<std::size_t>(smallest - motion.velocity_mps.begin())];
}

}  // namespace

Metrics metrics(const Motion& whole, double mass_kg) {
  const Motion motion = from_impact(whole);
  check(motion, mass_kg);
  const double speed = motion.velocity_mps.front();
  Metrics out;
  const MaxCrush end = find_max_crush(motion.time_s, motion.accel_mps2, motion.velocity_mps, motion.displacement_m);
  out.t_m_s = end.t_m_s;
  out.max_crush_m = end.max_crush_m;
  out.peak_decel_g = -*std::min_element(motion.accel_mps2.begin(), motion.accel_mps2.end()) / kStandardGravity;
  out.mean_decel_g = speed / end.t_m_s / kStandardGravity;
  out.centroid_s = end.max_crush_m / speed;
  if (!std::isnan(end.t_m_s)) out.energy_j = 0.5 * mass_kg * speed * speed;
  set_rebound(motion, out);
  set_indices(motion, out);
  if (!std::isnan(mass_kg)) {
    std::vector<double> force(motion.accel_mps2.begin(), motion.accel_mps2.end());
    for (double& value : force) value *= -mass_kg;
    out.kw400_n_per_m = kw400(motion.displacement_m, force);
  }
  return out;
}

}  // namespace crashsim
