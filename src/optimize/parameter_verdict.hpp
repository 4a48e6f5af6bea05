#pragma once
/// How far identified numbers of a model can be believed.

#include <span>
#include <string>
#include <utility>
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

/// Judges the values that an objective was minimised to, into what the fit reports.
/// @param squares the objective with the loss l2, whose error at the values is the residuals' variance.
template <class Objective, class Fit>
void judge_values(std::span<const SoughtRange> parameters, const Objective& objective, const Objective& squares,
                  std::span<const double> values, Fit& out) {
  const Eigen::MatrixXd jacobian = objective.jacobian(values);
  const auto freedom = static_cast<double>(jacobian.rows() - jacobian.cols());
  ParameterVerdict found = judge_parameters(parameters, values, jacobian, squares.evaluate(values, 0.0, {}) / freedom);
  out.verdict = std::move(found.verdict);
  out.parameters = std::move(found.parameters);
  out.correlation = std::move(found.correlation);
  warn_at_bounds(out.parameters, out.warnings);
}

}  // namespace crashsim
