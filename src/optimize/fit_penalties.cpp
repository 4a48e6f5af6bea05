#include "optimize/fit_penalties.hpp"

#include <algorithm>
#include <cmath>

namespace crashsim {
namespace {

using Eigen::Index;

/// Second differences of a curve's ordinates, from `first` on.
Index add_roughness(std::size_t first, std::size_t count, double weight, Index row, Eigen::MatrixXd& rows) {
  for (std::size_t i = first; i + 2 < first + count; ++i, ++row) {
    const auto column = static_cast<Index>(i);
    rows(row, column) = rows(row, column + 2) = weight;
    rows(row, column + 1) = -2.0 * weight;
  }
  return row;
}

}  // namespace

ForceScale force_scale(CrushLaw law, std::span<const FitTarget> targets) {
  double force = 0.0, crush = 0.0, speed = 0.0;
  for (const FitTarget& target : targets) {
    for (const double a : target.accel_mps2) force = std::max(force, target.mass_kg * std::fabs(a));
    crush = std::max(crush, target.max_crush_m);
    speed = std::max(speed, target.impact_speed_mps);
  }
  return {law == CrushLaw::stiffness ? force / crush : force, force / speed};
}

Penalties make_penalties(const FitStructure& structure, const ForceScale& scale, double smooth, const Prior& prior) {
  const auto differences = [&](std::size_t knots) { return smooth > 0.0 && knots > 2 ? knots - 2 : 0; };
  const auto known = static_cast<std::size_t>(prior.deviations.array().isFinite().count());
  const std::size_t count = differences(structure.springs()) + differences(structure.dampers()) + known;
  Penalties out{Eigen::MatrixXd::Zero(static_cast<Index>(count), static_cast<Index>(structure.size())),
                Eigen::VectorXd::Zero(static_cast<Index>(count))};
  Index row = 0;
  if (smooth > 0.0) {
    const double root = std::sqrt(smooth);
    row = add_roughness(0, structure.springs(), root / scale.spring, row, out.rows);
    row = add_roughness(structure.springs(), structure.dampers(), root / scale.damper, row, out.rows);
  }
  for (Index i = 0; i < prior.deviations.size(); ++i) {
    if (!std::isfinite(prior.deviations[i])) continue;
    out.rows(row, i) = std::sqrt(prior.weight) / prior.deviations[i];
    out.aims[row] = out.rows(row, i) * prior.values[i];
    ++row;
  }
  return out;
}

}  // namespace crashsim
