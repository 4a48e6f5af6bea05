#pragma once
/// Output-error fit of a crush model from many starts.

#include <span>
#include <vector>

#include <Eigen/Core>

#include "optimize/fit_objective.hpp"
#include "optimize/starts.hpp"

namespace crashsim {

/// Everything a start depends on but its index.
struct MultistartProblem {
  const FitStructure& structure;
  std::span<const FitTarget> targets;
  const IdentifyOptions& options;
  const Eigen::VectorXd& upper;           ///< Bounds of the parameters.
  const Eigen::VectorXd& equation_error;  ///< Start 0.
  double smooth = 0.0;
  Prior prior = {};
};

/// Initial ordinates of a start: the equation-error solution for 0, random ones that depend on seed and index only.
std::vector<double> initial_ordinates(const MultistartProblem& problem, int index);

/// Fits from every start; parameters are ordinates.
std::vector<StartResult> run_starts(const MultistartProblem& problem, const Progress& progress);

}  // namespace crashsim
