#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <crashsim/metrics.hpp>
#include <crashsim/signal.hpp>
#include <crashsim/units.hpp>

namespace crashsim {
namespace {

constexpr double kRounding = 1e-9;

/// The samples of `times` moved by `offset` that stay within their range.
std::vector<double> moved_within(std::span<const double> times, double offset) {
  const double slack = kRounding * std::abs(offset);
  std::vector<double> moved;
  for (const double t : times)
    if (t + offset >= times.front() - slack && t + offset <= times.back() + slack) moved.push_back(t + offset);
  return moved;
}

constexpr double kAsiWindow_s = 0.050;
constexpr double kAsiPadding_s = 0.5;
constexpr double kAsiCutoff_hz = 13.0;
constexpr std::array kAsiLimits_g = {12.0, 9.0, 10.0};

/// Means over every 50 ms that begin at a sample.
std::vector<double> moving_means(std::span<const double> values, double dt_s) {
  const std::vector<double> time = uniform_times(0.0, dt_s, values.size());
  const std::vector<double> integral = integrate(time, values, 0.0);
  const std::vector<double> ends = moved_within(time, kAsiWindow_s);
  std::vector<double> means = resample(time, integral, ends);
  for (std::size_t i = 0; i < means.size(); ++i) means[i] = (means[i] - integral[i]) / kAsiWindow_s;
  return means;
}

/// CFC180, then 13 Hz at -3 dB of both passes; the ends held for half a second.
std::vector<double> smoothed(std::span<const double> values, double dt_s) {
  const std::vector<double> clean = cfc_filter(values, dt_s, 180.0);
  const auto pad = static_cast<std::size_t>(std::ceil(kAsiPadding_s / dt_s));
  std::vector<double> padded(pad, clean.front());
  padded.insert(padded.end(), clean.begin(), clean.end());
  padded.insert(padded.end(), pad, clean.back());
  const std::vector<double> smooth = cfc_filter(padded, dt_s, 0.6 * kAsiCutoff_hz, CfcStandard::iso6487);
  const auto first = smooth.begin() + static_cast<std::ptrdiff_t>(pad);
  return {first, first + std::ssize(values)};
}

}  // namespace

double sliding_mean_peak(std::span<const double> time_s, std::span<const double> velocity_mps, double window_s) {
  check_series(time_s, velocity_mps, "velocity", 2);
  if (!(window_s > 0.0)) throw InvalidInput(fmt::format("window_s = {} s: must be > 0", window_s));
  const std::vector<double> ends = moved_within(time_s, window_s);
  const std::vector<double> starts = moved_within(time_s, -window_s);
  if (ends.empty()) return kUnset;
  const std::vector<double> at_ends = resample(time_s, velocity_mps, ends);
  const std::vector<double> at_starts = resample(time_s, velocity_mps, starts);
  double drop = velocity_mps.front() - at_ends.front();
  for (std::size_t i = 0; i < at_ends.size(); ++i) drop = std::max(drop, velocity_mps[i] - at_ends[i]);
  const std::size_t skipped = time_s.size() - starts.size();
  for (std::size_t i = 0; i < at_starts.size(); ++i) drop = std::max(drop, at_starts[i] - velocity_mps[skipped + i]);
  return drop / window_s;
}

double acceleration_severity_index(std::span<const double> ax, std::span<const double> ay, std::span<const double> az,
                                   double dt_s, AsiMethod method) {
  if (!(dt_s > 0.0)) throw InvalidInput(fmt::format("dt_s = {} s: must be > 0", dt_s));
  std::vector<double> squares;
  const std::array channels = {ax, ay, az};
  for (std::size_t axis = 0; axis < channels.size(); ++axis) {
    const auto channel = channels[axis];
    if (axis > 0 && channel.empty()) continue;
    const std::string name = fmt::format("a{}", "xyz"[axis]);
    if (channel.size() != ax.size())
      throw InvalidInput(
          fmt::format("{} has {} samples but ax has {}: the numbers must be equal", name, channel.size(), ax.size()));
    check_series(uniform_times(0.0, dt_s, channel.size()), channel, name);
    const auto means = method == AsiMethod::moving_mean_1998 ? moving_means(channel, dt_s) : smoothed(channel, dt_s);
    squares.resize(means.size());
    for (std::size_t i = 0; i < means.size(); ++i)
      squares[i] += std::pow(means[i] / (kAsiLimits_g[axis] * kStandardGravity), 2);
  }
  return squares.empty() ? kUnset : std::sqrt(*std::max_element(squares.begin(), squares.end()));
}

}  // namespace crashsim
