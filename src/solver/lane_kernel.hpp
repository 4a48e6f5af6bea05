#pragma once
/// One Taylor step of several motions at once, a motion a lane, and the sampling of a step: the inner loops of
/// simulate_many(), in the widest instructions the machine has.
///
/// A lane's numbers depend on that lane only and are computed by the same operations whatever the width, so that every
/// instruction set gives bitwise the same.

#include <cstddef>
#include <cstdint>

namespace crashsim {

inline constexpr std::size_t kMotions = 8;  ///< Lanes of a block.
inline constexpr int kLaneDegree = 10;      ///< Of the series: cheapest of 8..12 at the default accuracy.
using LaneNumbers = double[kMotions];

/// What ends the step of a lane. `unclear`: the force is too near zero, or may change its sign inside: first_event()
/// decides.
enum class LaneEnd : std::int64_t { step, damper_below, damper_above, spring_below, spring_above, unclear };

/// dv/dt = constant + x1 x + x2 x^2 + v1 v + v2 v^2 + xv x v within a segment.
struct alignas(64) LaneForce {
  LaneNumbers constant{}, x1{}, x2{}, v1{}, v2{}, xv{};
};

/// A step of each lane.
struct alignas(64) LaneBlock {
  // Given:
  LaneForce force;
  LaneNumbers x_from{}, v_from{};                    ///< State at the start.
  LaneNumbers remaining{};                           ///< Longest step [s].
  LaneNumbers tolerance{};                           ///< Error allowed [m/s].
  LaneNumbers margin{};                              ///< Rounding of v [m/s].
  LaneNumbers x_low{}, x_high{}, v_low{}, v_high{};  ///< Bounds of the segments.
  LaneNumbers bilateral{};                           ///< 1: the force may pull.
  // Found:
  LaneNumbers x[kLaneDegree + 1]{}, v[kLaneDegree + 1]{};  ///< Series about the start.
  LaneNumbers length{};                                    ///< Of the step.
  LaneNumbers tau{};                                       ///< Where it ends, at an event or its length.
  LaneNumbers x_to{}, v_to{};                              ///< State there.
  std::int64_t end[kMotions]{};                            ///< LaneEnd
  // Given, too; last, so that the numbers stay aligned:
  bool has_xv = false;  ///< A lane may have an xv other than 0.
};

/// Samples of one lane's step: motion at times[i] - base for i below `count`; up to kMotions - 1 values after them are
/// overwritten, too.
struct LaneSamples {
  const double* times;
  std::size_t count;
  double base, tau_end;
  double *accel, *velocity, *displacement;
};

struct LaneKernel {
  void (*advance)(LaneBlock& block);
  void (*sample)(const LaneBlock& block, std::size_t lane, const LaneSamples& samples);
};

extern const LaneKernel kLaneKernelBaseline, kLaneKernelAvx2, kLaneKernelAvx512;

}  // namespace crashsim
