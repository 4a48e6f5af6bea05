#include "pulse_channels.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <crashsim/error.hpp>
#include <crashsim/signal.hpp>

#include "io/reader.hpp"

namespace crashsim {
namespace {

constexpr std::size_t kFewestSamples = 10;
constexpr double kSameClock = 1e-6;  // of a step

std::string label_of(const Trace& trace) { return fmt::format("{} {}", trace.id, trace.name); }

/// "93 (LEFT REAR SEAT CROSSMEMBER X), 94 (..)": good channels of acceleration, X first.
std::string usable_channels(const TraceSet& set) {
  constexpr std::size_t kMost = 8;
  std::vector<std::string> along_x, others;
  for (const Trace& trace : set.traces)
    if (trace.problem.empty() && trace.dimension == Dimension::acceleration)
      (trace.axis == 'X' ? along_x : others).push_back(fmt::format("{} ({})", trace.id, trace.name));
  along_x.insert(along_x.end(), others.begin(), others.end());
  if (along_x.empty()) return "none";
  const bool more = along_x.size() > kMost;
  along_x.resize(std::min(along_x.size(), kMost));
  return fmt::format("{}{}", fmt::join(along_x, ", "), more ? ", ..." : "");
}

std::vector<std::size_t> pick(const TraceSet& set, const PulseOptions& options) {
  std::vector<std::size_t> indices;
  if (options.channels.empty()) {
    indices = default_channels(set);
  } else {
    ReadOptions named;
    named.channels = options.channels;
    indices = io::channels_named_by(named, set);
  }
  if (indices.empty())
    throw InvalidInput(
        fmt::format("{}: say which channels measure the vehicle's longitudinal motion (--channel); "
                    "acceleration channels: {}",
                    set.path, usable_channels(set)));
  return indices;
}

void check(const Trace& trace, const TraceSet& set) {
  const std::string what = fmt::format("{}: channel {}", set.path, label_of(trace));
  if (!trace.problem.empty())
    throw InvalidInput(
        fmt::format("{}: {}; choose others with --channel: {}", what, trace.problem, usable_channels(set)));
  if (!trace.has_samples) throw InvalidInput(fmt::format("{}: its samples were not read", what));
  if (trace.dimension == Dimension::unknown)
    throw InvalidInput(fmt::format("{}: its unit{} is unknown; say it, for example columns = time:s,accel:g", what,
                                   trace.source_unit.empty() ? "" : fmt::format(" '{}'", trace.source_unit)));
  if (trace.dimension != Dimension::acceleration && trace.dimension != Dimension::speed)
    throw InvalidInput(fmt::format("{}: measures {}; a pulse is made from acceleration or velocity", what,
                                   dimension_name(trace.dimension)));
  check_series(trace.times(), trace.values, what, kFewestSamples);
}

void check_alike(const Trace& first, const Trace& other, const TraceSet& set) {
  if (first.dimension != other.dimension)
    throw InvalidInput(fmt::format("{}: channel {} measures {}, channel {} {}: average channels of one kind", set.path,
                                   label_of(first), dimension_name(first.dimension), label_of(other),
                                   dimension_name(other.dimension)));
  if (first.axis != other.axis && first.axis != ' ' && other.axis != ' ')
    throw InvalidInput(fmt::format("{}: channel {} is along {}, channel {} along {}: average channels of one direction",
                                   set.path, label_of(first), first.axis, label_of(other), other.axis));
}

/// Whether times are start + i dt but for rounding.
bool is_regular(std::span<const double> time_s, double dt_s) {
  for (std::size_t i = 0; i < time_s.size(); ++i)
    if (std::abs(time_s[i] - time_s.front() - static_cast<double>(i) * dt_s) > kSameClock * dt_s) return false;
  return true;
}

/// Sets the common clock: the first channel's where that is uniform, else one with its mean step. Returns whether the
/// first channel's samples fit it as they are.
bool set_clock(const Trace& first, PulseChannels& result) {
  const auto times = first.times();
  const double step_s = uniform_step(times);
  const double mean_s = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  result.dt_s = mean_s;
  if (!std::isnan(step_s) && is_regular(times, step_s)) {
    result.time_s.assign(times.begin(), times.end());
    return true;
  }
  result.time_s = uniform_times(times.front(), mean_s, times.size());
  result.steps.push_back(
      std::isnan(step_s)
          ? fmt::format("resampled: steps of the trace are not uniform; linear onto a uniform step of {:.6g} s", mean_s)
          : fmt::format("times as rounded in the file taken as uniform steps of {:.6g} s", mean_s));
  return !std::isnan(step_s);
}

bool same_clock(std::span<const double> a, std::span<const double> b, double dt_s) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](double x, double y) { return std::abs(x - y) <= kSameClock * dt_s; });
}

/// Shortens the common clock to what every channel covers.
void keep_overlap(const std::vector<const Trace*>& traces, const TraceSet& set, PulseChannels& result) {
  double from_s = result.time_s.front(), to_s = result.time_s.back();
  for (const Trace* trace : traces) {
    from_s = std::max(from_s, trace->times().front());
    to_s = std::min(to_s, trace->times().back());
  }
  const double slack_s = kSameClock * result.dt_s;
  std::erase_if(result.time_s, [&](double t) { return t < from_s - slack_s || t > to_s + slack_s; });
  if (result.time_s.size() < kFewestSamples)
    throw InvalidInput(fmt::format("{}: the chosen channels overlap in {} samples only: at least {} are needed",
                                   set.path, result.time_s.size(), kFewestSamples));
}

void describe_channel(const Trace& trace, PulseChannels& result) {
  const std::string label = label_of(trace);
  if (trace.axis == 'Y' || trace.axis == 'Z')
    result.warnings.push_back(fmt::format("channel {} is along {}, not along the vehicle", label, trace.axis));
  if (!trace.source_unit.empty())
    result.steps.push_back(fmt::format("channel {}: {} to {}", label, trace.source_unit, si_symbol(trace.dimension)));
}

}  // namespace

std::vector<std::size_t> default_channels(const TraceSet& set) {
  std::vector<std::size_t> compartment, accelerations, speeds;
  for (std::size_t i = 0; i < set.traces.size(); ++i) {
    const Trace& trace = set.traces[i];
    if (std::find(set.compartment_x.begin(), set.compartment_x.end(), trace.id) != set.compartment_x.end())
      compartment.push_back(i);
    if (trace.dimension == Dimension::acceleration) accelerations.push_back(i);
    if (trace.dimension == Dimension::speed) speeds.push_back(i);
  }
  if (!compartment.empty()) return compartment;
  if (accelerations.size() == 1) return accelerations;
  if (accelerations.empty() && speeds.size() == 1) return speeds;
  if (set.traces.size() == 1) return {0};
  return {};
}

PulseChannels prepare_channels(const TraceSet& set, const PulseOptions& options) {
  std::vector<const Trace*> traces;
  for (const std::size_t i : pick(set, options)) {
    check(set.traces[i], set);
    check_alike(traces.empty() ? set.traces[i] : *traces.front(), set.traces[i], set);
    traces.push_back(&set.traces[i]);
  }
  const Trace& first = *traces.front();
  PulseChannels result;
  result.dimension = first.dimension;
  const bool first_fits = set_clock(first, result);
  keep_overlap(traces, set, result);
  for (const Trace* trace : traces) {
    describe_channel(*trace, result);
    const bool like_the_first = same_clock(trace->times(), first.times(), result.dt_s);
    if (!like_the_first)
      result.steps.push_back(
          fmt::format("channel {}: resampled onto the clock of channel {}", label_of(*trace), label_of(first)));
    const bool fits = like_the_first && first_fits && trace->values.size() == result.time_s.size();
    result.channels.push_back(
        {label_of(*trace), fits ? trace->values : resample(trace->times(), trace->values, result.time_s)});
  }
  return result;
}

}  // namespace crashsim
