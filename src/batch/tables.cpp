#include "batch/tables.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/metrics.hpp>
#include <crashsim/simulate_pitch.hpp>
#include <crashsim/units.hpp>

#include "json.hpp"

namespace crashsim::batch {
namespace {

/// A column: a number of the summary, or of one of its parts.
struct Column {
  std::string part, name;  ///< part "": of the summary itself

  [[nodiscard]] std::string title() const { return part.empty() ? name : part + "." + name; }
};

const std::vector<Column>& columns() {
  static const std::vector<Column> all = [] {
    std::vector<Column> columns = {{"", "mass_kg"}, {"", "impact_speed_mps"}};
    for (const auto& number : kMetricFields) columns.push_back({"", std::string(number.name)});
    for (const auto& number : kPitchNumbers) columns.push_back({"", std::string(number.name)});
    for (const char* name : {"error", "starts_at_best", "identifiable"}) columns.push_back({"identification", name});
    return columns;
  }();
  return all;
}

/// A field of a CSV file: quoted where it must be, on one line.
std::string csv_text(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  if (text.find_first_of(",\"#") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

std::string csv_value(const SummaryValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return std::isfinite(*number) ? format_number(*number) : "";
  if (const auto* count = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *count);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  return csv_text(std::get<std::string>(value));
}

std::string csv_value(const Summary& summary, const std::string& name) {
  const auto found =
      std::find_if(summary.begin(), summary.end(), [&](const SummaryItem& item) { return item.name == name; });
  return found == summary.end() ? "" : csv_value(found->value);
}

std::string csv_value(const BatchRow& row, const Column& column) {
  if (column.part.empty()) return csv_value(row.values, column.name);
  for (const auto& [name, part] : row.parts)
    if (name == column.part) return csv_value(part, column.name);
  return "";
}

}  // namespace

std::string results_header() {
  std::string line = "case,outcome,message";
  for (const Column& column : columns()) line += "," + column.title();
  return line + "\n";
}

std::string results_line(const BatchRow& row) {
  std::string line = csv_text(row.name) + "," + csv_text(row.outcome) + "," + csv_text(row.message);
  for (const Column& column : columns()) line += "," + csv_value(row, column);
  return line + "\n";
}

std::string results_json(const BatchRow& row) {
  const Json all = parse_json(to_json(row), row.name);
  Json json = {{"case", row.name}, {"outcome", row.outcome}, {"message", row.message}};
  for (const char* group : {"values", "parts"})
    for (const auto& [name, value] : all[group].items()) json[name] = value;
  return format_json_line(json) + "\n";
}

std::string timings_header() {
  std::string line = "case,seconds";
  for (const auto& stage : kStageTimes) line += fmt::format(",{}", stage.name);
  return line + "\n";
}

std::string timings_line(const BatchRow& row) {
  std::string line = fmt::format("{},{:.6f}", csv_text(row.name), row.seconds);
  for (const auto& stage : kStageTimes) line += fmt::format(",{:.6f}", row.stages.*stage.member);
  return line + "\n";
}

}  // namespace crashsim::batch
