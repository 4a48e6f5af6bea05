/// crashsim info: what a trace file holds.

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command.hpp"

namespace crashsim {
namespace cli {

struct InfoOptions {
  std::string filter, columns, units;
};
constexpr std::array<Field<InfoOptions>, 3> kInfoFields = {{
    {"filter", "filter", "", "only channels whose id or name is like this glob", &InfoOptions::filter},
    {"columns", "columns", "", "columns of a CSV file: time:ms,accel:g", &InfoOptions::columns},
    {"units", "units", "", "unit system of FE output: kg-m-s, t-mm-s, kg-mm-ms, g-mm-ms", &InfoOptions::units},
}};

}  // namespace cli

template <>
constexpr std::span<const Field<cli::InfoOptions>> fields<cli::InfoOptions>{cli::kInfoFields};

namespace cli {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// The channels of one database of a file, and the time that they span together.
struct Database {
  std::string name;
  std::size_t channels = 0, samples = 0;
  double first_s = kUnset, last_s = kUnset;
};

std::vector<Database> databases_of(const TraceFileInfo& info) {
  std::vector<Database> databases;
  for (const ChannelInfo& c : info.channels) {
    if (c.database.empty()) continue;
    auto found = std::find_if(databases.begin(), databases.end(), [&](const auto& d) { return d.name == c.database; });
    if (found == databases.end()) found = databases.insert(found, Database{c.database});
    ++found->channels;
    found->samples = std::max(found->samples, c.samples);
    found->first_s = std::fmin(found->first_s, c.first_s);
    found->last_s = std::fmax(found->last_s, c.last_s);
  }
  return databases;
}

/// Keys in the file's order; a repeated one has its values in a list.
Json metadata_json(const TraceSet& set) {
  Json json = Json::object();
  auto& members = json.get_ref<Json::object_t&>();  // whose own search for a key is linear
  std::unordered_map<std::string_view, std::size_t> places;
  for (const auto& [key, value] : set.metadata) {
    const auto [place, is_new] = places.emplace(key, members.size());
    if (is_new) {
      members.emplace_back(key, value);
      continue;
    }
    Json& entry = members.data()[place->second].second;
    if (!entry.is_array()) entry = Json::array({entry});
    entry.push_back(value);
  }
  return json;
}

Json to_json(const TraceFileInfo& info) {
  Json json = {{"path", info.set.path},
               {"format", info.set.format},
               {"title", info.set.title},
               {"mass_kg", number(info.set.mass_kg)},
               {"impact_speed_mps", number(info.set.impact_speed_mps)},
               {"compartment_x", info.set.compartment_x},
               {"warnings", info.set.warnings},
               {"metadata", metadata_json(info.set)},
               {"databases", Json::array()},
               {"channels", Json::array()}};
  for (const Database& d : databases_of(info))
    json["databases"].push_back({{"name", d.name},
                                 {"channels", d.channels},
                                 {"samples", d.samples},
                                 {"first_s", number(d.first_s)},
                                 {"last_s", number(d.last_s)}});
  for (const ChannelInfo& c : info.channels)
    json["channels"].push_back({{"id", c.id},
                                {"name", c.name},
                                {"database", c.database},
                                {"location", c.location},
                                {"axis", c.axis == ' ' ? "" : std::string(1, c.axis)},
                                {"unit", c.unit},
                                {"samples", c.samples},
                                {"rate_hz", number(c.rate_hz)},
                                {"uniform", c.uniform},
                                {"first_s", number(c.first_s)},
                                {"last_s", number(c.last_s)},
                                {"min", number(c.min)},
                                {"max", number(c.max)},
                                {"status", c.status}});
  return json;
}

/// Headers of real files are not always UTF-8.
std::string text_of(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

std::string range_of(double low, double high) {
  return std::isnan(low) ? "-" : fmt::format("{:.4g} .. {:.4g}", low, high);
}

/// Header fields for people to read: none that are shown in their own place, nor the record, which is for programs.
std::vector<std::pair<std::string, std::string>> further_fields(const TraceSet& set) {
  constexpr std::string_view kShownElsewhere[] = {"title", "mass_kg", "impact_speed_mps", "record"};
  std::vector<std::pair<std::string, std::string>> fields = set.metadata;
  std::erase_if(fields, [&](const auto& field) {
    return std::find(std::begin(kShownElsewhere), std::end(kShownElsewhere), field.first) != std::end(kShownElsewhere);
  });
  return fields;
}

/// Format and title, what the file says of its test, its databases.
std::string heading_of(const TraceFileInfo& info) {
  constexpr std::size_t kFewFields = 12;
  const TraceSet& set = info.set;
  std::string text = fmt::format("{}: {}{}\n", set.path, set.format, set.title.empty() ? "" : ", " + set.title);
  const auto further = further_fields(set);
  if (further.size() > kFewFields) {
    text += fmt::format("  {} header fields: --json shows them\n", further.size());
  } else {
    for (const auto& [key, value] : further) text += fmt::format("  {}: {}\n", key, value);
  }
  if (!std::isnan(set.mass_kg)) text += fmt::format("  mass {:g} kg\n", set.mass_kg);
  if (!std::isnan(set.impact_speed_mps))
    text += fmt::format("  impact speed {:.6g} m/s ({:.4g} km/h)\n", set.impact_speed_mps, 3.6 * set.impact_speed_mps);
  if (!set.compartment_x.empty())
    text += fmt::format("  longitudinal channels of the compartment: {}\n", fmt::join(set.compartment_x, ", "));
  for (const Database& d : databases_of(info))
    text += fmt::format("  {}: {} channels of up to {} samples, {} s\n", d.name, d.channels, d.samples,
                        range_of(d.first_s, d.last_s));
  return text;
}

std::string table_of(const TraceFileInfo& info) {
  const TraceSet& set = info.set;
  std::string text = heading_of(info);
  std::size_t id = 2, name = 4, unit = 4;
  for (const ChannelInfo& c : info.channels) {
    id = std::max(id, c.id.size());
    name = std::max(name, c.name.size());
    unit = std::max(unit, c.unit.size());
  }
  text += fmt::format("  {:<{}}  {:<{}}  {:<{}}  {:>8}  {:>9}  {:<20}  {:<24}  {}\n", "id", id, "name", name, "unit",
                      unit, "samples", "rate Hz", "time s", "range", "status");
  for (const ChannelInfo& c : info.channels) {
    const std::string rate = std::isnan(c.rate_hz) ? "-" : fmt::format("{}{:.5g}", c.uniform ? "" : "~", c.rate_hz);
    text += fmt::format("  {:<{}}  {:<{}}  {:<{}}  {:>8}  {:>9}  {:<20}  {:<24}  {}\n", c.id, id, c.name, name, c.unit,
                        unit, c.samples, rate, range_of(c.first_s, c.last_s), range_of(c.min, c.max), c.status);
  }
  for (const std::string& warning : set.warnings) text += "  warning: " + warning + "\n";
  return text;
}

class InfoCommand : public Command {
 public:
  explicit InfoCommand(CLI::App& parent)
      : Command(parent, "info", "Tell what is in trace files: format, mass, speed, channels",
                "crashsim info data/fe-car/C56.csv --filter '*REAR_VX'") {
    app().add_option("file", files_, "trace files")->required()->type_name("FILE");
    options_.flags.add_to(app(), "Options");
    add_reporting();
  }

  int run() override {
    resolve(options_);
    ReadOptions read{{}, options_.values.columns, options_.values.units};
    if (!options_.values.filter.empty()) read.channels = {options_.values.filter};
    Json all = Json::array();
    for (const std::string& file : files_) {
      const TraceFileInfo info = inspect_traces(file, read);
      if (json())
        all.push_back(to_json(info));
      else
        write_output("-", table_of(info), false);
    }
    if (json()) write_output("-", text_of(all.size() == 1 ? all.front() : all), false);
    return kDone;
  }

 private:
  std::vector<std::string> files_;
  Bound<InfoOptions> options_;
};

}  // namespace

std::unique_ptr<Command> make_info(CLI::App& app) { return std::make_unique<InfoCommand>(app); }

}  // namespace cli
}  // namespace crashsim
