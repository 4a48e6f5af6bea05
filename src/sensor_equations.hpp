#pragma once
/// The least-squares problem of a sensor correction. Unknowns are counted in their prior standard deviations.

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <crashsim/sensor_correction_options.hpp>

#include "sensor_signals.hpp"

namespace crashsim {

enum class SensorUnknown { bias, gain, time_shift, wall_gain };

/// What is not known: a number of a channel, or of the wall.
struct SensorParameter {
  SensorUnknown kind = SensorUnknown::bias;
  std::size_t channel = 0;  ///< Of all but the wall's gain.
  double prior_sd = kUnset;
};

/// A velocity that is known: quadrature gives the change of velocity that it speaks of from the common acceleration.
struct SensorCondition {
  enum class Kind { velocity, rebound, impulse };
  Kind kind = Kind::velocity;
  double time_s = kUnset;        ///< Of the velocity, or end of the impulse; of a rebound found.
  double velocity_mps = kUnset;  ///< Known; unset for an impulse.
};

/// What the equations are made from.
struct SensorProblem {
  SensorSignals signals;
  std::size_t first = 0, last = 0;  ///< Grid samples compared, `last` included.
  double impact_speed_mps = kUnset;
  std::vector<SensorCondition> conditions;
  double velocity_sd_mps = kUnset;
  bool compares_wall = false;  ///< Whether F/m is compared at every sample.
  std::vector<SensorParameter> parameters;
};

/// Models of channels and wall at a point.
struct SensorState {
  std::vector<SensorModel> channels;
  double wall_gain = 1.0;
};

class SensorEquations {
 public:
  /// Noise as of uncorrected channels.
  explicit SensorEquations(SensorProblem problem);

  [[nodiscard]] const SensorProblem& problem() const { return problem_; }
  [[nodiscard]] SensorState state(std::span<const double> units) const;

  /// Sum of the squares of all weighted rows, with its gradient and Gauss and Newton's Hessian.
  double evaluate(std::span<const double> units, std::span<double> gradient, Eigen::MatrixXd& hessian) const;

  /// Takes noise and its correlation from what is left of the rows near a point when the priors are let go, and weights
  /// by them from now on. @returns the relative change of the variance.
  double take_noise(std::span<const double> units);

  /// Noise of a channel of weight 1; variance unset when one channel stands alone.
  [[nodiscard]] const NoiseLevel& noise() const { return noise_; }

  /// The velocity that the channels' mean has where a condition speaks of it [m/s].
  [[nodiscard]] double velocity_of(const SensorCondition& condition, std::span<const double> accel_mps2) const;
  /// The velocity that a condition tells [m/s].
  [[nodiscard]] double known_velocity(const SensorCondition& condition, double wall_gain) const;

 private:
  struct Motion;
  struct Rows;
  struct Sums;
  [[nodiscard]] Rows channel_rows(const SensorState& state, const Motion& motion) const;
  [[nodiscard]] Rows wall_rows(const SensorState& state, const Motion& motion) const;
  void add_conditions(const SensorState& state, const Motion& motion, Sums& sums) const;
  [[nodiscard]] std::vector<double> quadrature(const SensorCondition& condition,
                                               std::span<const double> accel_mps2) const;
  [[nodiscard]] Eigen::MatrixXd condition_covariance(const SensorState& state,
                                                     std::span<const double> accel_mps2) const;
  [[nodiscard]] double total_variance() const;

  SensorProblem problem_;
  double least_variance_ = 0.0;  ///< Noise is never taken to be less.
  NoiseLevel noise_, wall_noise_;
  Eigen::MatrixXd condition_weights_;
};

}  // namespace crashsim
