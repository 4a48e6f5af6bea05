#include "optimize/vertical_objective.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <crashsim/signal.hpp>

#include "optimize/fit_target.hpp"

namespace crashsim {
namespace {

using L = VerticalForceLaw;

constexpr double kDefaultAngle = 1.0;     // bound of the angle to both sides [rad]
constexpr double kDefaultChange = 4.0;    // bound of its change over the largest crush [rad]
constexpr double kDefaultFriction = 2.0;  // upper bound

constexpr std::array kNumbers = {&L::angle_rad, &L::angle_rate_rad_per_m, &L::angle_start_m, &L::friction};

/// F_v / F_x with its derivatives by kNumbers.
struct Ratio {
  double value = std::numeric_limits<double>::infinity();
  std::array<double, kNumbers.size()> slopes = {};
};

Ratio ratio_of(const L& law, double crush_m) {
  const double past = std::max(0.0, crush_m - law.angle_start_m);
  const double angle = law.angle_rad + law.angle_rate_rad_per_m * past;
  if (std::abs(angle) >= std::atan(law.friction))  // never when there is no friction
    return {std::copysign(law.friction, angle), {0.0, 0.0, 0.0, std::copysign(1.0, angle)}};
  if (std::abs(angle) > kSteepestAngle) return {};
  const double tangent = std::tan(angle), by_angle = 1.0 + tangent * tangent;
  return {tangent, {by_angle, by_angle * past, past > 0.0 ? -by_angle * law.angle_rate_rad_per_m : 0.0, 0.0}};
}

/// Where in kNumbers each parameter is.
std::vector<std::size_t> places_of(std::span<const VerticalParameter> parameters) {
  std::vector<std::size_t> places;
  for (const VerticalParameter& parameter : parameters)
    places.push_back(static_cast<std::size_t>(std::ranges::find(kNumbers, parameter.member) - kNumbers.begin()));
  return places;
}

void set_default_bounds(VerticalParameter& parameter, double largest_crush_m) {
  const bool has_sign = parameter.member == &L::angle_rad || parameter.member == &L::angle_rate_rad_per_m;
  parameter.upper = parameter.member == &L::angle_rad              ? kDefaultAngle
                    : parameter.member == &L::angle_rate_rad_per_m ? kDefaultChange / largest_crush_m
                    : parameter.member == &L::angle_start_m        ? largest_crush_m
                                                                   : kDefaultFriction;
  parameter.lower = has_sign ? -parameter.upper : 0.0;
}

struct Window {
  double from_s, to_s;
};

Window common_window(const VerticalForceTarget& target, const IdentifyVerticalOptions& options) {
  if (options.from_s >= options.to_s)
    throw InvalidInput(fmt::format("IdentifyVerticalOptions.from_s = {:g} s: must be before to_s = {:g} s",
                                   options.from_s, options.to_s));
  const double lowest = -std::numeric_limits<double>::infinity();
  Window window{std::isnan(options.from_s) ? lowest : options.from_s,
                std::isnan(options.to_s) ? -lowest : options.to_s};
  const auto narrow = [&window](const TimeSeries& series, std::string_view name) {
    check_series(series.time_s, series.values, fmt::format("VerticalForceTarget.{}", name), 2);
    window.from_s = std::max(window.from_s, series.time_s.front());
    window.to_s = std::min(window.to_s, series.time_s.back());
  };
  narrow(target.vertical_force_n, "vertical_force_n");
  narrow(target.longitudinal_force_n, "longitudinal_force_n");
  narrow(target.crush_m, "crush_m");
  return window;
}

void check_largest(double largest, std::string_view name, std::string_view remedy) {
  if (largest > 0.0) return;
  throw InvalidInput(fmt::format("VerticalForceTarget.{} is nowhere {} where it is compared: {}", name,
                                 name == "vertical_force_n" ? "other than 0" : "> 0", remedy));
}

}  // namespace

VerticalFitTarget make_vertical_target(const VerticalForceTarget& target, const IdentifyVerticalOptions& options) {
  const Window window = common_window(target, options);
  const TimeSeries& vertical = target.vertical_force_n;
  VerticalFitTarget fit;
  std::vector<double> times;
  for (std::size_t i = 0; i < vertical.time_s.size(); ++i) {
    if (vertical.time_s[i] < window.from_s || vertical.time_s[i] > window.to_s) continue;
    times.push_back(vertical.time_s[i]);
    fit.samples.push_back({vertical.values[i], kUnset, kUnset});
  }
  if (times.empty())
    throw InvalidInput(fmt::format(
        "VerticalForceTarget: no sample of vertical_force_n from {:g} s to {:g} s, where all three are known and "
        "compared: check clocks and window",
        window.from_s, window.to_s));
  const auto along = resample(target.longitudinal_force_n.time_s, target.longitudinal_force_n.values, times);
  const auto crush = resample(target.crush_m.time_s, target.crush_m.values, times);
  double largest = 0.0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    fit.samples[i].longitudinal_n = along[i];
    fit.samples[i].crush_m = crush[i];
    largest = std::max(largest, std::abs(fit.samples[i].vertical_n));
  }
  check_largest(largest, "vertical_force_n", "there is no law to identify");
  check_largest(std::ranges::max(along), "longitudinal_force_n", "it is positive while it stops the vehicle");
  fit.largest_crush_m = std::ranges::max(crush);
  check_largest(fit.largest_crush_m, "crush_m", "it is positive while the front shortens");
  fit.scale = 1.0 / largest;
  fit.factor = 1.0 / static_cast<double>(times.size());
  return fit;
}

std::vector<VerticalParameter> vertical_parameters(const VerticalForceLaw& guess, double largest_crush_m,
                                                   const IdentifyVerticalOptions& options,
                                                   std::vector<std::string>& warnings) {
  return read_sought(
      guess, {"IdentifyVerticalOptions", options.free, options.lower, options.upper},
      [&](VerticalParameter& parameter, double) { set_default_bounds(parameter, largest_crush_m); }, warnings);
}

double VerticalObjective::evaluate(std::span<const double> values, double smoothing, std::span<double> gradient) const {
  const L law = with_values<L>(law_, parameters_, values);
  const std::vector<std::size_t> places = places_of(parameters_.first(gradient.size()));
  std::ranges::fill(gradient, 0.0);
  double sum = 0.0;
  for (const VerticalSample& sample : target_.samples) {
    const Ratio ratio = ratio_of(law, sample.crush_m);
    const double residual = sample.longitudinal_n * ratio.value - sample.vertical_n;
    const LossValue loss = loss_value(loss_, target_.scale * residual, smoothing);
    sum += loss.value;
    for (std::size_t i = 0; i < places.size(); ++i)
      gradient[i] += target_.factor * loss.derivative * target_.scale * sample.longitudinal_n * ratio.slopes[places[i]];
  }
  return std::isfinite(sum) ? target_.factor * sum : std::numeric_limits<double>::infinity();
}

Eigen::MatrixXd VerticalObjective::jacobian(std::span<const double> values) const {
  const L law = with_values<L>(law_, parameters_, values);
  const std::vector<std::size_t> places = places_of(parameters_);
  const double weight = std::sqrt(target_.factor) * target_.scale;
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(target_.samples.size()), static_cast<Eigen::Index>(values.size()));
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    const VerticalSample& sample = target_.samples[static_cast<std::size_t>(row)];
    const Ratio ratio = ratio_of(law, sample.crush_m);
    for (std::size_t i = 0; i < places.size(); ++i)
      rows(row, static_cast<Eigen::Index>(i)) = weight * sample.longitudinal_n * ratio.slopes[places[i]];
  }
  return rows;
}

}  // namespace crashsim
