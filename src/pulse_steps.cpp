#include "pulse_steps.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/signal.hpp>
#include <crashsim/units.hpp>

namespace crashsim {
namespace {

constexpr std::size_t kFewestQuietSamples = 10;
constexpr double kClearChange = 0.2;  // of the impact speed
constexpr double kSpeedsAgree = 0.02;

/// Runs a step on one channel; what it refuses is told with file and channel.
template <class Step>
auto for_channel(const std::string& path, const PulseChannel& channel, Step step) {
  try {
    return step();
  } catch (const InvalidInput& problem) {
    throw InvalidInput(fmt::format("{}: channel {}: {}", path, channel.label, problem.what()));
  }
}

std::size_t samples_before(const std::vector<double>& time_s, double t_s) {
  return static_cast<std::size_t>(std::lower_bound(time_s.begin(), time_s.end(), t_s) - time_s.begin());
}

double mean_of_first(const std::vector<double>& values, std::size_t count) {
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) sum += values[i];
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

void take_off(std::vector<double>& values, double offset) {
  for (double& value : values) value -= offset;
}

/// Time zero of one channel: as find_time_zero(), after a first guess of the offset from the first half of the record
/// before 5 g.
double found_time_zero(const PulseChannels& channels, std::vector<double> accel_mps2) {
  const double first_guess_s = find_time_zero(channels.time_s, accel_mps2);
  const std::size_t quiet = samples_before(channels.time_s, first_guess_s) / 2;
  if (quiet >= kFewestQuietSamples) take_off(accel_mps2, mean_of_first(accel_mps2, quiet));
  return find_time_zero(channels.time_s, accel_mps2);
}

std::vector<double> acceleration_of(const PulseChannels& channels, const PulseChannel& channel,
                                    const PulseOptions& options) {
  if (channels.dimension == Dimension::acceleration) return channel.values;
  if (!(options.cfc > 0.0)) return differentiate(channels.time_s, channel.values);
  return differentiate(channels.time_s, cfc_filter(channel.values, channels.dt_s, options.cfc, options.cfc_standard));
}

double time_zero(PulseChannels& channels, const PulseOptions& options, const std::string& path) {
  double t0_s = 0.0;
  std::string how = "the trace's own";
  if (options.t0.rule == TimeZero::given) {
    if (options.t0.numbers.size() != 1)
      throw InvalidInput(fmt::format("t0: {} numbers given: one time in s is needed", options.t0.numbers.size()));
    t0_s = options.t0.numbers.front();
    how = "given";
  } else if (options.t0.rule == TimeZero::automatic) {
    t0_s = channels.time_s.back();
    for (const PulseChannel& channel : channels.channels)
      t0_s = std::min(t0_s, for_channel(path, channel, [&] {
                        return found_time_zero(channels, acceleration_of(channels, channel, options));
                      }));
    how = "found: first 5 g, walked back to 0.5 g";
  }
  const double slack_s = 1e-6 * channels.dt_s;
  if (!(t0_s >= channels.time_s.front() - slack_s && t0_s <= channels.time_s.back()))
    throw InvalidInput(
        fmt::format("{}: time zero {:g} s is outside the trace, {:g} to {:g} s; say when the impact is (--t0)", path,
                    t0_s, channels.time_s.front(), channels.time_s.back()));
  channels.steps.push_back(fmt::format("time zero: {:.6g} s, {}", t0_s, how));
  return t0_s;
}

void remove_given_offset(PulseChannels& channels, const std::vector<double>& window, const std::string& path) {
  if (channels.dimension == Dimension::speed)
    throw InvalidInput(fmt::format("{}: bias: an offset window does not apply to velocity channels", path));
  if (window.size() != 2)
    throw InvalidInput(fmt::format("bias: {} numbers given: a window needs two times in s", window.size()));
  for (PulseChannel& channel : channels.channels) {
    const double offset =
        for_channel(path, channel, [&] { return mean_between(channels.time_s, channel.values, window[0], window[1]); });
    take_off(channel.values, offset);
    channels.steps.push_back(fmt::format("offset: {:.4g} m/s^2 taken off channel {}, its mean from {:g} to {:g} s",
                                         offset, channel.label, window[0], window[1]));
  }
}

void remove_offset_before(PulseChannels& channels, double t0_s) {
  const std::size_t quiet = samples_before(channels.time_s, t0_s);
  if (quiet < kFewestQuietSamples) {
    channels.steps.push_back(
        fmt::format("offset: none taken off, {} samples before impact are too few to tell", quiet));
    return;
  }
  for (PulseChannel& channel : channels.channels) {
    const double offset = mean_of_first(channel.values, quiet);
    take_off(channel.values, offset);
    channels.steps.push_back(
        fmt::format("offset: {:.4g} m/s^2 taken off channel {}, its mean of {} samples before impact", offset,
                    channel.label, quiet));
  }
}

void remove_offset(PulseChannels& channels, const PulseOptions& options, double t0_s, const std::string& path) {
  if (options.bias.rule == Bias::given) return remove_given_offset(channels, options.bias.numbers, path);
  if (options.bias.rule == Bias::none) return channels.steps.push_back("offset: none taken off, as asked");
  if (channels.dimension == Dimension::speed)
    return channels.steps.push_back("offset: none taken off velocity channels");
  remove_offset_before(channels, t0_s);
}

double value_at(const PulseChannels& channels, const std::vector<double>& values, double t_s) {
  return resample(channels.time_s, values, std::vector<double>{t_s}).front();
}

/// Turns a channel whose axis points backward: one that travels backward before impact, or accelerates forward in it.
void turn_channel_forward(PulseChannels& channels, PulseChannel& channel, double t0_s, double speed_mps) {
  double forward = 0.0;
  if (channels.dimension == Dimension::speed) {
    forward = value_at(channels, channel.values, t0_s);
  } else {
    const std::size_t first = samples_before(channels.time_s, t0_s);
    forward =
        -integrate(std::span(channels.time_s).subspan(first), std::span(channel.values).subspan(first), 0.0).back();
    if (std::abs(forward) < kClearChange * speed_mps)
      channels.warnings.push_back(fmt::format("channel {} changes speed by {:.3g} m/s only, from {:.4g} m/s",
                                              channel.label, forward, speed_mps));
  }
  if (forward >= 0.0) return;
  for (double& value : channel.values) value = -value;
  const std::string text =
      fmt::format("channel {}: sign turned, because its axis points opposite to the travel", channel.label);
  channels.steps.push_back(text);
  channels.warnings.push_back(text);
}

std::vector<double> mean_of(const PulseChannels& channels) {
  std::vector<double> mean(channels.time_s.size());
  for (const PulseChannel& channel : channels.channels)
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += channel.values[i];
  for (double& value : mean) value /= static_cast<double>(channels.channels.size());
  return mean;
}

}  // namespace

double set_zero(PulseChannels& channels, const PulseOptions& options, const std::string& path) {
  const double t0_s = time_zero(channels, options, path);
  remove_offset(channels, options, t0_s, path);
  return t0_s;
}

void filter(PulseChannels& channels, const PulseOptions& options, const std::string& path) {
  if (!(options.cfc >= 0.0)) throw InvalidInput(fmt::format("cfc = {} Hz: must be >= 0", options.cfc));
  if (options.cfc == 0.0) return channels.steps.push_back("filter: none, as asked");
  for (PulseChannel& channel : channels.channels)
    channel.values = for_channel(
        path, channel, [&] { return cfc_filter(channel.values, channels.dt_s, options.cfc, options.cfc_standard); });
  channels.steps.push_back(
      fmt::format("filter: CFC{:g} ({}), forward and backward", options.cfc, name_of(options.cfc_standard)));
}

void turn_forward(PulseChannels& channels, double t0_s, double speed_mps) {
  for (PulseChannel& channel : channels.channels) turn_channel_forward(channels, channel, t0_s, speed_mps);
}

Average average_channels(PulseChannels& channels, double t0_s, double speed_mps, const std::string& path) {
  const bool of_speed = channels.dimension == Dimension::speed;
  if (std::isnan(speed_mps) && !of_speed)
    throw InvalidInput(
        fmt::format("{}: impact speed unknown: the file does not say it; give impact_speed_mps (--speed)", path));
  turn_forward(channels, t0_s, speed_mps);
  Average average{mean_of(channels), speed_mps};
  if (channels.channels.size() > 1)
    channels.steps.push_back(fmt::format("average of {} channels", channels.channels.size()));
  if (!of_speed) return average;

  const double start_mps = value_at(channels, average.accel_mps2, t0_s);
  if (std::isnan(speed_mps)) average.impact_speed_mps = start_mps;
  if (std::abs(start_mps - average.impact_speed_mps) > kSpeedsAgree * average.impact_speed_mps)
    channels.warnings.push_back(fmt::format("velocity channels start at {:.4g} m/s, the impact speed is {:.4g} m/s",
                                            start_mps, average.impact_speed_mps));
  average.accel_mps2 = differentiate(channels.time_s, average.accel_mps2);
  channels.steps.push_back(
      "acceleration: central differences of the filtered velocity; velocity is then its integral, so that a, v and x "
      "agree");
  return average;
}

}  // namespace crashsim
