#pragma once
/// Measured heave and pitch of the body, from the vertical channels of a trace file.

#include <array>
#include <string>
#include <vector>

#include <crashsim/body_motion.hpp>
#include <crashsim/error.hpp>
#include <crashsim/options.hpp>
#include <crashsim/time_series.hpp>

namespace crashsim {

/// Which channels are vertical displacements or velocities, and where on the body they are. Positions are towards the
/// front, all from one reference.
struct MotionOptions {
  std::string file;                         ///< The trace.
  std::vector<std::string> front_channels;  ///< At the front station; displacements, velocities or both.
  std::vector<std::string> rear_channels;   ///< At the rear station.
  double front_position_m = kUnset;         ///< Of the front station [m].
  double rear_position_m = kUnset;          ///< Of the rear station [m].
  double cg_position_m = kUnset;            ///< Of the centre of gravity [m].
  double time_zero_s = kUnset;  ///< Impact on the file's clock [s]; unset: 0, in a case the pulse's of the same file.
  VerticalSign motion_sign = VerticalSign::up;
  std::string columns, units;  ///< As in ReadOptions.

  bool operator==(const MotionOptions&) const = default;
};
inline constexpr std::array<Field<MotionOptions>, 10> kMotionFields = {{
    {"file", "motion", "", "trace with the body's vertical motion", &MotionOptions::file},
    {"front_channels", "front", "", "vertical displacements and velocities at the front station",
     &MotionOptions::front_channels},
    {"rear_channels", "rear", "", "the same at the rear station", &MotionOptions::rear_channels},
    {"front_position_m", "front-position", "m", "place of the front station, counted towards the front",
     &MotionOptions::front_position_m},
    {"rear_position_m", "rear-position", "m", "place of the rear station, from the same reference",
     &MotionOptions::rear_position_m},
    {"cg_position_m", "cg-position", "m", "place of the centre of gravity, from the same reference",
     &MotionOptions::cg_position_m},
    {"time_zero_s", "motion-t0", "s", "time of impact in that trace; default 0", &MotionOptions::time_zero_s},
    {"motion_sign", "motion-sign", "", "which way vertical channels are positive",
     choice<&MotionOptions::motion_sign>()},
    {"columns", "motion-columns", "", "columns of a CSV file: time:ms,z:mm", &MotionOptions::columns},
    {"units", "motion-units", "", "unit system of FE output: kg-m-s, t-mm-s, kg-mm-ms, g-mm-ms", &MotionOptions::units},
}};
template <>
inline constexpr std::span<const Field<MotionOptions>> fields<MotionOptions>{kMotionFields};

/// Heave (up positive) of the centre of gravity and pitch (nose-down positive); what no channel measures is empty.
struct MeasuredMotion {
  TimeSeries heave_m, pitch_rad;                    ///< From displacements.
  TimeSeries heave_velocity_mps, pitch_rate_radps;  ///< From velocities.
  std::vector<std::string> warnings;                ///< What a careful reader should know.
  std::vector<std::string> input_files;             ///< Every file read.
};

/// Reads heave and pitch, as body_motion() makes them.
/// @throws InvalidInput naming file and channel when it cannot be read, a station has no channel or no place, a channel
///         measures neither a displacement nor a velocity, or the other station lacks its like.
MeasuredMotion read_motion(const MotionOptions& options);

}  // namespace crashsim
