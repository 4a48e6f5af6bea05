#include "wall_cells.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <crashsim/units.hpp>

#include "channel_choice.hpp"
#include "channel_fields.hpp"
#include "text.hpp"

namespace crashsim {
namespace {

constexpr int kMostRows = 99;

bool is_letter(char c) { return lower(c) >= 'a' && lower(c) <= 'z'; }
int row_of(char letter) { return lower(letter) - 'a' + 1; }

/// The number that a text of one or two digits is, 0 when it is none.
int small_number(std::string_view text) {
  if (text.empty() || text.size() > 2 || !std::all_of(text.begin(), text.end(), is_digit)) return 0;
  int number = 0;
  for (const char c : text) number = 10 * number + (c - '0');
  return number;
}

/// "LC1101", "LCA1".
std::optional<WallCell> cell_at(std::string_view location) {
  if (!same_ignoring_case(location.substr(0, 2), "LC") || location.size() < 4) return std::nullopt;
  const std::string_view place = location.substr(2);
  WallCell cell;
  if (place.size() == 4) {
    cell.row = small_number(place.substr(0, 2));
    cell.column = small_number(place.substr(2));
  } else if (is_letter(place.front())) {
    cell.row = row_of(place.front());
    cell.column = small_number(place.substr(1));
    cell.is_lettered = true;
  }
  return cell.row > 0 && cell.column > 0 ? std::optional(cell) : std::nullopt;
}

/// A word "K-01" of a comment.
std::optional<WallCell> cell_in_words(std::string_view comment) {
  for (const std::string_view word : split(comment, ' ')) {
    if (word.size() < 3 || word[1] != '-' || !is_letter(word.front())) continue;
    if (const int column = small_number(word.substr(2)); column > 0) return WallCell{row_of(word.front()), column};
  }
  return std::nullopt;
}

/// "row_K_N", "row 11 [kN]", "row_a_force_n".
std::optional<WallCell> row_in_name(std::string_view name) {
  if (!same_ignoring_case(name.substr(0, 3), "row") || name.size() < 5) return std::nullopt;
  std::string_view rest = name.substr(4);
  rest = rest.substr(0, rest.find_first_of("_ "));
  WallCell cell;
  if (rest.size() == 1 && is_letter(rest.front())) cell.row = row_of(rest.front());
  if (const int number = small_number(rest); number > 0) cell.row = number;
  return cell.row > 0 ? std::optional(cell) : std::nullopt;
}

/// Whether the file itself says that a force along x is one of the barrier's; axis labels alone are not to be trusted.
bool is_barrier_force(const Trace& trace, const ChannelFields& fields) {
  if (trace.dimension != Dimension::force || trace.axis != 'X') return false;
  const std::string_view vehicle = fields.of(trace, "VEHNO"), sensor = fields.of(trace, "SENTYP");
  return (vehicle.empty() || vehicle == "0") && (sensor.empty() || sensor == "LC");
}

std::vector<WallCell> cells_of(const TraceSet& set) {
  const ChannelFields fields(set);
  std::vector<WallCell> cells;
  for (std::size_t i = 0; i < set.traces.size(); ++i) {
    const Trace& trace = set.traces[i];
    if (!is_barrier_force(trace, fields)) continue;
    auto cell = cell_at(trace.location);
    if (!cell) cell = cell_in_words(trace.name);
    if (!cell) continue;
    cell->trace = i;
    cells.push_back(*cell);
  }
  return cells;
}

std::vector<WallCell> rows_of(const TraceSet& set) {
  std::vector<WallCell> rows;
  for (std::size_t i = 0; i < set.traces.size(); ++i) {
    if (set.traces[i].dimension != Dimension::force) continue;
    auto row = row_in_name(set.traces[i].name);
    if (!row) continue;
    row->trace = i;
    rows.push_back(*row);
  }
  return rows;
}

std::vector<WallCell> named_rows(const TraceSet& set, const std::vector<std::string>& selectors) {
  std::vector<WallCell> rows;
  for (const std::string& selector : selectors)
    for (const std::size_t i : select_channels(set, selector)) {
      if (set.traces[i].dimension != Dimension::force)
        throw InvalidInput(fmt::format("{}: measures {}; the force on a row of cells is needed",
                                       channel_label(set, set.traces[i]), dimension_name(set.traces[i].dimension)));
      rows.push_back({static_cast<int>(rows.size()) + 1, 0, i, false});
    }
  return rows;
}

/// INSRAT in newtons: the guide says kN for forces, files say N; no wall has cells of less than 10 kN or more than
/// 10 MN. Unset when it is not filled in.
double range_n(std::string_view insrat) {
  constexpr double kLeast_n = 10e3;
  const double value = parse_number(insrat).value_or(0.0);
  if (!(value > 0.0)) return kUnset;
  return value < kLeast_n ? 1e3 * value : value;
}

/// Why a cell's samples must not be added up, "" when they may.
std::string fault_of(const Trace& trace, std::string_view insrat) {
  if (!trace.problem.empty()) return trace.problem;
  if (!trace.has_samples || trace.values.empty()) return "its samples are not there";
  if (!std::all_of(trace.values.begin(), trace.values.end(), [](double v) { return std::isfinite(v); }))
    return "some samples are not finite";
  const auto [least, most] = std::minmax_element(trace.values.begin(), trace.values.end());
  if (*least == *most) return fmt::format("it is {:g} N at all times", *least);
  const double reach = std::max(-*least, *most), range = range_n(insrat);
  if (reach > range)
    return fmt::format("it reaches {:.4g} kN, beyond its range of {:.4g} kN", reach / 1e3, range / 1e3);
  return "";
}

using Times = std::vector<double>;

/// The clock that most cells have.
const Times* common_clock(const TraceSet& set, const std::vector<WallCell>& cells) {
  std::vector<std::pair<const Times*, int>> clocks;
  for (const WallCell& cell : cells) {
    const Times* times = set.traces[cell.trace].time_s.get();
    const auto same = std::find_if(clocks.begin(), clocks.end(),
                                   [&](const auto& clock) { return clock.first == times || *clock.first == *times; });
    if (same == clocks.end())
      clocks.emplace_back(times, 1);
    else
      ++same->second;
  }
  const auto most =
      std::max_element(clocks.begin(), clocks.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == clocks.end() ? nullptr : most->first;
}

}  // namespace

std::string row_name(int row) {
  constexpr int kLetters = 26;
  return row <= kLetters ? std::string(1, static_cast<char>('a' + row - 1)) : fmt::format("{:02}", row);
}

std::string cell_name(const WallCell& cell) {
  std::string row = row_name(cell.row);
  if (row.size() == 1) row.front() = static_cast<char>(row.front() - 'a' + 'A');
  return cell.column > 0 ? fmt::format("{}-{:02}", row, cell.column) : "row " + row;
}

std::vector<WallCell> find_cells(const TraceSet& set, const WallOptions& options) {
  std::vector<WallCell> cells = options.rows.empty() ? cells_of(set) : named_rows(set, options.rows);
  if (cells.empty()) cells = rows_of(set);
  if (cells.empty())
    throw InvalidInput(
        fmt::format("{}: no load cells: no channel is a force along X at a cell such as LC1101 or BARRIER K-01, and "
                    "none is called row_a...; name the sums of rows, first row first (--row); see crashsim info {}",
                    set.path, set.path));
  std::stable_sort(cells.begin(), cells.end(), [](const WallCell& a, const WallCell& b) {
    return std::pair(a.row, a.column) < std::pair(b.row, b.column);
  });
  if (cells.back().row > kMostRows)
    throw InvalidInput(fmt::format("{}: {} rows of cells: at most {}", set.path, cells.back().row, kMostRows));
  return cells;
}

CellChoice choose_cells(const TraceSet& set, const std::vector<WallCell>& cells) {
  const ChannelFields fields(set);
  CellChoice choice;
  const auto leave_out = [&](const WallCell& cell, std::string_view why) {
    choice.excluded.push_back(fmt::format("{} (channel {}): {}", cell_name(cell), set.traces[cell.trace].id, why));
  };
  std::vector<WallCell> good;
  std::set<std::pair<int, int>> taken;
  for (const WallCell& cell : cells) {
    const Trace& trace = set.traces[cell.trace];
    const std::string fault = fault_of(trace, fields.of(trace, "INSRAT"));
    if (!fault.empty())
      leave_out(cell, fault);
    else if (!taken.insert({cell.row, cell.column}).second)
      leave_out(cell, "another channel of this cell is used");
    else
      good.push_back(cell);
  }
  const Times* clock = common_clock(set, good);
  for (const WallCell& cell : good) {
    const Times* times = set.traces[cell.trace].time_s.get();
    if (times == clock || *times == *clock)
      choice.used.push_back(cell);
    else
      leave_out(cell, "it has other sample times than most cells");
  }
  return choice;
}

}  // namespace crashsim
