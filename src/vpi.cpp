#include <algorithm>
#include <cmath>
#include <cstddef>

#include <crashsim/metrics.hpp>
#include <crashsim/signal.hpp>

#include "root.hpp"

namespace crashsim {
namespace {

constexpr double kSlack_m = 0.03;
constexpr double kStiffnessPerMass = 2500.0;  // 1/s^2
constexpr double kOmega = 50.0;               // 1/s, its square root
constexpr double kLongestStep_s = 0.005;      // a twelfth of the oscillation's half: at most one turn a step
constexpr double kLongestPulse_s = 1e3;       // of a longer one nobody asks, and it would take without end
constexpr double kShortestStep_s = 1e-9;      // every step moves on, whatever rounding says about its end

/// Unit mass relative to the vehicle: displacement beyond the slack, and speed.
struct Occupant {
  double stretch_m = -kSlack_m;
  double speed_mps = 0.0;
};

/// Vehicle acceleration a + jerk t from now on.
struct Ramp {
  double a, jerk;
};

bool is_held(const Occupant& occupant, const Ramp& vehicle) {
  if (occupant.stretch_m != 0.0) return occupant.stretch_m > 0.0;
  if (occupant.speed_mps != 0.0) return occupant.speed_mps > 0.0;
  return vehicle.a < 0.0;
}

Occupant fly(const Occupant& now, const Ramp& vehicle, double t) {
  return {now.stretch_m + t * (now.speed_mps - t * (vehicle.a / 2.0 + t * vehicle.jerk / 6.0)),
          now.speed_mps - t * (vehicle.a + t * vehicle.jerk / 2.0)};
}

/// On the belt: the stretch that balances the vehicle's acceleration, and a free oscillation about it.
Occupant swing(const Occupant& now, const Ramp& vehicle, double t) {
  const double balance = -vehicle.a / kStiffnessPerMass;
  const double drift = -vehicle.jerk / kStiffnessPerMass;
  const double cosine = now.stretch_m - balance;
  const double sine = (now.speed_mps - drift) / kOmega;
  const double c = std::cos(kOmega * t), s = std::sin(kOmega * t);
  return {balance + drift * t + cosine * c + sine * s, drift + kOmega * (sine * c - cosine * s)};
}

/// Moves the occupant by `limit` or to the belt's next taking hold or letting go, whichever comes first. Raises
/// `largest` to the largest stretch on the way and returns the time moved.
double step(Occupant& occupant, const Ramp& vehicle, double limit, double& largest) {
  const Occupant start = occupant;
  const bool held = is_held(start, vehicle);
  const auto state = [&](double t) { return held ? swing(start, vehicle, t) : fly(start, vehicle, t); };
  const auto stretch = [&](double t) { return state(t).stretch_m; };
  const auto speed = [&](double t) { return state(t).speed_mps; };

  const bool turns = speed(0.0) * speed(limit) < 0.0;
  const double turn = turns ? bisect(speed, 0.0, limit) : 0.0;
  double from = 0.0;
  for (const double to : {turn, limit}) {
    const bool switches = held ? stretch(to) < 0.0 : stretch(to) > 0.0;
    if (switches) {
      const double end = std::max(bisect(stretch, from, to), kShortestStep_s);
      occupant = {0.0, speed(end)};
      return end;
    }
    largest = std::max(largest, stretch(to));
    from = to;
  }
  occupant = state(limit);
  return limit;
}

/// Largest stretch still to come when the vehicle no longer accelerates.
double coasting_stretch(const Occupant& occupant) {
  if (occupant.speed_mps <= 0.0) return 0.0;
  return std::hypot(std::max(occupant.stretch_m, 0.0), occupant.speed_mps / kOmega);
}

}  // namespace

double vehicle_pulse_index(const Motion& motion) {
  const auto& [time_s, accel_mps2, velocity_mps, displacement_m] = motion;
  check_series(time_s, accel_mps2, "acceleration", 2);
  if (time_s.back() - time_s.front() > kLongestPulse_s) return kUnset;
  Occupant occupant;
  double largest = 0.0;
  for (std::size_t i = 0; i + 1 < time_s.size(); ++i) {
    const double h = time_s[i + 1] - time_s[i];
    const double jerk = (accel_mps2[i + 1] - accel_mps2[i]) / h;
    for (double t = 0.0; t < h;) {
      const Ramp vehicle{accel_mps2[i] + jerk * t, jerk};
      t += step(occupant, vehicle, std::min(h - t, kLongestStep_s), largest);
    }
  }
  return kStiffnessPerMass * std::max(largest, coasting_stretch(occupant));
}

}  // namespace crashsim
