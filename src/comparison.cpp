#include <crashsim/comparison.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <crashsim/metrics.hpp>
#include <crashsim/option_values.hpp>
#include <crashsim/plausibility.hpp>
#include <crashsim/signal.hpp>
#include <crashsim/units.hpp>

#include "unit_suffix.hpp"

namespace crashsim {
namespace {

constexpr std::size_t kFewestSamples = 2;
constexpr double kOnSample = 1e-6;  // of a step

/// The name without its unit: "accel" of "accel_mps2".
std::string_view stem(std::string_view name) { return name.substr(0, before_unit_suffix(name)); }

/// The candidate's channel for a reference channel: of the same name, else of the same stem and dimension.
const Trace* counterpart(const Trace& reference, const TraceSet& candidate) {
  const auto find = [&](auto matches) {
    const auto found = std::find_if(candidate.traces.begin(), candidate.traces.end(),
                                    [&](const Trace& t) { return t.has_samples && matches(t); });
    return found == candidate.traces.end() ? nullptr : &*found;
  };
  if (const Trace* same = find([&](const Trace& t) { return t.name == reference.name; })) return same;
  return find(
      [&](const Trace& t) { return t.dimension == reference.dimension && stem(t.name) == stem(reference.name); });
}

struct Pair {
  const Trace* reference;
  const Trace* candidate;
};

std::vector<std::string> names_of(const TraceSet& set) {
  std::vector<std::string> names;
  for (const Trace& trace : set.traces) names.push_back(trace.name);
  return names;
}

std::vector<Pair> pair_up(const TraceSet& reference, const TraceSet& candidate, const CompareOptions& options,
                          Comparison& out) {
  std::vector<bool> wanted(reference.traces.size(), options.channels.empty());
  for (const std::string& selector : options.channels)
    for (const std::size_t i : select_channels(reference, selector)) wanted[i] = true;
  std::vector<Pair> pairs;
  std::vector<std::string> alone;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const Trace& trace = reference.traces[i];
    if (!wanted[i] || !trace.has_samples) continue;
    const Trace* other = counterpart(trace, candidate);
    if (other != nullptr)
      pairs.push_back({&trace, other});
    else
      alone.push_back(trace.name);
  }
  if (pairs.empty())
    throw InvalidInput(fmt::format("{} and {} have no channel in common: {} against {}", reference.path, candidate.path,
                                   fmt::join(alone, ", "), fmt::join(names_of(candidate), ", ")));
  if (!alone.empty()) out.notes.push_back(fmt::format("not in {}: {}", candidate.path, fmt::join(alone, ", ")));
  return pairs;
}

/// The times to compare at: the reference's own inside the range, made uniform where they are not.
std::vector<double> common_times(const Pair& pair, const CompareOptions& options, Comparison& out) {
  const auto a = pair.reference->times(), b = pair.candidate->times();
  double from = std::max(a.front(), b.front()), to = std::min(a.back(), b.back());
  if (!std::isnan(options.start_s)) from = std::max(from, options.start_s);
  if (!std::isnan(options.end_s)) to = std::min(to, options.end_s);
  double step = uniform_step(a);
  const bool is_uniform = !std::isnan(step);
  if (!is_uniform) {
    step = (a.back() - a.front()) / static_cast<double>(a.size() - 1);
    out.notes.push_back(fmt::format("{}: steps are not uniform: compared every {:.4g} s", pair.reference->name, step));
  }
  const std::vector<double> grid =
      is_uniform ? std::vector<double>(a.begin(), a.end()) : uniform_times(a.front(), step, a.size());
  std::vector<double> times;
  for (const double t : grid)
    if (t >= from - kOnSample * step && t <= to + kOnSample * step) times.push_back(std::clamp(t, from, to));
  if (times.size() < kFewestSamples)
    throw InvalidInput(
        fmt::format("{}: {} samples between {:g} and {:g} s, where both have samples and the comparison was asked for: "
                    "at least {} are needed",
                    pair.reference->name, times.size(), from, to, kFewestSamples));
  out.dt_s = step;
  return times;
}

ChannelComparison compare_channel(const Pair& pair, const CompareOptions& options, Comparison& out) {
  check_series(pair.reference->times(), pair.reference->values, pair.reference->name, kFewestSamples);
  check_series(pair.candidate->times(), pair.candidate->values, pair.candidate->name, kFewestSamples);
  const std::vector<double> times = common_times(pair, options, out);
  const std::vector<double> reference = resample(pair.reference->times(), pair.reference->values, times);
  const std::vector<double> candidate = resample(pair.candidate->times(), pair.candidate->values, times);
  out.start_s = std::fmin(out.start_s, times.front());
  out.end_s = std::fmax(out.end_s, times.back());
  ChannelComparison channel;
  channel.name = pair.reference->name;
  channel.unit = si_symbol(pair.reference->dimension);
  channel.errors = errors(reference, candidate);
  try {
    channel.rating = rate(reference, candidate, out.dt_s);
  } catch (const InvalidInput& problem) {
    channel.not_rated = problem.what();
  }
  return channel;
}

/// The motion that a set holds.
std::optional<Motion> motion_in(const TraceSet& set) {
  constexpr std::size_t kFewestOfMotion = 3;
  const auto find = [&](std::string_view name, Dimension dimension) -> const Trace* {
    const auto found = std::find_if(set.traces.begin(), set.traces.end(), [&](const Trace& trace) {
      return trace.has_samples && trace.dimension == dimension && stem(trace.name) == name;
    });
    return found == set.traces.end() ? nullptr : &*found;
  };
  const Trace* accel = find("accel", Dimension::acceleration);
  const Trace* velocity = find("velocity", Dimension::speed);
  const Trace* displacement = find("displacement", Dimension::length);
  if (accel == nullptr || velocity == nullptr || displacement == nullptr) return std::nullopt;
  const auto times = accel->times();
  for (const Trace* other : {velocity, displacement})
    if (!std::equal(times.begin(), times.end(), other->times().begin(), other->times().end())) return std::nullopt;
  const auto impact = std::lower_bound(times.begin(), times.end(), 0.0) - times.begin();
  if (times.size() < static_cast<std::size_t>(impact) + kFewestOfMotion) return std::nullopt;
  if (!(velocity->values[static_cast<std::size_t>(impact)] > 0.0)) return std::nullopt;
  return Motion{times, accel->values, velocity->values, displacement->values};
}

}  // namespace

Comparison compare(const TraceSet& reference, const TraceSet& candidate, const CompareOptions& options) {
  validate_options(options, "CompareOptions");
  Comparison out;
  for (const Pair& pair : pair_up(reference, candidate, options, out))
    out.channels.push_back(compare_channel(pair, options, out));
  return out;
}

std::vector<MetricComparison> compare_metrics(const TraceSet& reference, const TraceSet& candidate) {
  const std::optional<Motion> first = motion_in(reference), second = motion_in(candidate);
  std::vector<MetricComparison> compared;
  if (!first || !second) return compared;
  const Metrics a = metrics(*first, reference.mass_kg), b = metrics(*second, candidate.mass_kg);
  for (const MetricField& field : kMetricFields) {
    const double of_reference = a.*field.member, of_candidate = b.*field.member;
    compared.push_back({std::string(field.name), std::string(field.doc), of_reference, of_candidate,
                        (of_candidate - of_reference) / std::abs(of_reference)});
  }
  return compared;
}

std::vector<std::string> check_motion(const TraceSet& set) {
  const std::optional<Motion> motion = motion_in(set);
  if (!motion) return {};
  std::vector<std::string> findings =
      check_balance(motion_balance(motion->time_s, motion->accel_mps2, motion->velocity_mps, motion->displacement_m));
  for (std::string& finding : findings) finding = fmt::format("{}: {}", set.path, finding);
  return findings;
}

}  // namespace crashsim
