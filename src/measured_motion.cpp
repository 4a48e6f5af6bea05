#include <crashsim/measured_motion.hpp>

#include <cmath>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <crashsim/option_values.hpp>
#include <crashsim/trace_io.hpp>

#include "channel_choice.hpp"

namespace crashsim {
namespace {

std::vector<const Trace*> station_channels(const TraceSet& set, const std::vector<std::string>& selectors,
                                           std::string_view flag) {
  std::vector<const Trace*> channels = chosen_channels(set, selectors);
  if (channels.empty())
    throw InvalidInput(fmt::format("{}: say which vertical channels are at the {} station; see crashsim info {}",
                                   set.path, flag, set.path));
  for (const Trace* channel : channels)
    if (channel->dimension != Dimension::length && channel->dimension != Dimension::speed)
      throw InvalidInput(fmt::format("{}: measures {}; a displacement or a velocity is needed",
                                     channel_label(set, *channel), dimension_name(channel->dimension)));
  return channels;
}

BodyStation station(double position_m, const std::vector<const Trace*>& channels, Dimension dimension) {
  BodyStation out{position_m, {}};
  for (const Trace* channel : channels)
    if (channel->dimension == dimension) out.traces.push_back(*channel);
  return out;
}

}  // namespace

MeasuredMotion read_motion(const MotionOptions& options) {
  validate_options(options, "MotionOptions");
  for (const auto place :
       {&MotionOptions::front_position_m, &MotionOptions::rear_position_m, &MotionOptions::cg_position_m})
    require_set(options, place, "MotionOptions", "there is a trace");
  const TraceSet set = read_traces(options.file, {{}, options.columns, options.units});
  const auto front = station_channels(set, options.front_channels, "front");
  const auto rear = station_channels(set, options.rear_channels, "rear");
  MeasuredMotion out;
  out.input_files = set.input_files;
  out.warnings = set.warnings;
  for (const auto& [dimension, heave, pitch] :
       {std::tuple(Dimension::length, &out.heave_m, &out.pitch_rad),
        std::tuple(Dimension::speed, &out.heave_velocity_mps, &out.pitch_rate_radps)}) {
    const BodyStation at_front = station(options.front_position_m, front, dimension);
    const BodyStation at_rear = station(options.rear_position_m, rear, dimension);
    if (at_front.traces.empty() && at_rear.traces.empty()) continue;
    if (at_front.traces.empty() || at_rear.traces.empty())
      throw InvalidInput(fmt::format("{}: the {} station has no {} channel, the other has: both are needed", set.path,
                                     at_front.traces.empty() ? "front" : "rear", dimension_name(dimension)));
    BodyMotion motion = body_motion(at_front, at_rear, options.cg_position_m, options.motion_sign);
    if (!std::isnan(options.time_zero_s))
      for (TimeSeries* series : {&motion.heave, &motion.pitch})
        for (double& t : series->time_s) t -= options.time_zero_s;
    *heave = std::move(motion.heave);
    *pitch = std::move(motion.pitch);
  }
  return out;
}

}  // namespace crashsim
