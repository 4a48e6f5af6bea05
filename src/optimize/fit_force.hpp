#pragma once
/// The force that is fitted, and which parameters act on it where.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "optimize/fit_structure.hpp"
#include "solver/crush_force.hpp"

namespace crashsim {

inline constexpr std::size_t kActingColumns = 4;  ///< Ordinates of a region: two of the spring, two of the damper.

/// What acts inside one region of x and v: derivatives of the force are factor * (basis[column] * features), with the
/// features of fit_kernel.hpp; columns 0 and 1 have those of the spring, 2 and 3 those of the damper.
struct Action {
  struct Acting {
    std::size_t parameter, column;  ///< Inner parameter.
    double factor;
  };
  double basis[kActingColumns][3];
  std::array<Acting, 2 * kActingColumns> acting;
  std::size_t count = 0;

  void add(std::size_t parameter, std::size_t column, double factor) { acting[count++] = {parameter, column, factor}; }
  [[nodiscard]] std::span<const Acting> entries() const { return {acting.data(), count}; }
};

/// The force of a structure at given parameters. Inside, a PCHIP curve is its table: the inner parameters have the
/// table's ordinates instead of the curve's.
class FitForce {
 public:
  explicit FitForce(const FitStructure& structure);

  void set(std::span<const double> parameters);

  [[nodiscard]] const CrushForce& force() const { return force_; }
  [[nodiscard]] std::size_t inner_size() const { return inner_size_; }
  /// Derivatives of the inner parameters by the parameters; empty where they are the same.
  [[nodiscard]] const Eigen::MatrixXd& by_parameters() const { return by_parameters_; }
  /// Action in the segments `spring` of x and `damper` of v.
  void set_action(int spring, int damper, Action& out) const;

 private:
  struct Table;

  void make_curves();
  void tabulate(std::span<const double> knots, std::span<const double> ordinates, std::size_t row, std::size_t column,
                std::vector<double>& table);
  void add_curve(const std::array<OrdinateBasis, 2>& segment, const std::array<std::size_t, 3>& place,
                 const Table& table, Action& out) const;

  FitStructure structure_;
  std::size_t inner_size_;
  CrushForce force_;
  FitKnots knots_;
  std::vector<double> spring_, damper_;  ///< Inner ordinates.
  Eigen::MatrixXd by_parameters_;
};

}  // namespace crashsim
