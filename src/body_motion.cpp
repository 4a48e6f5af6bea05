#include <crashsim/body_motion.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <crashsim/signal.hpp>

namespace crashsim {
namespace {

void check(const BodyStation& station, std::string_view name, const Trace& first) {
  if (!std::isfinite(station.position_m))
    throw InvalidInput(fmt::format("BodyStation {}: position_m = {} m: must be finite", name, station.position_m));
  for (const Trace& trace : station.traces) {
    check_series(trace.times(), trace.values, fmt::format("BodyStation {}: channel {} {}", name, trace.id, trace.name),
                 2);
    if (trace.dimension != first.dimension)
      throw InvalidInput(
          fmt::format("BodyStation {}: channel {} {} is {} but channel {} {} is {}: give displacements, "
                      "velocities or accelerations only",
                      name, trace.id, trace.name, dimension_name(trace.dimension), first.id, first.name,
                      dimension_name(first.dimension)));
    if (!std::ranges::equal(trace.times(), first.times()))
      throw InvalidInput(
          fmt::format("BodyStation {}: channel {} {} has other times than channel {} {}: resample them "
                      "to one clock",
                      name, trace.id, trace.name, first.id, first.name));
  }
}

/// Mean of the traces, up positive.
std::vector<double> mean_of(const BodyStation& station, VerticalSign sign) {
  const double share = (sign == VerticalSign::up ? 1.0 : -1.0) / static_cast<double>(station.traces.size());
  std::vector<double> mean(station.traces.front().values.size());
  for (const Trace& trace : station.traces)
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += share * trace.values[i];
  return mean;
}

}  // namespace

BodyMotion body_motion(const BodyStation& front, const BodyStation& rear, double cg_position_m, VerticalSign sign) {
  for (const auto& [station, name] : {std::pair(&front, "front"), std::pair(&rear, "rear")})
    if (station->traces.empty()) throw InvalidInput(fmt::format("BodyStation {}: no trace given", name));
  const Trace& first = front.traces.front();
  check(front, "front", first);
  check(rear, "rear", first);
  if (!std::isfinite(cg_position_m))
    throw InvalidInput(fmt::format("body_motion: cg_position_m = {} m: must be finite", cg_position_m));
  const double distance = front.position_m - rear.position_m;
  if (!(distance > 0.0))
    throw InvalidInput(fmt::format("BodyStation front: position_m = {} m: must be ahead of the rear one's {} m",
                                   front.position_m, rear.position_m));
  const std::vector<double> z_front = mean_of(front, sign), z_rear = mean_of(rear, sign);
  const double cg_from_rear = cg_position_m - rear.position_m;
  const std::vector<double> times(first.times().begin(), first.times().end());
  BodyMotion motion{{times, {}}, {times, {}}};
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double pitch = (z_rear[i] - z_front[i]) / distance;
    motion.pitch.values.push_back(pitch);
    motion.heave.values.push_back(z_rear[i] - cg_from_rear * pitch);
  }
  return motion;
}

}  // namespace crashsim
