#include <crashsim/measured_vertical.hpp>

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/trace_io.hpp>

#include "channel_choice.hpp"

namespace crashsim {
namespace {

/// Mean of the channels, turned so that it grows to a positive value.
TimeSeries mean_crush(const TraceSet& set, const std::vector<const Trace*>& channels, std::vector<std::string>& steps) {
  const Trace& first = *channels.front();
  TimeSeries crush{{first.times().begin(), first.times().end()}, std::vector<double>(first.values.size())};
  for (const Trace* channel : channels) {
    if (channel->dimension != Dimension::length)
      throw InvalidInput(fmt::format("{}: measures {}; a displacement is needed", channel_label(set, *channel),
                                     dimension_name(channel->dimension)));
    if (!std::ranges::equal(channel->times(), first.times()))
      throw InvalidInput(fmt::format("{}: has other times than {}: take channels of one clock",
                                     channel_label(set, *channel), channel_label(set, first)));
    for (std::size_t i = 0; i < crush.values.size(); ++i)
      crush.values[i] += channel->values[i] / static_cast<double>(channels.size());
  }
  const auto [smallest, largest] = std::ranges::minmax(crush.values);
  if (largest < -smallest) {
    for (double& value : crush.values) value = -value;
    steps.emplace_back("crush: sign turned, so that it is positive");
  }
  return crush;
}

}  // namespace

MeasuredVertical read_vertical_target(const ForcingOptions& forces, const CrushChannelOptions& crush) {
  MeasuredForcing measured = read_forcing(forces);
  MeasuredVertical out{
      {std::move(measured.forcing.vertical_force_n), std::move(measured.forcing.longitudinal_force_n), {}},
      std::move(measured.steps),
      std::move(measured.warnings),
      std::move(measured.input_files)};
  for (const auto& [series, name, option] :
       {std::tuple(&out.target.vertical_force_n, "vertical", "channel"),
        std::tuple(&out.target.longitudinal_force_n, "longitudinal", "longitudinal")})
    if (series->empty())
      throw InvalidInput(fmt::format("{}: say which channels are the {} force, too ({}); see crashsim info {}",
                                     forces.file, name, option, forces.file));
  const TraceSet set = read_traces(forces.file, {{}, forces.columns, forces.units});
  const std::vector<std::string> own = {"displacement_m"};
  const auto channels = chosen_channels(set, crush.crush_channels.empty() ? own : crush.crush_channels);
  out.target.crush_m = mean_crush(set, channels, out.steps);
  return out;
}

}  // namespace crashsim
