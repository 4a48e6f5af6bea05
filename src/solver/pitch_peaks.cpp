#include "solver/pitch_peaks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crashsim {
namespace {

/// What to maximise: pitch, or heave and heave velocity downwards.
enum class Quantity { pitch, drop, drop_velocity };

/// A quantity and its first two derivatives.
struct Jet {
  double value, slope, curvature;
};

/// The motion from one time of the grid to the next.
struct Step {
  const LinearSystem& system;
  const Propagator& propagator;
  const PitchState& from;
  const ForcePiece& force;
  Quantity quantity;

  [[nodiscard]] Jet jet(const PitchState& y, double s) const {
    const Eigen::Vector2d accel = system.acceleration(y, value(force, s));
    if (quantity == Quantity::pitch) return {y[1], y[3], accel[1]};
    if (quantity == Quantity::drop) return {-y[0], -y[2], -accel[0]};
    const Eigen::Vector2d force_rate = force.col(1) + s * force.col(2);
    const Eigen::Vector2d jerk = force_rate - system.damping * accel - system.stiffness * y.tail<2>();
    return {-y[2], -accel[0], -jerk[0]};
  }
  [[nodiscard]] Jet jet(double s) const { return jet(s > 0.0 ? propagator.step(from, force, s) : from, s); }
};

/// Zero of f between a and b, where it has opposite signs (Illinois method).
template <class F>
double zero_between(const F& f, double a, double b) {
  constexpr int kMostIterations = 60;
  const double resolution = 4.0 * std::numeric_limits<double>::epsilon() * b;
  double fa = f(a), fb = f(b), s = a;
  for (int i = 0; i < kMostIterations; ++i) {
    const double before = s;
    s = (a * fb - b * fa) / (fb - fa);
    const double fs = f(s);
    if (fs == 0.0 || std::abs(s - before) <= resolution) break;
    if ((fs > 0.0) == (fb > 0.0)) {
      fa *= 0.5;
    } else {
      a = b;
      fa = fb;
    }
    b = s;
    fb = fs;
  }
  return s;
}

/// Raises `best` to the top inside [a, b], where the slope is monotone, if it falls through zero there.
void raise_by_top(const Step& step, double start, double a, double b, Peak& best) {
  if (!(step.jet(a).slope > 0.0 && step.jet(b).slope < 0.0)) return;
  const double s = zero_between([&](double at) { return step.jet(at).slope; }, a, b);
  const double top = step.jet(s).value;
  if (top > best.value) best = {start + s, top};
}

/// Raises `best` to the top inside a step of length h that ends in `to`, if there is a higher one.
void raise_by_step(const Step& step, double start, double h, const PitchState& to, Peak& best) {
  const Jet first = step.jet(0.0);
  const Jet last = step.jet(to, h);
  if ((first.curvature > 0.0) == (last.curvature > 0.0)) {
    if (first.slope > 0.0 && last.slope < 0.0) raise_by_top(step, start, 0.0, h, best);
    return;
  }
  const double inflection = zero_between([&](double at) { return step.jet(at).curvature; }, 0.0, h);
  raise_by_top(step, start, 0.0, inflection, best);
  raise_by_top(step, start, inflection, h, best);
}

}  // namespace

PitchPeaks find_peaks(const LinearSystem& system, const PitchGrid& grid, std::span<const PitchState> states,
                      std::span<const Eigen::Vector2d> accelerations) {
  const Propagator propagator(system, 0.0);
  const auto largest = [&](Quantity quantity, const auto& value_at, const auto& slope_at) {
    Peak best{grid.times[0], value_at(0)};
    double steepest = 0.0;
    for (std::size_t i = 0; i < states.size(); ++i) {
      if (value_at(i) > best.value) best = {grid.times[i], value_at(i)};
      steepest = std::max(steepest, std::abs(slope_at(i)));
    }
    for (std::size_t i = 0; i + 1 < states.size(); ++i) {
      const double h = grid.times[i + 1] - grid.times[i];
      if (std::max(value_at(i), value_at(i + 1)) + 2.0 * h * steepest <= best.value) continue;
      raise_by_step({system, propagator, states[i], grid.forces[i], quantity}, grid.times[i], h, states[i + 1], best);
    }
    return best;
  };
  const auto negated = [](Peak peak) { return Peak{peak.time_s, -peak.value}; };
  return {
      .pitch_max = largest(
          Quantity::pitch, [&](std::size_t i) { return states[i][1]; }, [&](std::size_t i) { return states[i][3]; }),
      .heave_min = negated(largest(
          Quantity::drop, [&](std::size_t i) { return -states[i][0]; }, [&](std::size_t i) { return states[i][2]; })),
      .heave_velocity_min = negated(largest(
          Quantity::drop_velocity, [&](std::size_t i) { return -states[i][2]; },
          [&](std::size_t i) { return accelerations[i][0]; })),
  };
}

}  // namespace crashsim
