#include "io/lsdyna_binout_history.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace crashsim::io {
namespace {

std::string_view plural(std::size_t count) { return count == 1 ? "" : "s"; }

/// Columns and states whose values are turned from one order into the other at a time: they fit a core's cache.
constexpr std::size_t kTileColumns = 64, kTileStates = 32;
constexpr std::size_t kTilePitch = kTileColumns + 8;  // a power of two would crowd a few lines of the cache
using Tile = std::array<std::array<double, kTilePitch>, kTileStates>;

/// Columns of `columns` that lie within kTileColumns of the first.
std::span<const BinoutColumn> first_tile(std::span<const BinoutColumn> columns) {
  const std::size_t limit = columns.front().index + kTileColumns;
  const auto end = std::find_if(columns.begin(),
                                columns.begin() + static_cast<std::ptrdiff_t>(std::min(columns.size(), kTileColumns)),
                                [&](const BinoutColumn& column) { return column.index >= limit; });
  return columns.first(static_cast<std::size_t>(end - columns.begin()));
}

}  // namespace

std::vector<std::uint32_t> history_of(const BinoutBranch& branch, std::vector<std::string>& warnings) {
  const auto& states = branch.states;
  std::vector<std::uint32_t> history;
  std::size_t replaced = 0, timeless = 0;
  double replaced_from = kUnset;
  for (std::uint32_t i = 0; i < std::min(states.size(), branch.ids_change); ++i) {
    if (states[i].number == BinoutState::kDropped) continue;
    if (!std::isfinite(states[i].time)) {
      ++timeless;
      continue;
    }
    for (; !history.empty() && states[history.back()].time >= states[i].time; history.pop_back(), ++replaced)
      replaced_from = std::fmin(replaced_from, states[history.back()].time);
    history.push_back(i);
  }
  const auto warn = [&](const std::string& text) { warnings.push_back(fmt::format("{}: {}", branch.path, text)); };
  if (replaced > 0)
    warn(fmt::format("{} state{} from time {:g} on written again by a later part of the run, which is used", replaced,
                     plural(replaced), replaced_from));
  if (timeless > 0) warn(fmt::format("{} state{} without a time left out", timeless, plural(timeless)));
  if (branch.ids_change < states.size())
    warn(fmt::format("its ids change at state {} (d{:06}): the {} from there on left out", branch.ids_change + 1,
                     states[branch.ids_change].number, states.size() - branch.ids_change));
  return history;
}

std::vector<BinoutRecord> records_of(const BinoutSeries& series, std::span<const std::uint32_t> history) {
  std::vector<BinoutRecord> records;
  records.reserve(std::min(series.records.size(), history.size()));
  for (std::size_t r = 0; r < series.runs.size(); ++r) {
    const BinoutRun& run = series.runs[r];
    const std::size_t end = r + 1 < series.runs.size() ? series.runs[r + 1].record : series.records.size();
    const std::size_t end_state = run.state + (end - run.record);
    for (auto at = std::lower_bound(history.begin(), history.end(), run.state); at != history.end() && *at < end_state;
         ++at)
      records.push_back({series.records[run.record + (*at - run.state)], *at, run.file});
  }
  return records;
}

void read_columns(std::span<const BinoutRecord> records, const BinoutIndex& index, double to_si,
                  std::span<const BinoutColumn> all_columns) {
  Tile tile;
  std::array<LsdaVariable, kTileStates> variables;
  for (std::size_t from = 0; from < records.size(); from += kTileStates) {
    const auto states = records.subspan(from, std::min(kTileStates, records.size() - from));
    for (std::size_t s = 0; s < states.size(); ++s)
      variables[s] = lsda_variable(states[s].record, index.layout(states[s].file));
    for (auto left = all_columns; !left.empty();) {
      const auto columns = first_tile(left);
      left = left.subspan(columns.size());
      const std::size_t first = columns.front().index, count = columns.back().index - first + 1;
      for (std::size_t s = 0; s < states.size(); ++s)
        decode(variables[s], index.layout(states[s].file), first, count, tile[s].data());
      for (const BinoutColumn& column : columns)
        for (std::size_t s = 0; s < states.size(); ++s)
          column.samples[from + s] = tile[s][column.index - first] * to_si;
    }
  }
}

}  // namespace crashsim::io
