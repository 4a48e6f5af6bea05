#pragma once
/// Output-error fit from many starts.

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "optimize/fit_objective.hpp"

namespace crashsim {

/// Everything a start depends on but its index.
struct MultistartProblem {
  const FitStructure& structure;
  std::span<const FitTarget> targets;
  const IdentifyOptions& options;
  const Eigen::VectorXd& upper;           ///< Bounds of the ordinates.
  const Eigen::VectorXd& equation_error;  ///< Start 0.
};

struct StartResult {
  std::vector<double> parameters;
  StartReport report;
};

/// Initial ordinates of a start: the equation-error solution for 0, random ones that depend on seed and index only.
std::vector<double> initial_ordinates(const MultistartProblem& problem, int index);

/// Fits from every start; the outcome does not depend on the number of threads. Starts that `progress` kept from
/// ending have no evaluations.
std::vector<StartResult> run_starts(const MultistartProblem& problem, const Progress& progress);

/// Uniform number in [0, 1) that depends on (seed, stream, index) only.
double uniform_random(std::uint64_t seed, std::uint64_t stream, std::uint64_t index);

}  // namespace crashsim
