#include "optimize/fit_structure.hpp"

#include <algorithm>

#include "optimize/pchip.hpp"

namespace crashsim {
namespace {

/// Part of the way to a neighbour's middle place that a free knot may move: they cannot meet.
constexpr double kFreedom = 0.45;

/// Lowest and highest place of each knot between the first and the last.
struct KnotRange {
  double low, high;
};
std::vector<KnotRange> ranges_of(const std::vector<double>& knots) {
  std::vector<KnotRange> ranges;
  for (std::size_t i = 1; i + 1 < knots.size(); ++i)
    ranges.push_back(
        {knots[i] - kFreedom * (knots[i] - knots[i - 1]), knots[i] + kFreedom * (knots[i + 1] - knots[i])});
  return ranges;
}

void move_knots(std::span<const double> distances, std::vector<double>& knots) {
  if (distances.empty()) return;
  const std::vector<KnotRange> ranges = ranges_of(knots);
  for (std::size_t i = 0; i < ranges.size(); ++i) knots[i + 1] = ranges[i].low + distances[i];
}

PiecewiseLinear curve_of(Curve shape, const std::vector<double>& knots, std::span<const double> ordinates) {
  if (shape == Curve::pchip && !knots.empty()) return tabulate_pchip(knots, ordinates);
  return {knots, {ordinates.begin(), ordinates.end()}};
}

}  // namespace

FitKnots knots_of(const FitStructure& structure, std::span<const double> parameters) {
  FitKnots knots{structure.spring_knots, structure.damper_knots};
  if (!structure.has_free_knots) return knots;
  move_knots(parameters.subspan(structure.first_knot(), structure.free_springs()), knots.spring);
  move_knots(parameters.subspan(structure.first_knot() + structure.free_springs()), knots.damper);
  return knots;
}

Eigen::VectorXd free_knot_ranges(const FitStructure& structure) {
  Eigen::VectorXd widths(static_cast<Eigen::Index>(structure.free_springs() + structure.free_dampers()));
  if (widths.size() == 0) return widths;
  Eigen::Index next = 0;
  for (const auto* knots : {&structure.spring_knots, &structure.damper_knots})
    for (const KnotRange& range : ranges_of(*knots)) widths[next++] = range.high - range.low;
  return widths;
}

CrushModel make_model(const FitStructure& structure, std::span<const double> parameters, double mass_kg,
                      double impact_speed_mps) {
  const FitKnots knots = knots_of(structure, parameters);
  CrushModel model;
  model.mass_kg = mass_kg;
  model.impact_speed_mps = impact_speed_mps;
  model.law = structure.law;
  model.spring = curve_of(structure.curve, knots.spring, parameters.first(structure.springs()));
  model.damper = curve_of(structure.curve, knots.damper, parameters.subspan(structure.springs(), structure.dampers()));
  if (!structure.has_rate()) return model;
  model.rate_coefficient = parameters[structure.ordinates()];
  model.reference_speed_mps = structure.reference_speed_mps;
  return model;
}

}  // namespace crashsim
