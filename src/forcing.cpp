#include <crashsim/forcing.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/option_values.hpp>
#include <crashsim/pulse.hpp>
#include <crashsim/signal.hpp>
#include <crashsim/trace_io.hpp>

#include "channel_choice.hpp"
#include "force_rows.hpp"

namespace crashsim {
namespace {

constexpr double kImpulseCfc = 60.0;  // SAE J211: barrier forces

using Names = std::vector<std::string>;

/// One file's channels on their way to forces.
class Source {
 public:
  Source(const TraceSet& set, const ForcingOptions& options, MeasuredForcing& out)
      : set_(set), options_(options), out_(out) {}

  [[nodiscard]] std::vector<const Trace*> pick(const Names& selectors) const {
    return chosen_channels(set_, selectors);
  }

  [[nodiscard]] const Trace* find(std::string_view name) const {
    const auto found = std::find_if(set_.traces.begin(), set_.traces.end(),
                                    [&](const Trace& trace) { return trace.name == name && trace.has_samples; });
    return found == set_.traces.end() ? nullptr : &*found;
  }

  /// A channel as a force: an impulse is differentiated; filtered as the options say.
  [[nodiscard]] TimeSeries force(const Trace& trace) const {
    const bool is_impulse = trace.dimension == Dimension::impulse;
    if (!is_impulse && trace.dimension != Dimension::force)
      throw InvalidInput(fmt::format("{}: measures {}; a force or an impulse is needed", what(trace),
                                     dimension_name(trace.dimension)));
    TimeSeries series{{trace.times().begin(), trace.times().end()}, trace.values};
    if (is_impulse) series.values = differentiate(series.time_s, series.values);
    const double cfc = std::isnan(options_.cfc) ? (is_impulse ? kImpulseCfc : 0.0) : options_.cfc;
    const std::string done = filter(series, cfc, trace);
    out_.steps.push_back(fmt::format("channel {}: {}{}", trace.name, is_impulse ? "impulse differentiated" : "force",
                                     done.empty() ? "" : ", " + done));
    return series;
  }

  [[nodiscard]] std::string what(const Trace& trace) const { return channel_label(set_, trace); }

 private:
  /// Filters in place, on uniform steps. @returns what was done.
  [[nodiscard]] std::string filter(TimeSeries& series, double cfc, const Trace& trace) const {
    if (!(cfc > 0.0)) return {};
    std::string resampled;
    double dt_s = uniform_step(series.time_s);
    if (std::isnan(dt_s)) {
      dt_s = (series.time_s.back() - series.time_s.front()) / static_cast<double>(series.time_s.size() - 1);
      std::vector<double> uniform = uniform_times(series.time_s.front(), dt_s, series.time_s.size());
      uniform.back() = series.time_s.back();
      series.values = resample(series.time_s, series.values, uniform);
      series.time_s = std::move(uniform);
      resampled = fmt::format("resampled to steps of {:.6g} s, ", dt_s);
    }
    try {
      series.values = cfc_filter(series.values, dt_s, cfc);
    } catch (const InvalidInput& problem) {
      throw InvalidInput(fmt::format("{}: {}", what(trace), problem.what()));
    }
    return fmt::format("{}filtered by CFC{:g}", resampled, cfc);
  }

  const TraceSet& set_;
  const ForcingOptions& options_;
  MeasuredForcing& out_;
};

void turn(TimeSeries& force) {
  for (double& value : force.values) value = -value;
}

void set_longitudinal(const Source& source, const std::vector<const Trace*>& channels, const ForcingOptions& options,
                      const std::string& path, MeasuredForcing& out) {
  const std::vector<double>& heights = options.row_heights_m;
  if (channels.empty() && !heights.empty())
    throw InvalidInput(
        fmt::format("{}: row_heights_m are given, but no longitudinal channels that they belong to", path));
  if (channels.empty()) return;
  if (!heights.empty() && heights.size() != channels.size())
    throw InvalidInput(fmt::format("{}: row_heights_m has {} heights for {} longitudinal channels: one each is needed",
                                   path, heights.size(), channels.size()));
  ForceRows rows;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const TimeSeries force = source.force(*channels[i]);
    add_force(rows.force, force, 1.0, source.what(*channels[i]));
    if (!heights.empty()) add_force(rows.moment, force, heights[i], source.what(*channels[i]));
  }
  if (turn_to_stop(rows)) out.steps.emplace_back("longitudinal force: sign turned, so that it stops the vehicle");
  if (!heights.empty()) out.forcing.force_height_m = height_of(rows, heights, path, out.warnings);
  out.forcing.longitudinal_force_n = std::move(rows.force);
}

/// Time at which velocities, turned to start positive, come to zero in their mean; unset when they do not.
double end_of_velocity(const Source& source, const std::vector<const Trace*>& channels) {
  TimeSeries sum;
  for (const Trace* channel : channels) {
    if (channel->dimension != Dimension::speed)
      throw InvalidInput(fmt::format("{}: measures {}; a velocity is needed", source.what(*channel),
                                     dimension_name(channel->dimension)));
    add_force(sum, {{channel->times().begin(), channel->times().end()}, channel->values}, 1.0, source.what(*channel));
  }
  if (sum.values.front() < 0.0) turn(sum);
  return find_max_crush(sum.time_s, differentiate(sum.time_s, sum.values), sum.values,
                        integrate(sum.time_s, sum.values, 0.0))
      .t_m_s;
}

/// The time of maximum crush: given, or where velocities end that are named or our own.
void set_t_m(const Source& source, const ForcingOptions& options, MeasuredForcing& out) {
  out.forcing.t_m_s = options.t_m_s;
  const bool is_named = !options.velocity_channels.empty();
  if (!std::isnan(options.t_m_s) || (!is_named && source.find("velocity_mps") == nullptr)) return;
  const std::vector<const Trace*> channels = source.pick(is_named ? options.velocity_channels : Names{"velocity_mps"});
  const double end_s = end_of_velocity(source, channels);
  if (std::isnan(end_s)) {
    if (is_named)
      throw InvalidInput(
          fmt::format("{}: does not come from a speed to zero, so there is no time of maximum crush: give "
                      "t_m or another velocity, or start at impact or a time",
                      source.what(*channels.front())));
    return;
  }
  out.forcing.t_m_s = end_s - (std::isnan(options.time_zero_s) ? 0.0 : options.time_zero_s);
  out.steps.push_back(fmt::format("time of maximum crush: {:.6g} s, where the velocity ends", out.forcing.t_m_s));
}

/// Puts every series on a clock that starts at impact.
void start_at_impact(double time_zero_s, MeasuredForcing& out) {
  if (std::isnan(time_zero_s) || time_zero_s == 0.0) return;
  for (TimeSeries* series :
       {&out.forcing.vertical_force_n, &out.forcing.longitudinal_force_n, &out.forcing.force_height_m})
    for (double& t : series->time_s) t -= time_zero_s;
  out.steps.push_back(fmt::format("forces: impact is at {:.6g} s of their trace", time_zero_s));
}

/// Selectors, or the names that crashsim writes.
Names or_own(const Names& selectors, bool is_default, const Source& source, const Names& own) {
  if (!selectors.empty() || !is_default) return selectors;
  Names found;
  for (const std::string& name : own)
    if (source.find(name) != nullptr) found.push_back(name);
  return found;
}

}  // namespace

MeasuredForcing read_forcing(const ForcingOptions& options) {
  validate_options(options, "ForcingOptions");
  const std::string& path = options.file;
  const TraceSet set = read_traces(path, {{}, options.columns, options.units});
  MeasuredForcing out;
  out.input_files = set.input_files;
  out.warnings = set.warnings;
  const Source source(set, options, out);
  const bool is_default = options.vertical_channels.empty() && options.longitudinal_channels.empty();
  Names along = or_own(options.longitudinal_channels, is_default, source, {"longitudinal_force_n"});
  if (along.empty()) along = or_own({}, is_default, source, {"total_force_n"});
  if (along.empty()) along = or_own({}, is_default, source, {"spring_force_n", "damper_force_n"});
  for (const Trace* trace : source.pick(or_own(options.vertical_channels, is_default, source, {"vertical_force_n"})))
    add_force(out.forcing.vertical_force_n, source.force(*trace),
              options.vertical_sign == VerticalSign::up ? -1.0 : 1.0, source.what(*trace));
  set_longitudinal(source, source.pick(along), options, path, out);
  if (out.forcing.vertical_force_n.empty() && out.forcing.longitudinal_force_n.empty())
    throw InvalidInput(
        fmt::format("{}: say which channels are the vertical force (channel) or the longitudinal force "
                    "(longitudinal); see crashsim info {}",
                    path, path));
  for (const Trace* trace : source.pick(or_own(options.height_channel, is_default, source, {"force_height_m"}))) {
    if (trace->dimension != Dimension::length)
      throw InvalidInput(fmt::format("{}: measures {}; a height in m is needed", source.what(*trace),
                                     dimension_name(trace->dimension)));
    if (!out.forcing.force_height_m.empty())
      throw InvalidInput(fmt::format("{}: the height of the force is given twice: one channel or row_heights_m", path));
    out.forcing.force_height_m = {{trace->times().begin(), trace->times().end()}, trace->values};
  }
  set_t_m(source, options, out);
  start_at_impact(options.time_zero_s, out);
  return out;
}

PitchForcing forcing_of(const CrushResponse& response) {
  PitchForcing forcing;
  forcing.longitudinal_force_n.time_s = response.time_s;
  for (std::size_t i = 0; i < response.time_s.size(); ++i)
    forcing.longitudinal_force_n.values.push_back(response.spring_force_n[i] + response.damper_force_n[i]);
  forcing.t_m_s = response.t_m_s;
  return forcing;
}

}  // namespace crashsim
