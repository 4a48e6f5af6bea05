#include "optimize/sought_numbers.hpp"

#include "random.hpp"

namespace crashsim {
namespace {

void check_length(const GivenBounds& given, std::string_view name, const std::vector<double>& bounds) {
  if (!bounds.empty() && bounds.size() != given.free.size())
    throw InvalidInput(fmt::format("{}.{} has {} numbers but there are {} in free: give one for each", given.options,
                                   name, bounds.size(), given.free.size()));
}

/// Takes entry `i` of a list of bounds unless it is unset.
void take_bound(const std::vector<double>& bounds, std::string_view list, std::size_t i, const Range& allowed,
                const SoughtRange& of, double& bound) {
  if (bounds.empty() || std::isnan(bounds[i])) return;
  bound = bounds[i];
  if (!detail::in_range(bound, allowed))
    detail::throw_out_of_range(fmt::format("{}[{}] ({})", list, i, of.name), bound, of.unit, allowed);
}

}  // namespace

double SoughtRange::value_at(double place) const {
  const double value = is_logarithmic() ? lower * std::pow(upper / lower, place) : lower + (upper - lower) * place;
  return std::clamp(value, lower, upper);
}

double SoughtRange::slope_at(double value) const {
  return is_logarithmic() ? value * std::log(upper / lower) : upper - lower;
}

double SoughtRange::place_of(double value) const {
  const double place =
      is_logarithmic() ? std::log(value / lower) / std::log(upper / lower) : (value - lower) / (upper - lower);
  return std::clamp(place, 0.0, 1.0);
}

void check_lengths(const GivenBounds& given) {
  if (given.free.empty())
    throw InvalidInput(fmt::format("{}.free names no number: give at least one to identify", given.options));
  check_length(given, "lower", given.lower);
  check_length(given, "upper", given.upper);
}

void take_bounds(const GivenBounds& given, std::size_t i, const Range& allowed, SoughtRange& sought) {
  take_bound(given.lower, fmt::format("{}.lower", given.options), i, allowed, sought, sought.lower);
  take_bound(given.upper, fmt::format("{}.upper", given.options), i, allowed, sought, sought.upper);
  if (!(sought.lower < sought.upper))
    throw InvalidInput(fmt::format("{}: the bounds {:g} to {:g} {} of {} must increase: give lower and upper",
                                   given.options, sought.lower, sought.upper, sought.unit, sought.name));
}

void set_first(double guess, SoughtRange& sought, std::vector<std::string>& warnings) {
  if (std::isnan(guess)) {
    sought.first = sought.value_at(0.5);
    return;
  }
  sought.first = std::clamp(guess, sought.lower, sought.upper);
  if (sought.first != guess)
    warnings.push_back(
        fmt::format("{} = {:.6g} {} of the given model is outside its bounds {:.6g} to {:.6g} {}: the "
                    "first start begins at the nearer one",
                    sought.name, guess, sought.unit, sought.lower, sought.upper, sought.unit));
}

std::vector<double> values_at(std::span<const SoughtRange> ranges, std::span<const double> point) {
  std::vector<double> values(point.size());
  for (std::size_t i = 0; i < point.size(); ++i) values[i] = ranges[i].value_at(point[i]);
  return values;
}

StartPlan plan_of_starts(std::vector<SoughtRange> ranges, ErrorOfValues error, std::uint64_t seed) {
  StartPlan plan;
  plan.initial_point = [ranges, seed](int index) {
    std::vector<double> point(ranges.size());
    for (std::size_t i = 0; i < point.size(); ++i)
      point[i] =
          index == 0 ? ranges[i].place_of(ranges[i].first) : uniform_random(seed, static_cast<std::uint64_t>(index), i);
    return point;
  };
  plan.make_functions = [ranges = std::move(ranges), error = std::move(error)]() -> StartFunctions {
    return {[ranges, error](std::span<const double> point, double smoothing, std::span<double> gradient) {
              const std::vector<double> values = values_at(ranges, point);
              const double e = error(values, smoothing, gradient);
              for (std::size_t i = 0; i < values.size(); ++i) gradient[i] *= ranges[i].slope_at(values[i]);
              return e;
            },
            {}};
  };
  return plan;
}

}  // namespace crashsim
