#pragma once
/// Options of the correction of accelerometers.

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include <crashsim/error.hpp>
#include <crashsim/options.hpp>

namespace crashsim {

/// What a load-cell wall is taken to tell: the change of momentum over the window, or the deceleration F/m at all
/// times.
enum class WallUse { impulse, force };
inline constexpr std::string_view kWallUseNames[] = {"impulse", "force"};
template <>
inline constexpr std::span<const std::string_view> enum_names<WallUse>{kWallUseNames};

/// What is corrected, how far it is believed as it is, and what else is known.
struct SensorCorrectionOptions {
  double bias_sd_mps2 = 2.0;             ///< Prior standard deviation of a channel's bias [m/s^2]; 0: not corrected.
  double gain_sd = 0.02;                 ///< Of its gain about 1; 0: not corrected.
  double time_shift_sd_s = 1e-4;         ///< Of its time shift [s]; 0: not corrected.
  double start_s = 0.0;                  ///< Channels are compared from here [s after impact]..
  double end_s = 0.15;                   ///< ..to here [s], or to the end of the record; impulse and rebound, too.
  std::vector<double> channel_weights;   ///< Of the channels in their order (1 / variance of noise); empty: all alike.
  std::vector<double> velocity_times_s;  ///< Times at which the velocity is known [s after impact].
  std::vector<double> velocities_mps;    ///< The velocities there [m/s].
  double rebound_velocity_mps = kUnset;  ///< The smallest velocity within the window [m/s]; unset: not known.
  double velocity_sd_mps = 0.1;          ///< Standard deviation of what is known of velocity, or by the impulse [m/s].
  WallUse wall_use = WallUse::impulse;   ///< What a wall is taken to tell.
  double wall_gain_sd = 0.02;            ///< Prior standard deviation of the wall's gain; 0: the wall is exact.

  bool operator==(const SensorCorrectionOptions&) const = default;
};
inline constexpr std::array<Field<SensorCorrectionOptions>, 12> kSensorCorrectionFields = {{
    {"bias_sd_mps2", "bias-sd", "m/s^2", "prior standard deviation of a channel's bias; 0: not corrected",
     &SensorCorrectionOptions::bias_sd_mps2, at_least(0.0)},
    {"gain_sd", "gain-sd", "", "prior standard deviation of a channel's gain about 1; 0: not corrected",
     &SensorCorrectionOptions::gain_sd, between(0.0, 0.09)},
    {"time_shift_sd_s", "shift-sd", "s", "prior standard deviation of a channel's time shift; 0: not corrected",
     &SensorCorrectionOptions::time_shift_sd_s, at_least(0.0)},
    {"start_s", "start", "s", "channels are compared from here on, after impact", &SensorCorrectionOptions::start_s,
     at_least(0.0)},
    {"end_s", "end", "s", "end of the comparison, of impulse and of rebound", &SensorCorrectionOptions::end_s,
     positive()},
    {"channel_weights", "weights", "", "weights of the channels in their order; default: all alike",
     &SensorCorrectionOptions::channel_weights, positive()},
    {"velocity_times_s", "velocity-at", "s", "times at which the velocity is known",
     &SensorCorrectionOptions::velocity_times_s, at_least(0.0)},
    {"velocities_mps", "velocity", "m/s", "the velocities there", &SensorCorrectionOptions::velocities_mps},
    {"rebound_velocity_mps", "rebound", "m/s", "smallest velocity within the window, <= 0",
     &SensorCorrectionOptions::rebound_velocity_mps, between(-100.0, 0.0)},
    {"velocity_sd_mps", "velocity-sd", "m/s", "standard deviation of the velocities known, and by the impulse",
     &SensorCorrectionOptions::velocity_sd_mps, positive()},
    {"wall_use", "wall-use", "", "what the wall tells: change of momentum, or F/m at all times",
     choice<&SensorCorrectionOptions::wall_use>()},
    {"wall_gain_sd", "wall-gain-sd", "", "prior standard deviation of the wall's gain about 1; 0: exact",
     &SensorCorrectionOptions::wall_gain_sd, between(0.0, 0.09)},
}};
template <>
inline constexpr std::span<const Field<SensorCorrectionOptions>> fields<SensorCorrectionOptions>{
    kSensorCorrectionFields};

}  // namespace crashsim
