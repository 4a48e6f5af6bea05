#include <crashsim/sensor_correction.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <crashsim/option_values.hpp>
#include <crashsim/signal.hpp>

#include "io/reader.hpp"
#include "optimize/gauss_newton.hpp"
#include "pulse_channels.hpp"
#include "pulse_steps.hpp"
#include "sensor_equations.hpp"
#include "sensor_verdict.hpp"

namespace crashsim {
namespace {

using Kind = SensorUnknown;

constexpr double kWidest = 10.0;  // prior standard deviations to which corrections are bounded
constexpr double kFtol = 1e-12;
constexpr int kMostEvaluations = 200;
constexpr int kMostRounds = 10;    // of noise and corrections by turns
constexpr double kSettled = 1e-3;  // relative change of the noise's variance
constexpr std::size_t kFewestSamples = 20;

/// Channels ready to be compared, and as they are given back.
struct Prepared {
  PulseChannels raw, filtered;
  double time_zero_s = 0.0, impact_speed_mps = kUnset, mass_kg = kUnset;
};

Prepared prepare(const TraceSet& traces, const PulseOptions& pulse) {
  Prepared out;
  out.raw = prepare_channels(traces, pulse);
  if (out.raw.dimension != Dimension::acceleration)
    throw InvalidInput(fmt::format("{}: channel {} measures {}: corrections are for accelerometers", traces.path,
                                   out.raw.channels.front().label, dimension_name(out.raw.dimension)));
  for (const PulseChannel& channel : out.raw.channels)
    if (std::all_of(channel.values.begin(), channel.values.end(), [](double v) { return v == 0.0; }))
      throw InvalidInput(fmt::format("{}: channel {} is zero throughout: leave it out", traces.path, channel.label));
  out.time_zero_s = set_zero(out.raw, pulse, traces.path);
  out.impact_speed_mps = std::isnan(pulse.impact_speed_mps) ? traces.impact_speed_mps : pulse.impact_speed_mps;
  out.mass_kg = std::isnan(pulse.mass_kg) ? traces.mass_kg : pulse.mass_kg;
  turn_forward(out.raw, out.time_zero_s, out.impact_speed_mps);
  out.filtered = out.raw;
  filter(out.filtered, pulse, traces.path);
  out.raw.steps.push_back(pulse.cfc > 0.0 ? fmt::format("compared through CFC{:g} ({}); the result is not filtered",
                                                        pulse.cfc, name_of(pulse.cfc_standard))
                                          : std::string("compared unfiltered, as asked"));
  return out;
}

SensorSignals signals_of(const PulseChannels& channels, double time_zero_s, std::vector<double> weights) {
  constexpr double kOnSample = 1e-6;  // of a step
  SensorSignals signals;
  signals.dt_s = channels.dt_s;
  signals.first_s = channels.time_s.front() - time_zero_s;
  const double steps = (channels.time_s.back() - time_zero_s) / channels.dt_s;
  signals.count = static_cast<std::size_t>(std::floor(steps + kOnSample)) + 1;
  for (const PulseChannel& channel : channels.channels) signals.channels.push_back(channel.values);
  signals.weights = std::move(weights);
  return signals;
}

std::vector<double> weights_of(const SensorCorrectionOptions& options, std::size_t channels) {
  if (options.channel_weights.empty()) return std::vector<double>(channels, 1.0);
  if (options.channel_weights.size() != channels)
    throw InvalidInput(fmt::format("channel_weights: {} numbers for {} channels: one for each is needed",
                                   options.channel_weights.size(), channels));
  for (const double weight : options.channel_weights)
    if (!(weight > 0.0 && std::isfinite(weight)))
      throw InvalidInput(fmt::format("channel_weights: {}: must be > 0", weight));
  return options.channel_weights;
}

/// The samples of the window.
void set_window(const SensorCorrectionOptions& options, const std::string& path, SensorProblem& problem) {
  constexpr double kOnSample = 1e-6;  // of a step
  const SensorSignals& signals = problem.signals;
  const double end_s = std::min(options.end_s, signals.time(signals.count - 1));
  problem.first = static_cast<std::size_t>(std::ceil(options.start_s / signals.dt_s - kOnSample));
  problem.last = static_cast<std::size_t>(std::floor(end_s / signals.dt_s + kOnSample));
  if (problem.last < problem.first + kFewestSamples)
    throw InvalidInput(
        fmt::format("{}: fewer than {} samples between {:g} and {:g} s after impact, where channels are to be "
                    "compared: give another start_s or end_s",
                    path, kFewestSamples, options.start_s, end_s));
}

/// F/m on the grid, to the end of the window.
void take_wall(const LoadCellWall& wall, double mass_kg, const std::string& path, SensorProblem& problem) {
  if (!(mass_kg > 0.0 && std::isfinite(mass_kg)))
    throw InvalidInput(fmt::format("{}: the wall's force needs the test mass: give mass_kg (--mass)", path));
  const double end_s = problem.signals.time(problem.last);
  if (wall.time_s.empty() || wall.time_s.front() > 0.0 || wall.time_s.back() < end_s)
    throw InvalidInput(fmt::format(
        "{}: the wall's record does not cover the time from impact to {:g} s: give an earlier end_s", path, end_s));
  const std::vector<double> at = uniform_times(0.0, problem.signals.dt_s, problem.last + 1);
  problem.signals.wall_mps2 = resample(wall.time_s, wall.total_force_n, at);
  for (double& value : problem.signals.wall_mps2) value /= mass_kg;
}

void set_conditions(const SensorCorrectionOptions& options, const std::string& path, SensorProblem& problem) {
  using Condition = SensorCondition::Kind;
  if (options.velocity_times_s.size() != options.velocities_mps.size())
    throw InvalidInput(fmt::format("velocity_times_s has {} numbers but velocities_mps {}: give a velocity for each",
                                   options.velocity_times_s.size(), options.velocities_mps.size()));
  const double end_s = problem.signals.time(problem.signals.count - 1);
  for (std::size_t i = 0; i < options.velocities_mps.size(); ++i) {
    const double time_s = options.velocity_times_s[i];
    if (!(time_s > 0.0 && time_s <= end_s))
      throw InvalidInput(
          fmt::format("velocity_times_s: {} s: must be after impact and in the record, to {:g} s", time_s, end_s));
    if (!std::isfinite(options.velocities_mps[i]))
      throw InvalidInput(fmt::format("velocities_mps: {}: must be finite", options.velocities_mps[i]));
    problem.conditions.push_back({Condition::velocity, time_s, options.velocities_mps[i]});
  }
  if (!std::isnan(options.rebound_velocity_mps))
    problem.conditions.push_back({Condition::rebound, kUnset, options.rebound_velocity_mps});
  problem.compares_wall = !problem.signals.wall_mps2.empty() && options.wall_use == WallUse::force;
  if (!problem.signals.wall_mps2.empty() && options.wall_use == WallUse::impulse)
    problem.conditions.push_back({Condition::impulse, problem.signals.time(problem.last), kUnset});
  problem.velocity_sd_mps = options.velocity_sd_mps;
  const double speed = problem.impact_speed_mps;
  if (!problem.conditions.empty() && !(speed > 0.0 && std::isfinite(speed)))
    throw InvalidInput(
        fmt::format("{}: what is known of velocity needs the impact speed: give impact_speed_mps (--speed)", path));
}

void set_parameters(const SensorCorrectionOptions& options, SensorProblem& problem) {
  const std::size_t channels = problem.signals.channels.size();
  for (const auto& [kind, sd] : {std::pair(Kind::bias, options.bias_sd_mps2), std::pair(Kind::gain, options.gain_sd),
                                 std::pair(Kind::time_shift, options.time_shift_sd_s)})
    for (std::size_t c = 0; c < channels && sd > 0.0; ++c) problem.parameters.push_back({kind, c, sd});
  if (problem.parameters.empty())
    throw InvalidInput("bias_sd_mps2, gain_sd and time_shift_sd_s are all 0: nothing is to be corrected");
  if (!problem.signals.wall_mps2.empty() && options.wall_gain_sd > 0.0)
    problem.parameters.push_back({Kind::wall_gain, 0, options.wall_gain_sd});
  if (channels == 1 && problem.conditions.empty() && !problem.compares_wall)
    throw InvalidInput(
        "one channel and nothing it could be compared with: give a further channel, a velocity that is known "
        "(velocities_mps, rebound_velocity_mps) or a wall");
}

SensorProblem problem_of(const Prepared& prepared, const SensorCorrectionOptions& options, const LoadCellWall* wall,
                         const std::string& path) {
  SensorProblem problem;
  problem.signals =
      signals_of(prepared.filtered, prepared.time_zero_s, weights_of(options, prepared.raw.channels.size()));
  problem.impact_speed_mps = prepared.impact_speed_mps;
  set_window(options, path, problem);
  if (wall != nullptr) take_wall(*wall, prepared.mass_kg, path, problem);
  set_conditions(options, path, problem);
  set_parameters(options, problem);
  return problem;
}

/// The corrections nearest to where `units` are, in prior standard deviations. @returns whether they have settled.
bool minimize(const SensorEquations& equations, std::vector<double>& units) {
  const auto to_units = [](std::span<const double> box) {
    std::vector<double> at(box.begin(), box.end());
    for (double& value : at) value = (2.0 * value - 1.0) * kWidest;
    return at;
  };
  const auto in_box = [&](std::span<const double> box, std::span<double> gradient, Eigen::MatrixXd& hessian) {
    const double value = equations.evaluate(to_units(box), gradient, hessian);
    for (double& slope : gradient) slope *= 2.0 * kWidest;
    hessian *= 4.0 * kWidest * kWidest;
    return value;
  };
  std::vector<double> start = units;
  for (double& value : start) value = 0.5 * (value / kWidest + 1.0);
  const Minimum minimum = minimize_by_gauss_newton(in_box, start, kFtol, kMostEvaluations);
  units = to_units(minimum.point);
  return std::isfinite(minimum.value) && minimum.evaluations < kMostEvaluations;
}

/// Corrections and noise by turns, until the noise settles. @returns whether the corrections have.
bool solve(SensorEquations& equations, std::vector<double>& units) {
  units.assign(equations.problem().parameters.size(), 0.0);
  for (int round = 0; round < kMostRounds; ++round) {
    if (!minimize(equations, units)) return false;
    if (equations.take_noise(units) < kSettled) break;
  }
  return minimize(equations, units);
}

double root_mean_square(std::span<const double> a, std::span<const double> b, std::size_t first, std::size_t last) {
  double sum = 0.0;
  for (std::size_t i = first; i <= last; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(last - first + 1));
}

/// Differences to the mean and velocities at the end of the window, before and after.
void take_differences(const SensorProblem& problem, const SensorState& state, SensorCorrection& out) {
  const std::vector<SensorModel> untouched(state.channels.size());
  const std::vector<double> mean_before = common_acceleration(problem.signals, untouched);
  const std::vector<double> mean_after = common_acceleration(problem.signals, state.channels);
  const std::vector<double> weights = quadrature_weights(problem.signals.dt_s, problem.signals.time(problem.last));
  const auto end_velocity = [&](const std::vector<double>& accel) {
    double velocity = problem.impact_speed_mps;
    for (std::size_t i = 0; i < weights.size(); ++i) velocity += weights[i] * accel[i];
    return velocity;
  };
  for (std::size_t c = 0; c < state.channels.size(); ++c) {
    const std::vector<double> before = corrected_channel(problem.signals, c, untouched[c]);
    const std::vector<double> after = corrected_channel(problem.signals, c, state.channels[c]);
    ChannelCorrection& channel = out.channels[c];
    channel.rms_before_mps2 = root_mean_square(before, mean_before, problem.first, problem.last);
    channel.rms_after_mps2 = root_mean_square(after, mean_after, problem.first, problem.last);
    channel.end_velocity_before_mps = end_velocity(before);
    channel.end_velocity_after_mps = end_velocity(after);
  }
}

/// "accel_93_mps2": a name that is one column's and reads back with its unit.
std::string column_name(const std::string& label) {
  std::string id = label.substr(0, label.find(' '));
  for (char& c : id)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return fmt::format("accel_{}_mps2", id);
}

/// The unfiltered channels, corrected: their mean, then each.
void give_back(const Prepared& prepared, const TraceSet& traces, const SensorProblem& problem, const SensorState& state,
               SensorCorrection& out) {
  const SensorSignals raw = signals_of(prepared.raw, prepared.time_zero_s, problem.signals.weights);
  TraceSet& set = out.corrected;
  set.path = traces.path;
  set.title = traces.title;
  set.mass_kg = prepared.mass_kg;
  set.impact_speed_mps = prepared.impact_speed_mps;
  set.input_files = traces.input_files;
  set.compartment_x = {"mean"};
  const auto times = std::make_shared<const std::vector<double>>(uniform_times(0.0, raw.dt_s, raw.count));
  const auto add = [&](std::string id, std::string name, std::vector<double> values) {
    Trace trace;
    trace.id = std::move(id);
    trace.name = std::move(name);
    trace.axis = 'X';
    trace.dimension = Dimension::acceleration;
    trace.time_s = times;
    trace.values = std::move(values);
    set.traces.push_back(std::move(trace));
  };
  add("mean", "accel_mps2", common_acceleration(raw, state.channels));
  for (std::size_t c = 0; c < state.channels.size(); ++c) {
    const std::string& label = prepared.raw.channels[c].label;
    add(label.substr(0, label.find(' ')), column_name(label), corrected_channel(raw, c, state.channels[c]));
  }
}

}  // namespace

SensorCorrection correct_sensors(const TraceSet& traces, const PulseOptions& pulse,
                                 const SensorCorrectionOptions& options, const LoadCellWall* wall) {
  validate_options(options, "SensorCorrectionOptions");
  Prepared prepared = prepare(traces, pulse);
  SensorEquations equations(problem_of(prepared, options, wall, traces.path));
  const SensorProblem& problem = equations.problem();
  std::vector<double> units;
  const bool has_converged = solve(equations, units);
  SensorCorrection out;
  out.outcome = has_converged ? CorrectionOutcome::completed : CorrectionOutcome::not_converged;
  out.time_zero_s = prepared.time_zero_s;
  out.steps = std::move(prepared.raw.steps);
  out.warnings = traces.warnings;
  out.warnings.insert(out.warnings.end(), prepared.raw.warnings.begin(), prepared.raw.warnings.end());
  out.input_files = traces.input_files;
  for (const PulseChannel& channel : prepared.raw.channels) out.channels.push_back({.channel = channel.label});
  if (!has_converged) {
    out.message = fmt::format("the corrections did not settle within {} evaluations", kMostEvaluations);
    return out;
  }
  take_corrections(equations, units, out);
  const SensorState state = equations.state(units);
  take_differences(problem, state, out);
  give_back(prepared, traces, problem, state, out);
  return out;
}

SensorCorrection read_sensor_correction(const std::string& path, const PulseOptions& pulse,
                                        const SensorCorrectionOptions& options, const LoadCellWall* wall) {
  const ReadOptions read{pulse.channels, pulse.columns, pulse.units};
  const auto choose = [&](const TraceSet& catalogue) {
    return pulse.channels.empty() ? default_channels(catalogue) : io::channels_named_by(read, catalogue);
  };
  return correct_sensors(io::read_chosen(path, read, choose), pulse, options, wall);
}

std::string SensorCorrection::brief_report() const {
  if (outcome == CorrectionOutcome::not_run) return "not run";
  if (!usable()) return fmt::format("{}: {}", name_of(outcome), message);
  double before = 0.0, after = 0.0;
  for (const ChannelCorrection& channel : channels) {
    before = std::max(before, channel.rms_before_mps2);
    after = std::max(after, channel.rms_after_mps2);
  }
  return fmt::format("{} channels corrected: largest difference to their mean {:.4g} m/s^2, before {:.4g} m/s^2",
                     channels.size(), after, before);
}

}  // namespace crashsim
