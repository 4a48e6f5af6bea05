#pragma once
/// The numbers of a result under the names that the command line, files, tables and Python share.

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <crashsim/comparison.hpp>
#include <crashsim/identify.hpp>
#include <crashsim/identify_pitch.hpp>
#include <crashsim/identify_vertical.hpp>
#include <crashsim/load_cell_wall.hpp>
#include <crashsim/metrics.hpp>
#include <crashsim/pulse.hpp>
#include <crashsim/sensor_correction.hpp>
#include <crashsim/simulate.hpp>
#include <crashsim/simulate_coupled.hpp>
#include <crashsim/simulate_pitch.hpp>

namespace crashsim {

/// NaN where a quantity does not exist.
using SummaryValue = std::variant<double, std::int64_t, bool, std::string>;

/// One number or text of a result.
struct SummaryItem {
  std::string name;  ///< "max_crush_m"
  SummaryValue value;
  std::string doc;  ///< "maximum dynamic crush"
};
using Summary = std::vector<SummaryItem>;

/// Metrics of a pulse.
Metrics metrics_of(const Pulse& pulse);
/// Metrics of a simulation; times, crush and rebound exactly as its events found them. All unset when it broke off;
/// fewer than 3 samples leave the others unset.
Metrics metrics_of(const CrushResponse& response, double mass_kg);

/// `outcome`, then every metric. The outcome of a pulse is "completed" or "no_max_crush".
Summary summarize(const Pulse& pulse);
Summary summarize(const CrushResponse& response, double mass_kg);
/// `outcome`, then the numbers of kPitchNumbers.
Summary summarize(const PitchResponse& response);
/// `outcome`, then the numbers of kCoupledNumbers.
Summary summarize(const CoupledResponse& response);
/// Cells used and left out, then the numbers of kWallNumbers.
Summary summarize(const LoadCellWall& wall, const WallNumbers& numbers);
/// Outcome, errors, starts and verdict.
Summary summarize(const Identification& identification);
/// Outcome, errors, the numbers identified, starts and verdict.
Summary summarize(const PitchIdentification& identification);
Summary summarize(const VerticalIdentification& identification);

/// Outcome, channels, noise, and the gain of the wall.
Summary summarize(const SensorCorrection& correction);

/// The summary of a correction as a JSON object, with its channels, conditions, what the priors determine and warnings.
std::string format_summary(const SensorCorrection& correction);

/// A summary as a JSON object.
std::string format_summary(const Summary& summary);
/// The same with further summaries inside, each under its name.
std::string format_summary(const Summary& summary, const std::vector<std::pair<std::string, Summary>>& parts);

}  // namespace crashsim
