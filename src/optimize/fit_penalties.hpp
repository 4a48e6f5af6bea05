#pragma once
/// What smoothing and a prior add to E.

#include <span>

#include <Eigen/Core>

#include "optimize/fit_structure.hpp"
#include "optimize/fit_target.hpp"

namespace crashsim {

/// Sizes of ordinates that alone would make the largest measured force at the end of their range.
struct ForceScale {
  double spring = kUnset, damper = kUnset;
};
ForceScale force_scale(CrushLaw law, std::span<const FitTarget> targets);

/// What is known of parameters beforehand: each with the deviation expected of it, infinite where nothing is known.
/// E gains `weight` times the sum of the squared deviations in those units. Empty: nothing is known.
struct Prior {
  Eigen::VectorXd values, deviations;
  double weight = 0.0;
};

/// E gains |rows * parameters - aims|^2.
struct Penalties {
  Eigen::MatrixXd rows;
  Eigen::VectorXd aims;
};
/// @param smooth weight of the squared second differences of the ordinates in units of `scale`.
Penalties make_penalties(const FitStructure& structure, const ForceScale& scale, double smooth, const Prior& prior);

}  // namespace crashsim
