#pragma once
/// How far identified numbers of a heave-pitch model can be believed.

#include <span>
#include <vector>

#include <Eigen/Core>

#include "optimize/pitch_parameters.hpp"

namespace crashsim {

struct PitchIdentifiability {
  Verdict verdict;
  std::vector<ParameterReport> parameters;
  std::vector<std::vector<double>> correlation;
};

/// @param jacobian of the scaled residuals by the parameters at `values`.
/// @param residual_variance of those residuals.
PitchIdentifiability judge_pitch(std::span<const PitchParameter> parameters, std::span<const double> values,
                                 const Eigen::MatrixXd& jacobian, double residual_variance);

}  // namespace crashsim
