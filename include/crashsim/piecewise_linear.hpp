#pragma once
/// Piecewise-linear curve through (knot, ordinate) pairs.

#include <cstddef>
#include <string_view>
#include <vector>

namespace crashsim {

/// Curve through (knots[i], ordinates[i]), linear between knots. One knot makes a constant.
struct PiecewiseLinear {
  std::vector<double> knots;      ///< Abscissae: first 0, strictly increasing.
  std::vector<double> ordinates;  ///< Values at the knots, as many as knots.

  bool operator==(const PiecewiseLinear&) const = default;
};

/// Value at `s` >= 0; beyond the last knot the last ordinate is held.
double evaluate(const PiecewiseLinear& curve, double s);

/// Index i of the segment [knots[i], knots[i+1]) that holds `s`; the last segment is open to the right.
/// 0 for a curve of one knot.
std::size_t segment_of(const PiecewiseLinear& curve, double s);

/// @throws InvalidInput when the curve is empty, the lengths differ, a number is not finite, the first knot is not 0,
///         the knots do not increase strictly or an ordinate is negative. `what` names the curve.
void validate(const PiecewiseLinear& curve, std::string_view what);

/// `count` knots evenly spaced on [0, last].
std::vector<double> uniform_knots(double last, int count);

}  // namespace crashsim
