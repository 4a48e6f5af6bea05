#include <crashsim/signal.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/units.hpp>

namespace crashsim {
namespace {

constexpr double kPaddingTime_s = 0.010;
constexpr std::size_t kPaddingSamples = 100;
constexpr std::size_t kStartSamples = 10;
constexpr double kUniformTolerance = 0.02;
constexpr double kRateTolerance = 1e-3;  // a rate read from rounded times
constexpr double kImpact_mps2 = 5.0 * kStandardGravity;
constexpr double kQuiet_mps2 = 0.5 * kStandardGravity;

/// One pass of the section over `y`, in place. The first two outputs are the mean of the first samples.
template <class Iterator>
void run_section(Iterator first, std::size_t count, const CfcCoefficients& c) {
  const std::size_t start = std::min(kStartSamples, count);
  const double level =
      std::accumulate(first, first + static_cast<std::ptrdiff_t>(start), 0.0) / static_cast<double>(start);
  double x1 = first[1], x2 = first[0], y1 = level, y2 = level;
  first[0] = first[1] = level;
  for (Iterator at = first + 2, end = first + static_cast<std::ptrdiff_t>(count); at != end; ++at) {
    const double x = *at;
    const double y = c.b0 * x + c.b1 * x1 + c.b2 * x2 + c.a1 * y1 + c.a2 * y2;
    *at = y;
    x2 = x1, x1 = x, y2 = y1, y1 = y;
  }
}

/// The signal between its odd mirror images of `pad` samples: 2 x_0 - x_i before, 2 x_last - x_(last-i) after.
std::vector<double> mirrored(std::span<const double> x, std::size_t pad) {
  std::vector<double> y;
  y.reserve(x.size() + 2 * pad);
  for (std::size_t i = pad; i > 0; --i) y.push_back(2.0 * x.front() - x[i]);
  y.insert(y.end(), x.begin(), x.end());
  for (std::size_t i = 1; i <= pad; ++i) y.push_back(2.0 * x.back() - x[x.size() - 1 - i]);
  return y;
}

}  // namespace

CfcCoefficients cfc_coefficients(double cfc, double dt_s, CfcStandard standard) {
  if (!(cfc > 0.0)) throw InvalidInput(fmt::format("cfc = {} Hz: must be > 0", cfc));
  if (!(dt_s > 0.0)) throw InvalidInput(fmt::format("dt_s = {} s: must be > 0", dt_s));
  if (1.0 / dt_s < 10.0 * cfc * (1.0 - kRateTolerance))
    throw InvalidInput(
        fmt::format("sampling rate {:.6g} Hz is too low for CFC{:g}: at least 10 x {:g} = {:g} Hz are needed; choose a "
                    "lower class or finer samples",
                    1.0 / dt_s, cfc, cfc, 10.0 * cfc));
  using std::numbers::pi, std::numbers::sqrt2;
  const double wd = standard == CfcStandard::j211 ? 2.0 * pi * cfc * 2.0775 : 2.0 * pi * (cfc / 0.6) * 1.25;
  const double wa = std::tan(wd * dt_s / 2.0);
  const double d = 1.0 + sqrt2 * wa + wa * wa;
  const double b0 = wa * wa / d;
  return {b0, 2.0 * b0, b0, -2.0 * (wa * wa - 1.0) / d, (-1.0 + sqrt2 * wa - wa * wa) / d};
}

std::vector<double> cfc_filter(std::span<const double> values, double dt_s, double cfc, CfcStandard standard) {
  const CfcCoefficients section = cfc_coefficients(cfc, dt_s, standard);
  if (values.size() < 3)
    throw InvalidInput(fmt::format("cfc_filter: {} samples: at least 3 are needed", values.size()));
  const auto time_pad = static_cast<std::size_t>(std::lround(kPaddingTime_s / dt_s));
  const std::size_t pad = std::min(std::max(time_pad, kPaddingSamples), values.size() - 1);
  std::vector<double> y = mirrored(values, pad);
  run_section(y.begin(), y.size(), section);
  run_section(y.rbegin(), y.size(), section);
  const auto first = y.begin() + static_cast<std::ptrdiff_t>(pad);
  return {first, first + std::ssize(values)};
}

std::vector<double> integrate(std::span<const double> time_s, std::span<const double> values, double initial) {
  std::vector<double> sum(values.size());
  double total = initial;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) total += 0.5 * (values[i] + values[i - 1]) * (time_s[i] - time_s[i - 1]);
    sum[i] = total;
  }
  return sum;
}

std::vector<double> differentiate(std::span<const double> time_s, std::span<const double> values) {
  const std::size_t n = values.size();
  if (n < 2) throw InvalidInput(fmt::format("differentiate: {} samples: at least 2 are needed", n));
  const auto slope = [&](std::size_t i) { return (values[i + 1] - values[i]) / (time_s[i + 1] - time_s[i]); };
  std::vector<double> rate(n);
  rate.front() = slope(0);
  rate.back() = slope(n - 2);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = time_s[i] - time_s[i - 1], after = time_s[i + 1] - time_s[i];
    rate[i] = (slope(i - 1) * after + slope(i) * before) / (before + after);
  }
  return rate;
}

std::vector<double> resample(std::span<const double> time_s, std::span<const double> values,
                             std::span<const double> at) {
  std::vector<double> result;
  result.reserve(at.size());
  std::size_t i = 0;
  for (const double t : at) {
    while (i + 2 < time_s.size() && time_s[i + 1] <= t) ++i;
    const double part = std::clamp((t - time_s[i]) / (time_s[i + 1] - time_s[i]), 0.0, 1.0);
    result.push_back(values[i] + part * (values[i + 1] - values[i]));
  }
  return result;
}

std::vector<double> uniform_times(double start_s, double dt_s, std::size_t count) {
  std::vector<double> times(count);
  for (std::size_t i = 0; i < count; ++i) times[i] = start_s + static_cast<double>(i) * dt_s;
  return times;
}

double uniform_step(std::span<const double> time_s) {
  if (time_s.size() < 2) return kUnset;
  const double mean = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
  for (std::size_t i = 1; i < time_s.size(); ++i)
    if (!(std::abs(time_s[i] - time_s[i - 1] - mean) <= kUniformTolerance * mean)) return kUnset;
  return mean;
}

double mean_between(std::span<const double> time_s, std::span<const double> values, double from_s, double to_s) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (time_s[i] < from_s || time_s[i] >= to_s) continue;
    sum += values[i];
    ++count;
  }
  if (count == 0)
    throw InvalidInput(fmt::format("no samples with {:g} s <= time < {:g} s: the trace covers {:g} to {:g} s", from_s,
                                   to_s, time_s.empty() ? kUnset : time_s.front(),
                                   time_s.empty() ? kUnset : time_s.back()));
  return sum / static_cast<double>(count);
}

double find_time_zero(std::span<const double> time_s, std::span<const double> accel_mps2) {
  const auto hit =
      std::find_if(accel_mps2.begin(), accel_mps2.end(), [](double a) { return std::abs(a) >= kImpact_mps2; });
  if (hit == accel_mps2.end())
    throw InvalidInput("time zero cannot be found: the acceleration never reaches 5 g; give the time of impact");
  auto i = static_cast<std::size_t>(hit - accel_mps2.begin());
  while (i > 0 && std::abs(accel_mps2[i]) >= kQuiet_mps2) --i;
  return time_s[i];
}

void check_series(std::span<const double> time_s, std::span<const double> values, std::string_view what,
                  std::size_t minimum) {
  if (time_s.size() != values.size())
    throw InvalidInput(
        fmt::format("{}: {} times but {} values: the numbers must be equal", what, time_s.size(), values.size()));
  if (values.size() < minimum)
    throw InvalidInput(fmt::format("{}: {} samples: at least {} are needed", what, values.size(), minimum));
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(time_s[i]))
      throw InvalidInput(fmt::format("{}: time of sample {} is {}: must be finite", what, i + 1, time_s[i]));
    if (i > 0 && !(time_s[i] > time_s[i - 1]))
      throw InvalidInput(
          fmt::format("{}: time of sample {} is {:.9g} s, not after the one before it, {:.9g} s: times must "
                      "increase",
                      what, i + 1, time_s[i], time_s[i - 1]));
    if (!std::isfinite(values[i]))
      throw InvalidInput(
          fmt::format("{}: sample {} at {:.9g} s is {}: must be finite", what, i + 1, time_s[i], values[i]));
  }
}

}  // namespace crashsim
