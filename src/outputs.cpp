#include <crashsim/outputs.hpp>

#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include <crashsim/coupled_columns.hpp>
#include <crashsim/table_io.hpp>
#include <crashsim/units.hpp>

#include "json.hpp"
#include "record_json.hpp"

namespace crashsim {
namespace {

Comments header(const Record& record, double mass_kg, double impact_speed_mps) {
  Comments comments = {{"crashsim", record.version}};
  if (!std::isnan(mass_kg)) comments.emplace_back("mass_kg", format_number(mass_kg));
  if (!std::isnan(impact_speed_mps)) comments.emplace_back("impact_speed_mps", format_number(impact_speed_mps));
  return comments;
}

/// A response by the table of its columns.
template <class Response, class Columns>
std::string format_motion(const Response& response, const Columns& table, const Record& record) {
  Comments comments = {{"crashsim", record.version}, {"outcome", std::string(name_of(response.outcome))}};
  for (const std::string& note : response.notes) comments.emplace_back("note", note);
  comments.emplace_back("record", to_json(record));
  std::vector<Column> columns;
  for (const auto& column : table) columns.push_back({std::string(column.name), response.*column.member});
  return format_csv(comments, columns);
}

template <class S, std::size_t N>
Json numbers_json(const S& numbers, const std::array<NamedNumber<S>, N>& table) {
  Json json = Json::object();
  for (const NamedNumber<S>& field : table) json[std::string(field.name)] = json_number(numbers.*field.member);
  return json;
}

Json channel_json(const ChannelComparison& channel) {
  Json rating = numbers_json(channel.rating, kRatingFields);
  rating["grade"] = grade(channel.rating.overall);
  if (!channel.not_rated.empty()) rating["not_rated"] = channel.not_rated;
  return {{"name", channel.name},
          {"unit", channel.unit},
          {"errors", numbers_json(channel.errors, kErrorFields)},
          {"iso18571", rating}};
}

Json comparison_json(const Comparison& comparison) {
  Json json = {{"start_s", json_number(comparison.start_s)},
               {"end_s", json_number(comparison.end_s)},
               {"dt_s", json_number(comparison.dt_s)},
               {"channels", Json::array()},
               {"notes", comparison.notes}};
  for (const ChannelComparison& channel : comparison.channels) json["channels"].push_back(channel_json(channel));
  return json;
}

}  // namespace

std::string format_pulse(const Pulse& pulse, const Record& record) {
  Comments comments = header(record, pulse.mass_kg, pulse.impact_speed_mps);
  for (const std::string& channel : pulse.channels) comments.emplace_back("channel", channel);
  for (const std::string& step : pulse.steps) comments.emplace_back("step", step);
  for (const std::string& warning : pulse.warnings) comments.emplace_back("warning", warning);
  comments.emplace_back("record", to_json(record));
  return format_csv(comments, {{"time_s", pulse.time_s},
                               {"accel_mps2", pulse.accel_mps2},
                               {"velocity_mps", pulse.velocity_mps},
                               {"displacement_m", pulse.displacement_m}});
}

std::string format_wall(const LoadCellWall& wall, const Record& record) {
  Comments comments = {{"crashsim", record.version}};
  for (const WallStrip& row : wall.rows)
    comments.emplace_back(fmt::format("row_{}_height_m", row.name), format_number(row.height_m));
  for (const std::string& cell : wall.excluded) comments.emplace_back("left_out", cell);
  for (const std::string& step : wall.steps) comments.emplace_back("step", step);
  for (const std::string& warning : wall.warnings) comments.emplace_back("warning", warning);
  comments.emplace_back("record", to_json(record));
  std::vector<Column> columns = {
      {"time_s", wall.time_s}, {"total_force_n", wall.total_force_n}, {"force_height_m", wall.force_height_m}};
  for (const WallStrip& row : wall.rows) columns.push_back({fmt::format("row_{}_force_n", row.name), row.force_n});
  for (const WallStrip& column : wall.cell_columns)
    columns.push_back({fmt::format("column_{}_force_n", column.name), column.force_n});
  return format_csv(comments, columns);
}

std::string format_correction(const SensorCorrection& correction, const Record& record) {
  const TraceSet& set = correction.corrected;
  Comments comments = header(record, set.mass_kg, set.impact_speed_mps);
  comments.emplace_back("outcome", std::string(name_of(correction.outcome)));
  if (!set.traces.empty()) comments.emplace_back("compartment_x", set.traces.front().name);
  for (const ChannelCorrection& channel : correction.channels)
    comments.emplace_back("corrected", fmt::format("{}: bias_mps2 {}, gain {}, time_shift_s {}", channel.channel,
                                                   format_number(channel.bias_mps2), format_number(channel.gain),
                                                   format_number(channel.time_shift_s)));
  for (const std::string& step : correction.steps) comments.emplace_back("step", step);
  for (const std::string& share : correction.by_prior) comments.emplace_back("by_prior", share);
  for (const std::string& warning : correction.warnings) comments.emplace_back("warning", warning);
  comments.emplace_back("record", to_json(record));
  std::vector<Column> columns;
  if (!set.traces.empty()) columns.push_back({"time_s", set.traces.front().times()});
  for (const Trace& trace : set.traces) columns.push_back({trace.name, trace.values});
  return format_csv(comments, columns);
}

std::string format_response(const CrushResponse& response, double mass_kg, const Record& record) {
  Comments comments = header(record, mass_kg, response.impact_speed_mps);
  comments.emplace_back("outcome", std::string(name_of(response.outcome)));
  comments.emplace_back("record", to_json(record));
  return format_csv(comments, {{"time_s", response.time_s},
                               {"accel_mps2", response.accel_mps2},
                               {"velocity_mps", response.velocity_mps},
                               {"displacement_m", response.displacement_m},
                               {"spring_force_n", response.spring_force_n},
                               {"damper_force_n", response.damper_force_n},
                               {"energy_residual_j", response.energy_residual_j}});
}

std::string format_pitch(const PitchResponse& response, const Record& record) {
  return format_motion(response, kPitchColumns, record);
}

std::string format_coupled(const CoupledResponse& response, const Record& record) {
  return format_motion(response, kCoupledColumns, record);
}

std::string format_comparison(const Comparison& comparison, const Record& record) {
  Json json = comparison_json(comparison);
  json["record"] = record_json(record);
  return format_json(json);
}

std::string format_comparison(const Comparison& comparison, const std::vector<MetricComparison>& metrics,
                              const Record& record) {
  Json json = comparison_json(comparison);
  for (const MetricComparison& metric : metrics)
    json["metrics"][metric.name] = {{"reference", json_number(metric.reference)},
                                    {"candidate", json_number(metric.candidate)},
                                    {"difference", json_number(metric.difference)}};
  json["record"] = record_json(record);
  return format_json(json);
}

std::string format_comparisons(const std::vector<NamedComparison>& comparisons, const Record& record) {
  Json json = Json::object();
  for (const NamedComparison& comparison : comparisons) json[comparison.name] = comparison_json(comparison.result);
  json["record"] = record_json(record);
  return format_json(json);
}

std::string format_record(const Record& record) { return format_json(record_json(record)); }

}  // namespace crashsim
