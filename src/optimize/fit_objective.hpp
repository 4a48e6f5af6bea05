#pragma once
/// E of eq. (4) and its exact gradient, by the Taylor kernel.

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "optimize/fit_kernel.hpp"
#include "optimize/fit_target.hpp"
#include "solver/crush_force.hpp"

namespace crashsim {

/// What is fitted: law and knots; parameters are the ordinates, spring first.
struct FitStructure {
  CrushLaw law = CrushLaw::stiffness;
  std::vector<double> spring_knots, damper_knots;

  [[nodiscard]] std::size_t size() const { return spring_knots.size() + damper_knots.size(); }
};

/// Sizes of ordinates that alone would make the largest measured force at the end of their range.
struct ForceScale {
  double spring = kUnset, damper = kUnset;
};
ForceScale force_scale(CrushLaw law, std::span<const FitTarget> targets);

/// Model with given parameters.
CrushModel make_model(const FitStructure& structure, std::span<const double> parameters, double mass_kg,
                      double impact_speed_mps);

/// E over one or several targets (their mean). Holds its workspace: one object per thread.
class FitObjective {
 public:
  FitObjective(const FitStructure& structure, std::span<const FitTarget> targets, Loss loss, double smooth);

  /// E, and its gradient when `gradient` is not empty; infinite when a simulation fails.
  /// @param smoothing rounding of the corner of |u|, relative to each channel's largest u; 0 for the true loss.
  double evaluate(std::span<const double> parameters, double smoothing, std::span<double> gradient);

  /// E with its gradient, and the Hessian that Gauss and Newton make of the residuals, each weighted as its loss says
  /// at its size. `hessian` is square, of size(). Infinite when a simulation fails.
  double normal_equations(std::span<const double> parameters, double smoothing, std::span<double> gradient,
                          Eigen::MatrixXd& hessian);

  /// Derivatives of the scaled residuals (acceleration, velocity, displacement of each sample in turn) by the
  /// parameters; rows are weighted as in E with the squared loss.
  Eigen::MatrixXd jacobian(std::span<const double> parameters);

  /// Rows that the smoothing adds to jacobian(), none without smoothing.
  [[nodiscard]] Eigen::MatrixXd roughness_rows() const;

  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  template <class OnSamples>
  class Walk;
  struct PaddedSamples {
    std::vector<double> time, accel, velocity, displacement;
    std::size_t count;
  };

  void set(std::span<const double> parameters);
  /// Simulates the test of a target; false when that fails.
  template <class OnSamples>
  bool walk(std::size_t index, bool with_sensitivities, const OnSamples& on_samples);
  /// Adds to `gradient` what a linear functional of the piece, known on the columns, says of every parameter.
  void add_gradient(const Columns& columns, double weight, std::span<double> gradient) const;
  void add_hessian(const PieceLoss& loss, double weight, Eigen::MatrixXd& hessian) const;
  void columns_at_sample(double tau, Columns& accel, Columns& velocity, Columns& displacement) const;
  [[nodiscard]] double roughness(std::span<const double> parameters, std::span<double> gradient) const;

  std::span<const FitTarget> targets_;
  std::vector<PaddedSamples> samples_;
  Loss loss_;
  double smooth_;
  std::size_t spring_count_, size_;
  CrushForce force_;
  ForceScale scale_;
  std::vector<double> by_x_, by_v_;  ///< Sensitivities of x and v to every parameter at the start of the piece.
  FitPiece piece_;
  SensitivitySeries series_;
  std::array<int, kColumns - kHomogeneous> acting_{};  ///< Parameters of the acting columns, -1: none.
};

}  // namespace crashsim
