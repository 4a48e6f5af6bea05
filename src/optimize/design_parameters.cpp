#include "optimize/design_parameters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <crashsim/option_values.hpp>

#include "number_list.hpp"

namespace crashsim {
namespace {

/// A quantity: the response it is, its limit's option and its unit.
struct Quantity {
  double DesignResponses::*response;
  double sign;
  double DesignOptions::*limit;
  std::string_view unit;
};
/// In the order of DesignQuantity, without `none`.
constexpr std::array<Quantity, 5> kQuantities = {{
    {&DesignResponses::pitch_max_rad, 1.0, &DesignOptions::max_pitch_rad, "rad"},
    {&DesignResponses::heave_min_m, -1.0, &DesignOptions::max_drop_m, "m"},
    {&DesignResponses::max_crush_m, 1.0, &DesignOptions::max_crush_m, "m"},
    {&DesignResponses::olc_g, 1.0, &DesignOptions::max_olc_g, ""},
    {&DesignResponses::peak_decel_g, 1.0, &DesignOptions::max_peak_decel_g, ""},
}};
const Quantity& described(DesignQuantity quantity) { return kQuantities.at(static_cast<std::size_t>(quantity) - 1); }

/// Members of a part of the model that are numbers.
template <class S>
std::optional<DesignParameter> member_named(std::string_view name) {
  for (const Field<S>& field : fields<S>) {
    const auto* member = std::get_if<double S::*>(&field.member);
    if (member != nullptr && is_key_of(name, field))
      return DesignParameter{std::string(field.name), std::string(field.unit), *member, field.range};
  }
  return std::nullopt;
}

/// "k3" or "k3_n_per_m": the third ordinate of the spring.
std::optional<DesignParameter> ordinate_named(std::string_view name, const CrushModel& crush) {
  struct Curve {
    char letter;
    PiecewiseLinear CrushModel::*member;
    std::string_view unit, suffix;
  };
  const bool is_stiffness = crush.law == CrushLaw::stiffness;
  const Curve curves[] = {
      {'k', &CrushModel::spring, is_stiffness ? "N/m" : "N", is_stiffness ? "_n_per_m" : "_n"},
      {'c', &CrushModel::damper, "N s/m", "_ns_per_m"},
  };
  for (const auto& [letter, member, unit, suffix] : curves)
    for (std::size_t i = 0; i < (crush.*member).ordinates.size(); ++i) {
      const std::string shortest = fmt::format("{}{}", letter, i + 1), full = fmt::format("{}{}", shortest, suffix);
      if (name == shortest || name == full)
        return DesignParameter{full, std::string(unit), CurveOrdinate{member, i}, at_least(0.0)};
    }
  return std::nullopt;
}

constexpr std::string_view kRateCoefficient = "rate_coefficient";

/// The coefficient of law `rate`.
std::optional<DesignParameter> rate_named(std::string_view name, const CrushModel& crush) {
  if (crush.law != CrushLaw::rate || name != kRateCoefficient) return std::nullopt;
  return DesignParameter{std::string(name), "", &CrushModel::rate_coefficient, at_least(0.0)};
}

template <class S>
void append_flags(std::vector<std::string>& names) {
  for (const Field<S>& field : fields<S>) {
    if (!std::holds_alternative<double S::*>(field.member)) continue;
    names.emplace_back(field.flag);
    std::ranges::replace(names.back(), '-', '_');
  }
}

[[noreturn]] void refuse_name(std::string_view what, std::string_view name, const CrushModel& crush) {
  std::vector<std::string> names;
  append_flags<HeavePitchModel>(names);
  append_flags<VerticalForceLaw>(names);
  for (std::size_t i = 0; i < crush.spring.ordinates.size(); ++i) names.push_back(fmt::format("k{}", i + 1));
  for (std::size_t i = 0; i < crush.damper.ordinates.size(); ++i) names.push_back(fmt::format("c{}", i + 1));
  if (crush.law == CrushLaw::rate) names.emplace_back(kRateCoefficient);
  detail::throw_unknown_name(what, name, {names.begin(), names.end()});
}

DesignParameter named(std::string_view what, std::string_view name, const CrushModel& crush) {
  if (auto found = member_named<HeavePitchModel>(name)) return *found;
  if (auto found = member_named<VerticalForceLaw>(name)) return *found;
  if (auto found = ordinate_named(name, crush)) return *found;
  if (auto found = rate_named(name, crush)) return *found;
  refuse_name(what, name, crush);
}

void check_length(const std::vector<std::string>& bounds, std::string_view name, std::size_t count) {
  if (bounds.size() != count)
    throw InvalidInput(fmt::format("DesignOptions.{} has {} numbers but there are {} parameters: give one for each",
                                   name, bounds.size(), count));
}

double bound(const std::vector<std::string>& bounds, std::string_view name, std::size_t i, const DesignParameter& of) {
  const std::string what = fmt::format("DesignOptions.{}[{}] ({})", name, i, of.name);
  const double value = detail::to_number(bounds[i], of.unit, what);
  if (!detail::in_range(value, of.allowed)) detail::throw_out_of_range(what, value, of.unit, of.allowed);
  return value;
}

}  // namespace

double quantity_of(const DesignResponses& responses, DesignQuantity quantity) {
  if (quantity == DesignQuantity::none) return kUnset;
  return described(quantity).sign * (responses.*described(quantity).response);
}

double DesignParameter::value_at(double place_between) const {
  return std::clamp(lower + (upper - lower) * place_between, lower, upper);
}

double DesignParameter::place_of(double value) const { return std::clamp((value - lower) / (upper - lower), 0.0, 1.0); }

double value_of(const CoupledModel& model, const DesignParameter& parameter) {
  if (const auto* member = std::get_if<double HeavePitchModel::*>(&parameter.place)) return model.body.**member;
  if (const auto* member = std::get_if<double VerticalForceLaw::*>(&parameter.place)) return model.vertical.**member;
  if (const auto* member = std::get_if<double CrushModel::*>(&parameter.place)) return model.crush.**member;
  const auto& [curve, index] = std::get<CurveOrdinate>(parameter.place);
  return (model.crush.*curve).ordinates[index];
}

void set_value(CoupledModel& model, const DesignParameter& parameter, double value) {
  if (const auto* member = std::get_if<double HeavePitchModel::*>(&parameter.place)) {
    model.body.** member = value;
    if (*member == &HeavePitchModel::mass_kg) model.crush.mass_kg = value;  // it is one vehicle
  } else if (const auto* law = std::get_if<double VerticalForceLaw::*>(&parameter.place)) {
    model.vertical.** law = value;
  } else if (const auto* crush = std::get_if<double CrushModel::*>(&parameter.place)) {
    model.crush.** crush = value;
  } else {
    const auto& [curve, index] = std::get<CurveOrdinate>(parameter.place);
    (model.crush.*curve).ordinates[index] = value;
  }
}

std::vector<DesignParameter> design_parameters(const CoupledModel& model, const DesignOptions& options) {
  const std::size_t count = options.parameters.size();
  if (count == 0) throw InvalidInput("DesignOptions.parameters names nothing: give at least one parameter to change");
  check_length(options.lower, "lower", count);
  check_length(options.upper, "upper", count);
  std::vector<DesignParameter> parameters;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string what = fmt::format("DesignOptions.parameters[{}]", i);
    DesignParameter parameter = named(what, options.parameters[i], model.crush);
    if (std::ranges::find(parameters, parameter.place, &DesignParameter::place) != parameters.end())
      throw InvalidInput(fmt::format("{} = '{}': is named twice", what, options.parameters[i]));
    if (std::isnan(value_of(model, parameter)))
      throw InvalidInput(fmt::format("{} = '{}': the model has no such number to start from: give its {}", what,
                                     options.parameters[i], parameter.name));
    parameter.lower = bound(options.lower, "lower", i, parameter);
    parameter.upper = bound(options.upper, "upper", i, parameter);
    if (!(parameter.lower < parameter.upper))
      throw InvalidInput(fmt::format("DesignOptions.lower[{}] = {:g} {}: must be below upper[{}] = {:g} {} of {}", i,
                                     parameter.lower, parameter.unit, i, parameter.upper, parameter.unit,
                                     parameter.name));
    parameters.push_back(std::move(parameter));
  }
  return parameters;
}

std::string_view unit_of(DesignQuantity quantity) { return described(quantity).unit; }

std::vector<QuantityLimit> limits_of(const DesignOptions& options) {
  std::vector<QuantityLimit> limits;
  for (std::size_t i = 0; i < kQuantities.size(); ++i)
    if (const double limit = options.*kQuantities[i].limit; !std::isnan(limit))
      limits.push_back({static_cast<DesignQuantity>(i + 1), limit});
  return limits;
}

std::vector<double> trade_off_limits(const DesignOptions& options) {
  const std::string_view traded = name_of(options.trade_off);
  if (options.trade_off == DesignQuantity::none) {
    if (options.trade_off_limits.empty()) return {};
    throw InvalidInput("DesignOptions.trade_off_limits are limits of nothing: name it in trade_off");
  }
  if (options.minimise == DesignQuantity::none || options.minimise == options.trade_off)
    throw InvalidInput(
        fmt::format("DesignOptions.trade_off = {}: minimise is {}: the curve needs something else to "
                    "minimise",
                    traded, name_of(options.minimise)));
  std::vector<double> limits =
      listed_numbers(options.trade_off_limits, unit_of(options.trade_off), "DesignOptions.trade_off_limits");
  if (limits.empty())
    throw InvalidInput(fmt::format("DesignOptions.trade_off = {}: give its trade_off_limits", traded));
  for (const double limit : limits)
    if (!detail::in_range(limit, positive()))
      detail::throw_out_of_range("DesignOptions.trade_off_limits", limit, unit_of(options.trade_off), positive());
  std::ranges::sort(limits);
  limits.erase(std::ranges::unique(limits).begin(), limits.end());
  return limits;
}

}  // namespace crashsim
