#include "optimize/pitch_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <variant>

#include <fmt/format.h>

#include <crashsim/option_values.hpp>

namespace crashsim {
namespace {

using M = HeavePitchModel;

/// Where a number is sought by default: within a factor of the given one, or in a range that cars and trucks stay
/// within when there is none or the factor is 0.
struct DefaultRange {
  double M::*member;
  double factor, low, high;
};
constexpr DefaultRange kDefaultRanges[] = {
    {&M::mass_kg, 5.0, 200.0, 40e3},
    {&M::pitch_inertia_kgm2, 5.0, 50.0, 200e3},
    {&M::front_axle_m, 4.0, 0.3, 5.0},
    {&M::rear_axle_m, 4.0, 0.3, 5.0},
    {&M::front_stiffness_n_per_m, 20.0, 0.0, 1e6},
    {&M::rear_stiffness_n_per_m, 20.0, 0.0, 1e6},
    {&M::front_damping_ns_per_m, 20.0, 0.0, 1e5},
    {&M::rear_damping_ns_per_m, 20.0, 0.0, 1e5},
    {&M::force_arm_m, 0.0, -5.0, 5.0},
    {&M::cg_height_m, 0.0, 0.0, 2.0},
    {&M::force_height_m, 0.0, 0.0, 2.0},
};

void set_default_bounds(PitchParameter& parameter, double guess) {
  const DefaultRange& range = *std::ranges::find(kDefaultRanges, parameter.member, &DefaultRange::member);
  const bool around_guess = range.factor > 0.0 && guess > 0.0;
  parameter.lower = around_guess ? guess / range.factor : range.low;
  parameter.upper = around_guess ? guess * range.factor : range.high;
}

/// Takes entry `i` of a list of bounds unless it is unset.
void take_bound(const std::vector<double>& bounds, std::string_view name, std::size_t i, const PitchParameter& of,
                double& bound) {
  if (bounds.empty() || std::isnan(bounds[i])) return;
  bound = bounds[i];
  const std::string what = fmt::format("IdentifyPitchOptions.{}[{}] ({})", name, i, of.field->name);
  if (!detail::in_range(bound, of.field->range))
    detail::throw_out_of_range(what, bound, of.field->unit, of.field->range);
}

void check_length(const std::vector<double>& bounds, std::string_view name, std::size_t count) {
  if (!bounds.empty() && bounds.size() != count)
    throw InvalidInput(fmt::format("IdentifyPitchOptions.{} has {} numbers but there are {} in free: give one for each",
                                   name, bounds.size(), count));
}

PitchParameter named(const std::string& name) {
  PitchParameter parameter;
  parameter.field = &find_field<M>(name, "IdentifyPitchOptions.free");
  const auto* member = std::get_if<double M::*>(&parameter.field->member);
  if (member == nullptr)
    throw InvalidInput(fmt::format("IdentifyPitchOptions.free: {} is not a number to identify", parameter.field->name));
  parameter.member = *member;
  return parameter;
}

/// Start 0: the given number, or the middle of the range.
void set_first(PitchParameter& parameter, double guess, std::vector<std::string>& warnings) {
  const auto& [name, flag, unit, doc, member, range] = *parameter.field;
  if (std::isnan(guess)) {
    parameter.first = parameter.value_at(0.5);
    return;
  }
  parameter.first = std::clamp(guess, parameter.lower, parameter.upper);
  if (parameter.first != guess)
    warnings.push_back(
        fmt::format("{} = {:.6g} {} of the given model is outside its bounds {:.6g} to {:.6g} {}: the "
                    "first start begins at the nearer one",
                    name, guess, unit, parameter.lower, parameter.upper, unit));
}

}  // namespace

double PitchParameter::value_at(double place) const {
  const double value = is_logarithmic() ? lower * std::pow(upper / lower, place) : lower + (upper - lower) * place;
  return std::clamp(value, lower, upper);
}

double PitchParameter::slope_at(double value) const {
  return is_logarithmic() ? value * std::log(upper / lower) : upper - lower;
}

double PitchParameter::place_of(double value) const {
  const double place =
      is_logarithmic() ? std::log(value / lower) / std::log(upper / lower) : (value - lower) / (upper - lower);
  return std::clamp(place, 0.0, 1.0);
}

std::vector<PitchParameter> pitch_parameters(const HeavePitchModel& guess, const IdentifyPitchOptions& options,
                                             std::vector<std::string>& warnings) {
  const std::size_t count = options.free.size();
  if (count == 0) throw InvalidInput("IdentifyPitchOptions.free names no number: give at least one to identify");
  check_length(options.lower, "lower", count);
  check_length(options.upper, "upper", count);
  std::vector<PitchParameter> parameters;
  for (std::size_t i = 0; i < count; ++i) {
    PitchParameter parameter = named(options.free[i]);
    const std::string_view name = parameter.field->name;
    if (std::ranges::find(parameters, parameter.field, &PitchParameter::field) != parameters.end())
      throw InvalidInput(fmt::format("IdentifyPitchOptions.free names {} twice", name));
    const double given = guess.*parameter.member;
    set_default_bounds(parameter, given);
    take_bound(options.lower, "lower", i, parameter, parameter.lower);
    take_bound(options.upper, "upper", i, parameter, parameter.upper);
    if (!(parameter.lower < parameter.upper))
      throw InvalidInput(
          fmt::format("IdentifyPitchOptions: the bounds {:g} to {:g} {} of {} must increase: give lower "
                      "and upper",
                      parameter.lower, parameter.upper, parameter.field->unit, name));
    set_first(parameter, given, warnings);
    parameters.push_back(parameter);
  }
  return parameters;
}

HeavePitchModel with_values(const HeavePitchModel& model, std::span<const PitchParameter> parameters,
                            std::span<const double> values) {
  HeavePitchModel with = model;
  for (std::size_t i = 0; i < parameters.size(); ++i) with.*parameters[i].member = values[i];
  return with;
}

}  // namespace crashsim
