#include "sensor_signals.hpp"

#include <algorithm>
#include <cmath>

namespace crashsim {

Reading read_between(std::span<const double> values, double position) {
  const auto last = static_cast<double>(values.size() - 1);
  if (position <= 0.0) return {values.front(), 0.0};
  if (position >= last) return {values.back(), 0.0};
  const auto segment = static_cast<std::size_t>(std::clamp(std::floor(position), 1.0, last - 2.0));
  const double s = position - static_cast<double>(segment);
  const double before = values[segment - 1], here = values[segment], next = values[segment + 1],
               after = values[segment + 2];
  // Newton's form of the cubic through s = -1, 0, 1, 2.
  const double first = next - here;
  const double second = 0.5 * (next - 2.0 * here + before);
  const double third = (after - 3.0 * next + 3.0 * here - before) / 6.0;
  return {here + s * (first + (s - 1.0) * (second + (s + 1.0) * third)),
          first + (2.0 * s - 1.0) * second + (3.0 * s * s - 1.0) * third};
}

double total_weight(const SensorSignals& signals, std::span<const SensorModel> models) {
  double total = 0.0;
  for (std::size_t c = 0; c < models.size(); ++c) total += signals.weights[c] * models[c].gain * models[c].gain;
  return total;
}

std::vector<double> common_acceleration(const SensorSignals& signals, std::span<const SensorModel> models) {
  std::vector<double> mean(signals.count);
  const double norm = total_weight(signals, models);
  for (std::size_t c = 0; c < models.size(); ++c) {
    const SensorModel& model = models[c];
    for (std::size_t i = 0; i < mean.size(); ++i)
      mean[i] += signals.weights[c] * model.gain * (signals.read(c, i, model.time_shift_s).value - model.bias_mps2);
  }
  for (double& value : mean) value /= norm;
  return mean;
}

std::vector<double> corrected_channel(const SensorSignals& signals, std::size_t channel, const SensorModel& model) {
  std::vector<double> corrected(signals.count);
  for (std::size_t i = 0; i < corrected.size(); ++i)
    corrected[i] = (signals.read(channel, i, model.time_shift_s).value - model.bias_mps2) / model.gain;
  return corrected;
}

std::vector<double> quadrature_weights(double dt_s, double end_s) {
  constexpr double kOnSample = 1e-6;  // of a step
  const double steps = end_s / dt_s;
  const double whole = std::floor(steps + kOnSample);
  const double rest = std::max(steps - whole, 0.0);
  std::vector<double> weights(static_cast<std::size_t>(whole) + 1, dt_s);
  weights.front() = weights.back() = 0.5 * dt_s;
  if (weights.size() == 1) weights.front() = 0.0;
  if (rest <= kOnSample) return weights;
  weights.back() += dt_s * rest * (1.0 - 0.5 * rest);
  weights.push_back(0.5 * dt_s * rest * rest);
  return weights;
}

NoiseLevel noise_of(std::span<const std::vector<double>> differences) {
  const std::size_t count = differences.front().size();
  const auto product = [&](std::size_t lag) {
    double sum = 0.0;
    for (const std::vector<double>& d : differences)
      for (std::size_t i = 0; i + lag < count; ++i) sum += d[i] * d[i + lag];
    return sum;
  };
  const double power = product(0);
  NoiseLevel noise{power / static_cast<double>(count), 1.0};
  if (power == 0.0) return noise;
  for (std::size_t lag = 1; lag < count / 3; ++lag) {
    const double alike = product(lag) / power;
    if (alike <= 0.0) break;
    noise.samples += 2.0 * alike;
  }
  return noise;
}

}  // namespace crashsim
