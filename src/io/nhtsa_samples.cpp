#include "io/nhtsa_samples.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include <crashsim/units.hpp>

#include "io/input_file.hpp"
#include "io/last_line.hpp"
#include "io/unit_system.hpp"
#include "number.hpp"
#include "text.hpp"

namespace crashsim::io {
namespace {

constexpr double kTimeRounding_s = 1e-6;  // files print times with six decimals
constexpr int kMostHeaderLines = 50;

const char* skip_blanks(const char* p, const char* end) {
  while (p != end && (*p == ' ' || *p == '\t' || *p == '\r' || *p == ',')) ++p;
  return p;
}

/// One line of a channel file.
struct Row {
  double numbers[2] = {};
  int count = 0;          ///< How many numbers it starts with, at most two.
  std::string_view rest;  ///< What follows them.
};

Row parse_row(std::string_view line) {
  Row row;
  const char* p = line.data();
  const char* const end = p + line.size();
  p = skip_blanks(p, end);
  for (; row.count < 2 && p != end; ++row.count) {
    const char* const after = scan_number(p, end, row.numbers[row.count]);
    if (after == p) break;
    p = skip_blanks(after, end);
  }
  row.rest = {p, static_cast<std::size_t>(end - p)};
  return row;
}

/// Collects the rows of a file line by line.
class RowCollector {
 public:
  explicit RowCollector(const std::string& path) : path_(path) {}

  /// Takes the next line of a text, without its end. False when there is no use in going on.
  bool take(std::string_view line, bool is_ended) {
    ++number_;
    const std::string_view text = trimmed(line);
    if (text.empty()) return true;
    const Row row = parse_row(text);
    const bool is_first = rows_.values.empty();
    const bool fits = row.count > 0 && row.rest.empty() && (is_first || (row.count == 2) == !rows_.times.empty());
    if (!is_ended && !(fits && !is_first && is_last_line_whole(rows_before(line), line))) {
      rows_.last_is_dropped = true;
      if (is_first && !fits) note(row);
      return false;
    }
    if (!fits) return pass_over(row, text);
    if (row.count == 2) rows_.times.push_back(row.numbers[0]);
    rows_.values.push_back(row.numbers[row.count - 1]);
    if (is_first) first_row_ = line.data();
    return true;
  }

  NhtsaRows result() {
    if (!rows_.values.empty()) return std::move(rows_);
    rows_.problem = odd_.empty() ? fmt::format("{}: the file is empty", path_) : odd_;
    return std::move(rows_);
  }

 private:
  /// The text from the first row up to a line.
  [[nodiscard]] std::string_view rows_before(std::string_view line) const {
    return {first_row_, static_cast<std::size_t>(line.data() - first_row_)};
  }

  void note(const Row& row) {
    constexpr std::size_t kMost = 40;
    if (odd_.empty())
      odd_ = fmt::format("{}:{}: '{}' is not a sample", path_, number_, trimmed(row.rest.substr(0, kMost)));
  }

  /// Text before the numbers is a header; anything else spoils the file.
  bool pass_over(const Row& row, std::string_view text) {
    const bool is_header =
        rows_.values.empty() && row.count == 0 && text.front() != '<' && ++headers_ < kMostHeaderLines;
    if (!rows_.values.empty()) {
      rows_ = {};
      odd_.clear();
    }
    note(row);
    return is_header;
  }

  const std::string& path_;
  std::size_t number_ = 0;
  int headers_ = 0;
  std::string odd_;                  ///< The first line that is no row.
  const char* first_row_ = nullptr;  ///< In the text that the lines are of.
  NhtsaRows rows_;
};

bool agree(const std::vector<double>& a, const std::vector<double>& b, double step_us) {
  const double tolerance_s = std::max(kTimeRounding_s, 0.02 * step_us / 1e6);
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](double x, double y) { return std::abs(x - y) <= tolerance_s; });
}

/// What the number of rows says beside what the header declares.
void compare_with_declared(const NhtsaChannel& c, const NhtsaRows& rows, const std::string& path, Trace& trace,
                           TraceSet& set) {
  const long declared = c.last - c.first + 1, found = std::ssize(rows.values);
  if (rows.last_is_dropped)
    set.warnings.push_back(fmt::format("{}: its last line has no end and may be cut short: left out", path));
  if (found > declared)
    set.warnings.push_back(
        fmt::format("{}: {} samples, {} more than its header declares: all are used", path, found, found - declared));
  if (trace.problem.empty() && found + (rows.last_is_dropped ? 1 : 0) < declared)
    trace.problem = fmt::format("{}: truncated: {} of the {} samples that its header declares", path, found, declared);
}

/// The file's own times where they differ from the header's.
void set_times(const NhtsaChannel& c, NhtsaRows& rows, const std::string& path, NhtsaClocks& clocks, Trace& trace,
               TraceSet& set) {
  trace.time_s = clocks.of(c, rows.values.size());
  if (rows.times.empty() || agree(rows.times, *trace.time_s, c.step_us)) return;
  set.warnings.push_back(
      fmt::format("{}: times in the file differ from those of its header; the file's are used", path));
  const auto back =
      std::adjacent_find(rows.times.begin(), rows.times.end(), [](double a, double b) { return !(a < b); });
  if (back != rows.times.end() && trace.problem.empty())
    trace.problem =
        fmt::format("{}: time does not increase after sample {}, {:g} s", path, back - rows.times.begin() + 1, *back);
  trace.time_s = std::make_shared<const std::vector<double>>(std::move(rows.times));
}

}  // namespace

NhtsaRows parse_nhtsa_rows(std::string_view text, const std::string& path) {
  RowCollector collector(path);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    const bool is_ended = end != std::string_view::npos;
    if (!collector.take(text.substr(at, is_ended ? end - at : end), is_ended) || !is_ended) break;
    at = end + 1;
  }
  return collector.result();
}

std::shared_ptr<const std::vector<double>> NhtsaClocks::of(const NhtsaChannel& c, std::size_t count) {
  auto& clock = clocks_[{c.first, count, c.step_us}];
  if (clock) return clock;
  std::vector<double> times(count);
  for (std::size_t i = 0; i < count; ++i)
    times[i] = (static_cast<double>(c.first) + static_cast<double>(i)) * c.step_us / 1e6;
  clock = std::make_shared<const std::vector<double>>(std::move(times));
  return clock;
}

void read_nhtsa_samples(const NhtsaChannel& c, const std::string& path, NhtsaClocks& clocks, Trace& trace,
                        TraceSet& set) {
  const InputFile file(path);
  NhtsaRows rows = parse_nhtsa_rows(file.bytes(), path);
  set.input_files.push_back(path);
  if (!rows.problem.empty()) {
    trace.problem = rows.problem;
    return;
  }
  compare_with_declared(c, rows, path, trace, set);
  set_times(c, rows, path, clocks, trace, set);
  if (const auto unit = find_unit(c.y_unit)) scale(rows.values, unit->to_si);
  trace.values = std::move(rows.values);
  trace.has_samples = true;
}

}  // namespace crashsim::io
