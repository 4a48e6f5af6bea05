#pragma once
/// How far identified numbers of a model can be believed.

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <crashsim/identify.hpp>

#include "optimize/sought_numbers.hpp"

namespace crashsim {

struct ParameterVerdict {
  Verdict verdict;
  std::vector<ParameterReport> parameters;
  std::vector<std::vector<double>> correlation;
};

/// @param jacobian of the scaled residuals by the parameters at `values`.
/// @param residual_variance of those residuals.
ParameterVerdict judge_parameters(std::span<const SoughtRange> parameters, std::span<const double> values,
                                  const Eigen::MatrixXd& jacobian, double residual_variance);

/// Warns of numbers that ended at a bound although samples depend on them.
void warn_at_bounds(std::span<const ParameterReport> parameters, std::vector<std::string>& warnings);

}  // namespace crashsim
