#include <crashsim/distribution.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace crashsim {
namespace {

double normal_probability(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

double normal_density(double x) { return std::exp(-0.5 * x * x) * std::numbers::inv_sqrtpi / std::numbers::sqrt2; }

/// Quantile of the standard normal distribution between two ends.
double quantile_between(double lower, double upper, double p) {
  if (lower > 0.0) return -quantile_between(-upper, -lower, 1.0 - p);  // the lower tail has the digits
  const double below = normal_probability(lower), inside = normal_probability(upper) - below;
  return std::clamp(normal_quantile(below + p * inside), lower, upper);
}

/// Mean and standard deviation of the normal distribution, for lognormal that of the logarithm.
struct Normal {
  double mean, deviation;
  [[nodiscard]] double standard(double x) const { return (x - mean) / deviation; }
};
Normal normal_of(const Distribution& distribution) {
  const double mean = distribution.numbers[0], deviation = distribution.numbers[1];
  if (distribution.kind == DistributionKind::normal) return {mean, deviation};
  const double variance = std::log1p(deviation * deviation / (mean * mean));
  return {std::log(mean) - 0.5 * variance, std::sqrt(variance)};
}

/// Ends of the standard normal distribution; infinite where nothing is cut off.
std::pair<double, double> ends_of(const Distribution& distribution) {
  const bool is_log = distribution.kind == DistributionKind::lognormal;
  const Normal normal = normal_of(distribution);
  const auto end = [&](double bound, double none) {
    if (std::isnan(bound) || (is_log && bound <= 0.0 && none < 0.0)) return none;
    return normal.standard(is_log ? std::log(bound) : bound);
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {end(distribution.lower, -kInfinity), end(distribution.upper, kInfinity)};
}

double normal_number(const Distribution& distribution, double p) {
  const Normal normal = normal_of(distribution);
  const auto [lower, upper] = ends_of(distribution);
  const double x = normal.mean + normal.deviation * quantile_between(lower, upper, p);
  const double number = distribution.kind == DistributionKind::lognormal ? std::exp(x) : x;
  return std::fmin(std::fmax(number, distribution.lower), distribution.upper);
}

double triangular_number(double least, double likely, double largest, double p) {
  const double width = largest - least, rise = likely - least;
  if (p * width < rise) return least + std::sqrt(p * width * rise);
  return largest - std::sqrt((1.0 - p) * width * (largest - likely));
}

double tabulated_number(const Distribution& distribution, double p) {
  const std::vector<double>& weights = distribution.weights;
  const auto count = static_cast<double>(distribution.numbers.size());
  if (weights.empty()) return distribution.numbers[static_cast<std::size_t>(std::min(p * count, count - 1.0))];
  const double wanted = p * std::accumulate(weights.begin(), weights.end(), 0.0);
  double so_far = 0.0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] <= 0.0) continue;
    last = i;
    if (so_far += weights[i]; wanted < so_far) break;
  }
  return distribution.numbers[last];
}

[[noreturn]] void refuse(const Distribution& distribution, std::string_view what, std::string_view rule) {
  throw InvalidInput(
      fmt::format("{}: {} [{}]: {}", what, name_of(distribution.kind), fmt::join(distribution.numbers, ", "), rule));
}

void check_count(const Distribution& distribution, std::string_view what) {
  constexpr std::string_view kNeeded[] = {"a mean and a standard deviation", "a mean and a standard deviation",
                                          "the least and the largest number",
                                          "the least, the most likely and the largest number", "at least one number"};
  constexpr std::size_t kCounts[] = {2, 2, 2, 3, 1};
  const auto kind = static_cast<std::size_t>(distribution.kind);
  const std::size_t count = distribution.numbers.size();
  const bool is_right = distribution.kind == DistributionKind::table ? count > 0 : count == kCounts[kind];
  if (!is_right) refuse(distribution, what, fmt::format("needs {}", kNeeded[kind]));
  for (const double number : distribution.numbers)
    if (!std::isfinite(number)) refuse(distribution, what, "numbers must be finite");
}

void check_ends(const Distribution& distribution, std::string_view what) {
  const double lower = distribution.lower, upper = distribution.upper;
  if (std::isnan(lower) && std::isnan(upper)) return;
  const bool can_be_cut =
      distribution.kind == DistributionKind::normal || distribution.kind == DistributionKind::lognormal;
  if (!can_be_cut) refuse(distribution, what, "lower and upper go with normal and lognormal");
  if (!(lower < upper) && !std::isnan(lower) && !std::isnan(upper))
    refuse(distribution, what, fmt::format("lower = {:g} must be below upper = {:g}", lower, upper));
  if (distribution.kind == DistributionKind::lognormal && upper <= 0.0)
    refuse(distribution, what, fmt::format("upper = {:g} must be > 0", upper));
  auto [from, to] = ends_of(distribution);
  if (from > 0.0) from = -std::exchange(to, -from);
  if (!(normal_probability(to) - normal_probability(from) > 0.0))
    refuse(distribution, what, "has no probability between lower and upper");
}

void check_weights(const Distribution& distribution, std::string_view what) {
  const std::vector<double>& weights = distribution.weights;
  if (weights.empty()) return;
  if (distribution.kind != DistributionKind::table) refuse(distribution, what, "weights go with table");
  if (weights.size() != distribution.numbers.size())
    refuse(distribution, what,
           fmt::format("has {} weights for {} numbers", weights.size(), distribution.numbers.size()));
  const bool are_weights = std::all_of(weights.begin(), weights.end(), [](double w) { return w >= 0.0; });
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (!are_weights || !(sum > 0.0) || !std::isfinite(sum))
    refuse(distribution, what, "weights must be >= 0, one of them > 0");
}

}  // namespace

void validate(const Distribution& distribution, std::string_view what) {
  check_count(distribution, what);
  check_weights(distribution, what);
  const std::vector<double>& n = distribution.numbers;
  const bool is_log = distribution.kind == DistributionKind::lognormal;
  if (is_log && !(n[0] > 0.0)) refuse(distribution, what, "the mean must be > 0");
  if ((is_log || distribution.kind == DistributionKind::normal) && !(n[1] > 0.0))
    refuse(distribution, what, "the standard deviation must be > 0");
  if (distribution.kind == DistributionKind::uniform && !(n[0] < n[1]))
    refuse(distribution, what, "the least number must be below the largest");
  if (distribution.kind == DistributionKind::triangular && !(n[0] <= n[1] && n[1] <= n[2] && n[0] < n[2]))
    refuse(distribution, what, "the most likely number must be between the least and a larger largest one");
  check_ends(distribution, what);
}

double quantile(const Distribution& distribution, double p) {
  const std::vector<double>& n = distribution.numbers;
  switch (distribution.kind) {
    case DistributionKind::normal:
    case DistributionKind::lognormal:
      return normal_number(distribution, p);
    case DistributionKind::uniform:
      return n[0] + (n[1] - n[0]) * p;
    case DistributionKind::triangular:
      return triangular_number(n[0], n[1], n[2], p);
    case DistributionKind::table:
      return tabulated_number(distribution, p);
  }
  return kUnset;
}

/// From an approximation of Abramowitz and Stegun, 26.2.23 (within 4.5e-4), by two steps of Halley's method.
double normal_quantile(double p) {
  if (p > 0.5) return -normal_quantile(1.0 - p);
  const double t = std::sqrt(-2.0 * std::log(p));
  double x = (2.515517 + t * (0.802853 + t * 0.010328)) / (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308))) - t;
  constexpr int kSteps = 2;  // each cubes the error
  for (int step = 0; step < kSteps; ++step) {
    const double newton = (normal_probability(x) - p) / normal_density(x);
    x -= newton / (1.0 + 0.5 * x * newton);
  }
  return x;
}

}  // namespace crashsim
