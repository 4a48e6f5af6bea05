#pragma once
/// Measured forces and crush, from which the law of the vertical force is identified, from a trace file.

#include <array>
#include <string>
#include <vector>

#include <crashsim/forcing.hpp>
#include <crashsim/identify_vertical.hpp>
#include <crashsim/options.hpp>

namespace crashsim {

/// Which channels are the crush.
struct CrushChannelOptions {
  /// Displacements of the compartment, averaged, either sign; empty: `displacement_m`.
  std::vector<std::string> crush_channels;

  bool operator==(const CrushChannelOptions&) const = default;
};
inline constexpr std::array<Field<CrushChannelOptions>, 1> kCrushChannelFields = {{
    {"crush_channels", "crush", "", "channels of the compartment's longitudinal displacement (averaged, either sign)",
     &CrushChannelOptions::crush_channels},
}};
template <>
inline constexpr std::span<const Field<CrushChannelOptions>> fields<CrushChannelOptions>{kCrushChannelFields};

/// Forces and crush with what was done to get them.
struct MeasuredVertical {
  VerticalForceTarget target;
  std::vector<std::string> steps;        ///< In the order they were done.
  std::vector<std::string> warnings;     ///< What a careful reader should know.
  std::vector<std::string> input_files;  ///< Every file read.
};

/// Forces as read_forcing() reads them, and the crush from the same file.
/// @throws InvalidInput naming file and channel when it cannot be read, lacks a force or the crush, or a channel is
/// none.
MeasuredVertical read_vertical_target(const ForcingOptions& forces, const CrushChannelOptions& crush);

}  // namespace crashsim
