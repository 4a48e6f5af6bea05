/// Rows as text: between processes, in the journal.

#include <type_traits>

#include <crashsim/batch.hpp>
#include <crashsim/error.hpp>

#include "json.hpp"

namespace crashsim {
namespace {

Json json_of(const SummaryValue& value) {
  return std::visit(
      [](const auto& held) -> Json {
        if constexpr (std::is_same_v<std::decay_t<decltype(held)>, double>)
          return json_number(held);
        else
          return held;
      },
      value);
}

Json json_of(const Summary& summary) {
  Json json = Json::object();
  for (const SummaryItem& item : summary) json[item.name] = json_of(item.value);
  return json;
}

SummaryValue value_from(const Json& json) {
  if (json.is_null()) return kUnset;
  if (json.is_boolean()) return json.get<bool>();
  if (json.is_number_integer()) return json.get<std::int64_t>();
  if (json.is_number()) return json.get<double>();
  return json.get<std::string>();
}

Summary summary_from(const Json& json) {
  Summary summary;
  for (const auto& [name, value] : json.items()) summary.push_back({name, value_from(value), ""});
  return summary;
}

}  // namespace

std::string to_json(const BatchRow& row) {
  Json json = {{"case", row.name},           {"outcome", row.outcome},   {"message", row.message},
               {"exit_code", row.exit_code}, {"identity", row.identity}, {"bytes", row.bytes},
               {"seconds", row.seconds}};
  for (const auto& stage : kStageTimes) json["stages"][std::string(stage.name)] = row.stages.*stage.member;
  json["values"] = json_of(row.values);
  json["parts"] = Json::object();
  for (const auto& [name, part] : row.parts) json["parts"][name] = json_of(part);
  return format_json_line(json);
}

BatchRow batch_row_from_json(std::string_view text) {
  const Json json = parse_json(text, "row of a batch");
  try {
    BatchRow row;
    row.name = json.at("case").get<std::string>();
    row.outcome = json.at("outcome").get<std::string>();
    row.message = json.at("message").get<std::string>();
    row.exit_code = json.at("exit_code").get<int>();
    row.identity = json.at("identity").get<std::string>();
    row.bytes = json.at("bytes").get<std::uint64_t>();
    row.seconds = json.at("seconds").get<double>();
    for (const auto& stage : kStageTimes)
      row.stages.*stage.member = json.at("stages").at(std::string(stage.name)).get<double>();
    row.values = summary_from(json.at("values"));
    for (const auto& [name, part] : json.at("parts").items()) row.parts.emplace_back(name, summary_from(part));
    return row;
  } catch (const Json::exception& error) {
    throw InvalidInput(std::string("row of a batch: is not as crashsim writes it: ") + error.what());
  }
}

}  // namespace crashsim
