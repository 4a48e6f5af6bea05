#pragma once
/// Load-cell walls: the barrier's force, by rows and columns of cells, and the height at which it acts.

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <crashsim/error.hpp>
#include <crashsim/named_number.hpp>
#include <crashsim/options.hpp>
#include <crashsim/pulse.hpp>
#include <crashsim/trace.hpp>

namespace crashsim {

/// Which row of cells is on top: the first (A, or 1) or the last. Test reports say; headers do not.
enum class TopRow { first, last };
inline constexpr std::string_view kTopRowNames[] = {"first", "last"};
template <>
inline constexpr std::span<const std::string_view> enum_names<TopRow>{kTopRowNames};

/// How a wall is put together from its cells, or from sums of its rows.
struct WallOptions {
  std::vector<std::string>
      rows;  ///< Channels that are row sums, first row first; empty: cells and rows by their names.
  double cell_height_m =
      kUnset;                 ///< Height of a row [m]; unset: 0.125, with four rows or fewer 0.24606 (38.75 in / 4).
  double lower_edge_m = 0.0;  ///< Height of the wall's lower edge above the level that heights are counted from [m].
  TopRow top_row = TopRow::first;  ///< Which row is on top.
  double cfc = kUnset;             ///< Filter of the forces [Hz]; 0: none; unset: 60 for cells, none for row sums.
  double time_zero_s = 0.0;        ///< Impact on the trace's clock [s].
  double end_s = 0.15;             ///< Impulse and mean height are taken from impact to here [s].
  std::string columns, units;      ///< As in ReadOptions.

  bool operator==(const WallOptions&) const = default;
};
inline constexpr std::array<Field<WallOptions>, 9> kWallFields = {{
    {"rows", "row", "", "channel that is the sum of a row, first row first; default: by their names",
     &WallOptions::rows},
    {"cell_height_m", "cell-height", "m", "height of a row of cells; default 0.125, with four rows or fewer 0.24606",
     &WallOptions::cell_height_m, positive()},
    {"lower_edge_m", "lower-edge", "m", "height of the wall's lower edge, added to all heights",
     &WallOptions::lower_edge_m, at_least(0.0)},
    {"top_row", "top-row", "", "which row is on top, the first (A or 1) or the last", choice<&WallOptions::top_row>()},
    {"cfc", "cfc", "Hz", "filter of the forces, 0: none; default: 60 for cells, none for row sums", &WallOptions::cfc,
     at_least(0.0)},
    {"time_zero_s", "t0", "s", "time of impact in the trace", &WallOptions::time_zero_s},
    {"end_s", "end", "s", "end of impulse and mean height, after impact", &WallOptions::end_s, positive()},
    {"columns", "columns", "", "columns of a CSV file: time:ms,force:kN", &WallOptions::columns},
    {"units", "units", "", "unit system of FE output: kg-m-s, t-mm-s, kg-mm-ms, g-mm-ms", &WallOptions::units},
}};
template <>
inline constexpr std::span<const Field<WallOptions>> fields<WallOptions>{kWallFields};

/// Cells of one row or column added up.
struct WallStrip {
  std::string name;             ///< Of a row "a", "b", ... (1 is a); of a column "01".
  double height_m = kUnset;     ///< Of a row's middle [m]; unset for columns.
  std::vector<double> force_n;  ///< Positive where it stops the vehicle [N].
};

/// A wall's force over time.
struct LoadCellWall {
  std::vector<double> time_s;           ///< From impact on the clock of the trace [s]; also before impact.
  std::vector<double> total_force_n;    ///< Positive where it stops the vehicle [N].
  std::vector<double> force_height_m;   ///< Of the total force [m]; where that is below 5 % of its largest value,
                                        ///< between the heights before and after.
  std::vector<WallStrip> rows;          ///< First row first.
  std::vector<WallStrip> cell_columns;  ///< Empty when made of row sums.
  int cells = 0;                        ///< Cells (or row sums) that were added up.
  double coverage = kUnset;             ///< Their share of the rectangle that all known cells span.
  std::vector<std::string> excluded;    ///< Cells left out, and why: "C-04 (channel 500): ... (DASTAT CF)".
  double end_s = kUnset;                ///< As in the options, but inside the record.
  std::vector<std::string> steps, warnings, input_files;
};

/// Indices of the cells or row sums in a catalogue, good ones only.
std::vector<std::size_t> wall_channels(const TraceSet& catalogue, const WallOptions& options = {});

/// Puts a wall together from the barrier's longitudinal forces. Cells are known by sensor location ("LC1101": row 11,
/// column 1; "LCA1": row A) or comment ("BARRIER K-01 Fx"); in an NHTSA test also by VEHNO 0, load cell, axis X and
/// dimension force together. Row sums are known by the name `row_a...` or chosen. Left out and named are cells flagged
/// bad, absent, without change, beyond their range (INSRAT), not finite, or on another clock. The mean before impact is
/// taken off each row (from 10 samples on).
/// @throws InvalidInput when there is no cell left, or options are out of range.
LoadCellWall assemble_wall(const TraceSet& traces, const WallOptions& options = {});

/// read_traces() of the wall's channels and assemble_wall().
LoadCellWall read_wall(const std::string& path, const WallOptions& options = {});

/// Numbers of a wall; those of crush need the vehicle's motion.
struct WallNumbers {
  double coverage = kUnset;
  double peak_force_n = kUnset;        ///< Largest total force [N].
  double peak_time_s = kUnset;         ///< When [s].
  double impulse_ns = kUnset;          ///< Of the total force from impact to end_s [N s].
  double mean_height_m = kUnset;       ///< Of the force, weighted by impulse [m].
  double momentum_change_ns = kUnset;  ///< m (v(0) - v(end_s)) of the pulse [N s].
  double ahof400_m = kUnset;           ///< Height weighted by work over 25..400 mm of crush [m].
  double kw400_n_per_m = kUnset;       ///< Work-equivalent stiffness over 25..400 mm of crush [N/m].
};
inline constexpr std::array<NamedNumber<WallNumbers>, 8> kWallNumbers = {{
    {"coverage", &WallNumbers::coverage, "share of the cells that measured"},
    {"peak_force_n", &WallNumbers::peak_force_n, "peak force"},
    {"peak_time_s", &WallNumbers::peak_time_s, "time of the peak force"},
    {"impulse_ns", &WallNumbers::impulse_ns, "impulse"},
    {"mean_height_m", &WallNumbers::mean_height_m, "mean height of the force"},
    {"momentum_change_ns", &WallNumbers::momentum_change_ns, "change of the vehicle's momentum"},
    {"ahof400_m", &WallNumbers::ahof400_m, "height of the force over 25..400 mm crush"},
    {"kw400_n_per_m", &WallNumbers::kw400_n_per_m, "work-equivalent stiffness"},
}};

/// The numbers of a wall. `pulse` may be null.
WallNumbers wall_numbers(const LoadCellWall& wall, const Pulse* pulse = nullptr);

/// What a wall and a pulse of one test say of each other: a warning when impulse and change of momentum differ by more
/// than 10 %. Empty when they agree or one is not known.
std::vector<std::string> check_momentum(const WallNumbers& numbers);

}  // namespace crashsim
