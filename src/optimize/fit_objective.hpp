#pragma once
/// E of eq. (4) and its exact gradient, by the Taylor kernel.

#include <span>
#include <vector>

#include <Eigen/Core>

#include "optimize/fit_force.hpp"
#include "optimize/fit_kernel.hpp"
#include "optimize/fit_penalties.hpp"
#include "optimize/fit_target.hpp"

namespace crashsim {

/// E over one or several targets (their mean), with what smoothing and a prior add. Holds its workspace: one object per
/// thread.
class FitObjective {
 public:
  FitObjective(const FitStructure& structure, std::span<const FitTarget> targets, Loss loss, double smooth,
               const Prior& prior = {});

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

  /// Rows that smoothing and prior add to jacobian(), none without.
  [[nodiscard]] Eigen::MatrixXd penalty_rows() const;

  [[nodiscard]] const Penalties& penalties() const { return penalties_; }

  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  template <class OnSamples>
  class Walk;
  struct PaddedSamples {
    std::vector<double> time, accel, velocity, displacement;
    std::size_t count;
  };

  /// Simulates the test of a target; false when that fails.
  template <class OnSamples>
  bool walk(std::size_t index, bool with_sensitivities, const OnSamples& on_samples);
  /// Adds to `gradient` what a linear functional of the piece, known on the columns, says of every inner parameter.
  void add_gradient(const Columns& columns, double weight, std::span<double> gradient) const;
  void add_hessian(const PieceLoss& loss, double weight, Eigen::MatrixXd& hessian) const;
  void columns_at_sample(double tau, Columns& accel, Columns& velocity, Columns& displacement) const;
  [[nodiscard]] double penalty(std::span<const double> parameters, std::span<double> gradient) const;
  /// Where derivatives by the inner parameters are collected: the result itself where they are the parameters.
  std::span<double> inner(std::span<double> gradient);
  void to_parameters(std::span<double> gradient) const;

  [[nodiscard]] bool is_table() const { return force_.by_parameters().size() > 0; }

  std::span<const FitTarget> targets_;
  std::vector<PaddedSamples> samples_;
  Loss loss_;
  std::size_t size_;
  const FitKernel* kernel_;
  FitForce force_;
  Penalties penalties_;
  std::vector<double> inner_gradient_;
  Eigen::MatrixXd inner_hessian_;
  std::vector<double> by_x_, by_v_;  ///< Sensitivities of x and v to every inner parameter at the start of the piece.
  FitPiece piece_;
  SensitivitySeries series_;
  Action action_;
};

}  // namespace crashsim
