#include "comparison_table.hpp"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <crashsim/files.hpp>
#include <crashsim/rating.hpp>

#include "shown_number.hpp"

namespace crashsim::cli {
namespace {

std::string cell(double value, int decimals) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

std::string percent(double ratio) { return std::isnan(ratio) ? "-" : fmt::format("{:.2f} %", 100.0 * ratio); }

std::string markdown_row(const std::vector<std::string>& cells) {
  return fmt::format("| {} |", fmt::join(cells, " | "));
}

/// Header and ruler of a Markdown table; the first `left` columns are text, the others numbers.
std::vector<std::string> markdown_head(const std::vector<std::string>& names, std::size_t left) {
  std::vector<std::string> ruler(names.size(), "---:");
  for (std::size_t i = 0; i < left; ++i) ruler[i] = "---";
  return {markdown_row(names), markdown_row(ruler)};
}

/// All digits; nothing when unset.
std::string csv_number(double value) { return std::isnan(value) ? "" : format_number(value); }

/// A name that may hold commas or quotes.
std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::vector<std::string> plain_channels(const Comparison& comparison) {
  std::vector<std::string> lines = {
      fmt::format("  {:.4g} to {:.4g} s, every {:.4g} s", comparison.start_s, comparison.end_s, comparison.dt_s),
      fmt::format("  {:<20} {:>11} {:>11} {:>9} {:<6} | {:>6} {:<9} {:>5} {:>5} {:>5} {:>5}", "channel", "mean error",
                  "largest", "relative", "unit", "R", "grade", "Z", "EP", "EM", "ES")};
  for (const ChannelComparison& c : comparison.channels) {
    const Rating& r = c.rating;
    lines.push_back(fmt::format("  {:<20} {:>11.4g} {:>11.4g} {:>9} {:<6} | {:>6} {:<9} {:>5} {:>5} {:>5} {:>5}",
                                c.name, c.errors.mean_abs, c.errors.max_abs, percent(c.errors.mean_abs_relative),
                                c.unit, cell(r.overall, 3), grade(r.overall), cell(r.corridor, 3), cell(r.phase, 3),
                                cell(r.magnitude, 3), cell(r.slope, 3)));
  }
  for (const ChannelComparison& c : comparison.channels)
    if (!c.not_rated.empty()) lines.push_back(fmt::format("  {} is not rated: {}", c.name, c.not_rated));
  return lines;
}

std::vector<std::string> markdown_channels(const Comparison& comparison) {
  std::vector<std::string> lines =
      markdown_head({"channel", "unit", "grade", "mean error", "largest", "relative", "R", "Z", "EP", "EM", "ES"}, 3);
  for (const ChannelComparison& c : comparison.channels) {
    const Rating& r = c.rating;
    lines.push_back(
        markdown_row({c.name, c.unit, std::string(grade(r.overall)), fmt::format("{:.4g}", c.errors.mean_abs),
                      fmt::format("{:.4g}", c.errors.max_abs), percent(c.errors.mean_abs_relative), cell(r.overall, 3),
                      cell(r.corridor, 3), cell(r.phase, 3), cell(r.magnitude, 3), cell(r.slope, 3)}));
  }
  lines.push_back("");
  lines.push_back(
      fmt::format("Compared from {:.4g} to {:.4g} s; R by ISO/TS 18571.", comparison.start_s, comparison.end_s));
  for (const ChannelComparison& c : comparison.channels)
    if (!c.not_rated.empty()) lines.push_back(fmt::format("{} is not rated: {}", c.name, c.not_rated));
  return lines;
}

std::vector<std::string> csv_channels(const Comparison& comparison) {
  std::string head = "channel,unit,start_s,end_s,grade";
  for (const auto& field : kErrorFields) head += fmt::format(",{}", field.name);
  for (const auto& field : kRatingFields) head += fmt::format(",{}", field.name);
  std::vector<std::string> lines = {head};
  for (const ChannelComparison& c : comparison.channels) {
    std::string line = fmt::format("{},{},{},{},{}", csv_text(c.name), c.unit, format_number(comparison.start_s),
                                   format_number(comparison.end_s), grade(c.rating.overall));
    for (const auto& field : kErrorFields) line += "," + csv_number(c.errors.*field.member);
    for (const auto& field : kRatingFields) line += "," + csv_number(c.rating.*field.member);
    lines.push_back(line);
  }
  return lines;
}

std::string scaled(const MetricComparison& metric, double value) {
  return std::isnan(value) ? "-" : fmt::format("{:.5g}", value * shown_as(metric.name).factor);
}

std::string signed_percent(double ratio) {
  return std::isfinite(ratio) ? fmt::format("{:+.2f} %", 100.0 * ratio) : "-";
}

}  // namespace

std::vector<std::string> table_of(const Comparison& comparison, TableFormat format) {
  if (format == TableFormat::markdown) return markdown_channels(comparison);
  return format == TableFormat::csv ? csv_channels(comparison) : plain_channels(comparison);
}

std::vector<std::string> table_of(const std::vector<MetricComparison>& metrics, TableFormat format) {
  if (metrics.empty()) return {};
  std::vector<std::string> lines;
  if (format == TableFormat::markdown)
    lines = markdown_head({"metric", "unit", "reference", "candidate", "difference"}, 2);
  if (format == TableFormat::csv) lines = {"metric,reference,candidate,difference"};
  if (format == TableFormat::plain)
    lines = {
        fmt::format("  {:<34} {:>11} {:>11} {:<6} {:>11}", "metric", "reference", "candidate", "unit", "difference")};
  for (const MetricComparison& m : metrics) {
    const std::string_view unit = shown_as(m.name).unit;
    if (format == TableFormat::csv)
      lines.push_back(fmt::format("{},{},{},{}", m.name, csv_number(m.reference), csv_number(m.candidate),
                                  csv_number(m.difference)));
    else if (format == TableFormat::markdown)
      lines.push_back(markdown_row(
          {m.doc, std::string(unit), scaled(m, m.reference), scaled(m, m.candidate), signed_percent(m.difference)}));
    else
      lines.push_back(fmt::format("  {:<34} {:>11} {:>11} {:<6} {:>11}", m.doc, scaled(m, m.reference),
                                  scaled(m, m.candidate), unit, signed_percent(m.difference)));
  }
  return lines;
}

}  // namespace crashsim::cli
