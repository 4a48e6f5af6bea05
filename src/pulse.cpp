#include <crashsim/pulse.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <crashsim/plausibility.hpp>
#include <crashsim/redundancy.hpp>
#include <crashsim/trace_io.hpp>
#include <crashsim/units.hpp>

#include "io/reader.hpp"
#include "pulse_channels.hpp"
#include "pulse_steps.hpp"

namespace crashsim {
namespace {

constexpr std::size_t kFewestPulseSamples = 10;

void check_positive(double value, std::string_view name, std::string_view unit) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw InvalidInput(fmt::format("{} = {} {}: must be > 0", name, value, unit));
}

void append(std::vector<std::string>& warnings, const std::vector<std::string>& findings) {
  warnings.insert(warnings.end(), findings.begin(), findings.end());
}

/// Forms velocity, displacement and maximum crush from time and acceleration.
void integrate_motion(Pulse& pulse) {
  check_positive(pulse.impact_speed_mps, "impact_speed_mps", "m/s");
  if (!std::isnan(pulse.mass_kg)) check_positive(pulse.mass_kg, "mass_kg", "kg");
  pulse.velocity_mps = integrate(pulse.time_s, pulse.accel_mps2, pulse.impact_speed_mps);
  pulse.displacement_m = integrate(pulse.time_s, pulse.velocity_mps, 0.0);
  pulse.steps.push_back(
      fmt::format("velocity and displacement by trapezoids, from {:.6g} m/s and 0 m", pulse.impact_speed_mps));
}

void find_end_of_crush(Pulse& pulse) {
  const MaxCrush end = find_max_crush(pulse.time_s, pulse.accel_mps2, pulse.velocity_mps, pulse.displacement_m);
  pulse.t_m_s = end.t_m_s;
  pulse.max_crush_m = end.max_crush_m;
  if (!std::isnan(end.t_m_s)) {
    const double peak_g = -*std::min_element(pulse.accel_mps2.begin(), pulse.accel_mps2.end()) / kStandardGravity;
    return append(pulse.warnings, check_fleet(pulse.max_crush_m, peak_g));
  }
  pulse.warnings.push_back(
      fmt::format("velocity does not reach zero within {:.4g} s, so there is no time of maximum crush: check channel, "
                  "units, speed and length of the record",
                  pulse.time_s.back()));
}

double known_speed(const TraceSet& set, const PulseOptions& options) {
  return std::isnan(options.impact_speed_mps) ? set.impact_speed_mps : options.impact_speed_mps;
}

/// The motion from time zero on, `offset` samples or a part of one into the common clock.
void cut_at_time_zero(const PulseChannels& channels, const std::vector<double>& accel_mps2, double t0_s, Pulse& pulse) {
  constexpr double kOnSample = 1e-6;  // of a step
  const auto& time_s = channels.time_s;
  const auto at_zero = std::lower_bound(time_s.begin(), time_s.end(), t0_s - kOnSample * channels.dt_s);
  const auto first = at_zero - time_s.begin();
  const auto count = static_cast<std::size_t>(time_s.end() - at_zero);
  if (count < kFewestPulseSamples)
    throw InvalidInput(
        fmt::format("{} samples from time zero {:g} s on: at least {} are needed", count, t0_s, kFewestPulseSamples));
  if (*at_zero - t0_s <= kOnSample * channels.dt_s) {
    pulse.accel_mps2.assign(accel_mps2.begin() + first, accel_mps2.end());
    for (auto t = at_zero; t != time_s.end(); ++t) pulse.time_s.push_back(t == at_zero ? 0.0 : *t - t0_s);
    return;
  }
  pulse.time_s = uniform_times(0.0, channels.dt_s, count);
  const std::vector<double> at = uniform_times(t0_s, channels.dt_s, count);
  pulse.accel_mps2 = resample(time_s, accel_mps2, at);
  pulse.steps.push_back(
      fmt::format("time zero {:.6g} s lies between samples: linear onto a grid that starts there", t0_s));
}

constexpr std::array<std::string_view, 3> kOwnColumns = {"accel_mps2", "velocity_mps", "displacement_m"};

/// Whether a file is a pulse or a response that this program wrote, and nobody asks for a channel of it.
bool is_own_pulse(const TraceSet& set, const PulseOptions& options) {
  return options.channels.empty() && set.traces.size() >= kOwnColumns.size() &&
         std::equal(kOwnColumns.begin(), kOwnColumns.end(), set.traces.begin(),
                    [](std::string_view name, const Trace& trace) { return trace.name == name; });
}

/// Indices of the channels that a pulse needs of a file.
std::vector<std::size_t> needed_channels(const TraceSet& catalogue, const ReadOptions& read,
                                         const PulseOptions& options) {
  if (is_own_pulse(catalogue, options)) return {0, 1, 2};
  if (!options.channels.empty()) return io::channels_named_by(read, catalogue);
  return default_channels(catalogue);
}

Pulse as_written(TraceSet set, const PulseOptions& options) {
  constexpr double kSameSpeed = 1e-9;
  Pulse pulse;
  const auto times = set.traces[0].times();
  for (std::size_t i = 0; i < kOwnColumns.size(); ++i)
    check_series(times, set.traces[i].values, fmt::format("{}: {}", set.path, set.traces[i].name));
  if (times.front() != 0.0)
    throw InvalidInput(
        fmt::format("{}: a pulse starts at time 0, not at {} s; to make one of its acceleration, choose it "
                    "with --channel accel_mps2",
                    set.path, times.front()));
  if (options.t0.rule != TimeZero::trace || options.bias.rule != Bias::pre_impact)
    throw InvalidInput(
        fmt::format("{}: is a finished pulse: t0 and bias do not apply; to process its acceleration again, "
                    "choose it with --channel accel_mps2",
                    set.path));
  pulse.time_s.assign(times.begin(), times.end());
  pulse.accel_mps2 = std::move(set.traces[0].values);
  pulse.velocity_mps = std::move(set.traces[1].values);
  pulse.displacement_m = std::move(set.traces[2].values);
  pulse.impact_speed_mps = pulse.velocity_mps.front();
  check_positive(pulse.impact_speed_mps, fmt::format("{}: velocity_mps[0]", set.path), "m/s");
  if (std::abs(known_speed(set, options) - pulse.impact_speed_mps) > kSameSpeed * pulse.impact_speed_mps)
    throw InvalidInput(fmt::format("{}: its velocity starts at {} m/s, which is not the impact speed {} m/s", set.path,
                                   pulse.impact_speed_mps, known_speed(set, options)));
  pulse.mass_kg = std::isnan(options.mass_kg) ? set.mass_kg : options.mass_kg;
  pulse.channels = {set.path};
  pulse.steps = {"taken as written: not filtered or integrated again"};
  pulse.input_files = set.input_files;
  append(pulse.warnings,
         check_balance(motion_balance(pulse.time_s, pulse.accel_mps2, pulse.velocity_mps, pulse.displacement_m)));
  find_end_of_crush(pulse);
  return pulse;
}

}  // namespace

Pulse make_pulse(std::span<const double> time_s, std::span<const double> accel_mps2, double impact_speed_mps,
                 double mass_kg, double cfc) {
  check_series(time_s, accel_mps2, "accel_mps2");
  if (time_s.front() != 0.0)
    throw InvalidInput(
        fmt::format("time_s[0] = {} s: a pulse starts at time zero; leave out what is before", time_s[0]));
  if (!(cfc >= 0.0)) throw InvalidInput(fmt::format("cfc = {} Hz: must be >= 0", cfc));
  Pulse pulse;
  pulse.time_s.assign(time_s.begin(), time_s.end());
  pulse.accel_mps2.assign(accel_mps2.begin(), accel_mps2.end());
  pulse.impact_speed_mps = impact_speed_mps;
  pulse.mass_kg = mass_kg;
  if (cfc > 0.0) {
    const double dt_s = uniform_step(time_s);
    if (std::isnan(dt_s))
      throw InvalidInput("time_s: steps are not uniform: a filter needs uniform steps; resample first");
    pulse.accel_mps2 = cfc_filter(accel_mps2, dt_s, cfc);
    pulse.steps.push_back(fmt::format("filter: CFC{:g} (j211), forward and backward", cfc));
  }
  integrate_motion(pulse);
  find_end_of_crush(pulse);
  return pulse;
}

Pulse make_pulse(const TraceSet& traces, const PulseOptions& options) {
  if (is_own_pulse(traces, options)) return as_written(traces, options);
  PulseChannels channels = prepare_channels(traces, options);
  const double t0_s = set_zero(channels, options, traces.path);
  filter(channels, options, traces.path);
  Pulse pulse;
  pulse.time_zero_s = t0_s;
  pulse.mass_kg = std::isnan(options.mass_kg) ? traces.mass_kg : options.mass_kg;
  pulse.input_files = traces.input_files;
  pulse.warnings = traces.warnings;
  for (const PulseChannel& channel : channels.channels) pulse.channels.push_back(channel.label);
  const Average average = average_channels(channels, t0_s, known_speed(traces, options), traces.path);
  pulse.impact_speed_mps = average.impact_speed_mps;
  pulse.steps = std::move(channels.steps);
  append(pulse.warnings, channels.warnings);
  append(pulse.warnings, check_redundant(traces));
  cut_at_time_zero(channels, average.accel_mps2, t0_s, pulse);
  integrate_motion(pulse);
  find_end_of_crush(pulse);
  return pulse;
}

Pulse read_pulse(const std::string& path, const PulseOptions& options) {
  const ReadOptions read{options.channels, options.columns, options.units};
  const auto choose = [&](const TraceSet& catalogue) { return needed_channels(catalogue, read, options); };
  return make_pulse(io::read_chosen(path, read, choose), options);
}

MaxCrush find_max_crush(std::span<const double> time_s, std::span<const double> accel_mps2,
                        std::span<const double> velocity_mps, std::span<const double> displacement_m) {
  if (velocity_mps.empty() || !(velocity_mps.front() > 0.0)) return {};
  for (std::size_t i = 0; i + 1 < velocity_mps.size(); ++i) {
    // v = v_i + a_i s + b s^2 through both samples; its first zero, in the form that does not cancel
    const double h = time_s[i + 1] - time_s[i], v = velocity_mps[i], a = accel_mps2[i];
    const double b = (velocity_mps[i + 1] - v - a * h) / (h * h);
    const double discriminant = a * a - 4.0 * b * v;
    if (discriminant < 0.0) continue;
    double s = 2.0 * v / (-a + std::sqrt(discriminant));
    if (velocity_mps[i + 1] <= 0.0) s = std::min(s, h);
    if (!(s > 0.0 && s <= h)) continue;
    return {time_s[i] + s, displacement_m[i] + s * (v + s * (a / 2.0 + s * b / 3.0))};
  }
  return {};
}

}  // namespace crashsim
