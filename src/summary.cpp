#include <crashsim/summary.hpp>

#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <crashsim/coupled_columns.hpp>
#include <crashsim/units.hpp>

#include "event_metrics.hpp"
#include "json.hpp"

namespace crashsim {
namespace {

void append_metrics(const Metrics& metrics, Summary& summary) {
  for (const MetricField& field : kMetricFields)
    summary.push_back({std::string(field.name), metrics.*field.member, std::string(field.doc)});
}

/// Outcome and the numbers of a table.
template <class Response, class Table>
Summary summary_of(const Response& response, const Table& table) {
  Summary summary = {{"outcome", std::string(name_of(response.outcome)), "outcome"}};
  for (const auto& number : table)
    summary.push_back({std::string(number.name), response.*number.member, std::string(number.doc)});
  return summary;
}

Json to_json(const SummaryValue& value) {
  return std::visit(
      [](const auto& held) -> Json {
        if constexpr (std::is_same_v<std::decay_t<decltype(held)>, double>)
          return json_number(held);
        else
          return held;
      },
      value);
}

Json to_json(const Summary& summary) {
  Json json = Json::object();
  for (const SummaryItem& item : summary) json[item.name] = to_json(item.value);
  return json;
}

/// The numbers found, starts and verdict of an identification of named numbers.
template <class Fit>
void append_fit_of_numbers(const Fit& fit, Summary& summary) {
  for (const ParameterReport& parameter : fit.parameters)
    summary.push_back({parameter.name, parameter.value, parameter.name});
  const Summary rest = {{"starts", static_cast<std::int64_t>(fit.starts.size()), "starts"},
                        {"starts_at_best", std::int64_t{fit.starts_at_best}, "starts within 0.1 % of the best"},
                        {"identifiable", fit.verdict.identifiable, "every number determined"},
                        {"rank", std::int64_t{fit.verdict.rank}, "rank of the sensitivities"},
                        {"condition", fit.verdict.condition, "their condition number"},
                        {"verdict", fit.verdict.message, "verdict"},
                        {"evaluations", std::int64_t{fit.evaluations}, "evaluations of E and its gradient"},
                        {"seconds", fit.seconds, "wall time"}};
  summary.insert(summary.end(), rest.begin(), rest.end());
}

}  // namespace

Metrics metrics_of(const Pulse& pulse) {
  return metrics({pulse.time_s, pulse.accel_mps2, pulse.velocity_mps, pulse.displacement_m}, pulse.mass_kg);
}

Metrics metrics_of(const CrushResponse& response, double mass_kg) {
  constexpr std::size_t kFewestSamples = 3;
  const bool has_ended = response.usable() || response.outcome == CrushOutcome::no_max_crush;
  Metrics out;
  if (!has_ended) return out;
  if (response.time_s.size() >= kFewestSamples)
    out = metrics({response.time_s, response.accel_mps2, response.velocity_mps, response.displacement_m}, mass_kg);
  take_events(response, mass_kg, response.impact_speed_mps, out);
  return out;
}

Summary summarize(const Pulse& pulse) {
  const CrushOutcome outcome = std::isnan(pulse.t_m_s) ? CrushOutcome::no_max_crush : CrushOutcome::completed;
  Summary summary = {{"outcome", std::string(name_of(outcome)), "outcome"},
                     {"mass_kg", pulse.mass_kg, "test mass"},
                     {"impact_speed_mps", pulse.impact_speed_mps, "impact speed"}};
  append_metrics(metrics_of(pulse), summary);
  return summary;
}

Summary summarize(const CrushResponse& response, double mass_kg) {
  Summary summary = {{"outcome", std::string(name_of(response.outcome)), "outcome"},
                     {"mass_kg", mass_kg, "mass"},
                     {"impact_speed_mps", response.impact_speed_mps, "impact speed"}};
  append_metrics(metrics_of(response, mass_kg), summary);
  return summary;
}

Summary summarize(const PitchResponse& response) { return summary_of(response, kPitchNumbers); }

Summary summarize(const CoupledResponse& response) { return summary_of(response, kCoupledNumbers); }

Summary summarize(const LoadCellWall& wall, const WallNumbers& numbers) {
  std::string excluded;
  for (const std::string& cell : wall.excluded) excluded += fmt::format("{}{}", excluded.empty() ? "" : "; ", cell);
  Summary summary = {{"cells", std::int64_t{wall.cells}, "cells added up"},
                     {"cells_excluded", std::ssize(wall.excluded), "cells left out"},
                     {"excluded", excluded, "left out"}};
  for (const auto& number : kWallNumbers)
    summary.push_back({std::string(number.name), numbers.*number.member, std::string(number.doc)});
  return summary;
}

Summary summarize(const Identification& fit) {
  return {{"outcome", std::string(name_of(fit.outcome)), "outcome"},
          {"error", fit.error.total, "error E of the fit"},
          {"error_accel", fit.error.accel, "its part of acceleration"},
          {"error_velocity", fit.error.velocity, "its part of velocity"},
          {"error_displacement", fit.error.displacement, "its part of displacement"},
          {"starts", static_cast<std::int64_t>(fit.starts.size()), "starts"},
          {"starts_at_best", std::int64_t{fit.starts_at_best}, "starts within 0.1 % of the best"},
          {"identifiable", fit.verdict.identifiable, "every ordinate determined"},
          {"rank", std::int64_t{fit.verdict.rank}, "rank of the sensitivities"},
          {"condition", fit.verdict.condition, "their condition number"},
          {"verdict", fit.verdict.message, "verdict"},
          {"evaluations", std::int64_t{fit.evaluations}, "evaluations of E and its gradient"},
          {"seconds", fit.seconds, "wall time"}};
}

Summary summarize(const PitchIdentification& fit) {
  Summary summary = {{"outcome", std::string(name_of(fit.outcome)), "outcome"},
                     {"error", fit.error.total, "error E of the fit"},
                     {"error_heave", fit.error.heave, "its part of heave"},
                     {"error_pitch", fit.error.pitch, "its part of pitch"},
                     {"error_heave_velocity", fit.error.heave_velocity, "its part of heave velocity"},
                     {"error_pitch_rate", fit.error.pitch_rate, "its part of pitch rate"}};
  append_fit_of_numbers(fit, summary);
  return summary;
}

Summary summarize(const VerticalIdentification& fit) {
  Summary summary = {{"outcome", std::string(name_of(fit.outcome)), "outcome"},
                     {"error", fit.error, "error E of the fit"},
                     {"samples", std::int64_t{fit.samples}, "samples compared"},
                     {"limited_samples", std::int64_t{fit.limited_samples}, "of these, bounded by friction"}};
  append_fit_of_numbers(fit, summary);
  return summary;
}

Summary summarize(const SensorCorrection& correction) {
  return {{"outcome", std::string(name_of(correction.outcome)), "outcome"},
          {"channel_count", std::ssize(correction.channels), "channels"},
          {"noise_mps2", correction.noise_mps2, "noise of a channel"},
          {"correlation_time_s", correction.correlation_time_s, "its correlation in time"},
          {"wall_gain", correction.wall_gain, "gain of the wall"},
          {"wall_gain_error", correction.wall_gain_error, "its standard error"}};
}

std::string format_summary(const SensorCorrection& correction) {
  Json json = to_json(summarize(correction));
  json["channels"] = Json::array();
  for (const ChannelCorrection& channel : correction.channels) {
    Json numbers = {{"channel", channel.channel}};
    for (const auto& number : kChannelCorrectionNumbers)
      numbers[std::string(number.name)] = json_number(channel.*number.member);
    json["channels"].push_back(std::move(numbers));
  }
  json["conditions"] = Json::array();
  for (const CorrectionCondition& condition : correction.conditions)
    json["conditions"].push_back({{"name", condition.name},
                                  {"known_mps", json_number(condition.known_mps)},
                                  {"standard_deviation_mps", json_number(condition.standard_deviation_mps)},
                                  {"before_mps", json_number(condition.before_mps)},
                                  {"after_mps", json_number(condition.after_mps)}});
  json["by_prior"] = correction.by_prior;
  json["warnings"] = correction.warnings;
  return format_json(json);
}

std::string format_summary(const Summary& summary) { return format_json(to_json(summary)); }

std::string format_summary(const Summary& summary, const std::vector<std::pair<std::string, Summary>>& parts) {
  Json json = to_json(summary);
  for (const auto& [name, part] : parts) json[name] = to_json(part);
  return format_json(json);
}

}  // namespace crashsim
