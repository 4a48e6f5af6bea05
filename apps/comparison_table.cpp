#include "comparison_table.hpp"

#include <cmath>

#include <fmt/format.h>

#include <crashsim/rating.hpp>

namespace crashsim::cli {
namespace {

std::string cell(double value, int decimals) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

}  // namespace

std::vector<std::string> table_of(const Comparison& comparison) {
  std::vector<std::string> lines = {
      fmt::format("  {:.4g} to {:.4g} s, every {:.4g} s", comparison.start_s, comparison.end_s, comparison.dt_s),
      fmt::format("  {:<20} {:>11} {:>11} {:>9} {:<6} | {:>6} {:<9} {:>5} {:>5} {:>5} {:>5}", "channel", "mean error",
                  "largest", "relative", "unit", "R", "grade", "Z", "EP", "EM", "ES")};
  for (const ChannelComparison& c : comparison.channels) {
    const Rating& r = c.rating;
    const std::string relative =
        std::isnan(c.errors.mean_abs_relative) ? "-" : fmt::format("{:.2f} %", 100.0 * c.errors.mean_abs_relative);
    lines.push_back(fmt::format("  {:<20} {:>11.4g} {:>11.4g} {:>9} {:<6} | {:>6} {:<9} {:>5} {:>5} {:>5} {:>5}",
                                c.name, c.errors.mean_abs, c.errors.max_abs, relative, c.unit, cell(r.overall, 3),
                                grade(r.overall), cell(r.corridor, 3), cell(r.phase, 3), cell(r.magnitude, 3),
                                cell(r.slope, 3)));
  }
  for (const ChannelComparison& c : comparison.channels)
    if (!c.not_rated.empty()) lines.push_back(fmt::format("  {} is not rated: {}", c.name, c.not_rated));
  return lines;
}

}  // namespace crashsim::cli
