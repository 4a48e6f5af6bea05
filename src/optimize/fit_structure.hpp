#pragma once
/// What is fitted: law, curves and their knots, and where each number of them is among the parameters.

#include <span>
#include <vector>

#include <Eigen/Core>

#include <crashsim/identify_options.hpp>

namespace crashsim {

/// Parameters in turn: ordinates of the spring, of the damper; r of law `rate`; places of the free knots, of the spring
/// and of the damper. A free knot's parameter is its distance from the lowest place it may take.
struct FitStructure {
  CrushLaw law = CrushLaw::stiffness;
  std::vector<double> spring_knots, damper_knots;  ///< Where knots are free: their middle places.
  double reference_speed_mps = kUnset;             ///< Of law `rate`.
  Curve curve = Curve::linear;
  bool has_free_knots = false;

  [[nodiscard]] std::size_t springs() const { return spring_knots.size(); }
  [[nodiscard]] std::size_t dampers() const { return damper_knots.size(); }
  [[nodiscard]] std::size_t ordinates() const { return springs() + dampers(); }
  [[nodiscard]] bool has_rate() const { return law == CrushLaw::rate; }
  [[nodiscard]] std::size_t first_knot() const { return ordinates() + (has_rate() ? 1 : 0); }  ///< After r.
  [[nodiscard]] std::size_t free_springs() const { return free_of(springs()); }
  [[nodiscard]] std::size_t free_dampers() const { return free_of(dampers()); }
  [[nodiscard]] std::size_t size() const { return first_knot() + free_springs() + free_dampers(); }

 private:
  /// The first knot is 0 and the last the end of the range.
  [[nodiscard]] std::size_t free_of(std::size_t knots) const { return has_free_knots && knots > 2 ? knots - 2 : 0; }
};

/// Knots that parameters stand for.
struct FitKnots {
  std::vector<double> spring, damper;
};
FitKnots knots_of(const FitStructure& structure, std::span<const double> parameters);

/// How far free knots may move, for the bounds of their parameters; appended to `upper`.
Eigen::VectorXd free_knot_ranges(const FitStructure& structure);

/// Model with given parameters; a PCHIP curve as pchip.hpp tabulates it.
CrushModel make_model(const FitStructure& structure, std::span<const double> parameters, double mass_kg,
                      double impact_speed_mps);

}  // namespace crashsim
