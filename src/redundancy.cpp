#include <crashsim/redundancy.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include <fmt/format.h>

#include <crashsim/signal.hpp>

#include "channel_fields.hpp"
#include "text.hpp"

namespace crashsim {
namespace {

constexpr double kCfc = 60.0, kSamplesPerCfc = 10.0;
constexpr double kLongestShift_s = 0.01;
constexpr double kFinestShift_s = 1e-4;  // a tenth of what is told; keeps the work linear in the file
constexpr double kDeltaVTime_s = 0.15;
constexpr std::size_t kFewestSamples = 20;

bool can_be_compared(const Trace& trace) {
  return trace.problem.empty() && trace.has_samples && trace.values.size() >= kFewestSamples &&
         std::all_of(trace.values.begin(), trace.values.end(), [](double v) { return std::isfinite(v); });
}

std::string label_of(const Trace& trace) { return fmt::format("{} {}", trace.id, trace.name); }

/// The comment without what only says that the channel is redundant: "... XR", "... RED.", "... REDUNDANT".
std::string without_redundant(std::string_view comment) {
  std::string text = to_lower(trimmed(comment));
  const std::size_t at = text.rfind(' ');
  const std::string last = text.substr(at == std::string::npos ? 0 : at + 1);
  if (last == "red." || last == "red" || last == "redundant" || last == "r")
    text.resize(at == std::string::npos ? 0 : at);
  if (last.size() == 2 && last[0] >= 'x' && last[0] <= 'z' && last[1] == 'r') text.pop_back();
  return text;
}

/// Where a sensor sits and what it measures.
std::string place_of(const Trace& trace, const ChannelFields& fields) {
  return fmt::format("{}|{}|{}|{}|{}|{}", fields.of(trace, "VEHNO"), fields.of(trace, "SENLOC"),
                     fields.of(trace, "SENTYP"), trace.location, fields.of(trace, "AXIS"), trace.source_unit);
}

/// The primary channel that a redundant one belongs to, null when there is none or it is in doubt.
const Trace* primary_of(const Trace& redundant, const std::vector<const Trace*>& at_its_place) {
  if (at_its_place.size() == 1) return at_its_place.front();
  for (const Trace* primary : at_its_place)
    if (without_redundant(primary->name) == without_redundant(redundant.name)) return primary;
  return nullptr;
}

double mean_before_zero(const Trace& trace) {
  const auto times = trace.times();
  const auto count = std::lower_bound(times.begin(), times.end(), 0.0) - times.begin();
  double sum = 0.0;
  for (std::ptrdiff_t i = 0; i < count; ++i) sum += trace.values[static_cast<std::size_t>(i)];
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

/// A signal as it is compared.
std::vector<double> smooth(const Trace& trace, double dt_s) {
  std::vector<double> values = trace.values;
  const double offset = mean_before_zero(trace);
  for (double& value : values) value -= offset;
  return 1.0 / dt_s >= kSamplesPerCfc * kCfc ? cfc_filter(values, dt_s, kCfc) : values;
}

double root_mean_square(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// Sum of a_i b_(i + shift) over the samples that both have.
double overlap(std::span<const double> a, std::span<const double> b, long shift) {
  double sum = 0.0;
  const long count = std::ssize(a);
  for (long i = std::max(0L, -shift); i < std::min(count, count - shift); ++i)
    sum += a[static_cast<std::size_t>(i)] * b[static_cast<std::size_t>(i + shift)];
  return sum;
}

/// Every step-th sample.
std::vector<double> thinned(std::span<const double> values, std::size_t step) {
  std::vector<double> kept;
  for (std::size_t i = 0; i < values.size(); i += step) kept.push_back(values[i]);
  return kept;
}

/// How two signals lie to each other where they are most alike, of either sign.
struct Alignment {
  double shift_s = 0.0;
  bool is_opposite = false;
};

/// The best shift within the longest. The signals are smooth wherever their rate is above that of the shifts tried.
Alignment align(std::span<const double> first, std::span<const double> second, double dt_s) {
  constexpr double kRounding = 1e-9;
  const double fits = std::floor(kFinestShift_s / dt_s + kRounding), count = static_cast<double>(first.size());
  const auto step = static_cast<std::size_t>(std::clamp(fits, 1.0, count));
  const std::vector<double> a = thinned(first, step), b = thinned(second, step);
  const double step_s = static_cast<double>(step) * dt_s;
  const auto longest = std::min(std::lround(kLongestShift_s / step_s), static_cast<long>(a.size() / 4));
  long best = 0;
  double most = overlap(a, b, 0);
  for (long shift = -longest; shift <= longest; ++shift)
    if (const double alike = overlap(a, b, shift); std::abs(alike) > std::abs(most)) {
      most = alike;
      best = shift;
    }
  return {static_cast<double>(best) * step_s, most < 0.0};
}

void compare(const Trace& primary, const Trace& redundant, std::vector<std::string>& findings) {
  const double dt_s = uniform_step(primary.times());
  if (std::isnan(dt_s) ||
      !std::equal(primary.times().begin(), primary.times().end(), redundant.times().begin(), redundant.times().end()))
    return;
  const std::vector<double> a = smooth(primary, dt_s), b = smooth(redundant, dt_s);
  const double size = root_mean_square(a);
  const std::string what =
      fmt::format("channel {} and its redundant channel {}", label_of(primary), label_of(redundant));
  if (size == 0.0) return;
  const Alignment alignment = align(a, b, dt_s);
  if (alignment.is_opposite) {
    findings.push_back(fmt::format("{} have opposite signs", what));
    return;
  }
  const auto largest =
      std::max_element(a.begin(), a.end(), [](double x, double y) { return std::abs(x) < std::abs(y); });
  const double offset = mean_before_zero(redundant) - mean_before_zero(primary);
  if (std::abs(offset) > kSameOffset * std::abs(*largest))
    findings.push_back(fmt::format("{} differ by an offset of {:.3g} % of the peak before time 0", what,
                                   100.0 * std::abs(offset / *largest)));
  if (std::abs(alignment.shift_s) > kSameTime_s)
    findings.push_back(fmt::format("{} are {:.3g} ms apart in time", what, 1e3 * std::abs(alignment.shift_s)));
  std::vector<double> difference(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) difference[i] = b[i] - a[i];
  const double relative = root_mean_square(difference) / size;
  if (relative > kSameSignal)
    findings.push_back(fmt::format("{} differ by {:.3g} % (root mean square, CFC60)", what, 100.0 * relative));
}

void compare_redundant(const TraceSet& set, std::vector<std::string>& findings) {
  const ChannelFields fields(set);
  std::map<std::string, std::vector<const Trace*>> primaries;
  for (const Trace& trace : set.traces)
    if (fields.of(trace, "CHSTAT") == "P") primaries[place_of(trace, fields)].push_back(&trace);
  for (const Trace& trace : set.traces) {
    if (!can_be_compared(trace) || fields.of(trace, "CHSTAT") != "R") continue;
    const auto found = primaries.find(place_of(trace, fields));
    if (found == primaries.end()) continue;
    const Trace* primary = primary_of(trace, found->second);
    if (primary != nullptr && can_be_compared(*primary)) compare(*primary, trace, findings);
  }
}

/// Change of speed from time 0 on, without the mean before it.
double change_of_speed(const Trace& trace) {
  const auto times = trace.times();
  const double offset = mean_before_zero(trace);
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < times.size(); ++i)
    if (times[i] >= 0.0 && times[i + 1] <= kDeltaVTime_s)
      sum += ((trace.values[i] + trace.values[i + 1]) / 2.0 - offset) * (times[i + 1] - times[i]);
  return sum;
}

void compare_sides(const TraceSet& set, std::vector<std::string>& findings) {
  const Trace* first = nullptr;
  double first_mps = 0.0;
  for (const Trace& trace : set.traces) {
    const bool is_compartment =
        std::find(set.compartment_x.begin(), set.compartment_x.end(), trace.id) != set.compartment_x.end();
    if (!is_compartment || trace.dimension != Dimension::acceleration || !can_be_compared(trace)) continue;
    const double change_mps = change_of_speed(trace);
    if (first == nullptr) {
      first = &trace;
      first_mps = change_mps;
    } else if (std::abs(change_mps - first_mps) > kSameDeltaV * std::max(std::abs(change_mps), std::abs(first_mps))) {
      findings.push_back(fmt::format(
          "compartment channels {} and {} change speed by {:.4g} and {:.4g} m/s in {:g} ms: more than "
          "{:g} % apart",
          label_of(*first), label_of(trace), first_mps, change_mps, 1e3 * kDeltaVTime_s, 1e2 * kSameDeltaV));
    }
  }
}

}  // namespace

std::vector<std::string> check_redundant(const TraceSet& set) {
  std::vector<std::string> findings;
  compare_redundant(set, findings);
  compare_sides(set, findings);
  return findings;
}

}  // namespace crashsim
