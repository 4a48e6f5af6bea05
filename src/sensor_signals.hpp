#pragma once
/// Accelerometers of one compartment on one uniform grid that starts at impact, each read with a time shift.

#include <cstddef>
#include <span>
#include <vector>

#include <crashsim/error.hpp>

namespace crashsim {

/// A channel's corrections.
struct SensorModel {
  double bias_mps2 = 0.0, gain = 1.0, time_shift_s = 0.0;
};

/// Value of a sampled signal between its samples, and slope per sample.
struct Reading {
  double value = kUnset, slope = kUnset;
};

/// Uniform samples, between them the cubic through the four around; beyond the ends they are held.
/// @param position in samples from the first; at least 4 samples.
Reading read_between(std::span<const double> values, double position);

/// What is compared. Time counts from impact.
struct SensorSignals {
  double dt_s = kUnset;
  double first_s = kUnset;                    ///< Time of the channels' first sample [s], <= 0.
  std::size_t count = 0;                      ///< Samples of the grid 0, dt, 2 dt, ..
  std::vector<std::vector<double>> channels;  ///< From the first sample on [m/s^2].
  std::vector<double> weights;                ///< Of the channels, 1 / variance of noise up to a common factor.
  std::vector<double> wall_mps2;              ///< F/m on the grid, positive [m/s^2]; empty without a wall.

  [[nodiscard]] double time(std::size_t i) const { return static_cast<double>(i) * dt_s; }
  /// A channel at grid sample i, as its model would have read it late.
  [[nodiscard]] Reading read(std::size_t channel, std::size_t i, double time_shift_s) const {
    return read_between(channels[channel], (time(i) + time_shift_s - first_s) / dt_s);
  }
};

/// Sum of the weights of the channels' readings in their common acceleration.
double total_weight(const SensorSignals& signals, std::span<const SensorModel> models);

/// The channels' common acceleration at every sample of the grid: their weighted mean, given what is wrong with each.
std::vector<double> common_acceleration(const SensorSignals& signals, std::span<const SensorModel> models);

/// One channel at every sample of the grid, corrected.
std::vector<double> corrected_channel(const SensorSignals& signals, std::size_t channel, const SensorModel& model);

/// Weights by which the samples of a grid give the integral from 0 to end_s; acceleration linear between samples.
std::vector<double> quadrature_weights(double dt_s, double end_s);

/// Noise of signals that should agree: its variance, and over how many samples it is alike.
struct NoiseLevel {
  double variance = kUnset;
  double samples = kUnset;  ///< 1 + 2 sum of the autocorrelations up to the first that is not positive.
};
/// @param differences one series a channel, of equal length.
NoiseLevel noise_of(std::span<const std::vector<double>> differences);

}  // namespace crashsim
