#include "optimize/fit_target.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace crashsim {
namespace {

constexpr std::size_t kFewestSamples = 10;

double maximum_of(const std::vector<double>& channel) {
  double maximum = 0.0;
  for (const double value : channel) maximum = std::max(maximum, std::fabs(value));
  return maximum;
}

void check_given(const std::vector<double>& weights) {
  const bool valid = weights.size() == 3 &&
                     std::all_of(weights.begin(), weights.end(), [](double w) { return std::isfinite(w) && w >= 0.0; });
  if (!valid || weights[0] + weights[1] + weights[2] == 0.0)
    throw InvalidInput(fmt::format(
        "IdentifyOptions.weights = {}: three numbers >= 0, not all 0, are needed, for acceleration, velocity and "
        "displacement",
        fmt::join(weights, ",")));
}

void set_weights(FitTarget& target, const Setting<Weights>& weights) {
  const double accel = maximum_of(target.accel_mps2), velocity = maximum_of(target.velocity_mps),
               displacement = maximum_of(target.displacement_m);
  target.factor = 1.0;
  switch (weights.rule) {
    case Weights::normalised:
      target.accel_scale = 1.0 / accel;
      target.velocity_scale = 1.0 / velocity;
      target.displacement_scale = 1.0 / displacement;
      target.factor = 1.0 / static_cast<double>(target.time_s.size());
      break;
    case Weights::paper:
      target.accel_scale = target.velocity_scale = target.displacement_scale = 1.0;
      break;
    case Weights::given:
      check_given(weights.numbers);
      target.accel_scale = weights.numbers[0];
      target.velocity_scale = weights.numbers[1];
      target.displacement_scale = weights.numbers[2];
  }
  target.accel_size = target.accel_scale * accel;
  target.velocity_size = target.velocity_scale * velocity;
  target.displacement_size = target.displacement_scale * displacement;
}

void check_channel(const std::vector<double>& channel, std::size_t samples, const char* name) {
  if (channel.size() != samples)
    throw InvalidInput(
        fmt::format("pulse: {} has {} samples but time_s has {}: as many are needed", name, channel.size(), samples));
  for (std::size_t i = 0; i < samples; ++i)
    if (!std::isfinite(channel[i]))
      throw InvalidInput(fmt::format("pulse: {}[{}] = {}: must be finite", name, i, channel[i]));
}

void check_pulse(const Pulse& pulse) {
  const auto& t = pulse.time_s;
  check_channel(t, t.size(), "time_s");
  check_channel(pulse.accel_mps2, t.size(), "accel_mps2");
  check_channel(pulse.velocity_mps, t.size(), "velocity_mps");
  check_channel(pulse.displacement_m, t.size(), "displacement_m");
  for (std::size_t i = 0; i < t.size(); ++i)
    if (i == 0 ? t[i] < 0.0 : t[i] <= t[i - 1])
      throw InvalidInput(fmt::format("pulse: time_s[{}] = {} s: times must increase from 0", i, t[i]));
  if (!(pulse.impact_speed_mps > 0.0))
    throw InvalidInput(fmt::format("pulse: impact_speed_mps = {} m/s: must be > 0", pulse.impact_speed_mps));
  if (std::isnan(pulse.t_m_s)) throw InvalidInput(no_max_crush_message(pulse));
  if (!(pulse.max_crush_m > 0.0))
    throw InvalidInput(fmt::format("pulse: max_crush_m = {} m: must be > 0", pulse.max_crush_m));
}

}  // namespace

std::string no_max_crush_message(const Pulse& pulse) {
  const double v = pulse.velocity_mps.empty() ? kUnset : pulse.velocity_mps.back();
  const double t = pulse.time_s.empty() ? kUnset : pulse.time_s.back();
  return fmt::format(
      "pulse: has no time of maximum crush: its velocity ({:.4g} m/s at {:.4g} s) never reaches zero; a longer "
      "trace or the right impact speed is needed",
      v, t);
}

FitTarget make_target(const Pulse& pulse, double mass_kg, const Setting<Weights>& weights) {
  check_pulse(pulse);
  FitTarget target;
  target.mass_kg = std::isnan(mass_kg) ? pulse.mass_kg : mass_kg;
  if (std::isnan(target.mass_kg))
    throw InvalidInput("IdentifyOptions.mass_kg: not given, and the pulse does not say it: give the test mass");
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
  if (maximum_of(target.accel_mps2) == 0.0)
    throw InvalidInput("pulse: accel_mps2 is zero up to t_m: there is no force to identify");
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
