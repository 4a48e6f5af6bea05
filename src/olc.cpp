#include <algorithm>
#include <cmath>
#include <cstddef>

#include <crashsim/metrics.hpp>
#include <crashsim/signal.hpp>

#include "root.hpp"

namespace crashsim {
namespace {

constexpr double kFreeFlight_m = 0.065;
constexpr double kRestraint_m = 0.235;
constexpr double kOlcGravity = 9.81;

struct State {
  double t, v, x;
};

/// Sampled motion, between samples the cubic with the samples' displacements and velocities. Times and displacements
/// count from the first sample.
struct Path {
  std::span<const double> time_s, velocity_mps, displacement_m;

  [[nodiscard]] State at_sample(std::size_t i) const {
    return {time_s[i] - time_s[0], velocity_mps[i], displacement_m[i] - displacement_m[0]};
  }

  [[nodiscard]] State between(std::size_t i, double t) const {
    const State a = at_sample(i), b = at_sample(i + 1);
    const double h = b.t - a.t;
    const double s = (t - a.t) / h;
    const double mean = (b.x - a.x) / h;
    const double bend = 3.0 * (a.v + b.v - 2.0 * mean);
    const double linear = b.v - a.v - bend;
    return {t, a.v + s * (linear + s * bend), a.x + h * s * (a.v + s * (linear / 2.0 + s * bend / 3.0))};
  }
};

/// First state from segment `first` and time `from` on in which travel(state) reaches `distance`. After the last
/// sample the vehicle keeps its velocity and the travel grows at `late_speed`.
template <class Travel>
State first_reached(const Path& path, const Travel& travel, double distance, double from, double late_speed) {
  const std::size_t last = path.time_s.size() - 1;
  for (std::size_t i = 0; i < last; ++i) {
    const State end = path.at_sample(i + 1);
    if (end.t <= from || travel(end) < distance) continue;
    const double start = std::max(from, path.at_sample(i).t);
    const auto excess = [&](double t) { return travel(path.between(i, t)) - distance; };
    return path.between(i, bisect(excess, start, end.t));
  }
  if (!(late_speed > 0.0)) return {kUnset, kUnset, kUnset};
  const State end = path.at_sample(last);
  const double late = (distance - travel(end)) / late_speed;
  return {end.t + late, end.v, end.x + end.v * late};
}

}  // namespace

Olc occupant_load_criterion(std::span<const double> time_s, std::span<const double> velocity_mps,
                            std::span<const double> displacement_m) {
  check_series(time_s, velocity_mps, "velocity", 2);
  check_series(time_s, displacement_m, "displacement", 2);
  const Path path{time_s, velocity_mps, displacement_m};
  const double v0 = velocity_mps.front();
  const double gain = v0 - velocity_mps.back();

  const auto flown = [&](const State& s) { return v0 * s.t - s.x; };
  const State one = first_reached(path, flown, kFreeFlight_m, 0.0, gain);
  if (std::isnan(one.t)) return {};
  const auto restrained = [&](const State& s) { return (v0 + s.v) / 2.0 * (s.t - one.t) - (s.x - one.x); };
  const State two = first_reached(path, restrained, kRestraint_m, one.t, gain / 2.0);
  if (std::isnan(two.t)) return {};
  return {(v0 - two.v) / (two.t - one.t) / kOlcGravity, time_s[0] + one.t, time_s[0] + two.t};
}

}  // namespace crashsim
