#include "io/iso_mme_samples.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "io/last_line.hpp"
#include "number.hpp"
#include "text.hpp"

namespace crashsim::io {
namespace {

constexpr std::string_view kNoValue = "NOVALUE";

const char* skip_blanks(const char* p, const char* end) {
  while (p != end && (*p == ' ' || *p == '\t' || *p == '\r')) ++p;
  return p;
}

/// Reads a number or NOVALUE; returns where it ends, `p` when there is neither.
const char* scan_sample(const char* p, const char* end, double& value) {
  const char* after = scan_number(p, end, value);
  if (after != p) return after;
  const std::string_view rest(p, std::min(static_cast<std::size_t>(end - p), kNoValue.size()));
  if (!same_ignoring_case(rest, kNoValue)) return p;
  value = std::nan("");
  return p + kNoValue.size();
}

/// Reads the values of all lines that have an end, and of the last when it is known to be whole. Returns whether
/// something was left out at the end.
bool read_values(std::string_view data, std::size_t first_line, const std::string& path, IsoMmeSamples& samples) {
  const char* p = data.data();
  const char* const end = p + data.size();
  for (std::size_t line = first_line; p != end; ++line) {
    const char* const start = p;
    double value = 0.0;
    p = skip_blanks(p, end);
    const char* const number = p;
    p = scan_sample(p, end, value);
    const bool found = p != number;
    p = skip_blanks(p, end);
    if (p == end && found && end[-1] != '\r')
      if (!is_last_line_whole(data.substr(0, static_cast<std::size_t>(start - data.data())),
                              {start, static_cast<std::size_t>(end - start)}))
        return true;
    if (p != end && *p != '\n') {
      const std::string_view rest(number, static_cast<std::size_t>(end - number));
      const std::size_t length = rest.find('\n');
      if (length == std::string_view::npos && end[-1] != '\r') return true;
      samples.problem = fmt::format("{}:{}: '{}' is not a sample", path, line,
                                    trimmed(rest.substr(0, std::min(length, std::size_t{40}))));
      return false;
    }
    if (found) samples.values.push_back(value);
    if (p != end) ++p;
  }
  return false;
}

void compare_with_declared(double declared, bool cut, const std::string& path, IsoMmeSamples& samples) {
  const auto count = static_cast<double>(samples.values.size());
  if (count < declared && !(cut && count + 1.0 == declared)) {
    samples.problem =
        fmt::format("{}: truncated: {} of the {} samples that its header declares", path, count, declared);
    samples.warning = samples.problem;
  } else if (cut) {
    samples.warning = fmt::format("{}: the last line has no end: sample {} may be cut short and is left out", path,
                                  samples.values.size() + 1);
  } else if (count > declared) {
    samples.warning = fmt::format("{}: {} samples, but its header declares {}: all are kept", path, count, declared);
  } else if (std::isnan(declared)) {
    samples.warning =
        fmt::format("{}: its header does not say the number of samples: whether all are there is not known", path);
  }
}

}  // namespace

IsoMmeSamples parse_iso_mme_samples(std::string_view text, const IsoMmeHeader& header, const std::string& path) {
  constexpr std::size_t kShortestLine = 2;
  const std::string_view data = text.substr(std::min(header.data_offset, text.size()));
  const double declared = header.number("Number of samples");
  IsoMmeSamples samples;
  const std::size_t most = data.size() / kShortestLine + 1;
  if (declared > 0.0)
    samples.values.reserve(declared < static_cast<double>(most) ? static_cast<std::size_t>(declared) : most);
  const bool cut = read_values(data, header.data_line, path, samples);
  if (!samples.problem.empty()) {
    samples.values.clear();
    return samples;
  }
  if (samples.values.empty()) {
    samples.problem = fmt::format("{}: truncated: no samples follow its header", path);
    samples.warning = samples.problem;
    return samples;
  }
  compare_with_declared(declared, cut, path, samples);
  return samples;
}

std::vector<double> iso_mme_times(double first_s, double interval_s, std::size_t count) {
  constexpr double kWhole = 1e-9, kLargest = 1e9;
  const double rate = std::round(1.0 / interval_s), start = std::round(first_s * rate);
  const bool is_grid = rate >= 1.0 && rate <= kLargest && std::abs(rate * interval_s - 1.0) <= kWhole &&
                       std::abs(first_s * rate - start) <= kWhole * std::max(1.0, std::abs(start)) &&
                       std::abs(start) <= kLargest;
  std::vector<double> times(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto step = static_cast<double>(i);
    times[i] = is_grid ? (start + step) / rate : first_s + step * interval_s;
  }
  return times;
}

}  // namespace crashsim::io
