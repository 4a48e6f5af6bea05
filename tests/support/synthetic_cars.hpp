#pragma once
/// Crash pulses of cars that no law of crashsim describes: a front of elements in series, each of which buckles,
/// softens and hardens again, with power-law strain-rate effect and masses between, integrated here by RK4.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <crashsim/pulse.hpp>

#include "support/random.hpp"

namespace crashsim::test {

/// One element: force over its own compression, at its own rate of compression.
struct CrushZone {
  double stiffness_n_per_m;   ///< Until it yields.
  double peak_n, plateau_n;   ///< Buckling load, and what it falls to.
  double softening_m;         ///< Compression over which it falls.
  double length_m;            ///< Where its folds are used up.
  double locking_n_per_m;     ///< Stiffness from there on.
  double viscosity_ns_per_m;  ///< Damping that keeps the chain from ringing.
};

/// The compartment behind masses and crush zones; zone 0 touches the barrier.
struct SyntheticCar {
  std::vector<CrushZone> zones;
  std::vector<double> masses_kg;  ///< Behind each zone; the last is the compartment.
  double rate_strength = 0.0;     ///< Force grows by this times (rate / reference)^power.
  double rate_power = 0.3;
  double inertia_peak = 0.0;  ///< Buckling load grows by this times rate / reference: stubby columns.
  static constexpr double kReferenceRate_mps = 10.0;

  [[nodiscard]] double mass_kg() const {
    double sum = 0.0;
    for (const double m : masses_kg) sum += m;
    return sum;
  }
};

/// Force of a zone at compression d that has been at most `deepest`, with rate w.
inline double zone_force(const SyntheticCar& car, const CrushZone& zone, double d, double deepest, double w) {
  const double rate = std::max(w, 0.0) / SyntheticCar::kReferenceRate_mps;
  const double peak = zone.peak_n * (1.0 + car.inertia_peak * rate);
  const auto envelope = [&](double at) {
    const double yield = peak / zone.stiffness_n_per_m;
    if (at < yield) return zone.stiffness_n_per_m * at;
    const double fallen = zone.plateau_n + (peak - zone.plateau_n) * std::exp(-(at - yield) / zone.softening_m);
    return fallen + zone.locking_n_per_m * std::max(0.0, at - zone.length_m);
  };
  double force = envelope(deepest);
  if (d < deepest) force = std::max(0.0, force - zone.stiffness_n_per_m * (deepest - d));
  return force * (1.0 + car.rate_strength * std::pow(rate, car.rate_power)) + zone.viscosity_ns_per_m * w;
}

/// Deceleration of the compartment, sampled every `dt_s` until it has rebounded and filtered; a barrier test.
inline Pulse synthetic_pulse(const SyntheticCar& car, double speed_mps, double dt_s = 1e-4, double cfc = 60.0) {
  constexpr int kSubsteps = 10;
  constexpr double kEnd_s = 0.25;
  const std::size_t n = car.masses_kg.size();
  std::vector<double> x(n, 0.0), v(n, speed_mps), deepest(n, 0.0);  // forward travel of the masses
  const auto accelerations = [&](const std::vector<double>& at, const std::vector<double>& rate) {
    std::vector<double> force(n), a(n);
    for (std::size_t i = 0; i < n; ++i) {
      const double d = at[i] - (i > 0 ? at[i - 1] : 0.0), w = rate[i] - (i > 0 ? rate[i - 1] : 0.0);
      force[i] = zone_force(car, car.zones[i], d, std::max(deepest[i], d), w);
      if (i == 0) force[i] = std::max(force[i], 0.0);  // the barrier does not pull
    }
    for (std::size_t i = 0; i < n; ++i) a[i] = ((i + 1 < n ? force[i + 1] : 0.0) - force[i]) / car.masses_kg[i];
    return a;
  };
  const auto moved = [n](const std::vector<double>& from, double h, const std::vector<double>& along) {
    std::vector<double> out(n);
    for (std::size_t i = 0; i < n; ++i) out[i] = from[i] + h * along[i];
    return out;
  };
  std::vector<double> time, accel;
  const double h = dt_s / kSubsteps;
  for (int sample = 0; sample * dt_s < kEnd_s; ++sample) {
    time.push_back(sample * dt_s);
    accel.push_back(accelerations(x, v).back());
    for (int step = 0; step < kSubsteps; ++step) {
      const auto a1 = accelerations(x, v);
      const auto v2 = moved(v, h / 2, a1);
      const auto a2 = accelerations(moved(x, h / 2, v), v2);
      const auto v3 = moved(v, h / 2, a2);
      const auto a3 = accelerations(moved(x, h / 2, v2), v3);
      const auto v4 = moved(v, h, a3);
      const auto a4 = accelerations(moved(x, h, v3), v4);
      for (std::size_t i = 0; i < n; ++i) {
        x[i] += h / 6.0 * (v[i] + 2.0 * v2[i] + 2.0 * v3[i] + v4[i]);
        v[i] += h / 6.0 * (a1[i] + 2.0 * a2[i] + 2.0 * a3[i] + a4[i]);
        deepest[i] = std::max(deepest[i], x[i] - (i > 0 ? x[i - 1] : 0.0));
      }
    }
    if (v.back() < -0.1 * speed_mps) break;
  }
  return make_pulse(time, accel, speed_mps, car.mass_kg(), cfc);
}

/// A car of three zones, soft to stiff, each with some scatter.
inline SyntheticCar synthetic_car(Random& random) {
  SyntheticCar car;
  const std::array<double, 3> plateaus_n = {80e3, 150e3, 330e3}, lengths_m = {0.22, 0.25, 0.35};
  car.masses_kg = {random.between(25.0, 45.0), random.between(150.0, 250.0), random.between(850.0, 1200.0)};
  for (std::size_t i = 0; i < plateaus_n.size(); ++i) {
    const double plateau = plateaus_n[i] * random.between(0.85, 1.15);
    car.zones.push_back({2.0e7, plateau * random.between(1.3, 1.9), plateau, random.between(0.02, 0.05),
                         lengths_m[i] * random.between(0.9, 1.1), 3.0e6, 4e3});
  }
  car.rate_strength = random.between(0.15, 0.35);
  car.inertia_peak = random.between(0.1, 0.4);
  return car;
}

}  // namespace crashsim::test
