#include "optimize/equation_error.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "optimize/bounded_least_squares.hpp"

namespace crashsim {
namespace {

using Eigen::Index;

void add_row(const ForceAxis& axis, double s, Index offset, double weight, Eigen::MatrixXd::RowXpr row) {
  for (const OrdinateBasis& basis : axis.segments[static_cast<std::size_t>(axis.locate(s, +1))])
    if (basis.ordinate >= 0) row[offset + basis.ordinate] += weight * value(basis.c, s);
}

Index add_roughness(Index first, Index count, double weight, Index row, Eigen::MatrixXd& a) {
  for (Index i = first; i + 2 < first + count; ++i, ++row) {
    a(row, i) = a(row, i + 2) = weight;
    a(row, i + 1) = -2.0 * weight;
  }
  return row;
}

}  // namespace

Eigen::VectorXd solve_equation_error(const FitStructure& structure, std::span<const FitTarget> targets,
                                     const Eigen::VectorXd& upper, double smooth) {
  const auto springs = static_cast<Index>(structure.spring_knots.size());
  const auto dampers = static_cast<Index>(structure.damper_knots.size());
  Index samples = 0;
  for (const FitTarget& target : targets) samples += static_cast<Index>(target.time_s.size());
  if (samples < springs + dampers)
    throw InvalidInput(
        fmt::format("{} samples up to t_m cannot determine {} ordinates: use fewer knots", samples, springs + dampers));
  const CrushForce force =
      make_force({structure.law, Extrapolation::constant, structure.spring_knots, structure.damper_knots});
  const ForceAxis &spring = force.spring, &damper = force.damper;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(samples + springs + dampers, springs + dampers);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(a.rows());
  Index row = 0;
  for (const FitTarget& target : targets) {
    // Acceleration without weight in E still has to say what the force is.
    const double scale =
        target.accel_scale > 0.0 ? target.accel_scale : target.velocity_scale + target.displacement_scale;
    const double weight = scale * std::sqrt(target.factor) / target.mass_kg;
    for (std::size_t i = 0; i < target.time_s.size(); ++i, ++row) {
      // v > 0 up to t_m: a negative x is rounding, and must not turn a force that does not vanish at 0.
      add_row(spring, std::max(target.displacement_m[i], 0.0), 0, weight, a.row(row));
      add_row(damper, target.velocity_mps[i], springs, weight, a.row(row));
      b[row] = -weight * target.mass_kg * target.accel_mps2[i];
    }
  }
  const ForceScale scale = force_scale(structure.law, targets);
  const double rough =
      std::sqrt(smooth * static_cast<double>(targets.size()));  // E is the targets' mean, this their sum
  row = add_roughness(0, springs, rough / scale.spring, row, a);
  add_roughness(springs, dampers, rough / scale.damper, row, a);
  return bounded_least_squares(a, b, upper);
}

}  // namespace crashsim
