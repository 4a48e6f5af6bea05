#include <crashsim/vehicle_io.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <crashsim/config.hpp>
#include <crashsim/coupled_model.hpp>
#include <crashsim/error.hpp>
#include <crashsim/files.hpp>

#include "json.hpp"
#include "text.hpp"

namespace crashsim {
namespace {

constexpr std::string_view kForPeople[] = {"title", "source"};

std::vector<ConfigEntry> entries_of_json(const std::string& text, const std::string& path) {
  const Json json = parse_json(text, path);
  std::vector<ConfigEntry> entries;
  for (const auto& [key, value] : json.items())
    entries.push_back({"", key, option_from_json(value, fmt::format("{}: {}", path, key)), path});
  return entries;
}

/// The [vehicle] table where there is one, else what stands before any table.
std::vector<ConfigEntry> entries_of_toml(const std::string& path) {
  std::vector<ConfigEntry> entries = read_config(path);
  const auto is_vehicle = [](const ConfigEntry& entry) { return entry.section == "vehicle"; };
  const bool has_table = std::any_of(entries.begin(), entries.end(), is_vehicle);
  std::erase_if(entries, [&](const ConfigEntry& entry) { return entry.section != (has_table ? "vehicle" : ""); });
  return entries;
}

/// Keys that are not of the heave-pitch model: for people, or the coupled model's.
bool is_for_others(const std::string& key) {
  const auto& ground = fields<GroundContact>;
  return std::find(std::begin(kForPeople), std::end(kForPeople), key) != std::end(kForPeople) ||
         std::any_of(ground.begin(), ground.end(), [&](const auto& field) { return is_key_of(key, field); });
}

}  // namespace

std::vector<FileKey> vehicle_keys() {
  std::vector<FileKey> keys;
  for (const Field<HeavePitchModel>& field : fields<HeavePitchModel>)
    keys.push_back({"", std::string(field.name), describe_field(field)});
  for (const std::string_view key : kForPeople) keys.push_back({"", std::string(key), {"", "for people", "", "", ""}});
  return keys;
}

HeavePitchModel read_vehicle(const std::string& path) {
  const std::string text = read_file(path);
  HeavePitchModel model;
  for (const ConfigEntry& entry :
       trimmed(text).starts_with('{') ? entries_of_json(text, path) : entries_of_toml(path)) {
    if (entry.key == "format")
      throw InvalidInput(
          fmt::format("{}: is a {}, not a vehicle: see crashsim schema vehicle", path, text_of(entry.value)));
    if (!is_for_others(entry.key)) set_from(model, entry);
  }
  return model;
}

}  // namespace crashsim
