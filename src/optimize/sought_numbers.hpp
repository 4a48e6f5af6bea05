#pragma once
/// Numbers of a model that are sought between bounds, and the starts of the search.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include <crashsim/option_values.hpp>

#include "optimize/starts.hpp"

namespace crashsim {

/// Where one number is sought: evenly on a logarithmic scale when both bounds are positive, else evenly.
struct SoughtRange {
  std::string_view name, unit;
  double lower = kUnset, upper = kUnset;
  double first = kUnset;  ///< Value of start 0.

  [[nodiscard]] bool is_logarithmic() const { return lower > 0.0; }
  /// Value at a place 0..1 between the bounds.
  [[nodiscard]] double value_at(double place) const;
  /// Derivative of value_at() where it has this value.
  [[nodiscard]] double slope_at(double value) const;
  [[nodiscard]] double place_of(double value) const;
};

/// A number of S that is sought.
template <class S>
struct SoughtNumber : SoughtRange {
  double S::*member = nullptr;
};

/// The bounds an identification was given: of its `options`, the lists `free`, `lower` and `upper`.
struct GivenBounds {
  std::string_view options;
  const std::vector<std::string>& free;
  const std::vector<double>&lower, &upper;
};

/// @throws InvalidInput when nothing is free or a list of bounds has another length.
void check_lengths(const GivenBounds& given);
/// Takes entry `i` of the bounds given, where they are. @throws InvalidInput when one is not allowed or they do not
/// increase.
void take_bounds(const GivenBounds& given, std::size_t i, const Range& allowed, SoughtRange& sought);
/// Start 0: the given number, or the middle of the range. Notes in `warnings` when it lies outside.
void set_first(double guess, SoughtRange& sought, std::vector<std::string>& warnings);

/// Reads the numbers that are free, with their bounds. `set_default_bounds(number, guess)` fills those not given.
template <class S, class SetDefaultBounds>
std::vector<SoughtNumber<S>> read_sought(const S& guess, const GivenBounds& given, SetDefaultBounds set_default_bounds,
                                         std::vector<std::string>& warnings) {
  check_lengths(given);
  const std::string what = fmt::format("{}.free", given.options);
  std::vector<SoughtNumber<S>> numbers;
  for (std::size_t i = 0; i < given.free.size(); ++i) {
    const Field<S>& field = find_field<S>(given.free[i], what);
    const auto* member = std::get_if<double S::*>(&field.member);
    if (member == nullptr) throw InvalidInput(fmt::format("{}: {} is not a number to identify", what, field.name));
    if (std::ranges::find(numbers, *member, &SoughtNumber<S>::member) != numbers.end())
      throw InvalidInput(fmt::format("{} names {} twice", what, field.name));
    SoughtNumber<S> number{{field.name, field.unit}, *member};
    set_default_bounds(number, guess.**member);
    take_bounds(given, i, field.range, number);
    set_first(guess.**member, number, warnings);
    numbers.push_back(number);
  }
  return numbers;
}

/// `model` with these numbers.
template <class S>
S with_values(const S& model, std::span<const SoughtNumber<S>> numbers, std::span<const double> values) {
  S with = model;
  for (std::size_t i = 0; i < numbers.size(); ++i) with.*numbers[i].member = values[i];
  return with;
}

template <class S>
std::vector<SoughtRange> ranges_of(const std::vector<SoughtNumber<S>>& numbers) {
  std::vector<SoughtRange> ranges;
  for (const SoughtNumber<S>& number : numbers) ranges.push_back(number);
  return ranges;
}

/// Values at a point of the unit box.
std::vector<double> values_at(std::span<const SoughtRange> ranges, std::span<const double> point);

/// E at values of the numbers, with its gradient; serves all threads at once.
using ErrorOfValues =
    std::function<double(std::span<const double> values, double smoothing, std::span<double> gradient)>;

/// Starts over these ranges: the first at their first values, the others drawn by the seed.
StartPlan plan_of_starts(std::vector<SoughtRange> ranges, ErrorOfValues error, std::uint64_t seed);

/// The same with the starts, seed, loss, algorithm and jobs of an identification's options.
template <class Options>
StartPlan plan_of_starts(std::vector<SoughtRange> ranges, ErrorOfValues error, const Options& options) {
  StartPlan plan = plan_of_starts(std::move(ranges), std::move(error), options.seed);
  plan.starts = options.starts;
  plan.jobs = options.jobs;
  plan.loss = options.loss;
  plan.algorithm = options.algorithm;
  return plan;
}

}  // namespace crashsim
