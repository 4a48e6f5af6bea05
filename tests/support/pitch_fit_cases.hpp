#pragma once
/// Measured motions that the identification tests of heave and pitch share.

#include <string>
#include <vector>

#include <crashsim/identify_pitch.hpp>

#include "support/pitch_cases.hpp"

namespace crashsim::test {

inline const std::vector<std::string> kSuspension = IdentifyPitchOptions().free;

/// What perfect instruments would record.
inline PitchTarget target_of(const PitchResponse& run) {
  return {{run.time_s, run.heave_m},
          {run.time_s, run.pitch_rad},
          {run.time_s, run.heave_velocity_mps},
          {run.time_s, run.pitch_rate_radps}};
}

/// From impact to `end_s`.
inline PitchOptions to(double end_s, double dt_s = 1e-3) {
  PitchOptions options;
  options.start.rule = PitchStart::impact;
  options.end_time_s = end_s;
  options.dt_s = dt_s;
  return options;
}

inline PitchForcing vertical_half_sine() { return {sampled_half_sine(40), {}, {}, kUnset}; }

/// The half sine, and a longitudinal force that grows and falls.
inline PitchForcing both_forces() {
  return {sampled_half_sine(40), {{0.0, 0.03, 0.09, 0.11}, {0.0, 3e5, 4e5, 0.0}}, {}, kUnset};
}

/// The oracle vehicle with heights.
inline HeavePitchModel vehicle_with_heights() {
  HeavePitchModel model = oracle_vehicle();
  model.cg_height_m = 0.62;
  model.force_height_m = 0.5;
  return model;
}

/// The same vehicle with other suspension: where identification starts.
inline HeavePitchModel wrong_suspension(HeavePitchModel model) {
  model.front_stiffness_n_per_m *= 2.0;
  model.rear_stiffness_n_per_m *= 0.5;
  model.front_damping_ns_per_m *= 3.0;
  model.rear_damping_ns_per_m *= 0.4;
  return model;
}

}  // namespace crashsim::test
