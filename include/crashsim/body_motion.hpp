#pragma once
/// Heave and pitch of the body from vertical traces at two or more places along it.

#include <span>
#include <string_view>
#include <vector>

#include <crashsim/options.hpp>
#include <crashsim/time_series.hpp>
#include <crashsim/trace.hpp>

namespace crashsim {

/// Which way vertical values count as positive: up, as in most finite-element runs, or down, as SAE J1733 has it for
/// vehicles.
enum class VerticalSign { up, down };
inline constexpr std::string_view kVerticalSignNames[] = {"up", "down"};
template <>
inline constexpr std::span<const std::string_view> enum_names<VerticalSign>{kVerticalSignNames};

/// Nodes or sensors at one place along the vehicle, such as the left and the right rear sill; their mean is taken.
struct BodyStation {
  double position_m = kUnset;  ///< Towards the front, from any reference [m].
  std::vector<Trace> traces;   ///< Vertical displacements, velocities or accelerations.
};

/// Heave, up positive, of the centre of gravity, and pitch, nose-down positive; rates of them from velocities.
struct BodyMotion {
  TimeSeries heave;  ///< [m], [m/s] or [m/s^2], as the traces.
  TimeSeries pitch;  ///< [rad], [rad/s] or [rad/s^2].
};

/// The body as a rigid one, for small angles: pitch = (z_rear - z_front) / distance, heave on the line through both.
/// @param cg_position_m of the centre of gravity, from the same reference as the stations.
/// @throws InvalidInput when a station has no trace, its place is not set or the front one is not
///         ahead of the rear one, or the traces are not
///         of one dimension and one clock.
BodyMotion body_motion(const BodyStation& front, const BodyStation& rear, double cg_position_m, VerticalSign sign);

}  // namespace crashsim
