/// OpenRadioss time history as CSV: what its converter th_to_csv writes, with variables numbered ("var 98") or, where
/// the run wrote their titles, named; and tables whose node columns are called NODE_VX.
///
/// Numbered rigid-wall columns are the run's own cumulative impulses; named ones the converter has turned into forces.

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "io/csv_layout.hpp"
#include "io/radioss_variables.hpp"
#include "io/reader.hpp"
#include "io/unit_system.hpp"
#include "text.hpp"

namespace crashsim::io {
namespace {

constexpr std::size_t kVariablesOfNodes = 9, kVariablesOfWalls = 6;  // DX .. AZ and FNX .. FTZ, as decks ask for them
constexpr std::ptrdiff_t kLeastGlobals = 12;  // INTERNAL ENERGY .. HOURGLASS ENERGY, of all versions
constexpr std::string_view kNumbered = " var ";

/// What a column holds.
struct Head {
  std::string entity, variable;  ///< "LEFT_REAR" and "VX"; no entity for the whole model.
  Dimension dimension = Dimension::unknown;
  std::optional<Unit> unit;  ///< Where the header says it.
};

/// The text before " var 98" with runs of blanks made one: "outputblock1 250 RIGHT_MID"; empty when it is not numbered.
std::string numbered_entity(std::string_view name) {
  const std::size_t at = name.rfind(kNumbered);
  if (at == std::string_view::npos) return "";
  const std::string_view number = trimmed(name.substr(at + kNumbered.size()));
  if (number.empty() || !std::all_of(number.begin(), number.end(), is_digit)) return "";
  return with_single_blanks(name.substr(0, at));
}

/// What a column's text says before "var": the title of the group, and the entity.
struct Entity {
  std::string group, name;
};

/// Parts "TH RWALL 1 Barrier" at the number: "TH RWALL" and "Barrier". Without a number the whole is both.
Entity parse_entity(const std::string& entity) {
  const auto words = split(entity, ' ');
  for (std::size_t i = words.size(); i-- > 1;) {
    if (words[i].empty() || !std::all_of(words[i].begin(), words[i].end(), is_digit)) continue;
    const auto from = static_cast<std::size_t>(words[i].data() - entity.data()) + words[i].size();
    const std::string_view name = trimmed(std::string_view(entity).substr(from));
    return {entity.substr(0, from - words[i].size()), std::string(name.empty() ? words[i] : name)};
  }
  return {entity, entity};
}

/// Names the numbered variables of one entity, which stand in a fixed order.
void name_numbered(const std::string& entity, std::size_t count, std::vector<Head>& heads) {
  const auto [group, name] = parse_entity(entity);
  const bool is_wall = count == kVariablesOfWalls && to_lower(group).find("wall") != std::string::npos;
  const bool in_order = is_wall || count == kVariablesOfNodes;
  for (std::size_t i = 0; i < count; ++i) {
    Head head{name, fmt::format("var{}", i + 1), Dimension::unknown, std::nullopt};
    if (in_order) {
      const auto variable = radioss_group_variable(is_wall ? kRadiossWalls : kRadiossNodes, static_cast<int>(i) + 1);
      head.variable = variable.name;
      head.dimension = variable.dimension;
    }
    heads.push_back(std::move(head));
  }
}

/// "LEFT_REAR_VX", "part1      KE", "INTERNAL ENERGY", "mass_Mg", "barrier_impulse_FNX_N.s".
Head named_head(std::string_view name) {
  const std::string_view text = trimmed(name);
  const std::size_t padding = text.rfind("  ");  // between the name of a part and its "MASS"
  if (const Dimension whole = fe_dimension(text); whole != Dimension::unknown && padding == std::string_view::npos)
    return {"", std::string(text), whole, std::nullopt};
  for (std::size_t at = text.find('_'); at != std::string_view::npos; at = text.find('_', at + 1)) {
    const auto unit = find_unit(text.substr(at + 1));
    if (!unit || unit->dimension == Dimension::none) continue;
    const std::string variable(trimmed(text.substr(0, at)));
    const bool energy = unit->dimension == Dimension::moment && fe_dimension(variable) == Dimension::energy;
    return {"", variable, energy ? Dimension::energy : unit->dimension, unit};
  }
  const std::size_t at = padding == std::string_view::npos ? text.rfind('_') : padding + 1;
  if (at == std::string_view::npos || at == 0) return {"", std::string(text), Dimension::unknown, std::nullopt};
  const std::string_view variable = text.substr(at + 1);
  return {std::string(trimmed(text.substr(0, at))), std::string(variable), fe_dimension(variable), std::nullopt};
}

std::vector<Head> parse_heads(const std::vector<std::string>& names) {
  std::vector<Head> heads;
  for (std::size_t i = 0; i < names.size();) {
    const std::string entity = numbered_entity(names[i]);
    if (entity.empty()) {
      heads.push_back(named_head(names[i++]));
      continue;
    }
    std::size_t count = 1;
    while (i + count < names.size() && numbered_entity(names[i + count]) == entity) ++count;
    name_numbered(entity, count, heads);
    i += count;
  }
  return heads;
}

/// DX, VY, AZ of an entity, without a unit.
bool is_motion(const Head& head) {
  constexpr Dimension kMotion[] = {Dimension::length, Dimension::speed, Dimension::acceleration};
  return !head.entity.empty() && !head.unit && head.variable.size() == 2 &&
         std::find(std::begin(kMotion), std::end(kMotion), head.dimension) != std::end(kMotion);
}

bool is_radioss(const CsvLayout& layout) {
  if (layout.names.size() < 4 || !to_lower(layout.names[0]).starts_with("time")) return false;
  if (layout.names[1] == "INTERNAL ENERGY" && layout.names[2] == "KINETIC ENERGY") return true;
  const std::vector<Head> heads = parse_heads(layout.names);
  return std::count_if(heads.begin(), heads.end(), is_motion) >= 3;
}

/// Some versions of the converter name fewer or more global variables than they write. What follows them is right, and
/// they are the first of a list, so the number of columns tells which they are.
void mend_global_names(CsvLayout& layout) {
  const std::vector<std::string>& odd = layout.odd_names;
  if (!layout.names.empty() || odd.size() < 4 || odd[0] != "time" || odd[1] != "INTERNAL ENERGY" ||
      odd[2] != "KINETIC ENERGY")
    return;
  const auto is_global = [](const std::string& name) {
    for (int code = 1; !radioss_global_variable(code).name.empty(); ++code)
      if (name == radioss_global_variable(code).name) return true;
    return name.empty() || name == "NO NAME";
  };
  const auto others = std::find_if_not(odd.begin() + 1, odd.end(), is_global);
  const auto globals = static_cast<std::ptrdiff_t>(layout.columns) - 1 - (odd.end() - others);
  if (globals < kLeastGlobals) return;
  layout.names = {odd[0]};
  for (int code = 1; code <= globals; ++code) {
    const std::string_view name = radioss_global_variable(code).name;
    layout.names.push_back(name.empty() ? fmt::format("var{}", code) : std::string(name));
  }
  layout.names.insert(layout.names.end(), others, odd.end());
}

/// The header where it is one of OpenRadioss.
std::optional<CsvLayout> radioss_layout(const InputFile& file) {
  if (file.is_folder()) return std::nullopt;
  auto layout = find_layout(file.bytes());
  if (layout && layout->columns > most_channels(file.bytes().size())) return std::nullopt;
  if (layout) mend_global_names(*layout);
  return layout && is_radioss(*layout) ? std::move(layout) : std::nullopt;
}

bool detects(const InputFile& file) { return radioss_layout(file).has_value(); }

Trace describe(const Head& head, std::size_t column) {
  Trace trace = radioss_trace(head.entity, head.variable, head.dimension, column + 1);
  if (head.unit) trace.source_unit = head.unit->name;
  return trace;
}

TraceSet read(const InputFile& file, const ReadOptions& options, const Choose& choose) {
  const CsvLayout layout = radioss_layout(file).value();
  const std::vector<Head> heads = parse_heads(layout.names);
  const UnitSystem system = parse_unit_system(options.units);
  TraceSet set;
  set.path = file.path();
  set.input_files = {file.path()};
  for (std::size_t column = 1; column < heads.size(); ++column) set.traces.push_back(describe(heads[column], column));

  const std::vector<std::size_t> chosen = choose(set);
  std::vector<bool> wanted(layout.columns);
  wanted[0] = true;
  for (const std::size_t i : chosen) wanted[i + 1] = true;
  auto columns = read_columns(file.bytes(), layout, wanted, 0, file.path());
  warn_when_open_ended(file.bytes(), set);
  const auto unit_of = [&](const Head& head) { return head.unit ? head.unit->to_si : to_si(system, head.dimension); };
  scale(columns[0], unit_of(heads[0]));
  const auto time_s = std::make_shared<const std::vector<double>>(std::move(columns[0]));
  for (const std::size_t i : chosen) {
    Trace& trace = set.traces[i];
    scale(columns[i + 1], unit_of(heads[i + 1]));
    trace.values = std::move(columns[i + 1]);
    trace.time_s = time_s;
    trace.has_samples = true;
  }
  warn_when_implausible(set, system);
  return set;
}

}  // namespace

const Reader kRadiossCsvReader = {"radioss_csv", "OpenRadioss time history as CSV", detects, read};

}  // namespace crashsim::io
