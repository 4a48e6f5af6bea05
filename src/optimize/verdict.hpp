#pragma once
/// How far identified ordinates can be believed, from the sensitivity matrix at the solution.

#include <span>
#include <vector>

#include <Eigen/Core>

#include "optimize/fit_objective.hpp"

namespace crashsim {

struct Identifiability {
  Verdict verdict;
  std::vector<OrdinateReport> ordinates;
  std::vector<std::vector<double>> correlation;
};

/// Gives ordinates that no sample depends on the value of the nearest one on their curve that some sample does: a curve
/// goes on as it was last seen.
void hold_untouched(const FitStructure& structure, const std::vector<bool>& touched, std::span<double> parameters);

/// @param roughness rows of the smoothing, which determine ordinates as samples do; none without smoothing.
/// @param residual_variance of the scaled residuals that the rows of `jacobian` belong to.
/// @param tests number of pulses fitted, for the message.
Identifiability judge_identifiability(const FitStructure& structure, std::span<const double> parameters,
                                      const Eigen::VectorXd& upper, const Eigen::MatrixXd& jacobian,
                                      const Eigen::MatrixXd& roughness, double residual_variance, std::size_t tests);

}  // namespace crashsim
