#pragma once
/// A fit at its solution as a linear least-squares problem, and what noise of the acceleration does to it.

#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "optimize/fit_study.hpp"
#include "optimize/noise_process.hpp"

namespace crashsim {

/// Motion of the model at a target's samples.
struct FittedMotion {
  std::vector<double> accel_mps2, velocity_mps, displacement_m;
};

/// @throws NumericalFailure when the motion ends before the samples do.
FittedMotion fitted_motion(const FitStructure& structure, std::span<const double> parameters, const FitTarget& target);

/// Weight of the parabola w u^2 that stands for a loss of normal residuals u of a size (root mean square): it has the
/// same expected slope, E[loss'(u) u] = 2 w E[u^2].
///     l2: 1,   l1: 1 / (size sqrt(2 pi)),   huber: erf(h / (size sqrt 2)) / (2 h)
double equivalent_weight(Loss loss, double size);

/// Running integral by trapezoids from 0, as velocity and displacement are of acceleration: adds C' g to `sum`, C its
/// matrix.
void add_transposed_integral(std::span<const double> time_s, const Eigen::MatrixXd& g, Eigen::MatrixXd& sum);

/// The problem about theta, the parameters found: rows J (p - theta) + r whose squares are E, but for a factor and a
/// constant, near it.
struct LinearFit {
  Eigen::VectorXd theta;
  std::vector<FitTarget> targets;             ///< With scales by which the squared loss stands for the loss.
  std::vector<std::vector<double>> residual;  ///< Of acceleration, measured - model [m/s^2].
  std::vector<NoiseProcess> noise;            ///< Of acceleration, a target each.
  double freedom = 1.0;                       ///< n / (n - p), n samples of all targets, p free parameters.
  Eigen::MatrixXd jacobian;                   ///< Of the targets' rows alone.
  Eigen::MatrixXd rows;              ///< Upper triangle with J' J of all rows, those of smoothing and prior, too.
  Eigen::VectorXd gradient;          ///< J' r; 0 where the parameter is free.
  Eigen::MatrixXd score_covariance;  ///< Of J' (errors), by the noise.
  std::vector<bool> is_free;         ///< Neither held at a bound nor without any sample.
};

/// The problem of a study at its solution.
/// @param nuisance sensitivities of unknown errors of the tests to which E is least, and rows of what is expected of
///        them, as functions of targets with other scales; they are taken out of the rows. Empty: none.
/// @param is_free of each parameter.
LinearFit linearise(const FitStudy& study, const Eigen::VectorXd& theta, const std::vector<bool>& is_free,
                    const std::function<Eigen::MatrixXd(const std::vector<FitTarget>& targets)>& nuisance = {});

/// Covariance B of the scores J' S e by the noise e of each target's acceleration, S = [1, C, C^2].
Eigen::MatrixXd score_covariance(const LinearFit& fit);

/// Covariance of the parameters: (J'J)^-1 B (J'J)^-1, B the covariance of the scores, those held left out: theirs are
/// 0. Unset rows and columns belong to parameters that the rows do not determine.
Eigen::MatrixXd covariance_of(const LinearFit& fit);

/// Correlations of a covariance; unset where a variance is 0 or unset.
Eigen::MatrixXd correlation_of(const Eigen::MatrixXd& covariance);

/// Diagonal of (J'J)^-1 among the free parameters; unset as above.
Eigen::VectorXd inverse_curvature(const LinearFit& fit);

}  // namespace crashsim
