#include "optimize/pitch_target.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <fmt/format.h>

#include <crashsim/signal.hpp>

#include "optimize/fit_target.hpp"
#include "pitch_input.hpp"
#include "solver/pitch_grid.hpp"

namespace crashsim {
namespace {

/// Times that are compared, ends included.
struct Window {
  double from_s, to_s, rounding_s;

  [[nodiscard]] bool holds(double t) const { return t >= from_s - rounding_s && t <= to_s + rounding_s; }
};

double last_time(const PitchTarget& target) {
  double last = -std::numeric_limits<double>::infinity();
  for (const PitchChannel& channel : kPitchChannels)
    if (const auto& times = (target.*channel.series).time_s; !times.empty()) last = std::max(last, times.back());
  return last;
}

Window make_window(const PitchTarget& target, double start_s, const PitchOptions& simulation,
                   const IdentifyPitchOptions& options) {
  Window window{start_s, last_time(target), 0.0};
  if (options.from_s >= options.to_s)
    throw InvalidInput(fmt::format("IdentifyPitchOptions.from_s = {:g} s: must be before to_s = {:g} s", options.from_s,
                                   options.to_s));
  if (!std::isnan(options.from_s)) window.from_s = std::max(start_s, options.from_s);
  if (!std::isnan(options.to_s)) window.to_s = std::min(window.to_s, options.to_s);
  if (!std::isnan(simulation.end_time_s)) window.to_s = std::min(window.to_s, simulation.end_time_s);
  window.rounding_s = time_rounding(start_s, window.to_s);
  return window;
}

/// Times and values of one channel in the window.
TimeSeries samples_in(const Window& window, const TimeSeries& series, std::string_view name) {
  TimeSeries in;
  for (std::size_t i = 0; i < series.time_s.size(); ++i) {
    if (!window.holds(series.time_s[i])) continue;
    in.time_s.push_back(series.time_s[i]);
    in.values.push_back(series.values[i]);
  }
  if (in.empty())
    throw InvalidInput(
        fmt::format("PitchTarget.{}: none of its samples, from {:g} s to {:g} s, is compared: that is "
                    "from {:g} s, not before the motion starts, to {:g} s: check clock and window",
                    name, series.time_s.front(), series.time_s.back(), window.from_s, window.to_s));
  return in;
}

/// Sorted, and those that differ by rounding made one.
void merge_times(std::vector<double>& times, double rounding_s) {
  std::ranges::sort(times);
  const auto same = [rounding_s](double a, double b) { return b - a <= rounding_s; };
  times.erase(std::unique(times.begin(), times.end(), same), times.end());
}

}  // namespace

PitchFitTarget make_pitch_target(const HeavePitchModel& model, const PitchForcing& forcing, const PitchTarget& target,
                                 const PitchOptions& simulation, const IdentifyPitchOptions& options) {
  PitchFitTarget fit;
  fit.start_s = start_of_motion(forcing, simulation);
  fit.initial = initial_state(model, simulation);
  const Window window = make_window(target, fit.start_s, simulation, options);
  std::array<TimeSeries, kPitchChannels.size()> kept;
  for (std::size_t c = 0; c < kPitchChannels.size(); ++c) {
    const TimeSeries& series = target.*kPitchChannels[c].series;
    if (series.empty()) continue;
    const std::string_view name = kPitchChannels[c].name;
    check_series(series.time_s, series.values, fmt::format("PitchTarget.{}", name), 2);
    kept[c] = samples_in(window, series, name);
    double largest = 0.0;
    for (const double value : kept[c].values) largest = std::max(largest, std::fabs(value));
    if (largest == 0.0)
      throw InvalidInput(
          fmt::format("PitchTarget.{} is zero where it is compared: there is no motion to identify from; "
                      "leave the channel out or widen the window",
                      name));
    fit.scale[c] = 1.0 / largest;
    fit.factor[c] = 1.0 / static_cast<double>(kept[c].values.size());
    fit.times.insert(fit.times.end(), kept[c].time_s.begin(), kept[c].time_s.end());
  }
  if (fit.times.empty())
    throw InvalidInput(
        "PitchTarget is empty: give at least one of heave_m, pitch_rad, heave_velocity_mps, pitch_rate_radps");
  merge_times(fit.times, window.rounding_s);
  if (fit.times.back() <= fit.start_s + window.rounding_s)
    throw InvalidInput(fmt::format(
        "PitchTarget: no sample after the start of the motion, {:g} s: check clock and window", fit.start_s));
  for (std::size_t c = 0; c < kept.size(); ++c)
    for (std::size_t i = 0; i < kept[c].time_s.size(); ++i) {
      const auto next = std::ranges::upper_bound(fit.times, kept[c].time_s[i]);
      fit.samples.push_back({static_cast<std::size_t>(next - fit.times.begin()) - 1, c, kept[c].values[i]});
    }
  std::ranges::sort(fit.samples, {}, [](const PitchSample& s) { return std::tuple(s.time, s.channel); });
  return fit;
}

PitchFitError pitch_fit_error(const PitchFitTarget& target, const std::vector<PitchState>& motion, Loss loss) {
  std::array<double, kPitchChannels.size()> sums = {};
  for (const PitchSample& sample : target.samples) {
    const double residual = motion[sample.time][static_cast<Eigen::Index>(sample.channel)] - sample.value;
    sums[sample.channel] += loss_value(loss, target.scale[sample.channel] * residual, 0.0).value;
  }
  PitchFitError error;
  error.total = 0.0;
  for (std::size_t c = 0; c < sums.size(); ++c) {
    if (target.factor[c] == 0.0) continue;
    error.*kPitchChannels[c].error = target.factor[c] * sums[c];
    error.total += target.factor[c] * sums[c];
  }
  return error;
}

}  // namespace crashsim
