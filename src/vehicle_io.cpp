#include <crashsim/vehicle_io.hpp>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <variant>

#include <fmt/format.h>

#include <crashsim/config.hpp>
#include <crashsim/coupled_model.hpp>
#include <crashsim/error.hpp>
#include <crashsim/files.hpp>

#include "fit_json.hpp"
#include "json.hpp"
#include "record_json.hpp"
#include "text.hpp"

namespace crashsim {
namespace {

struct NotRead {
  std::string_view key, doc;
};
constexpr NotRead kNotRead[] = {{"title", "for people"},
                                {"source", "for people"},
                                {"identification", "written by identify-pitch, not read"},
                                {"record", "written by crashsim: what made the file"}};

/// Whether a key is of the heave-pitch model, or unknown; not one for people or of the coupled model.
bool is_read(std::string_view key) {
  const auto names_it = [key](const auto& field) { return is_key_of(key, field); };
  return std::ranges::find(kNotRead, key, &NotRead::key) == std::end(kNotRead) &&
         std::ranges::none_of(fields<GroundContact>, names_it);
}

std::vector<ConfigEntry> entries_of_json(const std::string& text, const std::string& path) {
  const Json json = parse_json(text, path);
  if (json.contains("format"))
    throw InvalidInput(
        fmt::format("{}: is a {}, not a vehicle: see crashsim schema vehicle", path, json["format"].dump()));
  std::vector<ConfigEntry> entries;
  for (const auto& [key, value] : json.items())
    if (is_read(key)) entries.push_back({"", key, option_from_json(value, fmt::format("{}: {}", path, key)), path});
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

Json identification_json(const PitchIdentification& fit) {
  Json json = named_fit_json(fit);
  json["error"] = json_number(fit.error.total);
  json["error_heave"] = json_number(fit.error.heave);
  json["error_pitch"] = json_number(fit.error.pitch);
  json["error_heave_velocity"] = json_number(fit.error.heave_velocity);
  json["error_pitch_rate"] = json_number(fit.error.pitch_rate);
  return json;
}

}  // namespace

std::vector<FileKey> vehicle_keys() {
  std::vector<FileKey> keys;
  for (const Field<HeavePitchModel>& field : fields<HeavePitchModel>)
    keys.push_back({"", std::string(field.name), describe_field(field)});
  for (const auto& [key, doc] : kNotRead) keys.push_back({"", std::string(key), {"", std::string(doc), "", "", ""}});
  return keys;
}

HeavePitchModel read_vehicle(const std::string& path) {
  const std::string text = read_file(path);
  HeavePitchModel model;
  for (const ConfigEntry& entry : trimmed(text).starts_with('{') ? entries_of_json(text, path) : entries_of_toml(path))
    if (is_read(entry.key)) set_from(model, entry);
  return model;
}

std::string format_vehicle(const HeavePitchModel& model, const PitchIdentification* identification,
                           const Record* record) {
  validate(model);
  Json json = Json::object();
  for (const Field<HeavePitchModel>& field : fields<HeavePitchModel>)
    if (const OptionValue value = get_option(model, field); !std::holds_alternative<std::monostate>(value))
      json[std::string(field.name)] = json_option(value);
  if (identification != nullptr) json["identification"] = identification_json(*identification);
  if (record != nullptr) json["record"] = record_json(*record);
  return format_json(json);
}

}  // namespace crashsim
