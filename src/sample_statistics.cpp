#include <crashsim/sample_statistics.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace crashsim {
namespace {

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Whether values vary by more than integration errors do.
bool varies(std::span<const double> values) {
  constexpr double kNoise = 1e-7;
  if (values.empty()) return false;
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  return *largest - *least > kNoise * std::max(std::fabs(*least), std::fabs(*largest));
}

/// Index 1 - a / v or a / v of means a and v over groups, with its standard error by the spread of their influence.
SobolIndex index_of(const std::vector<double>& a, const std::vector<double>& v, bool is_rest) {
  const auto count = static_cast<double>(a.size());
  const double variance = mean_of(v), ratio = mean_of(a) / variance;
  double squares = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) squares += std::pow((a[i] - ratio * v[i]) / variance, 2);
  return {is_rest ? 1.0 - ratio : ratio, std::sqrt(squares / (count * (count - 1.0)))};
}

}  // namespace

double quantile_of(const std::vector<double>& ordered, double p) {
  const double place = p * static_cast<double>(ordered.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, ordered.size() - 1);
  return ordered[below] + (place - static_cast<double>(below)) * (ordered[above] - ordered[below]);
}

SampleStatistics statistics_of(std::span<const double> values) {
  SampleStatistics out;
  std::vector<double> ordered;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    ordered.push_back(values[i]);
    if (ordered.size() == 1 || values[i] < values[out.min_at]) out.min_at = i;
    if (ordered.size() == 1 || values[i] > values[out.max_at]) out.max_at = i;
  }
  out.count = ordered.size();
  if (ordered.empty()) return out;
  out.min = values[out.min_at];
  out.max = values[out.max_at];
  out.mean = mean_of(ordered);
  if (out.count > 1) {
    double squares = 0.0;
    for (const double value : ordered) squares += (value - out.mean) * (value - out.mean);
    out.sd = std::sqrt(squares / static_cast<double>(out.count - 1));
  }
  std::sort(ordered.begin(), ordered.end());
  out.q05 = quantile_of(ordered, 0.05);
  out.q50 = quantile_of(ordered, 0.5);
  out.q95 = quantile_of(ordered, 0.95);
  return out;
}

double correlation(std::span<const double> x, std::span<const double> y) {
  if (!varies(x) || !varies(y)) return kUnset;
  const double x_mean = mean_of(x), y_mean = mean_of(y);
  double xx = 0.0, yy = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = x[i] - x_mean, dy = y[i] - y_mean;
    xx += dx * dx;
    yy += dy * dy;
    xy += dx * dy;
  }
  return std::clamp(xy / std::sqrt(xx * yy), -1.0, 1.0);
}

std::vector<double> ranks_of(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0, end = 0; first < order.size(); first = end) {
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    for (std::size_t i = first; i < end; ++i) ranks[order[i]] = 0.5 * static_cast<double>(first + 1 + end);
  }
  return ranks;
}

double first_order_index(std::span<const double> ranks, std::span<const double> y) {
  const std::size_t count = y.size();
  const auto most = static_cast<std::size_t>(std::lround(std::cbrt(static_cast<double>(count))));
  if (!varies(y)) return kUnset;
  std::vector<double> sums(most, 0.0);
  std::vector<std::size_t> counts(most, 0);
  const double mean = mean_of(y);
  double total = 0.0, between = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto in = static_cast<std::size_t>((ranks[i] - 0.5) / static_cast<double>(count) * static_cast<double>(most));
    sums[in] += y[i] - mean;
    ++counts[in];
    total += (y[i] - mean) * (y[i] - mean);
  }
  std::size_t classes = 0;
  for (std::size_t i = 0; i < most; ++i) {
    if (counts[i] == 0) continue;
    between += sums[i] * sums[i] / static_cast<double>(counts[i]);
    ++classes;
  }
  if (count <= classes) return kUnset;
  return 1.0 - (1.0 - between / total) * static_cast<double>(count - 1) / static_cast<double>(count - classes);
}

std::vector<SobolIndices> sobol_indices(std::span<const double> outputs, int dimensions) {
  const auto inputs = static_cast<std::size_t>(dimensions), size = inputs + 2;
  std::vector<std::span<const double>> groups;
  std::vector<double> both;
  for (std::size_t at = 0; at + size <= outputs.size(); at += size) {
    const auto group = outputs.subspan(at, size);
    if (std::any_of(group.begin(), group.end(), [](double value) { return std::isnan(value); })) continue;
    groups.push_back(group);
    both.insert(both.end(), {group[0], group[1]});
  }
  std::vector<SobolIndices> indices(inputs);
  if (groups.size() < 2 || !varies(both)) return indices;
  const double mean = mean_of(both);
  const auto half_square = [](double difference) { return 0.5 * difference * difference; };
  std::vector<double> variance, from_a, from_b;
  for (const auto group : groups) variance.push_back(half_square(group[0] - mean) + half_square(group[1] - mean));
  for (std::size_t i = 0; i < inputs; ++i) {
    from_a.clear();
    from_b.clear();
    for (const auto group : groups) {
      from_a.push_back(half_square(group[0] - group[i + 2]));
      from_b.push_back(half_square(group[1] - group[i + 2]));
    }
    indices[i] = {index_of(from_b, variance, true), index_of(from_a, variance, false)};
  }
  return indices;
}

}  // namespace crashsim
