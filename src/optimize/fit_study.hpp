#pragma once
/// What an identification is made from: targets, structure, bounds, and what is known beforehand.

#include <span>
#include <vector>

#include <Eigen/Core>

#include "optimize/equation_error.hpp"
#include "optimize/fit_objective.hpp"

namespace crashsim {

/// Pulses and options, made into what the fit works on.
struct FitStudy {
  const IdentifyOptions& options;
  std::vector<FitTarget> targets;
  FitStructure structure;
  Eigen::VectorXd upper;           ///< Bounds of the parameters.
  double smooth = 0.0;             ///< Weight of the smoothing.
  double observation_error = 0.0;  ///< E that one independent observation stands for; makes the weight of priors.
  Prior prior;                     ///< Of the ordinates.

  /// @throws InvalidInput on options that do not fit together or to the pulses.
  FitStudy(std::span<const Pulse> pulses, const IdentifyOptions& how);

  [[nodiscard]] FitObjective objective() const { return {structure, targets, options.loss, smooth, prior}; }
  [[nodiscard]] Eigen::VectorXd solve_equation_error() const {
    return crashsim::solve_equation_error(structure, targets, upper, smooth, prior);
  }
};

}  // namespace crashsim
