/// Case files: read from TOML or a record, and written as one.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <crashsim/error.hpp>
#include <crashsim/option_values.hpp>

#include "case_sections.hpp"
#include "nearest.hpp"
#include "sweep_keys.hpp"

namespace crashsim {
namespace {

/// What stands in [sweep] and [monte_carlo] beside options: numbers of other sections by their keys.
constexpr std::string_view kAnyNumber = "<section>.<key>";
constexpr const char* kSweepDoc =
    "values of any number of the sections above, or of the model's ordinates crush.k1, .. and crush.c1, .. or "
    "crush.rate_coefficient: "
    "[\"40 km/h\", \"48 km/h\"], \"1 t..1.4 t:5\", or factors {values = [0.9, 1.1], relative = true}";
constexpr const char* kMonteCarloDoc =
    "distribution of such a number: {normal = [mean, deviation], lower = .., upper = ..}, {lognormal = [mean, "
    "deviation]}, {uniform = [least, largest]}, {triangular = [least, likely, largest]}, {table = [..], weights = "
    "[..]}; of a factor with relative = true";

[[noreturn]] void refuse_key(const ConfigEntry& entry, const std::vector<FileKey>& keys) {
  std::vector<std::string_view> sections, here;
  for (const FileKey& key : keys) {
    if (sections.empty() || sections.back() != key.section) sections.push_back(key.section);
    if (key.section == entry.section) here.push_back(key.key);
  }
  std::erase(sections, "");
  if (here.empty()) detail::throw_unknown_name(entry.where, "[" + entry.section + "]", sections);
  const std::string what = entry.section.empty() ? entry.where : fmt::format("{}: [{}]", entry.where, entry.section);
  detail::throw_unknown_name(what, entry.key, here);
}

void set(Case& study, const ConfigEntry& entry) {
  bool known = false;
  for_each_key(study, [&](std::string_view section, const auto& field, auto& options) {
    const Place place = place_of(section, field);
    using Options = std::remove_cvref_t<decltype(options)>;
    constexpr bool has_table = std::is_same_v<Options, ForcingOptions> || std::is_same_v<Options, MotionOptions>;
    const std::string_view key = option_key(entry.section, entry.key);
    if (key != entry.key && !has_table) return;  // a key of `force = {..}`
    const bool is_named = section.empty() ? entry.key == place.key : is_key_of(key, field);
    if (known || place.section != entry.section || !is_named) return;
    const std::string path = place.section.empty() ? "" : fmt::format("[{}] ", place.section);
    set_option(options, field, entry.value, fmt::format("{}: {}{}", entry.where, path, entry.key));
    known = true;
  });
  if (known) return;
  if (entry.section == "sweep") return add_variation(entry, study.sweep.vary, {});
  if (entry.section == "monte_carlo")
    return add_variation(entry, study.monte_carlo.vary, {"samples", "seed", "method"});
  refuse_key(entry, case_keys());
}

void check_speeds(const Case& study) {
  constexpr std::size_t kMostSpeeds = 1000;  // each keeps its motion in memory and writes a file
  if (study.what.speeds_mps.size() > kMostSpeeds)
    throw InvalidInput(fmt::format("{}: [predict] speeds has {} speeds: at most {} fit in a case, use several",
                                   study.path, study.what.speeds_mps.size(), kMostSpeeds));
  std::map<std::string, double> seen;
  for (std::size_t i = 0; i < study.what.speeds_mps.size(); ++i) {
    const double speed = study.what.speeds_mps[i];
    const std::string what = fmt::format("{}: [predict] speeds[{}]", study.path, i);
    if (!detail::in_range(speed, positive())) detail::throw_out_of_range(what, speed, "m/s", positive());
    const auto [other, is_new] = seen.emplace(prediction_name(speed), speed);
    if (!is_new)
      throw InvalidInput(fmt::format("{} = {} m/s: is the prediction_{} of {} m/s, too: leave one out", what,
                                     format_number(speed), other->first, format_number(other->second)));
  }
}

void check_unloading(const Case& study) {
  const CaseOptions& what = study.what;
  const bool has_stiffness = !std::isnan(what.unloading_stiffness_n_per_m), has_e = !std::isnan(what.restitution);
  if (what.unloading != UnloadingKind::plastic && (has_stiffness || has_e))
    throw InvalidInput(fmt::format(R"({}: [crush] {} goes with unloading = "plastic", this is "{}")", study.path,
                                   has_e ? "restitution" : "unloading_stiffness", name_of(what.unloading)));
  if (has_stiffness && has_e)
    throw InvalidInput(
        fmt::format("{}: [crush] has both unloading_stiffness and restitution: give one of them", study.path));
}

/// What heave and pitch need, before anything is computed.
void check_pitch(const Case& study) {
  const auto in_section = [&](std::string_view section, const auto& check) {
    try {
      check();
    } catch (const InvalidInput& problem) {
      throw InvalidInput(fmt::format("{}: [{}] {}", study.path, section, problem.what()));
    }
  };
  if (has_pitch(study)) {
    HeavePitchModel vehicle = study.vehicle;
    vehicle.mass_kg = 1.0;  // comes with the crush
    in_section("vehicle", [&] { validate(vehicle); });
    in_section("pitch", [&] { validate(study.vertical); });
  } else if (!study.measured.file.empty()) {
    throw InvalidInput(
        fmt::format("{}: [compare] motion needs heave and pitch to compare with: describe the [vehicle]", study.path));
  }
  if (study.measured.file.empty()) return;
  for (const auto place :
       {&MotionOptions::front_position_m, &MotionOptions::rear_position_m, &MotionOptions::cg_position_m})
    in_section("compare", [&] { require_set(study.measured, place, "motion", "there is a trace"); });
}

void check(const Case& study) {
  check_speeds(study);
  check_pitch(study);
  check_unloading(study);
  check_variations(study);
  if (study.what.pulse_file.empty() && study.what.model_file.empty())
    throw InvalidInput(
        fmt::format("{}: has neither [pulse] file nor [crush] model: name a trace to identify a model from, or a model "
                    "to simulate",
                    study.path));
  if (!study.what.model_file.empty() && !study.what.further_pulses.empty())
    throw InvalidInput(
        fmt::format("{}: [identify] pulses do not go with [crush] model, which is used as it is", study.path));
}

}  // namespace

std::string resolved(const Case& study, const std::string& path) {
  return (std::filesystem::path(study.path).parent_path() / path).lexically_normal().string();
}

bool has_pitch(const Case& study) {
  const std::vector<ConfigEntry> asked = entries_of(study), defaults = entries_of(Case{});
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const bool is_pitch = asked[i].section == "pitch" || (asked[i].section == "vehicle" && asked[i].key != "mass");
    if (is_pitch && asked[i].value != defaults[i].value) return true;
  }
  return false;
}

std::string prediction_name(double speed_mps) { return fmt::format("{:.4g}kmh", 3.6 * speed_mps); }

std::vector<std::string> case_inputs(const Case& study) {
  std::vector<std::string> paths = {study.path};
  for (const std::string& file :
       {study.what.pulse_file, study.what.model_file, study.forcing.file, study.measured.file})
    if (!file.empty()) paths.push_back(resolved(study, file));
  for (const std::string& file : study.what.further_pulses) paths.push_back(resolved(study, file));
  return paths;
}

std::vector<FileKey> case_keys() {
  Case defaults;
  std::vector<FileKey> keys;
  for_each_key(defaults, [&](std::string_view section, const auto& field, const auto& options) {
    const Place place = place_of(section, field);
    keys.push_back({place.section, place.key, describe_field(field, options)});
  });
  keys.push_back({"sweep", std::string(kAnyNumber), {"", kSweepDoc, "", "", ""}});
  keys.push_back({"monte_carlo", std::string(kAnyNumber), {"", kMonteCarloDoc, "", "", ""}});
  std::stable_sort(keys.begin(), keys.end(), [](const FileKey& a, const FileKey& b) {
    const auto rank = [](const std::string& name) {
      constexpr std::string_view kOrder[] = {"",      "vehicle", "impact",  "pulse",  "crush", "identify",   "simulate",
                                             "pitch", "compare", "predict", "design", "sweep", "monte_carlo"};
      return std::find(std::begin(kOrder), std::end(kOrder), name) - std::begin(kOrder);
    };
    return rank(a.section) < rank(b.section);
  });
  return keys;
}

Case read_case(const std::string& path) {
  Case study;
  study.path = path;
  std::vector<ConfigEntry> entries;
  if (const auto record = find_record(path)) {
    const bool is_case = record->command == "run" || record->command == "design";
    if (!is_case || record->arguments.size() != 1)
      throw InvalidInput(fmt::format("{}: is the record of 'crashsim {}', not of a case", path, record->command));
    verify_inputs(*record);
    study.path = record->arguments.front();
    entries = record->options;
  } else {
    entries = read_config(path);
  }
  for (const ConfigEntry& entry : entries) set(study, entry);
  check(study);
  return study;
}

std::vector<ConfigEntry> entries_of(const Case& study) {
  std::vector<ConfigEntry> entries;
  for_each_key(study, [&](std::string_view section, const auto& field, const auto& options) {
    const Place place = place_of(section, field);
    entries.push_back({place.section, place.key, get_option(options, field), ""});
  });
  for (const auto& varied : {entries_of(study.sweep.vary, "sweep"), entries_of(study.monte_carlo.vary, "monte_carlo")})
    entries.insert(entries.end(), varied.begin(), varied.end());
  return entries;
}

}  // namespace crashsim
