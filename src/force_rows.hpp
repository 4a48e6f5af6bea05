#pragma once
/// Rows of a load-cell wall added up: their force, and the height at which it acts.

#include <string>
#include <vector>

#include <crashsim/time_series.hpp>

namespace crashsim {

/// Sum of forces, and of forces times heights.
struct ForceRows {
  TimeSeries force, moment;
};

/// Adds `weight` b to a. @throws InvalidInput naming `what` when they are not on one clock.
void add_force(TimeSeries& a, const TimeSeries& b, double weight, const std::string& what);

/// Turns both so that the force stops the vehicle: its impulse is positive. Returns whether they were turned.
bool turn_to_stop(ForceRows& rows);

/// Height of the force where it is above 5 % of its largest value, so clear of noise; a warning where it lies outside
/// the rows. @throws InvalidInput naming `path` when that is at fewer than two samples.
TimeSeries height_of(const ForceRows& rows, const std::vector<double>& heights_m, const std::string& path,
                     std::vector<std::string>& warnings);

}  // namespace crashsim
