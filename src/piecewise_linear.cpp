#include <crashsim/piecewise_linear.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <crashsim/error.hpp>

namespace crashsim {

std::size_t segment_of(const PiecewiseLinear& curve, double s) {
  const auto& x = curve.knots;
  if (x.size() < 2) return 0;
  const auto above = std::upper_bound(x.begin(), x.end(), s) - x.begin();
  const auto last_segment = static_cast<std::ptrdiff_t>(x.size()) - 2;
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - 1, 0, last_segment));
}

double evaluate(const PiecewiseLinear& curve, double s) {
  const auto& x = curve.knots;
  const auto& y = curve.ordinates;
  if (s >= x.back()) return y.back();
  if (s <= x.front()) return y.front();
  const std::size_t i = segment_of(curve, s);
  return y[i] + (y[i + 1] - y[i]) * (s - x[i]) / (x[i + 1] - x[i]);
}

void validate(const PiecewiseLinear& curve, std::string_view what) {
  const auto& x = curve.knots;
  const auto& y = curve.ordinates;
  if (x.empty()) throw InvalidInput(fmt::format("{}: has no knots: at least one is needed", what));
  if (x.size() != y.size())
    throw InvalidInput(
        fmt::format("{}: {} knots but {} ordinates: the numbers must be equal", what, x.size(), y.size()));
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i])) throw InvalidInput(fmt::format("{}.knots[{}] = {}: must be finite", what, i, x[i]));
    if (!std::isfinite(y[i])) throw InvalidInput(fmt::format("{}.ordinates[{}] = {}: must be finite", what, i, y[i]));
    if (y[i] < 0.0) throw InvalidInput(fmt::format("{}.ordinates[{}] = {}: must be >= 0", what, i, y[i]));
    if (i > 0 && x[i] <= x[i - 1])
      throw InvalidInput(
          fmt::format("{}.knots[{}] = {}: must be greater than the knot before it, {}", what, i, x[i], x[i - 1]));
  }
  if (x.front() != 0.0) throw InvalidInput(fmt::format("{}.knots[0] = {}: the first knot must be 0", what, x.front()));
}

std::vector<double> uniform_knots(double last, int count) {
  std::vector<double> knots(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < knots.size(); ++i)
    knots[i] = count > 1 ? last * static_cast<double>(i) / (count - 1) : 0.0;
  return knots;
}

}  // namespace crashsim
