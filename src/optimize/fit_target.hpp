#pragma once
/// What a model is fitted to: samples 0..t_m of a pulse with the weights of their residuals.

#include <string>
#include <vector>

#include <crashsim/identify.hpp>

namespace crashsim {

/// E = factor * sum over samples and channels of loss(scale * residual), [Noorsumar2021] eq. (4).
struct FitTarget {
  std::vector<double> time_s, accel_mps2, velocity_mps, displacement_m;
  double mass_kg = kUnset, impact_speed_mps = kUnset, max_crush_m = kUnset;
  double accel_scale = kUnset, velocity_scale = kUnset, displacement_scale = kUnset;
  double accel_size = kUnset, velocity_size = kUnset, displacement_size = kUnset;  ///< scale * max|channel|.
  double factor = kUnset;
};

/// Why a pulse without t_m cannot be fitted.
std::string no_max_crush_message(const Pulse& pulse);

/// Samples 0..t_m of a pulse. @throws InvalidInput when its arrays do not fit together, it has no t_m, speed or mass,
/// or fewer than 10 samples to t_m.
FitTarget make_target(const Pulse& pulse, double mass_kg, const Setting<Weights>& weights);

/// A loss and its derivative at a scaled residual.
struct LossValue {
  double value, derivative;
};

inline constexpr double kHuberThreshold = 0.05;

/// `smoothing` > 0 rounds the corner of |u|: sqrt(u^2 + s^2) - s.
LossValue loss_value(Loss loss, double u, double smoothing);

}  // namespace crashsim
