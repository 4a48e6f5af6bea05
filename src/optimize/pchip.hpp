#pragma once
/// Monotone cubic curves (PCHIP, [FritschButland1984]) as tables that every law and solver takes.

#include <span>
#include <vector>

#include <Eigen/Core>

#include <crashsim/piecewise_linear.hpp>

namespace crashsim {

inline constexpr std::size_t kPchipPieces =
    8;  ///< Lines that stand for each cubic: within 1/64 of its distance from a line.

/// Knots of the table of a curve through `knots`.
std::vector<double> pchip_knots(std::span<const double> knots);

/// Ordinates of the table of a curve through (knots, ordinates), and their derivatives by the ordinates.
struct PchipTable {
  Eigen::VectorXd ordinates;
  Eigen::MatrixXd by_ordinates;
};
PchipTable pchip_table(std::span<const double> knots, std::span<const double> ordinates);

PiecewiseLinear tabulate_pchip(std::span<const double> knots, std::span<const double> ordinates);

}  // namespace crashsim
