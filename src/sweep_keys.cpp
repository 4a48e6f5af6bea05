#include "sweep_keys.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <crashsim/option_values.hpp>

#include "case_sections.hpp"
#include "number_list.hpp"

namespace crashsim {
namespace {

/// Whether samples depend on a number: not what judges them, and no list.
bool can_vary(const Place& place) {
  constexpr std::string_view kOthers[] = {"", "compare", "predict", "design", "monte_carlo"};
  static constexpr std::pair<std::string_view, std::string_view> kNot[] = {
      {"crush", "knots"}, {"identify", "weights"}, {"identify", "jobs"}, {"pulse", "bias"}};
  const auto is_it = [&](const auto& other) { return place.section == other.first && place.key == other.second; };
  return std::ranges::find(kOthers, place.section) == std::end(kOthers) && std::ranges::none_of(kNot, is_it);
}

/// Calls visit(place, field, options) for every number of a case that may vary.
template <class SomeCase, class Visit>
void for_each_number(SomeCase& study, Visit visit) {
  for_each_key(study, [&](std::string_view section, const auto& field, auto& options) {
    using S = std::remove_cvref_t<decltype(options)>;
    const bool is_number = std::holds_alternative<double S::*>(field.member) ||
                           std::holds_alternative<int S::*>(field.member) ||
                           std::holds_alternative<std::uint64_t S::*>(field.member) ||
                           std::holds_alternative<SettingMember<S>>(field.member);
    if (!is_number) return;
    if (const Place place = place_of(section, field); can_vary(place)) visit(place, field, options);
  });
}

std::string joined(const Place& place) { return place.section + "." + place.key; }

/// A name as places are spelled: "vehicle.mass-kg" -> {"vehicle", "mass_kg"}; section "" where there is none.
Place spelled(std::string_view name) {
  std::string text(name);
  std::ranges::replace(text, '-', '_');
  const std::size_t dot = text.find('.');
  if (dot == std::string::npos) return {"", text};
  const std::string section = text.substr(0, dot);
  return {section, std::string(option_key(section, std::string_view(text).substr(dot + 1)))};
}

[[noreturn]] void refuse_name(std::string_view name, std::string_view what, const std::vector<std::string>& others) {
  const Case any;
  std::vector<std::string> keys = others;
  for_each_number(any, [&](const Place& place, const auto&, const auto&) { keys.push_back(joined(place)); });
  for (const char* ordinate : {"crush.k", "crush.k1", "crush.c", "crush.c1", kRateCoefficientKey})
    keys.emplace_back(ordinate);
  std::ranges::sort(keys);
  const bool has_section = name.find('.') != std::string_view::npos;
  std::vector<std::string_view> known, short_names;
  for (const std::string& key : keys) {
    known.push_back(key);
    short_names.push_back(std::string_view(key).substr(key.find('.') + 1));
  }
  std::string_view nearest = nearest_name(name, has_section ? known : short_names);
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (!has_section && short_names[i] == nearest) nearest = known[i];
  throw InvalidInput(fmt::format("{}: unknown name '{}'{} (known: {})", what, name,
                                 nearest.empty() ? "" : fmt::format(", did you mean '{}'?", nearest),
                                 fmt::join(known, ", ")));
}

std::vector<std::string> texts_of(const OptionValue& value, const std::string& what) {
  if (const auto* number = std::get_if<double>(&value)) return {format_number(*number)};
  return detail::to_texts(value, what);
}

/// The last word of "vehicle.mass.normal" where it is one that a variation has; "" where it is part of the key.
std::string_view last_word(std::string_view key) {
  constexpr std::string_view kWords[] = {"values", "weights", "lower", "upper", "relative"};
  const std::size_t dot = key.rfind('.');
  const std::string_view word = dot == std::string_view::npos ? "" : key.substr(dot + 1);
  const auto& kinds = kDistributionKindNames;
  const bool is_word =
      std::ranges::find(kWords, word) != std::end(kWords) || std::ranges::find(kinds, word) != std::end(kinds);
  return is_word ? word : "";
}

void set_word(Variation& variation, std::string_view word, const OptionValue& value, const std::string& what) {
  if (word == "relative") {
    variation.relative = detail::to_bool(value, what);
  } else if (word == "lower" || word == "upper") {
    (word == "lower" ? variation.lower : variation.upper) = text_of(value);
  } else if (word == "weights") {
    variation.weights = detail::to_numbers(value, "", what);
  } else {
    if (!variation.numbers.empty()) throw InvalidInput(fmt::format("{}: has a distribution already", what));
    const auto& kinds = kDistributionKindNames;
    const auto kind = word == "values" ? std::string_view("table") : word;
    variation.distribution = static_cast<DistributionKind>(std::ranges::find(kinds, kind) - std::begin(kinds));
    variation.numbers = texts_of(value, what);
  }
}

void check_kind(const Variation& variation, std::string_view section, const std::string& what) {
  if (variation.numbers.empty()) throw InvalidInput(fmt::format("{}: has no numbers to vary over", what));
  if (section == "sweep" && (variation.distribution != DistributionKind::table || !variation.weights.empty()))
    throw InvalidInput(fmt::format("{}: a sweep takes a list of values; distributions stand in [monte_carlo]", what));
}

std::string_view section_of(const Case& study) { return study.sweep.vary.empty() ? "monte_carlo" : "sweep"; }

/// The numbers of a distribution with ends are numbers that the case can have.
void check_number(const Case& study, const Variation& variation, const CaseNumber& number) {
  const std::string what = what_varies(study, variation);
  const Distribution distribution = distribution_of(variation, number.unit, what);
  if (number.is_whole && distribution.kind != DistributionKind::table)
    throw InvalidInput(fmt::format("{}: must be a whole number: give a table of values", what));
  const bool is_endless =
      distribution.kind == DistributionKind::normal || distribution.kind == DistributionKind::lognormal;
  if (variation.relative || is_endless) return;
  for (const double value : distribution.numbers) {
    Case copy = study;
    try {
      set_number(copy, number.full_key(), value);
    } catch (const InvalidInput& error) {
      throw InvalidInput(fmt::format("{}: [{}] {}", study.path, section_of(study), error.what()));
    }
  }
}

}  // namespace

std::string what_varies(const Case& study, const Variation& variation) {
  return fmt::format("{}: [{}] {}", study.path, section_of(study), variation.key);
}

std::optional<CaseNumber> case_number(const Case& study, std::string_view full_key) {
  std::optional<CaseNumber> found;
  for_each_number(study, [&](const Place& place, const auto& field, const auto& options) {
    if (found || joined(place) != full_key) return;
    using S = std::remove_cvref_t<decltype(options)>;
    const bool is_whole =
        std::holds_alternative<int S::*>(field.member) || std::holds_alternative<std::uint64_t S::*>(field.member);
    found =
        CaseNumber{place.section, place.key, std::string(field.name), std::string(field.unit), field.range, is_whole};
    const OptionValue value = get_option(options, field);
    const auto* numbers = std::get_if<std::vector<double>>(&value);
    if (const auto* number = std::get_if<double>(&value)) found->value = *number;
    if (const auto* number = std::get_if<std::int64_t>(&value)) found->value = static_cast<double>(*number);
    if (numbers != nullptr && numbers->size() == 1) found->value = numbers->front();
  });
  return found;
}

void set_number(Case& study, std::string_view full_key, double value) {
  for_each_number(study, [&](const Place& place, const auto& field, auto& options) {
    if (joined(place) == full_key) set_option(options, field, value, full_key);
  });
}

std::optional<OrdinateKey> ordinate_key(std::string_view full_key) {
  constexpr std::string_view kSection = "crush.";
  if (!full_key.starts_with(kSection)) return std::nullopt;
  if (full_key == kRateCoefficientKey) return OrdinateKey{'r', 1};
  const std::string_view name = full_key.substr(kSection.size());
  if (!name.starts_with('k') && !name.starts_with('c')) return std::nullopt;
  OrdinateKey ordinate{name.front()};
  if (name.size() == 1) return ordinate;
  const char* end = name.data() + name.size();
  const auto [last, error] = std::from_chars(name.data() + 1, end, ordinate.number);
  if (error != std::errc() || last != end || ordinate.number == 0) return std::nullopt;
  return ordinate;
}

std::string full_key_of(std::string_view name, std::string_view what, const std::vector<std::string>& others) {
  const Place wanted = spelled(name);
  std::string ordinate = wanted.section.empty() ? "crush." + wanted.key : joined(wanted);
  if (ordinate_key(ordinate)) return ordinate;
  const Case any;
  std::vector<std::string> found;
  for_each_number(any, [&](const Place& place, const auto& field, const auto&) {
    const bool is_section = wanted.section.empty() || wanted.section == place.section;
    if (is_section && (wanted.key == place.key || wanted.key == field.name)) found.push_back(joined(place));
  });
  if (found.empty()) refuse_name(name, what, others);
  if (found.size() > 1)
    throw InvalidInput(fmt::format("{}: '{}' may be {}: write which", what, name, fmt::join(found, " or ")));
  return found.front();
}

Distribution distribution_of(const Variation& variation, std::string_view unit, const std::string& what) {
  if (variation.relative) unit = "";
  Distribution out;
  out.kind = variation.distribution;
  out.weights = variation.weights;
  if (out.kind == DistributionKind::table)
    out.numbers = listed_numbers(variation.numbers, unit, what);
  else
    for (const std::string& text : variation.numbers) out.numbers.push_back(detail::to_number(text, unit, what));
  if (!variation.lower.empty()) out.lower = detail::to_number(variation.lower, unit, what + " lower");
  if (!variation.upper.empty()) out.upper = detail::to_number(variation.upper, unit, what + " upper");
  validate(out, what);
  return out;
}

void add_variation(const ConfigEntry& entry, std::vector<Variation>& vary, const std::vector<std::string>& options) {
  const std::string what = fmt::format("{}: [{}] {}", entry.where, entry.section, entry.key);
  std::string_view key = entry.key, word = last_word(key);
  if (!word.empty()) key.remove_suffix(word.size() + 1);
  if (word.empty() && entry.section == "sweep") word = "values";
  const std::string full_key = full_key_of(key, fmt::format("{}: [{}]", entry.where, entry.section), options);
  if (word.empty())
    throw InvalidInput(fmt::format("{}: needs a distribution: {{normal = [mean, deviation]}}, or {}", what,
                                   fmt::join(kDistributionKindNames, ", ")));
  auto at = std::ranges::find(vary, full_key, &Variation::key);
  if (at == vary.end()) {
    at = vary.insert(at, Variation());
    at->key = full_key;
  }
  set_word(*at, word, entry.value, what);
}

std::vector<ConfigEntry> entries_of(const std::vector<Variation>& vary, std::string_view section) {
  std::vector<ConfigEntry> entries;
  const auto add = [&](const Variation& variation, std::string_view word, OptionValue value) {
    entries.push_back({std::string(section), fmt::format("{}.{}", variation.key, word), std::move(value), ""});
  };
  for (const Variation& variation : vary) {
    add(variation, section == "sweep" ? "values" : name_of(variation.distribution), variation.numbers);
    if (!variation.weights.empty()) add(variation, "weights", variation.weights);
    if (!variation.lower.empty()) add(variation, "lower", variation.lower);
    if (!variation.upper.empty()) add(variation, "upper", variation.upper);
    if (variation.relative) add(variation, "relative", true);
  }
  return entries;
}

const std::vector<Variation>& variations_of(const Case& study) {
  return study.sweep.vary.empty() ? study.monte_carlo.vary : study.sweep.vary;
}

void check_variations(const Case& study) {
  if (!study.sweep.vary.empty() && !study.monte_carlo.vary.empty())
    throw InvalidInput(fmt::format("{}: has both [sweep] and [monte_carlo]: leave one out", study.path));
  if (study.monte_carlo.vary.empty() && study.monte_carlo != MonteCarloOptions())
    throw InvalidInput(
        fmt::format("{}: [monte_carlo] names nothing that varies: vehicle.mass = {{normal = [1400, 30]}}, for instance",
                    study.path));
  for (const Variation& variation : variations_of(study)) {
    const std::string what = what_varies(study, variation);
    check_kind(variation, section_of(study), what);
    if (const auto number = case_number(study, full_key_of(variation.key, what)))
      check_number(study, variation, *number);
  }
}

}  // namespace crashsim
