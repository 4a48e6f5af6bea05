/// What a design study leaves behind.

#include <cmath>

#include <fmt/format.h>

#include <crashsim/design_case.hpp>
#include <crashsim/model_io.hpp>
#include <crashsim/outputs.hpp>
#include <crashsim/table_io.hpp>
#include <crashsim/units.hpp>

#include "json.hpp"
#include "record_json.hpp"

namespace crashsim {
namespace {

constexpr const char* kSensitivities = "sensitivities.csv";
constexpr const char* kTradeOff = "trade_off.csv";
constexpr const char* kModel = "model.json";
constexpr const char* kCoupled = "coupled.csv";
constexpr const char* kRecord = "case.lock.json";

/// Name of a quantity's limit: "max_crush_m".
std::string limit_name(DesignQuantity quantity) {
  constexpr std::string_view kNames[] = {"none",        "max_pitch_rad", "max_drop_m",
                                         "max_crush_m", "max_olc_g",     "max_peak_decel_g"};
  return std::string(kNames[static_cast<std::size_t>(quantity)]);
}

std::string cell(double value) { return std::isnan(value) ? "" : format_number(value); }

/// One row for each parameter and response; columns are text and numbers.
std::string format_sensitivities(const DesignResult& result, const Record& record) {
  std::string text = fmt::format("# crashsim = {}\n# record = {}\n", record.version, to_json(record));
  text += "parameter,unit,value,response,response_value,derivative,derivative_error,percent_per_percent\n";
  std::size_t row = 0;
  for (const DesignVariable& variable : result.variables)
    for (const auto& response : kDesignResponses) {
      if (row == result.sensitivities.size()) return text;
      const DesignSensitivity& s = result.sensitivities[row++];
      text += fmt::format("{},{},{},{},{},{},{},{}\n", variable.name, variable.unit, cell(variable.before), s.response,
                          cell(result.before.*response.member), cell(s.derivative), cell(s.error), cell(s.relative));
    }
  return text;
}

/// One row for each limit: 1 where there is a design, its responses and its parameters.
std::string format_trade_off(const DesignResult& result, const Record& record) {
  const std::size_t responses = kDesignResponses.size();
  std::vector<std::string> names = {limit_name(result.traded), "feasible"};
  for (const auto& response : kDesignResponses) names.emplace_back(response.name);
  for (const DesignVariable& variable : result.variables) names.push_back(variable.name);
  std::vector<std::vector<double>> cells(names.size());
  for (const TradeOffPoint& point : result.trade_off) {
    cells[0].push_back(point.limit);
    cells[1].push_back(point.feasible ? 1.0 : 0.0);
    for (std::size_t i = 0; i < responses; ++i) cells[2 + i].push_back(point.responses.*kDesignResponses[i].member);
    for (std::size_t i = 0; i < point.values.size(); ++i) cells[2 + responses + i].push_back(point.values[i]);
  }
  names.front() = "limit_" + names.front();
  std::vector<Column> columns;
  for (std::size_t i = 0; i < names.size(); ++i) columns.push_back({names[i], cells[i]});
  return format_csv({{"crashsim", record.version},
                     {"minimised", std::string(name_of(result.minimised))},
                     {"limited", std::string(name_of(result.traded))},
                     {"record", to_json(record)}},
                    columns);
}

Json responses_json(const DesignResponses& responses) {
  Json json = Json::object();
  for (const auto& response : kDesignResponses)
    json[std::string(response.name)] = json_number(responses.*response.member);
  return json;
}

std::string format_design(const DesignResult& result, const Record& record) {
  Json parameters = Json::array(), limits = Json::array();
  for (const DesignVariable& v : result.variables)
    parameters.push_back({{"name", v.name},
                          {"unit", v.unit},
                          {"lower", v.lower},
                          {"upper", v.upper},
                          {"before", v.before},
                          {"after", json_number(v.after)},
                          {"at_bound", v.at_bound}});
  for (const DesignLimit& limit : result.limits)
    limits.push_back({{"name", limit_name(limit.quantity)},
                      {"limit", limit.limit},
                      {"before", json_number(limit.before)},
                      {"after", json_number(limit.after)},
                      {"active", limit.active}});
  return format_json({{"outcome", name_of(result.outcome)},
                      {"message", result.message},
                      {"minimised", name_of(result.minimised)},
                      {"before", responses_json(result.before)},
                      {"after", responses_json(result.after)},
                      {"parameters", parameters},
                      {"limits", limits},
                      {"starts", result.starts},
                      {"starts_at_best", result.starts_at_best},
                      {"simulations", result.simulations},
                      {"warnings", result.warnings},
                      {"record", record_json(record)}});
}

}  // namespace

Summary summarize(const DesignResponses& responses) {
  Summary summary;
  for (const auto& response : kDesignResponses)
    summary.push_back({std::string(response.name), responses.*response.member, std::string(response.doc)});
  return summary;
}

std::vector<std::string> design_file_names(const Case& study) {
  std::vector<std::string> names = {kSensitivities};
  if (study.design.trade_off != DesignQuantity::none) names.emplace_back(kTradeOff);
  names.insert(names.end(), {kModel, kCoupled, std::string(kDesignSummary), kRecord});
  return names;
}

std::vector<FileText> design_files(const Case& study, const DesignCaseResult& result) {
  const Record record = make_record("design", {study.path}, entries_of(study), result.base.input_files);
  std::vector<FileText> files = {{kSensitivities, format_sensitivities(result.design, record)}};
  if (!result.design.trade_off.empty()) files.push_back({kTradeOff, format_trade_off(result.design, record)});
  if (result.design.usable()) {
    files.push_back({kModel, format_model(result.design.optimum.crush, nullptr, &record)});
    files.push_back({kCoupled, format_coupled(result.response, record)});
  }
  files.push_back({std::string(kDesignSummary), format_design(result.design, record)});
  files.push_back({kRecord, format_record(record)});
  return files;
}

}  // namespace crashsim
