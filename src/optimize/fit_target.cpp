#include "optimize/fit_target.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace crashsim {
namespace {

constexpr std::size_t kFewestSamples = 10;

double inverse_maximum(const std::vector<double>& channel) {
  double maximum = 0.0;
  for (const double value : channel) maximum = std::max(maximum, std::fabs(value));
  return maximum > 0.0 ? 1.0 / maximum : 0.0;
}

void set_weights(FitTarget& target, const Setting<Weights>& weights) {
  target.factor = 1.0;
  switch (weights.rule) {
    case Weights::normalised:
      target.accel_scale = inverse_maximum(target.accel_mps2);
      target.velocity_scale = inverse_maximum(target.velocity_mps);
      target.displacement_scale = inverse_maximum(target.displacement_m);
      target.factor = 1.0 / static_cast<double>(target.time_s.size());
      return;
    case Weights::paper:
      target.accel_scale = target.velocity_scale = target.displacement_scale = 1.0;
      return;
    case Weights::given:
      if (weights.numbers.size() != 3 ||
          std::any_of(weights.numbers.begin(), weights.numbers.end(), [](double w) { return !(w >= 0.0); }))
        throw InvalidInput(fmt::format(
            "IdentifyOptions.weights = {}: three numbers >= 0 are needed, for acceleration, velocity and displacement",
            fmt::join(weights.numbers, ",")));
      target.accel_scale = weights.numbers[0];
      target.velocity_scale = weights.numbers[1];
      target.displacement_scale = weights.numbers[2];
  }
}

}  // namespace

FitTarget make_target(const Pulse& pulse, double mass_kg, const Setting<Weights>& weights) {
  FitTarget target;
  target.mass_kg = std::isnan(mass_kg) ? pulse.mass_kg : mass_kg;
  if (std::isnan(target.mass_kg))
    throw InvalidInput("IdentifyOptions.mass_kg: not given, and the pulse does not say it: give the test mass");
  if (std::isnan(pulse.t_m_s))
    throw InvalidInput(fmt::format(
        "pulse: has no time of maximum crush: its velocity ({:.4g} m/s at {:.4g} s) never reaches zero; a longer "
        "trace or the right impact speed is needed",
        pulse.velocity_mps.empty() ? kUnset : pulse.velocity_mps.back(),
        pulse.time_s.empty() ? kUnset : pulse.time_s.back()));
  target.impact_speed_mps = pulse.impact_speed_mps;
  target.max_crush_m = pulse.max_crush_m;
  const auto count = std::upper_bound(pulse.time_s.begin(), pulse.time_s.end(), pulse.t_m_s) - pulse.time_s.begin();
  if (static_cast<std::size_t>(count) < kFewestSamples)
    throw InvalidInput(fmt::format("pulse: {} samples up to t_m = {:.4g} s are too few: at least {} are needed", count,
                                   pulse.t_m_s, kFewestSamples));
  const auto take = [count](const std::vector<double>& all) {
    return std::vector<double>(all.begin(), all.begin() + count);
  };
  target.time_s = take(pulse.time_s);
  target.accel_mps2 = take(pulse.accel_mps2);
  target.velocity_mps = take(pulse.velocity_mps);
  target.displacement_m = take(pulse.displacement_m);
  set_weights(target, weights);
  return target;
}

LossValue loss_value(Loss loss, double u, double smoothing) {
  switch (loss) {
    case Loss::l2:
      return {u * u, 2.0 * u};
    case Loss::huber:
      if (std::fabs(u) <= kHuberThreshold) return {0.5 * u * u / kHuberThreshold, u / kHuberThreshold};
      return {std::fabs(u) - 0.5 * kHuberThreshold, std::copysign(1.0, u)};
    case Loss::l1:
      break;
  }
  if (smoothing == 0.0) return {std::fabs(u), u == 0.0 ? 0.0 : std::copysign(1.0, u)};
  const double root = std::sqrt(u * u + smoothing * smoothing);
  return {root - smoothing, u / root};
}

}  // namespace crashsim
