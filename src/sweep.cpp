/// Planning the samples of a case.

#include <crashsim/sweep.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <crashsim/coupled_columns.hpp>
#include <crashsim/error.hpp>

#include "case_sections.hpp"
#include "sample_runner.hpp"
#include "sweep_keys.hpp"

namespace crashsim {
namespace {

/// What a relative number multiplies: of the case, else of its model.
double base_of(const SamplePlan& plan, const CaseNumber& number) {
  const std::string key = number.full_key();
  const CrushModel& model = plan.base.model;
  if (key == kMassKey) return model.mass_kg;
  if (key == kSpeedKey) return plan_speed(plan);
  if (key == kRestitutionKey) return model.unloading.restitution;
  if (key == kUnloadingStiffnessKey) return model.unloading.unloading_stiffness_n_per_m;
  return number.value;
}

/// Unit and suffix of the ordinates of a curve.
struct OrdinateUnit {
  std::string_view unit, suffix;
};
OrdinateUnit unit_of(const OrdinateKey& ordinate, CrushLaw law) {
  if (ordinate.curve == 'r') return {"", ""};
  if (ordinate.curve == 'c') return {"N s/m", "_ns_per_m"};
  return law == CrushLaw::stiffness ? OrdinateUnit{"N/m", "_n_per_m"} : OrdinateUnit{"N", "_n"};
}

SampleInput ordinate_input(const SamplePlan& plan, const Variation& variation, const OrdinateKey& ordinate,
                           const std::string& what) {
  CrushModel model = plan.base.model;
  const std::span<const double> ordinates = ordinates_of(model, ordinate);
  if (ordinate.curve == 'r' && ordinates.empty())
    throw InvalidInput(fmt::format("{}: goes with law rate, the model's is {}", what, name_of(model.law)));
  if (ordinate.number > ordinates.size())
    throw InvalidInput(fmt::format("{}: the model has the ordinates {}1 to {}{}", what, ordinate.curve, ordinate.curve,
                                   ordinates.size()));
  if (ordinate.number == 0 && !variation.relative)
    throw InvalidInput(fmt::format("{}: is a whole curve: give factors, with relative = true", what));
  SampleInput input{variation.key + "_factor", "", {}, kUnset};
  if (ordinate.number > 0) {
    const OrdinateUnit unit = unit_of(ordinate, model.law);
    input.unit = unit.unit;
    input.name = variation.key + std::string(unit.suffix);
    if (variation.relative) input.base = ordinates[ordinate.number - 1];
  }
  input.distribution = distribution_of(variation, input.unit, what);
  return input;
}

/// "vehicle.mass_kg"; "impact.speed_mps" of the field impact_speed_mps.
std::string column_name(const CaseNumber& number) {
  const std::string section = number.section + "_";
  const bool is_double = number.name.starts_with(section);
  return number.section + "." + (is_double ? number.name.substr(section.size()) : number.name);
}

SampleInput number_input(const SamplePlan& plan, const Variation& variation, const CaseNumber& number,
                         const std::string& what) {
  SampleInput input{column_name(number), number.unit, distribution_of(variation, number.unit, what), kUnset};
  if (!variation.relative) return input;
  input.base = base_of(plan, number);
  if (std::isnan(input.base))
    throw InvalidInput(
        fmt::format("{}: the case has no such number to multiply: give it, or values without relative", what));
  return input;
}

/// What cannot vary together.
void check_together(const SamplePlan& plan, const std::string& where) {
  const auto has = [&](std::string_view key) { return std::ranges::find(plan.keys, key) != plan.keys.end(); };
  for (const std::string& key : plan.keys) {
    const auto ordinate = ordinate_key(key);
    if (!ordinate) continue;
    if (ordinate->number > 0 && has(fmt::format("crush.{}", ordinate->curve)))
      throw InvalidInput(
          fmt::format("{} {}: is part of crush.{}, which varies, too: leave one out", where, key, ordinate->curve));
    if (is_identified_anew(plan))
      throw InvalidInput(
          fmt::format("{} {}: something varies that it is identified from: vary one or the other", where, key));
  }
  if (has(kRestitutionKey) && has(kUnloadingStiffnessKey))
    throw InvalidInput(fmt::format("{} restitution and unloading_stiffness vary both: vary one of them", where));
  for (const char* key : {kRestitutionKey, kUnloadingStiffnessKey})
    if (has(key) && plan.base.model.unloading.kind != UnloadingKind::plastic)
      throw InvalidInput(fmt::format(R"({} {}: goes with unloading = "plastic")", where, key));
}

std::vector<std::string> output_names(const Case& study) {
  std::vector<std::string> names;
  for (const MetricField& field : kMetricFields) names.emplace_back(field.name);
  if (!has_pitch(study)) return names;
  for (const auto& number : kPitchNumbers) names.emplace_back(number.name);
  if (study.what.coupled)
    for (const auto& number : kCoupledNumbers) names.push_back(fmt::format("coupled_{}", number.name));
  return names;
}

std::uint64_t count_of(const SampleTable& table, const std::string& where) {
  double count = 1.0;
  if (!table.is_grid)
    count = static_cast<double>(point_count(table.design));
  else
    for (const SampleInput& input : table.inputs) count *= static_cast<double>(input.distribution.numbers.size());
  if (count > kMostSamples)
    throw InvalidInput(fmt::format("{} asks for {:g} samples: there may be {:g}", where, count, kMostSamples));
  return static_cast<std::uint64_t>(count);
}

}  // namespace

bool has_samples(const Case& study) { return !variations_of(study).empty(); }

Case without_samples(Case study) {
  study.sweep = {};
  study.monte_carlo = {};
  return study;
}

SamplePlan plan_samples(const Case& study, const CaseResult& base) {
  check_variations(study);
  const std::vector<Variation>& vary = variations_of(study);
  if (vary.empty()) throw InvalidInput(fmt::format("{}: has neither [sweep] nor [monte_carlo]", study.path));
  SamplePlan plan{without_samples(study), {}, {}, {}};
  plan.base.pulse = base.pulse;
  plan.base.model = base.model;
  plan.base.forcing = base.forcing;
  for (const Variation& variation : vary) {
    const std::string what = what_varies(study, variation);
    const std::string key = full_key_of(variation.key, what);
    if (std::ranges::find(plan.keys, key) != plan.keys.end())
      throw InvalidInput(fmt::format("{}: is named twice", what));
    plan.keys.push_back(key);
    const auto ordinate = ordinate_key(key);
    plan.table.inputs.push_back(ordinate ? ordinate_input(plan, variation, *ordinate, what)
                                         : number_input(plan, variation, *case_number(study, key), what));
  }
  plan.table.is_grid = !study.sweep.vary.empty();
  const std::string where = fmt::format("{}: [{}]", study.path, plan.table.is_grid ? "sweep" : "monte_carlo");
  check_together(plan, where);
  const MonteCarloOptions& options = study.monte_carlo;
  plan.table.design = {options.method, options.samples, options.seed, static_cast<int>(vary.size())};
  plan.table.planned = count_of(plan.table, where);
  plan.table.outputs = output_names(study);
  if (!plan.table.is_grid) static_cast<void>(sample_point(plan.table.design, 0));  // refuses too many dimensions
  return plan;
}

std::vector<double> sample_inputs(const SampleTable& table, std::uint64_t sample) {
  std::vector<double> numbers(table.inputs.size());
  if (table.is_grid) {
    for (std::size_t i = numbers.size(); i-- > 0;) {
      const std::vector<double>& values = table.inputs[i].distribution.numbers;
      numbers[i] = values[sample % values.size()];
      sample /= values.size();
    }
  } else {
    const std::vector<double> point = sample_point(table.design, sample);
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = quantile(table.inputs[i].distribution, point[i]);
  }
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (!std::isnan(table.inputs[i].base)) numbers[i] *= table.inputs[i].base;
  return numbers;
}

}  // namespace crashsim
