/// Predictions as files.

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <crashsim/outputs.hpp>
#include <crashsim/predict.hpp>
#include <crashsim/units.hpp>

#include "json.hpp"

namespace crashsim {
namespace {

std::string cell(double value) { return std::isnan(value) ? std::string() : format_number(value); }

std::string line_of(const PredictedSpeed& row) {
  std::string line = fmt::format("{},{},{},{}", format_number(row.impact_speed_mps), name_of(row.outcome),
                                 row.extrapolated() ? 1 : 0, cell(row.without_max_crush));
  for (const MetricField& field : kMetricFields)
    line += fmt::format(",{},{},{}", cell(row.value.*field.member), cell(row.low.*field.member),
                        cell(row.high.*field.member));
  return line + "\n";
}

Json row_json(const PredictedSpeed& row) {
  Json json = {{"impact_speed_mps", row.impact_speed_mps},
               {"outcome", name_of(row.outcome)},
               {"extrapolated", row.extrapolated()},
               {"without_max_crush", json_number(row.without_max_crush)},
               {"reasons", row.reasons}};
  for (const MetricField& field : kMetricFields) {
    const std::string name(field.name);
    json[name] = json_number(row.value.*field.member);
    json[name + "_low"] = json_number(row.low.*field.member);
    json[name + "_high"] = json_number(row.high.*field.member);
  }
  return json;
}

}  // namespace

std::string format_prediction(const SpeedPrediction& prediction, const Record& record) {
  std::string text = fmt::format("# crashsim = {}\n# mass_kg = {}\n# replicates = {}\n", record.version,
                                 format_number(prediction.mass_kg), prediction.replicates);
  if (!std::isnan(prediction.level)) text += fmt::format("# level = {}\n", format_number(prediction.level));
  text += fmt::format("# message = {}\n", prediction.message);
  for (const PredictedSpeed& row : prediction.speeds)
    if (!row.reasons.empty())
      text += fmt::format("# at_{}_mps = {}\n", format_number(row.impact_speed_mps), fmt::join(row.reasons, "; "));
  text += fmt::format("# record = {}\nimpact_speed_mps,outcome,extrapolated,without_max_crush", to_json(record));
  for (const MetricField& field : kMetricFields) text += fmt::format(",{0},{0}_low,{0}_high", field.name);
  text += "\n";
  for (const PredictedSpeed& row : prediction.speeds) text += line_of(row);
  return text;
}

std::string prediction_json(const SpeedPrediction& prediction) {
  Json rows = Json::array();
  for (const PredictedSpeed& row : prediction.speeds) rows.push_back(row_json(row));
  return format_json({{"mass_kg", json_number(prediction.mass_kg)},
                      {"replicates", prediction.replicates},
                      {"level", json_number(prediction.level)},
                      {"message", prediction.message},
                      {"speeds", rows}});
}

}  // namespace crashsim
