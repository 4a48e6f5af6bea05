#include <crashsim/load_cell_wall.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <crashsim/metrics.hpp>
#include <crashsim/option_values.hpp>
#include <crashsim/signal.hpp>
#include <crashsim/trace_io.hpp>

#include "force_rows.hpp"
#include "io/reader.hpp"
#include "wall_cells.hpp"

namespace crashsim {
namespace {

constexpr double kCell_m = 0.125;             // the walls of 16 columns
constexpr double kTallCell_m = 0.984250 / 4;  // the older wall of 4 x 9: 38.75 in high
constexpr int kRowsOfTallCells = 4;
constexpr double kCellCfc = 60.0;  // SAE J211: barrier forces
constexpr std::size_t kFewestQuietSamples = 10;
constexpr double kMomentumAgrees = 0.1;

/// The rows between which all cells lie.
struct Extent {
  int first_row = 0, last_row = 0, first_column = 0, last_column = 0;
  [[nodiscard]] int rows() const { return last_row - first_row + 1; }
  [[nodiscard]] int cells() const { return rows() * (last_column - first_column + 1); }
};

Extent extent_of(const std::vector<WallCell>& cells) {
  Extent extent{cells.front().row, cells.front().row, cells.front().column, cells.front().column};
  for (const WallCell& cell : cells) {
    extent.first_row = std::min(extent.first_row, cell.row);
    extent.last_row = std::max(extent.last_row, cell.row);
    extent.first_column = std::min(extent.first_column, cell.column);
    extent.last_column = std::max(extent.last_column, cell.column);
  }
  return extent;
}

/// Middle of a row above the wall's lower edge, which is that of its lowest row.
double height_of_row(int row, const Extent& extent, double cell_m, const WallOptions& options) {
  const int below = options.top_row == TopRow::first ? extent.last_row - row : row - extent.first_row;
  return options.lower_edge_m + (below + 0.5) * cell_m;
}

double cell_height(const Extent& extent, const std::vector<WallCell>& cells, const WallOptions& options,
                   LoadCellWall& wall) {
  const bool is_given = !std::isnan(options.cell_height_m);
  const double cell_m = is_given ? options.cell_height_m : (extent.rows() <= kRowsOfTallCells ? kTallCell_m : kCell_m);
  wall.steps.push_back(fmt::format(
      "rows of {:.5g} m, {}, row {} on top: heights {:.4g} to {:.4g} m", cell_m, is_given ? "given" : "by their number",
      options.top_row == TopRow::first ? row_name(extent.first_row) : row_name(extent.last_row),
      options.lower_edge_m + 0.5 * cell_m, options.lower_edge_m + (extent.rows() - 0.5) * cell_m));
  const bool is_assumed = cells.front().is_lettered || cells.front().column == 0;
  if (!is_given && is_assumed)
    wall.warnings.push_back(
        "the file does not say how high the cells of this wall are, nor which row is on top: heights are "
        "an assumption until cell_height_m and top_row are given from the test report");
  return cell_m;
}

/// Takes the mean before impact off, and filters.
void clean(std::vector<double>& force_n, std::span<const double> time_s, double time_zero_s, double cfc) {
  const auto quiet = std::lower_bound(time_s.begin(), time_s.end(), time_zero_s) - time_s.begin();
  if (quiet >= std::ssize(force_n)) return;
  if (static_cast<std::size_t>(quiet) >= kFewestQuietSamples) {
    const double offset = mean_between(time_s, force_n, time_s.front(), time_zero_s);
    for (double& value : force_n) value -= offset;
  }
  if (cfc > 0.0) force_n = cfc_filter(force_n, uniform_step(time_s), cfc);
}

using Strips = std::map<int, std::vector<double>>;

void add_cell(const std::vector<double>& values, std::vector<double>& strip) {
  strip.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) strip[i] += values[i];
}

/// Sums over rows and columns, clean.
std::pair<Strips, Strips> sum_up(const TraceSet& set, const std::vector<WallCell>& cells, const WallOptions& options,
                                 double cfc) {
  std::pair<Strips, Strips> sums;
  for (const WallCell& cell : cells) {
    add_cell(set.traces[cell.trace].values, sums.first[cell.row]);
    if (cell.column > 0) add_cell(set.traces[cell.trace].values, sums.second[cell.column]);
  }
  const auto times = set.traces[cells.front().trace].times();
  for (Strips* strips : {&sums.first, &sums.second})
    for (auto& [index, force_n] : *strips) clean(force_n, times, options.time_zero_s, cfc);
  return sums;
}

double filter_of(const std::vector<WallCell>& cells, const TraceSet& set, const WallOptions& options,
                 LoadCellWall& wall) {
  const bool of_cells = cells.front().column > 0;
  const double cfc = std::isnan(options.cfc) ? (of_cells ? kCellCfc : 0.0) : options.cfc;
  const auto times = set.traces[cells.front().trace].times();
  check_series(times, set.traces[cells.front().trace].values, fmt::format("{}: wall", set.path));
  if (cfc > 0.0 && std::isnan(uniform_step(times)))
    throw InvalidInput(
        fmt::format("{}: steps of the cells' time are not uniform: a filter needs uniform steps; "
                    "resample first, or give cfc = 0",
                    set.path));
  wall.steps.push_back(cfc > 0.0 ? fmt::format("filter: CFC{:g}, forward and backward", cfc)
                                 : std::string("filter: none"));
  return cfc;
}

void turn(std::vector<double>& values) {
  for (double& value : values) value = -value;
}

/// The height at every sample: told where the force is clear, linear between, held outside.
std::vector<double> at_all_times(const TimeSeries& height, std::span<const double> time_s) {
  std::vector<double> at(time_s.begin(), time_s.end());
  for (double& t : at) t = std::clamp(t, height.time_s.front(), height.time_s.back());
  return resample(height.time_s, height.values, at);
}

/// Total, height, and the strips with one sign.
void add_up(std::pair<Strips, Strips> sums, const Extent& extent, double cell_m, const WallOptions& options,
            const std::string& path, LoadCellWall& wall) {
  ForceRows total;
  std::vector<double> heights;
  for (const auto& [row, force_n] : sums.first) {
    heights.push_back(height_of_row(row, extent, cell_m, options));
    add_force(total.force, {wall.time_s, force_n}, 1.0, path);
    add_force(total.moment, {wall.time_s, force_n}, heights.back(), path);
  }
  const bool turned = turn_to_stop(total);
  if (turned) wall.steps.emplace_back("sign turned, so that the force stops the vehicle");
  for (auto& [row, force_n] : sums.first) {
    if (turned) turn(force_n);
    wall.rows.push_back({row_name(row), height_of_row(row, extent, cell_m, options), std::move(force_n)});
  }
  for (auto& [column, force_n] : sums.second) {
    if (turned) turn(force_n);
    wall.cell_columns.push_back({fmt::format("{:02}", column), kUnset, std::move(force_n)});
  }
  wall.force_height_m = at_all_times(height_of(total, heights, path, wall.warnings), wall.time_s);
  wall.total_force_n = std::move(total.force.values);
}

void tell_of_cells(const std::vector<WallCell>& cells, const Extent& extent, LoadCellWall& wall) {
  const bool of_cells = cells.front().column > 0;
  wall.coverage = static_cast<double>(wall.cells) / extent.cells();
  wall.steps.push_back(of_cells ? fmt::format("{} cells of {} rows and {} columns added up", wall.cells, extent.rows(),
                                              extent.last_column - extent.first_column + 1)
                                : fmt::format("{} row sums added up", wall.cells));
  for (const std::string& cell : wall.excluded) wall.warnings.push_back("left out: " + cell);
  std::set<std::pair<int, int>> places;
  for (const WallCell& cell : cells) places.insert({cell.row, cell.column});
  if (std::ssize(places) < extent.cells())
    wall.warnings.push_back(fmt::format("{} of {} places of the wall have no channel at all",
                                        extent.cells() - std::ssize(places), extent.cells()));
}

/// Integral over [0, end] by trapezoids, `end` between samples.
double integral_to(std::span<const double> time_s, std::span<const double> values, double end_s) {
  std::vector<double> at;
  at.push_back(std::max(0.0, time_s.front()));
  for (const double t : time_s)
    if (t > at.front() && t < end_s) at.push_back(t);
  if (end_s > at.back()) at.push_back(end_s);
  return integrate(at, resample(time_s, values, at), 0.0).back();
}

/// Moment of the rows about the level that heights are counted from.
std::vector<double> moment_of(const LoadCellWall& wall) {
  std::vector<double> moment_nm(wall.time_s.size());
  for (const WallStrip& row : wall.rows)
    for (std::size_t i = 0; i < moment_nm.size(); ++i) moment_nm[i] += row.height_m * row.force_n[i];
  return moment_nm;
}

/// What the vehicle's motion adds: work over crush, and momentum.
void use_pulse(const LoadCellWall& wall, const std::vector<double>& moment_nm, const Pulse& pulse,
               WallNumbers& numbers) {
  std::vector<double> at, force_n, height_m;
  for (std::size_t i = 0; i < wall.time_s.size(); ++i) {
    if (wall.time_s[i] < pulse.time_s.front() || wall.time_s[i] > pulse.time_s.back()) continue;
    at.push_back(wall.time_s[i]);
    force_n.push_back(wall.total_force_n[i]);
    height_m.push_back(force_n.back() == 0.0 ? 0.0 : moment_nm[i] / force_n.back());
  }
  if (at.size() < 2)
    throw InvalidInput(
        fmt::format("the wall's record, {:g} to {:g} s after impact, and the pulse's, {:g} to {:g} s, "
                    "do not overlap",
                    wall.time_s.front(), wall.time_s.back(), pulse.time_s.front(), pulse.time_s.back()));
  const std::vector<double> crush_m = resample(pulse.time_s, pulse.displacement_m, at);
  numbers.kw400_n_per_m = kw400(crush_m, force_n);
  numbers.ahof400_m = ahof400(crush_m, force_n, height_m);
  if (wall.end_s > pulse.time_s.back()) return;
  const double end_mps = resample(pulse.time_s, pulse.velocity_mps, std::vector{wall.end_s}).front();
  numbers.momentum_change_ns = pulse.mass_kg * (pulse.velocity_mps.front() - end_mps);
}

}  // namespace

std::vector<std::size_t> wall_channels(const TraceSet& catalogue, const WallOptions& options) {
  std::vector<std::size_t> channels;
  for (const WallCell& cell : find_cells(catalogue, options))
    if (catalogue.traces[cell.trace].problem.empty()) channels.push_back(cell.trace);
  return channels;
}

LoadCellWall assemble_wall(const TraceSet& traces, const WallOptions& options) {
  validate_options(options, "WallOptions");
  const std::vector<WallCell> cells = find_cells(traces, options);
  CellChoice choice = choose_cells(traces, cells);
  if (choice.used.empty())
    throw InvalidInput(fmt::format("{}: none of {} load cells can be used; the first: {}", traces.path, cells.size(),
                                   choice.excluded.front()));
  const Extent extent = extent_of(cells);
  LoadCellWall wall;
  wall.input_files = traces.input_files;
  wall.warnings = traces.warnings;
  wall.cells = static_cast<int>(choice.used.size());
  wall.excluded = std::move(choice.excluded);
  tell_of_cells(cells, extent, wall);
  const double cell_m = cell_height(extent, cells, options, wall);
  const double cfc = filter_of(choice.used, traces, options, wall);
  for (const double t : traces.traces[choice.used.front().trace].times())
    wall.time_s.push_back(t - options.time_zero_s);
  if (!(wall.time_s.back() > 0.0))
    throw InvalidInput(fmt::format("{}: the record ends at {:g} s, before the impact at {:g} s", traces.path,
                                   wall.time_s.back() + options.time_zero_s, options.time_zero_s));
  wall.end_s = std::min(options.end_s, wall.time_s.back());
  add_up(sum_up(traces, choice.used, options, cfc), extent, cell_m, options, traces.path, wall);
  return wall;
}

LoadCellWall read_wall(const std::string& path, const WallOptions& options) {
  validate_options(options, "WallOptions");
  const auto choose = [&](const TraceSet& catalogue) { return wall_channels(catalogue, options); };
  return assemble_wall(io::read_chosen(path, {{}, options.columns, options.units}, choose), options);
}

WallNumbers wall_numbers(const LoadCellWall& wall, const Pulse* pulse) {
  WallNumbers numbers;
  numbers.coverage = wall.coverage;
  const auto peak = std::max_element(wall.total_force_n.begin(), wall.total_force_n.end());
  numbers.peak_force_n = *peak;
  numbers.peak_time_s = wall.time_s[static_cast<std::size_t>(peak - wall.total_force_n.begin())];
  const std::vector<double> moment_nm = moment_of(wall);
  numbers.impulse_ns = integral_to(wall.time_s, wall.total_force_n, wall.end_s);
  numbers.mean_height_m = integral_to(wall.time_s, moment_nm, wall.end_s) / numbers.impulse_ns;
  if (pulse != nullptr) use_pulse(wall, moment_nm, *pulse, numbers);
  return numbers;
}

std::vector<std::string> check_momentum(const WallNumbers& numbers) {
  const double impulse = numbers.impulse_ns, momentum = numbers.momentum_change_ns;
  if (!(std::abs(impulse - momentum) > kMomentumAgrees * std::abs(momentum))) return {};
  return {
      fmt::format("the wall's impulse of {:.5g} N s differs by {:.0f} % from the vehicle's change of momentum, "
                  "{:.5g} N s: check cells left out, mass, speed and time zero",
                  impulse, 100.0 * std::abs(impulse / momentum - 1.0), momentum)};
}

}  // namespace crashsim
