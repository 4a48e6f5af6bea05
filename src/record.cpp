#include <crashsim/record.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/files.hpp>
#include <crashsim/version.hpp>

#include "json.hpp"
#include "record_json.hpp"
#include "text.hpp"

namespace crashsim {
namespace {

constexpr std::string_view kFormat = "crashsim.record";
constexpr std::string_view kRecordMark = " record = ";

/// The JSON of a record in the comments before a table or, marked by `$`, before cards; empty when there is none.
std::string_view record_in_comments(std::string_view text) {
  for (std::size_t at = 0; at < text.size() && (text[at] == '#' || text[at] == '$');) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    if (line.substr(1).starts_with(kRecordMark)) return line.substr(1 + kRecordMark.size());
    at = end + 1;
  }
  return {};
}

const Json& member(const Json& object, const char* name, Json::value_t type, const std::string& path) {
  const auto found = object.find(name);
  if (found == object.end() || found->type() != type)
    throw InvalidInput(fmt::format("{}: its record has no proper '{}'", path, name));
  return *found;
}

std::string text_member(const Json& object, const char* name, const std::string& path) {
  return member(object, name, Json::value_t::string, path).get<std::string>();
}

Record from_json(const Json& json, const std::string& path) {
  Record record;
  record.version = text_member(json, "version", path);
  record.command = text_member(json, "command", path);
  for (const Json& argument : member(json, "arguments", Json::value_t::array, path)) {
    if (!argument.is_string()) throw InvalidInput(fmt::format("{}: its record has no proper 'arguments'", path));
    record.arguments.push_back(argument.get<std::string>());
  }
  for (const auto& [key, value] : member(json, "options", Json::value_t::object, path).items()) {
    if (!value.is_object()) {
      record.options.push_back({"", key, option_from_json(value, fmt::format("{}: {}", path, key)), path});
      continue;
    }
    for (const auto& [inner, item] : value.items())
      record.options.push_back({key, inner, option_from_json(item, fmt::format("{}: {}.{}", path, key, inner)), path});
  }
  for (const Json& input : member(json, "inputs", Json::value_t::array, path))
    record.inputs.push_back({text_member(input, "path", path), text_member(input, "sha256", path)});
  return record;
}

}  // namespace

Record make_record(std::string command, std::vector<std::string> arguments, std::vector<ConfigEntry> options,
                   const std::vector<std::string>& input_files) {
  Record record{kVersion, std::move(command), std::move(arguments), std::move(options), {}};
  std::erase_if(record.options, [](const ConfigEntry& entry) { return entry.key == "jobs"; });
  for (const std::string& path : input_files) {
    const auto is_same = [&](const RecordedInput& input) { return input.path == path; };
    if (std::none_of(record.inputs.begin(), record.inputs.end(), is_same))
      record.inputs.push_back({path, sha256_of_file(path)});
  }
  return record;
}

Json record_json(const Record& record) {
  Json options = Json::object();
  for (const ConfigEntry& entry : record.options)
    (entry.section.empty() ? options : options[entry.section])[entry.key] = json_option(entry.value);
  Json inputs = Json::array();
  for (const RecordedInput& input : record.inputs) inputs.push_back({{"path", input.path}, {"sha256", input.sha256}});
  return {{"format", kFormat},         {"version", record.version},
          {"command", record.command}, {"arguments", record.arguments},
          {"options", options},        {"inputs", inputs}};
}

std::string to_json(const Record& record) { return format_json_line(record_json(record)); }

std::optional<Record> find_record(const std::string& path) {
  const std::string text = read_file(path);
  if (const std::string_view line = record_in_comments(text); !line.empty())
    return from_json(parse_json(line, path), path);
  if (!trimmed(text).starts_with('{')) return std::nullopt;
  const Json json = parse_json(text, path);
  const Json& record = json.contains("record") ? json["record"] : json;
  if (!record.is_object() || !record.contains("format") || record["format"] != kFormat) return std::nullopt;
  return from_json(record, path);
}

void verify_inputs(const Record& record) {
  for (const RecordedInput& input : record.inputs) {
    const std::string now = sha256_of_file(input.path);
    if (now == input.sha256) continue;
    throw InvalidInput(
        fmt::format("{}: has changed since the record was made (SHA-256 {}.. then, {}.. now): the result would not be "
                    "the same; run the command itself instead",
                    input.path, input.sha256.substr(0, 12), now.substr(0, 12)));
  }
}

}  // namespace crashsim
