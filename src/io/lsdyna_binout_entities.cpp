#include "io/lsdyna_binout_entities.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "text.hpp"

namespace crashsim::io {
namespace {

/// Single values that belong to the whole model even in a database of one entity.
constexpr std::string_view kOfTheModel[] = {"cycle",          "num_nodal",      "max_brick_mass",
                                            "brick_id",       "max_shell_mass", "shell_id",
                                            "max_beam_mass",  "beam_id",        "max_thick_shell_mass",
                                            "thick_shell_id", "x_resultant",    "y_resultant",
                                            "z_resultant",    "total_x",        "total_y",
                                            "total_z",        "x_total",        "y_total",
                                            "z_total",        "xtotal",         "ytotal",
                                            "ztotal",         "etotal"};

constexpr std::string_view kStateIds = "/ids", kWalls = "/walls";  // no constant's name has a slash

bool is_of_the_model(std::string_view variable) {
  return std::find(std::begin(kOfTheModel), std::end(kOfTheModel), variable) != std::end(kOfTheModel);
}

/// Whether a list of ids is called after a variable: "force_ids" after "x_force".
bool is_called_after(std::string_view variable, std::string_view list) {
  constexpr std::string_view kEnd = "_ids";
  if (!list.ends_with(kEnd)) return false;
  list.remove_suffix(kEnd.size());
  return variable.find(list) != std::string_view::npos || (variable == "ring_slip" && list == "slipring");
}

/// Ids are whole numbers, whatever their type.
std::string id_text(double id) { return fmt::format("{:.0f}", id); }

}  // namespace

BinoutEntities::BinoutEntities(const BinoutBranch& branch, const BinoutIndex& index) : branch_(branch), index_(index) {
  read_titles();
}

/// A legend is one text for all, of equal parts (of 70 or 80 characters) in the order of legend_ids.
void BinoutEntities::read_titles() {
  const auto legend = branch_.constants.find("legend"), ids = branch_.constants.find("legend_ids");
  if (legend == branch_.constants.end() || ids == branch_.constants.end()) return;
  constexpr std::size_t kLeastWidth = 32;
  const LsdaVariable& text = legend->second.variable;
  const std::size_t count = ids->second.variable.count;
  if (size_of(text.type) != 1 || count == 0 || text.count % count != 0 || text.count / count < kLeastWidth) return;
  const std::vector<double> numbers = ids->second.numbers();
  const std::size_t width = text.count / count;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::string_view title = trimmed(std::string_view(text.values + i * width, width));
    if (!title.empty()) titles_.emplace(id_text(numbers[i]), title);
  }
}

/// The list of ids that has as many as the variable has values: the state's own, the one named after the variable
/// ("force_ids"), "ids", or the only other; "" when there is none.
std::string BinoutEntities::key_of(const BinoutSeries& series) const {
  const auto own = branch_.series_by_name.find("ids");
  if (own != branch_.series_by_name.end() && branch_.series[own->second].count == series.count)
    return std::string(kStateIds);
  std::string key;
  std::size_t others = 0;
  for (const auto& [name, constant] : branch_.constants) {
    if (!name.ends_with("ids") || name == "legend_ids" || constant.variable.count != series.count) continue;
    if (is_called_after(series.name, name)) return name;
    if (name != "ids") ++others;
    if (key.empty() || name == "ids") key = name;
  }
  return key != "ids" && others > 1 ? "" : key;
}

std::vector<BinoutEntity> BinoutEntities::numbered(const std::vector<double>& ids) {
  std::unordered_map<std::string, std::size_t> times;
  std::vector<BinoutEntity> entities;
  entities.reserve(ids.size());
  for (const double id : ids) {
    const std::string name = id_text(id);
    const auto title = titles_.find(name);
    entities.push_back({name, title == titles_.end() ? "" : title->second});
  }
  add_sides(entities);
  for (BinoutEntity& entity : entities) {
    const std::size_t before = times[entity.name]++;
    if (before == 0) continue;
    ++repeated_;
    entity.name += fmt::format("#{}", before + 1);
  }
  return entities;
}

/// A contact appears twice: side 0 is the slave's (surface A), others the master's (surface B).
void BinoutEntities::add_sides(std::vector<BinoutEntity>& entities) const {
  const auto side = branch_.constants.find("side");
  if (side == branch_.constants.end() || side->second.variable.count != entities.size()) return;
  const std::vector<double> sides = side->second.numbers();
  for (std::size_t i = 0; i < entities.size(); ++i) {
    const std::string_view name = sides[i] == 0.0 ? " slave" : " master";
    entities[i].name += name;
    if (!entities[i].title.empty()) entities[i].title += name;
  }
}

/// Energies of rigid walls have no ids; they are named as in the ASCII file.
const std::vector<BinoutEntity>* BinoutEntities::walls(std::size_t count) {
  std::vector<BinoutEntity>& entities = by_key_[std::string(kWalls)];
  for (std::size_t i = entities.size() + 1; i <= count; ++i)
    entities.push_back({fmt::format("{}", i), fmt::format("wall_{}", i)});
  return &entities;
}

const std::vector<BinoutEntity>* BinoutEntities::of(const BinoutSeries& series) {
  if (branch_.path == "glstat" && series.name == "stonewall_energy") return walls(series.count);
  if (series.count == 1 && is_of_the_model(series.name)) return nullptr;
  std::string key = key_of(series);
  if (key.empty() && series.count == 1) return nullptr;
  if (key.empty()) {
    key = fmt::format("/{}", series.count);
    without_ids_.push_back(series.name);
  }
  const auto known = by_key_.find(key);
  if (known != by_key_.end()) return &known->second;
  std::vector<BinoutEntity> entities;
  if (key == kStateIds) {
    const BinoutSeries& ids = branch_.series[branch_.series_by_name.at("ids")];
    const LsdaLayout& layout = index_.layout(ids.runs.front().file);
    entities = numbered(BinoutConstant{lsda_variable(ids.records.front(), layout), layout}.numbers());
  } else if (key.front() == '/') {
    for (std::size_t i = 0; i < series.count; ++i) entities.push_back({fmt::format("#{}", i + 1), ""});
  } else {
    entities = numbered(branch_.constants.find(key)->second.numbers());
  }
  return &by_key_.emplace(std::move(key), std::move(entities)).first->second;
}

std::vector<std::string> BinoutEntities::warnings() const {
  std::vector<std::string> texts;
  if (repeated_ > 0)
    texts.push_back(fmt::format("{}: {} id{} more than once: the later ones are named like 7#2", branch_.path,
                                repeated_, repeated_ == 1 ? " is there" : "s are there"));
  if (!without_ids_.empty())
    texts.push_back(fmt::format("{}: no ids for the values of {}: they are numbered by position (#1, #2)", branch_.path,
                                some_of(without_ids_)));
  return texts;
}

}  // namespace crashsim::io
