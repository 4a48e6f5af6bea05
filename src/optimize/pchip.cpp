#include "optimize/pchip.hpp"

#include <cmath>

namespace crashsim {
namespace {

using Eigen::Index;
using Row = Eigen::RowVectorXd;

/// A number with its derivatives by the ordinates.
struct Dual {
  double value;
  Row by;
};

/// Slope of the chord from knot i to the next.
Dual chord(std::span<const double> knots, std::span<const double> y, std::size_t i) {
  const double width = knots[i + 1] - knots[i];
  Dual out{(y[i + 1] - y[i]) / width, Row::Zero(static_cast<Index>(y.size()))};
  out.by[static_cast<Index>(i)] = -1.0 / width;
  out.by[static_cast<Index>(i) + 1] = 1.0 / width;
  return out;
}

/// Slope at a knot between two chords: their weighted harmonic mean, 0 at an extremum.
Dual inner_slope(double before, double after, const Dual& left, const Dual& right) {
  if (!(left.value * right.value > 0.0)) return {0.0, Row::Zero(left.by.size())};
  const double w_left = 2.0 * after + before, w_right = after + 2.0 * before;
  const double slope = (w_left + w_right) / (w_left / left.value + w_right / right.value);
  const double factor = slope * slope / (w_left + w_right);
  return {slope,
          factor * (w_left / (left.value * left.value) * left.by + w_right / (right.value * right.value) * right.by)};
}

/// Slope at an end: that of the parabola through three points, kept from overshooting.
Dual end_slope(double width, double next_width, const Dual& near, const Dual& next) {
  const double a = (2.0 * width + next_width) / (width + next_width), b = -width / (width + next_width);
  const double slope = a * near.value + b * next.value;
  if (!(slope * near.value > 0.0)) return {0.0, Row::Zero(near.by.size())};
  if (near.value * next.value < 0.0 && std::fabs(slope) > 3.0 * std::fabs(near.value))
    return {3.0 * near.value, 3.0 * near.by};
  return {slope, a * near.by + b * next.by};
}

std::vector<Dual> slopes_of(std::span<const double> knots, std::span<const double> y) {
  const std::size_t n = knots.size();
  const auto width = [&](std::size_t i) { return knots[i + 1] - knots[i]; };
  if (n == 2) return {chord(knots, y, 0), chord(knots, y, 0)};
  std::vector<Dual> slopes = {end_slope(width(0), width(1), chord(knots, y, 0), chord(knots, y, 1))};
  for (std::size_t i = 1; i + 1 < n; ++i)
    slopes.push_back(inner_slope(width(i - 1), width(i), chord(knots, y, i - 1), chord(knots, y, i)));
  slopes.push_back(end_slope(width(n - 2), width(n - 3), chord(knots, y, n - 2), chord(knots, y, n - 3)));
  return slopes;
}

}  // namespace

std::vector<double> pchip_knots(std::span<const double> knots) {
  std::vector<double> fine;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i)
    for (std::size_t j = 0; j < kPchipPieces; ++j)
      fine.push_back(std::lerp(knots[i], knots[i + 1], static_cast<double>(j) / kPchipPieces));
  if (!knots.empty()) fine.push_back(knots.back());
  return fine;
}

PchipTable pchip_table(std::span<const double> knots, std::span<const double> ordinates) {
  const auto n = static_cast<Index>(knots.size());
  if (n < 2) return {Eigen::Map<const Eigen::VectorXd>(ordinates.data(), n), Eigen::MatrixXd::Identity(n, n)};
  const Index rows = (n - 1) * static_cast<Index>(kPchipPieces) + 1;
  PchipTable table{Eigen::VectorXd(rows), Eigen::MatrixXd::Zero(rows, n)};
  const std::vector<Dual> slopes = slopes_of(knots, ordinates);
  for (Index row = 0; row < rows; ++row) {
    const Index i = std::min(row / static_cast<Index>(kPchipPieces), n - 2);
    const auto at = static_cast<std::size_t>(i);
    const double t = static_cast<double>(row - i * static_cast<Index>(kPchipPieces)) / kPchipPieces;
    const double width = knots[at + 1] - knots[at];
    // Hermite's basis.
    const double h00 = (1.0 + 2.0 * t) * (1.0 - t) * (1.0 - t), h01 = t * t * (3.0 - 2.0 * t);
    const double h10 = width * t * (1.0 - t) * (1.0 - t), h11 = width * t * t * (t - 1.0);
    table.ordinates[row] =
        h00 * ordinates[at] + h01 * ordinates[at + 1] + h10 * slopes[at].value + h11 * slopes[at + 1].value;
    table.by_ordinates.row(row) = h10 * slopes[at].by + h11 * slopes[at + 1].by;
    table.by_ordinates(row, i) += h00;
    table.by_ordinates(row, i + 1) += h01;
  }
  return table;
}

PiecewiseLinear tabulate_pchip(std::span<const double> knots, std::span<const double> ordinates) {
  const PchipTable table = pchip_table(knots, ordinates);
  return {pchip_knots(knots), {table.ordinates.begin(), table.ordinates.end()}};
}

}  // namespace crashsim
