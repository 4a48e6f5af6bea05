#pragma once
/// Corrections of a vehicle's accelerometers, so that they agree with each other and with what is known otherwise.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <crashsim/error.hpp>
#include <crashsim/load_cell_wall.hpp>
#include <crashsim/named_number.hpp>
#include <crashsim/options.hpp>
#include <crashsim/pulse.hpp>
#include <crashsim/sensor_correction_options.hpp>
#include <crashsim/trace.hpp>

namespace crashsim {

/// One channel: measured(t) = gain a(t - time_shift) + bias. Unset is what was not corrected.
struct ChannelCorrection {
  std::string channel;                      ///< "93 LEFT REAR SEAT CROSSMEMBER X".
  double bias_mps2 = kUnset;                ///< Beyond the offset before impact [m/s^2].
  double bias_error_mps2 = kUnset;          ///< Its standard error [m/s^2].
  double gain = kUnset;                     ///< Of the sensor.
  double gain_error = kUnset;               ///< Its standard error.
  double time_shift_s = kUnset;             ///< Positive where the channel is late [s].
  double time_shift_error_s = kUnset;       ///< Its standard error [s].
  double rms_before_mps2 = kUnset;          ///< Difference to the mean, root mean square over the window [m/s^2].
  double rms_after_mps2 = kUnset;           ///< The same of the corrected channel to the corrected mean.
  double end_velocity_before_mps = kUnset;  ///< At the window's end [m/s]; unset without impact speed.
  double end_velocity_after_mps = kUnset;   ///< The same of the corrected channel.
};
inline constexpr std::array<NamedNumber<ChannelCorrection>, 10> kChannelCorrectionNumbers = {{
    {"bias_mps2", &ChannelCorrection::bias_mps2, "bias"},
    {"bias_error_mps2", &ChannelCorrection::bias_error_mps2, "standard error of the bias"},
    {"gain", &ChannelCorrection::gain, "gain"},
    {"gain_error", &ChannelCorrection::gain_error, "standard error of the gain"},
    {"time_shift_s", &ChannelCorrection::time_shift_s, "time shift"},
    {"time_shift_error_s", &ChannelCorrection::time_shift_error_s, "standard error of the time shift"},
    {"rms_before_mps2", &ChannelCorrection::rms_before_mps2, "difference to the mean, before"},
    {"rms_after_mps2", &ChannelCorrection::rms_after_mps2, "difference to the mean, after"},
    {"end_velocity_before_mps", &ChannelCorrection::end_velocity_before_mps, "velocity at the end, before"},
    {"end_velocity_after_mps", &ChannelCorrection::end_velocity_after_mps, "velocity at the end, after"},
}};

/// A velocity that is known otherwise, and what the mean of the channels makes of it.
struct CorrectionCondition {
  std::string name;           ///< "velocity at 0.15 s", "rebound velocity", "velocity by the wall's impulse".
  double known_mps = kUnset;  ///< Of an impulse by the wall as it measured [m/s].
  double standard_deviation_mps = kUnset;          ///< Of it, with what the priors leave of the wall [m/s].
  double before_mps = kUnset, after_mps = kUnset;  ///< By the mean of the channels [m/s].
};

enum class CorrectionOutcome { not_run, completed, not_converged };
inline constexpr std::string_view kCorrectionOutcomeNames[] = {"not_run", "completed", "not_converged"};
template <>
inline constexpr std::span<const std::string_view> enum_names<CorrectionOutcome>{kCorrectionOutcomeNames};

/// What a correction gives.
struct SensorCorrection {
  CorrectionOutcome outcome = CorrectionOutcome::not_run;
  std::string message;
  std::vector<ChannelCorrection> channels;
  std::vector<CorrectionCondition> conditions;
  double wall_gain = kUnset, wall_gain_error = kUnset;  ///< Of the wall; unset without one, or where it is exact.
  double noise_mps2 = kUnset;          ///< Standard deviation of a channel of weight 1 about the common motion [m/s^2].
  double correlation_time_s = kUnset;  ///< Over which this noise is alike [s].
  std::vector<std::string> by_prior;   ///< Corrections of which the data leave more than half the prior's uncertainty.
  TraceSet corrected;                  ///< From impact on, not filtered: `accel_mps2`, their mean, then each channel.
  double time_zero_s = 0.0;            ///< Impact on the clock of the traces [s].
  std::vector<std::string> steps, warnings, input_files;

  [[nodiscard]] bool usable() const { return outcome == CorrectionOutcome::completed; }
  [[nodiscard]] std::string brief_report() const;
};

/// Corrects the accelerometers of one rigid compartment by weighted least squares. Their common motion is the weighted
/// mean of what they say; rows are each channel's differences to it (noise and its correlation in time taken from the
/// differences themselves), the velocities known, what the wall tells, and the priors. Channels are picked, turned
/// forward and freed of offset as for a pulse, and compared through its filter; the result is not filtered, and
/// make_pulse() takes it.
/// @param wall of the same test, its time zero that of `pulse`; may be null.
/// @throws InvalidInput when a channel is no accelerometer, nothing is known that could correct it, or what is needed
///         (impact speed for velocities, mass for a wall) is not known.
SensorCorrection correct_sensors(const TraceSet& traces, const PulseOptions& pulse = {},
                                 const SensorCorrectionOptions& options = {}, const LoadCellWall* wall = nullptr);

/// read_traces() of the channels that a pulse would need, and correct_sensors().
SensorCorrection read_sensor_correction(const std::string& path, const PulseOptions& pulse = {},
                                        const SensorCorrectionOptions& options = {},
                                        const LoadCellWall* wall = nullptr);

}  // namespace crashsim
