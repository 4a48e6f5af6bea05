#pragma once
/// What drives heave and pitch, taken from traces or from a simulated crush.

#include <array>
#include <string>
#include <vector>

#include <crashsim/body_motion.hpp>
#include <crashsim/options.hpp>
#include <crashsim/simulate.hpp>
#include <crashsim/simulate_pitch.hpp>
#include <crashsim/trace.hpp>

namespace crashsim {

/// Which channels are the forces. A force may be an impulse in its file (rigid walls of finite-element codes): it is
/// differentiated. Several channels add up.
struct ForcingOptions {
  std::string file;                                 ///< The trace.
  std::vector<std::string> vertical_channels;       ///< Barrier's vertical force on the vehicle; empty: none.
  VerticalSign vertical_sign = VerticalSign::down;  ///< Where a positive one pushes.
  std::vector<std::string> longitudinal_channels;   ///< Longitudinal force; empty: none. Either sign: it stops.
  std::vector<double> row_heights_m;  ///< Heights of the longitudinal channels (load-cell rows), which give the force's
                                      ///< height over time [m]; empty: the vehicle's force_height_m.
  std::vector<std::string> height_channel;  ///< Channel of the force's height instead, at most one.
  double cfc = kUnset;  ///< Filter of the forces [Hz]; 0: none; unset: 60 for differentiated impulses, none for forces.
  double t_m_s = kUnset;                       ///< Time of maximum crush [s]; unset: where the velocity ends.
  std::vector<std::string> velocity_channels;  ///< Longitudinal velocity of the vehicle (averaged), either sign; empty:
                                               ///< `velocity_mps` where the file has it.
  double time_zero_s = kUnset;  ///< Impact on the file's clock [s]; unset: 0, in a case the pulse's of the same file.
  std::string columns, units;   ///< As in ReadOptions.

  bool operator==(const ForcingOptions&) const = default;
};
inline constexpr std::array<Field<ForcingOptions>, 12> kForcingFields = {{
    {"file", "force", "", "trace with the barrier's force, or a response.csv", &ForcingOptions::file},
    {"vertical_channels", "channel", "", "channels of the vertical force on the vehicle (summed)",
     &ForcingOptions::vertical_channels},
    {"vertical_sign", "vertical-sign", "", "where a positive vertical force pushes the vehicle",
     choice<&ForcingOptions::vertical_sign>()},
    {"longitudinal_channels", "longitudinal", "", "channels of the longitudinal force (summed)",
     &ForcingOptions::longitudinal_channels},
    {"row_heights_m", "row-heights", "m", "heights of the longitudinal channels, rows of a load-cell wall",
     &ForcingOptions::row_heights_m},
    {"height_channel", "height", "", "channel of the force's height, where the file has one",
     &ForcingOptions::height_channel},
    {"cfc", "cfc", "Hz", "filter of the forces, 0: none; default: 60 for differentiated impulses, none for forces",
     &ForcingOptions::cfc, at_least(0.0)},
    {"t_m_s", "t-m", "s", "time of maximum crush; default: where the velocity ends", &ForcingOptions::t_m_s,
     positive()},
    {"velocity_channels", "velocity", "", "channels of the vehicle's longitudinal velocity (averaged)",
     &ForcingOptions::velocity_channels},
    {"time_zero_s", "force-t0", "s", "time of impact in that trace; default 0", &ForcingOptions::time_zero_s},
    {"columns", "columns", "", "columns of a CSV file: time:ms,force:kN", &ForcingOptions::columns},
    {"units", "units", "", "unit system of FE output: kg-m-s, t-mm-s, kg-mm-ms, g-mm-ms", &ForcingOptions::units},
}};
template <>
inline constexpr std::span<const Field<ForcingOptions>> fields<ForcingOptions>{kForcingFields};

/// Forcing with what was done to get it.
struct MeasuredForcing {
  PitchForcing forcing;
  std::vector<std::string> steps;        ///< In the order they were done.
  std::vector<std::string> warnings;     ///< What a careful reader should know.
  std::vector<std::string> input_files;  ///< Every file read.
};

/// Forcing from a trace file. Without channels named, those called `vertical_force_n`, `longitudinal_force_n` and
/// `force_height_m`, or the total force of a wall.csv, or the spring and damper force of a response.csv, are taken.
/// @throws InvalidInput naming file and channel when it cannot be read, has no such channel or none to take, or a
///         channel is no force, impulse or height.
MeasuredForcing read_forcing(const ForcingOptions& options);

/// The longitudinal force of a simulated crush, with its time of maximum crush.
PitchForcing forcing_of(const CrushResponse& response);

}  // namespace crashsim
