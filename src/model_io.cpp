#include <crashsim/model_io.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/files.hpp>
#include <crashsim/option_values.hpp>

#include "fit_json.hpp"
#include "json.hpp"
#include "json_object.hpp"
#include "record_json.hpp"
#include "uncertainty_json.hpp"

namespace crashsim {
namespace {

constexpr std::string_view kFormat = "crashsim.crush_model";
constexpr int kVersionOfFormat = 1;
constexpr std::string_view kCrushKnots = "knots_m", kSpeedKnots = "knots_mps";
constexpr std::string_view kDamperOrdinates = "ordinates_ns_per_m";
constexpr std::string_view kRateCoefficient = "coefficient", kReferenceSpeed = "reference_speed_mps";
constexpr std::string_view kReturnStiffness = "unloading_stiffness_n_per_m", kRestitution = "restitution";

struct Key {
  std::string_view section, key, unit, doc, range, choices;
};
constexpr Key kKeys[] = {
    {"", "format", "", "must be \"crashsim.crush_model\"", "", ""},
    {"", "version", "", "version of the format: 1", "", ""},
    {"", "title", "", "what it is a model of, for people", "", ""},
    {"", "source", "", "where it comes from, for people", "", ""},
    {"", "mass_kg", "kg", "test mass", "> 0", ""},
    {"", "impact_speed_mps", "m/s", "speed it was identified at, the default of simulate", "> 0", ""},
    {"", "law", "", "what spring and damper are curves of", "", "stiffness, force, crush_damping, rate"},
    {"", "extrapolation", "", "what a curve does beyond its last knot", "", "constant, linear, error"},
    {"", "spring", "", "k(|x|) or f(|x|); it or damper may be left out", "", ""},
    {"", "damper", "", "c(|v|), law crush_damping: c(|x|); none with law rate", "", ""},
    {"", "rate", "", "law rate: the factor 1 + r ln(1 + |v| / v_ref) of the spring's force", "", ""},
    {"", "unloading", "", "behaviour after maximum crush", "", ""},
    {"", "identification", "", "written by identify; predict reads its tests and verdict", "", ""},
    {"", "uncertainty", "", "written by identify: errors and replicates, read by predict", "", ""},
    {"", "record", "", "written by crashsim: what made the file", "", ""},
    {"spring", "knots_m", "m", "crush at the knots: first 0, increasing", "", ""},
    {"spring", "ordinates_n_per_m", "N/m", "stiffness at the knots (law stiffness)", ">= 0", ""},
    {"spring", "ordinates_n", "N", "force at the knots (every other law)", ">= 0", ""},
    {"damper", "knots_mps", "m/s", "speed at the knots: first 0, increasing", "", ""},
    {"damper", "knots_m", "m", "instead, with law crush_damping: crush at the knots", "", ""},
    {"damper", "ordinates_ns_per_m", "N s/m", "damping at the knots", ">= 0", ""},
    {"rate", kRateCoefficient, "", "r", ">= 0", ""},
    {"rate", kReferenceSpeed, "m/s", "v_ref", "> 0", ""},
    {"unloading", "kind", "", "path back", "", "elastic, plastic"},
    {"unloading", "bilateral", "", "the barrier pulls, too: contact is never lost", "", "true, false"},
    {"unloading", kReturnStiffness, "N/m", "plastic: slope of the line back; it or restitution", "> 0", ""},
    {"unloading", kRestitution, "", "plastic: rebound velocity / impact speed", ">= 0 and <= 1", ""},
};

/// Keys of one table of the file.
std::vector<std::string_view> keys_of(std::string_view section) {
  std::vector<std::string_view> keys;
  for (const Key& key : kKeys)
    if (key.section == section) keys.push_back(key.key);
  return keys;
}

std::string_view spring_ordinates(CrushLaw law) {
  return law == CrushLaw::stiffness ? "ordinates_n_per_m" : "ordinates_n";
}

std::string_view damper_knots(CrushLaw law) { return law == CrushLaw::crush_damping ? kCrushKnots : kSpeedKnots; }

PiecewiseLinear read_curve(const JsonObject& model, std::string_view name, std::string_view knots,
                           std::string_view ordinates) {
  if (!model.has(name)) return {};
  const JsonObject curve(model.get(name), model.name(name));
  curve.allow_only({knots, ordinates});
  return {curve.numbers(knots), curve.numbers(ordinates)};
}

void check_format(const JsonObject& file, const std::string& path) {
  if (file.get("format") != kFormat)
    throw InvalidInput(fmt::format("{}: format = {}: must be \"{}\"", path, file.get("format").dump(), kFormat));
  if (file.get("version") != kVersionOfFormat)
    throw InvalidInput(fmt::format("{}: version = {}: this program reads version {}", path, file.get("version").dump(),
                                   kVersionOfFormat));
}

Unloading read_unloading(const JsonObject& json) {
  json.allow_only(keys_of("unloading"));
  Unloading unloading;
  json.read_choice("kind", unloading.kind);
  if (json.has("bilateral")) unloading.bilateral = detail::to_bool(json.option("bilateral"), json.name("bilateral"));
  if (json.has(kReturnStiffness)) unloading.unloading_stiffness_n_per_m = json.number(kReturnStiffness);
  if (json.has(kRestitution)) unloading.restitution = json.number(kRestitution);
  return unloading;
}

void read_rate(const JsonObject& json, CrushModel& model) {
  json.allow_only(keys_of("rate"));
  model.rate_coefficient = json.number(kRateCoefficient);
  model.reference_speed_mps = json.number(kReferenceSpeed);
}

CrushModel read(const JsonObject& file) {
  file.allow_only(keys_of(""));
  CrushModel model;
  model.mass_kg = file.number("mass_kg");
  if (file.has("impact_speed_mps")) model.impact_speed_mps = file.number("impact_speed_mps");
  file.read_choice("law", model.law);
  file.read_choice("extrapolation", model.extrapolation);
  model.spring = read_curve(file, "spring", kCrushKnots, spring_ordinates(model.law));
  model.damper = read_curve(file, "damper", damper_knots(model.law), kDamperOrdinates);
  if (file.has("rate")) read_rate(JsonObject(file.get("rate"), file.name("rate")), model);
  if (file.has("unloading"))
    model.unloading = read_unloading(JsonObject(file.get("unloading"), file.name("unloading")));
  return model;
}

Json curve_json(const PiecewiseLinear& curve, std::string_view knots, std::string_view ordinates) {
  return {{std::string(knots), json_numbers(curve.knots)}, {std::string(ordinates), json_numbers(curve.ordinates)}};
}

Json unloading_json(const Unloading& unloading) {
  Json json = {{"kind", name_of(unloading.kind)}, {"bilateral", unloading.bilateral}};
  if (!std::isnan(unloading.unloading_stiffness_n_per_m))
    json[std::string(kReturnStiffness)] = unloading.unloading_stiffness_n_per_m;
  if (!std::isnan(unloading.restitution)) json[std::string(kRestitution)] = unloading.restitution;
  return json;
}

/// One number per fitted number, under the names of the parts.
template <class Get>
Json per_part(const Identification& fit, Get get) {
  Json parts = Json::object();
  for (const OrdinateReport& ordinate : fit.ordinates)
    parts[std::string(name_of(ordinate.part))].push_back(json_number(get(ordinate)));
  return parts;
}

/// The tests of a fit; corrections only where they were sought.
Json tests_json(const Identification& fit) {
  Json tests = Json::array();
  for (const TestReport& test : fit.tests) {
    Json json = {{"impact_speed_mps", test.impact_speed_mps},
                 {"mass_kg", test.mass_kg},
                 {"max_crush_m", test.max_crush_m},
                 {"t_m_s", test.t_m_s},
                 {"weight", test.weight},
                 {"error", json_number(test.error.total)}};
    const auto add = [&json](std::string_view name, double value, std::string_view error_name, double error) {
      if (std::isnan(value)) return;
      json[std::string(name)] = value;
      json[std::string(error_name)] = json_number(error);
    };
    add("time_shift_s", test.time_shift_s, "time_shift_error_s", test.time_shift_error_s);
    add("gain", test.gain, "gain_error", test.gain_error);
    add("bias_mps2", test.bias_mps2, "bias_error_mps2", test.bias_error_mps2);
    tests.push_back(json);
  }
  return tests;
}

template <class Is>
Json names_where(const Identification& fit, Is is) {
  Json names = Json::array();
  for (const OrdinateReport& ordinate : fit.ordinates)
    if (is(ordinate)) names.push_back(ordinate.name);
  return names;
}

Json verdict_json(const Verdict& verdict) {
  return {{"identifiable", verdict.identifiable},
          {"rank", verdict.rank},
          {"condition", json_number(verdict.condition)},
          {"spring_damper_cosine", json_number(verdict.spring_damper_cosine)},
          {"message", verdict.message}};
}

// Wall time is left out: a record run again gives the same bytes.
Json identification_json(const Identification& fit) {
  Json json = {{"outcome", name_of(fit.outcome)},
               {"error", json_number(fit.error.total)},
               {"error_accel", json_number(fit.error.accel)},
               {"error_velocity", json_number(fit.error.velocity)},
               {"error_displacement", json_number(fit.error.displacement)},
               {"starts", fit.starts.size()},
               {"starts_at_best", fit.starts_at_best},
               {"verdict", verdict_json(fit.verdict)},
               {"standard_error", per_part(fit, [](const OrdinateReport& o) { return o.standard_error; })},
               {"upper_bound", per_part(fit, [](const OrdinateReport& o) { return o.upper_bound; })},
               {"at_bound", names_where(fit, [](const OrdinateReport& o) { return o.at_bound; })},
               {"untouched", names_where(fit, [](const OrdinateReport& o) { return o.untouched; })},
               {"evaluations", fit.evaluations},
               {"seed", fit.seed}};
  json["tests"] = tests_json(fit);
  json["smooth"] = json_number(fit.smooth);
  json["correlation"] = correlation_json(fit.correlation);
  json["start_errors"] = start_errors_json(fit.starts);
  return json;
}

}  // namespace

std::vector<FileKey> model_keys() {
  std::vector<FileKey> keys;
  for (const Key& key : kKeys)
    keys.push_back(
        {std::string(key.section),
         std::string(key.key),
         {std::string(key.unit), std::string(key.doc), "", std::string(key.range), std::string(key.choices)}});
  return keys;
}

CrushModel read_model(const std::string& path) {
  const Json json = parse_json(read_file(path), path);
  const JsonObject file(json, path);
  check_format(file, path);
  const CrushModel model = read(file);
  try {
    validate(model);
  } catch (const InvalidInput& problem) {
    throw InvalidInput(fmt::format("{}: {}", path, problem.what()));
  }
  return model;
}

PredictionBasis read_prediction_basis(const std::string& path) {
  PredictionBasis basis;
  basis.model = read_model(path);
  const Json json = parse_json(read_file(path), path);
  read_basis(JsonObject(json, path), basis);
  return basis;
}

std::string format_model(const CrushModel& model, const Identification* identification, const Record* record,
                         const Uncertainty* uncertainty) {
  validate(model);
  Json json = {{"format", kFormat}, {"version", kVersionOfFormat}, {"mass_kg", model.mass_kg}};
  if (!std::isnan(model.impact_speed_mps)) json["impact_speed_mps"] = model.impact_speed_mps;
  json["law"] = name_of(model.law);
  json["extrapolation"] = name_of(model.extrapolation);
  if (!model.spring.knots.empty()) json["spring"] = curve_json(model.spring, kCrushKnots, spring_ordinates(model.law));
  if (!model.damper.knots.empty()) json["damper"] = curve_json(model.damper, damper_knots(model.law), kDamperOrdinates);
  if (model.law == CrushLaw::rate)
    json["rate"] = {{std::string(kRateCoefficient), model.rate_coefficient},
                    {std::string(kReferenceSpeed), model.reference_speed_mps}};
  json["unloading"] = unloading_json(model.unloading);
  if (identification != nullptr) json["identification"] = identification_json(*identification);
  if (uncertainty != nullptr) json["uncertainty"] = uncertainty_json(*uncertainty);
  if (record != nullptr) json["record"] = record_json(*record);
  return format_json(json);
}

}  // namespace crashsim
