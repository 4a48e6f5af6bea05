#include "force_rows.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/signal.hpp>

namespace crashsim {
namespace {

constexpr double kClearForce = 0.05;  // of the largest: below it the height of a force says nothing

}  // namespace

void add_force(TimeSeries& a, const TimeSeries& b, double weight, const std::string& what) {
  if (a.empty()) {
    a = {b.time_s, std::vector<double>(b.values.size(), 0.0)};
  } else if (a.time_s != b.time_s) {
    throw InvalidInput(
        fmt::format("{}: has other times than the channels before it: only channels of one clock add up", what));
  }
  for (std::size_t i = 0; i < a.values.size(); ++i) a.values[i] += weight * b.values[i];
}

bool turn_to_stop(ForceRows& rows) {
  if (!(integrate(rows.force.time_s, rows.force.values, 0.0).back() < 0.0)) return false;
  for (TimeSeries* series : {&rows.force, &rows.moment})
    for (double& value : series->values) value = -value;
  return true;
}

TimeSeries height_of(const ForceRows& rows, const std::vector<double>& heights_m, const std::string& path,
                     std::vector<std::string>& warnings) {
  const double largest = *std::max_element(rows.force.values.begin(), rows.force.values.end());
  const auto [lowest, highest] = std::minmax_element(heights_m.begin(), heights_m.end());
  TimeSeries height;
  for (std::size_t i = 0; i < rows.force.values.size(); ++i) {
    if (!(rows.force.values[i] > kClearForce * largest)) continue;
    height.time_s.push_back(rows.force.time_s[i]);
    height.values.push_back(rows.moment.values[i] / rows.force.values[i]);
  }
  if (height.values.size() < 2)
    throw InvalidInput(
        fmt::format("{}: the longitudinal channels add up to no force whose height could be told", path));
  const auto outside = std::count_if(height.values.begin(), height.values.end(),
                                     [low = *lowest, high = *highest](double h) { return h < low || h > high; });
  if (outside > 0)
    warnings.push_back(
        fmt::format("{}: the height of the force lies outside the rows, {:g} to {:g} m, in {} of {} samples: "
                    "some rows pull",
                    path, *lowest, *highest, outside, height.values.size()));
  return height;
}

}  // namespace crashsim
