/// Tables of numbers as text: our own and foreign ones.

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "io/csv_layout.hpp"
#include "io/reader.hpp"
#include "io/unit_system.hpp"
#include "text.hpp"
#include "unit_suffix.hpp"

namespace crashsim::io {
namespace {

constexpr double kLongestUnlabelled_s = 5.0;

/// A column's name and unit. A bracketed unit is not part of the name, a suffix is.
struct ColumnHead {
  std::string name, unit_text;
  std::optional<Unit> unit;
};

ColumnHead head_with_unit(std::string_view name, std::string_view unit_text) {
  return {std::string(trimmed(name)), std::string(trimmed(unit_text)), find_unit(unit_text)};
}

/// `name [unit]`, `name (unit)` or `name_unit`.
ColumnHead parse_head(std::string_view cell) {
  const std::string_view text = trimmed(cell);
  for (const auto& [open, close] : {std::pair('[', ']'), std::pair('(', ')')}) {
    const std::size_t at = text.rfind(open);
    if (text.ends_with(close) && at != std::string_view::npos && at > 0)
      return head_with_unit(text.substr(0, at), text.substr(at + 1, text.size() - at - 2));
  }
  const std::size_t at = before_unit_suffix(text);
  if (at != std::string_view::npos) return head_with_unit(text, text.substr(at + 1));
  return {std::string(text), "", std::nullopt};
}

std::vector<ColumnHead> heads_from_file(const CsvLayout& layout) {
  std::vector<ColumnHead> heads(layout.columns);
  for (std::size_t i = 0; i < layout.names.size(); ++i) {
    heads[i] = parse_head(layout.names[i]);
    if (layout.units.empty() || layout.units[i].empty()) continue;
    heads[i] = head_with_unit(layout.names[i], layout.units[i]);
  }
  return heads;
}

/// "time:ms,accel:g", in column order; an empty entry leaves its column as the file says.
void apply_columns_option(const std::string& option, const CsvLayout& layout, const std::string& path,
                          std::vector<ColumnHead>& heads) {
  const auto entries = split(option, ',');
  if (entries.size() != layout.columns)
    throw InvalidInput(
        fmt::format("{}: has {} columns, but columns = '{}' names {}", path, layout.columns, option, entries.size()));
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (trimmed(entries[i]).empty()) continue;
    const std::size_t colon = entries[i].rfind(':');
    if (colon == std::string_view::npos) {
      heads[i] = parse_head(entries[i]);
      continue;
    }
    heads[i] = head_with_unit(entries[i].substr(0, colon), entries[i].substr(colon + 1));
    if (!heads[i].unit)
      throw InvalidInput(fmt::format("{}: columns = '{}': unknown unit '{}'", path, option, heads[i].unit_text));
  }
}

std::vector<ColumnHead> column_heads(const CsvLayout& layout, const ReadOptions& options, const std::string& path) {
  std::vector<ColumnHead> heads = heads_from_file(layout);
  if (!options.columns.empty()) {
    apply_columns_option(options.columns, layout, path, heads);
  } else if (layout.odd_line != 0) {
    throw InvalidInput(
        fmt::format("{}:{}: this line before the numbers is no header for their {} columns; name the "
                    "columns, for example columns = time:s,accel:g",
                    path, layout.odd_line, layout.columns));
  } else if (layout.names.empty()) {
    throw InvalidInput(
        fmt::format("{}: no header: name the {} columns, for example columns = time:s,accel:g", path, layout.columns));
  }
  return heads;
}

bool is_called_time(const std::string& name) {
  const std::string lower_name = to_lower(name);
  return lower_name == "t" || lower_name == "zeit" || lower_name.starts_with("time");
}

std::size_t find_time_column(const std::vector<ColumnHead>& heads, const std::string& path) {
  for (std::size_t i = 0; i < heads.size(); ++i)
    if (is_called_time(heads[i].name)) return i;
  for (std::size_t i = 0; i < heads.size(); ++i)
    if (heads[i].unit && heads[i].unit->dimension == Dimension::time) return i;
  throw InvalidInput(
      fmt::format("{}: no time column: call one 'time_s', or name the columns, for example columns = "
                  "time:s,accel:g",
                  path));
}

double time_factor(const ColumnHead& time, const std::string& path) {
  if (!time.unit) return 1.0;
  if (time.unit->dimension != Dimension::time)
    throw InvalidInput(fmt::format("{}: time column '{}': '{}' measures {}, not time", path, time.name, time.unit_text,
                                   dimension_name(time.unit->dimension)));
  return time.unit->to_si;
}

TraceSet catalogue_of(const InputFile& file, const CsvLayout& layout, const std::vector<ColumnHead>& heads,
                      std::size_t time_column) {
  TraceSet set;
  set.path = file.path();
  set.input_files = {file.path()};
  set.metadata = layout.comments;
  for (const auto& [key, value] : layout.comments) {
    if (key == "mass_kg") set.mass_kg = parse_number(value).value_or(kUnset);
    if (key == "impact_speed_mps") set.impact_speed_mps = parse_number(value).value_or(kUnset);
    if (key == "title") set.title = value;
  }
  for (std::size_t i = 0; i < heads.size(); ++i) {
    if (i == time_column) continue;
    Trace trace;
    trace.id = std::to_string(i + 1);
    trace.name = heads[i].name.empty() ? fmt::format("column {}", i + 1) : heads[i].name;
    trace.source_unit = heads[i].unit_text;
    if (heads[i].unit) trace.dimension = heads[i].unit->dimension;
    trace.has_samples = false;
    set.traces.push_back(std::move(trace));
  }
  for (const auto& [key, value] : layout.comments) {
    if (key != "compartment_x" || !set.compartment_x.empty()) continue;
    for (const Trace& trace : set.traces)
      if (trace.name == value) set.compartment_x.push_back(trace.id);
  }
  return set;
}

/// Times without a unit are taken as seconds when a crash can be that long.
void check_unlabelled_time(const ColumnHead& head, const std::vector<double>& times, TraceSet& set) {
  if (head.unit || times.empty()) return;
  if (times.back() - times.front() > kLongestUnlabelled_s)
    throw InvalidInput(
        fmt::format("{}: time column '{}' has no unit and spans {:g}: too long to be seconds; say its unit, "
                    "for example columns = time:ms,accel:g",
                    set.path, head.name, times.back() - times.front()));
  set.warnings.push_back(fmt::format("{}: time column '{}' has no unit: taken as seconds", set.path, head.name));
}

bool is_markup(std::string_view text) { return text.starts_with('{') || text.starts_with('<'); }

bool detects(const InputFile& file) {
  return !file.is_folder() && !is_markup(trimmed(file.bytes().substr(0, 64))) && find_layout(file.bytes()).has_value();
}

TraceSet read(const InputFile& file, const ReadOptions& options, const Choose& choose) {
  const CsvLayout layout = find_layout(file.bytes()).value();
  if (const std::size_t most = most_channels(file.bytes().size()); layout.columns > most)
    throw InvalidInput(fmt::format("{}:{}: a row of more than {} cells, more channels than fit memory", file.path(),
                                   layout.data_line, most));
  const std::vector<ColumnHead> heads = column_heads(layout, options, file.path());
  const std::size_t time_column = find_time_column(heads, file.path());
  const double to_seconds = time_factor(heads[time_column], file.path());
  TraceSet set = catalogue_of(file, layout, heads, time_column);
  if (!options.units.empty())
    set.warnings.push_back(
        fmt::format("{}: units = {} has no effect: columns of a CSV file say their own, or are told by "
                    "columns = time:s,accel:g",
                    set.path, options.units));

  std::vector<bool> wanted(layout.columns);
  wanted[time_column] = true;
  const auto column_of = [&](std::size_t trace) { return trace < time_column ? trace : trace + 1; };
  const std::vector<std::size_t> chosen = choose(set);
  for (const std::size_t i : chosen) wanted[column_of(i)] = true;
  auto columns = read_columns(file.bytes(), layout, wanted, time_column, file.path());
  warn_when_open_ended(file.bytes(), set);
  check_unlabelled_time(heads[time_column], columns[time_column], set);
  scale(columns[time_column], to_seconds);
  const auto time_s = std::make_shared<const std::vector<double>>(std::move(columns[time_column]));
  for (const std::size_t i : chosen) {
    Trace& trace = set.traces[i];
    trace.values = std::move(columns[column_of(i)]);
    if (const auto& unit = heads[column_of(i)].unit) scale(trace.values, unit->to_si);
    trace.time_s = time_s;
    trace.has_samples = true;
  }
  return set;
}

}  // namespace

const Reader kCsvReader = {"csv", "CSV (time and channels in columns)", detects, read};

}  // namespace crashsim::io
