#include <crashsim/rating.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Core>

#include <crashsim/signal.hpp>

#include "dtw.hpp"

namespace crashsim {
namespace {

constexpr double kStandardStep = 1e-4;  // 10 kHz
constexpr double kLongest = 2.0;        // s
constexpr std::size_t kFewestSamples = 10;

/// Two curves of equal length.
struct Curves {
  std::span<const double> reference, candidate;

  [[nodiscard]] std::size_t size() const { return reference.size(); }
};

auto array_of(std::span<const double> values) {
  return Eigen::Map<const Eigen::ArrayXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

double largest(std::span<const double> values) { return array_of(values).abs().maxCoeff(); }

/// 1 for no error, 0 from the limit on.
double linear_score(double error, double limit) { return error < limit ? (limit - error) / limit : 0.0; }

/// Difference over norm; infinite when only the norm is zero.
double relative(double difference, double norm) {
  if (norm > 0.0) return difference / norm;
  return difference > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
}

double corridor_score(const Curves& curves) {
  const double norm = largest(curves.reference);
  const double inner = 0.05 * norm;
  const double outer = 0.5 * norm;
  double sum = 0.0;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const double difference = std::abs(curves.reference[i] - curves.candidate[i]);
    const double depth = std::clamp((outer - difference) / (outer - inner), 0.0, 1.0);
    sum += depth * depth;
  }
  return sum / static_cast<double>(curves.size());
}

/// Pearson's correlation; NaN where a curve is constant but for rounding.
double correlation(const Curves& curves) {
  constexpr double kRounding = 1e-11;
  const auto reference = array_of(curves.reference);
  const auto candidate = array_of(curves.candidate);
  const double reference_mean = reference.mean();
  const double candidate_mean = candidate.mean();
  const double reference_square = (reference - reference_mean).square().sum();
  const double candidate_square = (candidate - candidate_mean).square().sum();
  const auto is_constant = [n = static_cast<double>(curves.size())](double square, double mean) {
    return std::sqrt(square / n) <= kRounding * std::abs(mean);
  };
  if (is_constant(reference_square, reference_mean) || is_constant(candidate_square, candidate_mean)) return kUnset;
  const double product = ((reference - reference_mean) * (candidate - candidate_mean)).sum();
  return product / std::sqrt(reference_square) / std::sqrt(candidate_square);
}

/// The overlap that correlates best, and by how many samples the candidate was moved.
struct Shift {
  Curves overlap;
  std::size_t samples = 0;
};

Shift best_shift(const Curves& curves) {
  constexpr double kTie = 1e-12;  // correlations closer than this are equal but for rounding
  Shift best{curves, 0};
  double best_correlation = correlation(curves);
  const auto consider = [&](const Curves& overlap, std::size_t samples) {
    const double candidate = correlation(overlap);
    if (!(candidate > best_correlation + kTie)) return;
    best_correlation = candidate;
    best = {overlap, samples};
  };
  const std::size_t n = curves.size();
  for (std::size_t shift = 1; shift <= n / 5; ++shift) {
    const std::size_t length = n - shift;
    consider({curves.reference.first(length), curves.candidate.last(length)}, shift);  // to the left
    consider({curves.reference.last(length), curves.candidate.first(length)}, shift);
  }
  return best;
}

double phase_score(std::size_t shift, std::size_t n) {
  return linear_score(static_cast<double>(shift), 0.2 * static_cast<double>(n));
}

double magnitude_score(const Curves& overlap) {
  const std::size_t half_width = (overlap.size() + 9) / 10 - 1;
  double difference = 0.0, norm = 0.0;
  for (const auto [i, j] : warp(overlap.candidate, overlap.reference, half_width)) {
    difference += std::abs(overlap.candidate[i] - overlap.reference[j]);
    norm += std::abs(overlap.reference[j]);
  }
  return linear_score(relative(difference, norm), 0.5);
}

/// Central differences per sample, one-sided at the ends.
std::vector<double> slope(std::span<const double> values) {
  const std::size_t last = values.size() - 1;
  std::vector<double> result(values.size());
  for (std::size_t i = 1; i < last; ++i) result[i] = (values[i + 1] - values[i - 1]) / 2.0;
  result.front() = values[1] - values[0];
  result.back() = values[last] - values[last - 1];
  return result;
}

/// Mean over 9 samples, over 7, 5, 3, 1 towards the ends.
std::vector<double> smooth(std::span<const double> values) {
  std::vector<double> result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t reach = std::min({std::size_t{4}, i, values.size() - 1 - i});
    result[i] = array_of(values.subspan(i - reach, 2 * reach + 1)).mean();
  }
  return result;
}

double slope_score(const Curves& overlap) {
  const std::vector<double> reference = smooth(slope(overlap.reference));
  const std::vector<double> candidate = smooth(slope(overlap.candidate));
  const double difference = (array_of(candidate) - array_of(reference)).abs().sum();
  return linear_score(relative(difference, array_of(reference).abs().sum()), 2.0);
}

Rating rate_at_standard_step(const Curves& curves) {
  if (largest(curves.reference) == 0.0)
    throw InvalidInput("rating: the reference is zero throughout: nothing can be rated against it");
  const Shift shift = best_shift(curves);
  Rating rating;
  rating.corridor = corridor_score(curves);
  rating.phase = phase_score(shift.samples, curves.size());
  rating.magnitude = magnitude_score(shift.overlap);
  rating.slope = slope_score(shift.overlap);
  rating.overall = 0.4 * rating.corridor + 0.2 * (rating.phase + rating.magnitude + rating.slope);
  return rating;
}

/// Uniform samples brought to the standard step by linear interpolation.
std::vector<double> to_standard_step(std::span<const double> values, double dt_s) {
  constexpr double kRounding = 1e-9;
  const double steps = static_cast<double>(values.size() - 1) * dt_s / kStandardStep;
  const auto count = static_cast<std::size_t>(steps * (1.0 + kRounding)) + 1;
  return resample(uniform_times(0.0, dt_s, values.size()), values, uniform_times(0.0, kStandardStep, count));
}

void check_pair(const Curves& curves, std::size_t fewest) {
  if (curves.reference.size() != curves.candidate.size())
    throw InvalidInput(fmt::format("reference has {} samples but candidate has {}: the numbers must be equal",
                                   curves.reference.size(), curves.candidate.size()));
  if (curves.size() < fewest)
    throw InvalidInput(fmt::format("{} samples to compare: at least {} are needed", curves.size(), fewest));
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (!std::isfinite(curves.reference[i]))
      throw InvalidInput(fmt::format("reference[{}] = {}: must be finite", i, curves.reference[i]));
    if (!std::isfinite(curves.candidate[i]))
      throw InvalidInput(fmt::format("candidate[{}] = {}: must be finite", i, curves.candidate[i]));
  }
}

void check_rateable(const Curves& curves, double dt_s) {
  check_pair(curves, kFewestSamples);
  if (!(dt_s > 0.0) || !std::isfinite(dt_s)) throw InvalidInput(fmt::format("dt_s = {} s: must be > 0", dt_s));
  const double duration = dt_s * static_cast<double>(curves.size() - 1);
  if (duration > kLongest)
    throw InvalidInput(
        fmt::format("rating: {} s of signal: at most {} s can be rated; cut it to the impact", duration, kLongest));
  if (duration * (1.0 + 1e-9) < kStandardStep * (kFewestSamples - 1))
    throw InvalidInput(
        fmt::format("rating: {} s of signal: at least {} samples at 10 kHz are needed", duration, kFewestSamples));
}

}  // namespace

Rating rate(std::span<const double> reference, std::span<const double> candidate, double dt_s) {
  check_rateable({reference, candidate}, dt_s);
  if (std::abs(dt_s - kStandardStep) <= 1e-6 * kStandardStep) return rate_at_standard_step({reference, candidate});
  const std::vector<double> resampled_reference = to_standard_step(reference, dt_s);
  const std::vector<double> resampled_candidate = to_standard_step(candidate, dt_s);
  return rate_at_standard_step({resampled_reference, resampled_candidate});
}

std::string_view grade(double overall) {
  if (std::isnan(overall)) return "unrated";
  if (overall > 0.94) return "excellent";
  if (overall > 0.80) return "good";
  return overall > 0.58 ? "fair" : "poor";
}

ErrorSummary errors(std::span<const double> reference, std::span<const double> candidate) {
  const Curves curves{reference, candidate};
  check_pair(curves, 1);
  const Eigen::ArrayXd error = (array_of(candidate) - array_of(reference)).abs();
  ErrorSummary summary{.mean_abs = error.mean(), .rms = std::sqrt(error.square().mean()), .max_abs = error.maxCoeff()};
  const double scale = largest(reference);
  if (scale > 0.0) summary.mean_abs_relative = summary.mean_abs / scale;
  return summary;
}

}  // namespace crashsim
