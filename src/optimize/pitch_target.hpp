#pragma once
/// What a heave-pitch model is fitted to: samples of its channels in a window, with the weights of their residuals.

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include <crashsim/identify_pitch.hpp>

#include "solver/propagator.hpp"

namespace crashsim {

/// Channels that can be fitted; the index in the table is that in PitchState.
struct PitchChannel {
  std::string_view name;
  TimeSeries PitchTarget::*series;
  double PitchFitError::*error;
};
inline constexpr std::array<PitchChannel, 4> kPitchChannels = {{
    {"heave_m", &PitchTarget::heave_m, &PitchFitError::heave},
    {"pitch_rad", &PitchTarget::pitch_rad, &PitchFitError::pitch},
    {"heave_velocity_mps", &PitchTarget::heave_velocity_mps, &PitchFitError::heave_velocity},
    {"pitch_rate_radps", &PitchTarget::pitch_rate_radps, &PitchFitError::pitch_rate},
}};

/// One value of one channel.
struct PitchSample {
  std::size_t time = 0;     ///< Index in PitchFitTarget::times.
  std::size_t channel = 0;  ///< Index in kPitchChannels.
  double value = kUnset;
};

/// E = sum over samples of factor loss(scale residual), with scale and factor of the sample's channel.
struct PitchFitTarget {
  double start_s = kUnset;                        ///< Start of the motion.
  std::vector<double> times;                      ///< Of all samples, strictly increasing, from the start on [s].
  std::vector<PitchSample> samples;               ///< In order of time, then channel.
  std::array<double, 4> scale = {}, factor = {};  ///< 1 / max|target| and 1 / count; 0 where there is no channel.
  PitchState initial = PitchState::Zero();        ///< At the start.
};

/// @throws InvalidInput when no channel is given, one is bad, has no sample in the window or is zero there.
PitchFitTarget make_pitch_target(const HeavePitchModel& model, const PitchForcing& forcing, const PitchTarget& target,
                                 const PitchOptions& simulation, const IdentifyPitchOptions& options);

/// E of a motion known at target.times, by channel.
PitchFitError pitch_fit_error(const PitchFitTarget& target, const std::vector<PitchState>& motion, Loss loss);

}  // namespace crashsim
