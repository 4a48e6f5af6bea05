#include "optimize/fit_force.hpp"

#include <algorithm>

#include "optimize/pchip.hpp"

namespace crashsim {

using Eigen::Index;

/// Where a curve's ordinates and free knots are among the inner parameters, its columns, and what they are.
struct FitForce::Table {
  std::size_t first_ordinate, first_knot, first_column;
  const std::vector<double>&knots, &ordinates;
};

FitForce::FitForce(const FitStructure& structure) : structure_(structure) {
  const bool is_table = structure.curve == Curve::pchip;
  knots_ = {is_table ? pchip_knots(structure.spring_knots) : structure.spring_knots,
            is_table ? pchip_knots(structure.damper_knots) : structure.damper_knots};
  spring_.resize(knots_.spring.size());
  damper_.resize(knots_.damper.size());
  inner_size_ = structure.size() - structure.ordinates() + spring_.size() + damper_.size();
  if (is_table) {
    by_parameters_ = Eigen::MatrixXd::Zero(static_cast<Index>(inner_size_), static_cast<Index>(structure.size()));
    if (structure.has_rate()) by_parameters_.bottomRightCorner<1, 1>()(0) = 1.0;
  }
  make_curves();
}

void FitForce::make_curves() {
  force_ = make_force(
      {structure_.law, Extrapolation::constant, knots_.spring, knots_.damper, structure_.reference_speed_mps});
}

void FitForce::set(std::span<const double> parameters) {
  const auto spring = parameters.first(structure_.springs());
  const auto damper = parameters.subspan(structure_.springs(), structure_.dampers());
  if (structure_.has_free_knots) {
    knots_ = knots_of(structure_, parameters);
    make_curves();
  }
  if (structure_.has_rate()) force_.rate_coefficient = parameters[structure_.ordinates()];
  if (by_parameters_.size() == 0) {
    std::copy(spring.begin(), spring.end(), spring_.begin());
    std::copy(damper.begin(), damper.end(), damper_.begin());
  } else {
    tabulate(structure_.spring_knots, spring, 0, 0, spring_);
    tabulate(structure_.damper_knots, damper, spring_.size(), structure_.springs(), damper_);
  }
  force_.set_ordinates(spring_, damper_);
}

void FitForce::tabulate(std::span<const double> knots, std::span<const double> ordinates, std::size_t row,
                        std::size_t column, std::vector<double>& table) {
  if (knots.empty()) return;
  const PchipTable curve = pchip_table(knots, ordinates);
  std::copy(curve.ordinates.begin(), curve.ordinates.end(), table.begin());
  by_parameters_.block(static_cast<Index>(row), static_cast<Index>(column), curve.by_ordinates.rows(),
                       curve.by_ordinates.cols()) = curve.by_ordinates;
}

void FitForce::set_action(int spring, int damper, Action& out) const {
  out.count = 0;
  for (double(&basis)[3] : out.basis) std::fill(basis, basis + 3, 0.0);
  const auto s = static_cast<std::size_t>(spring), d = static_cast<std::size_t>(damper);
  const std::size_t springs = spring_.size(), rate = springs + damper_.size();
  const std::size_t first_knot = rate + (structure_.has_rate() ? 1 : 0);
  add_curve(force_.spring.segments[s], {0, 1, 2}, {0, first_knot, 0, knots_.spring, spring_}, out);
  const Table table{springs, first_knot + structure_.free_springs(), 2, knots_.damper, damper_};
  if (structure_.has_rate()) {
    std::copy_n(force_.spring_polynomials[s].begin(), 3, out.basis[2]);
    out.add(rate, 2, 1.0);
  } else if (force_.damping.empty()) {
    add_curve(force_.damper.segments[d], {2, 0, 1}, table, out);  // s and s^2 are v and v^2, there is no 1
  } else {
    add_curve(force_.damping[s], {0, 2, 1}, table, out);  // 1 and s are factors of v: v and x v
  }
}

/// @param place of the coefficients of 1, s and s^2 among the features of the curve.
void FitForce::add_curve(const std::array<OrdinateBasis, 2>& segment, const std::array<std::size_t, 3>& place,
                         const Table& table, Action& out) const {
  for (std::size_t j = 0; j < 2; ++j) {
    if (segment[j].ordinate < 0) continue;
    for (std::size_t i = 0; i < 3; ++i) out.basis[table.first_column + j][place[i]] = segment[j].c[i];
    out.add(table.first_ordinate + static_cast<std::size_t>(segment[j].ordinate), table.first_column + j, 1.0);
  }
  if (!structure_.has_free_knots || segment[0].ordinate < 0 || segment[1].ordinate < 0) return;
  // On the line y_a + slope (s - knot_a), a knot that moves does what -slope times its ordinate does.
  const auto a = static_cast<std::size_t>(segment[0].ordinate), b = static_cast<std::size_t>(segment[1].ordinate);
  const double slope = (table.ordinates[b] - table.ordinates[a]) / (table.knots[b] - table.knots[a]);
  for (std::size_t j = 0; j < 2; ++j) {
    const std::size_t knot = j == 0 ? a : b;
    if (knot > 0 && knot + 1 < table.knots.size()) out.add(table.first_knot + knot - 1, table.first_column + j, -slope);
  }
}

}  // namespace crashsim
