#pragma once
/// How much smoothing the data ask for.

#include <Eigen/Core>

#include <crashsim/identify_options.hpp>

#include "optimize/equation_error.hpp"

namespace crashsim {

/// A weight of the roughness, chosen.
struct SmoothingChoice {
  double smooth = kUnset;     ///< Weight of |roughness p|^2 beside |rows p - rhs|^2.
  double criterion = kUnset;  ///< Score of cross-validation (least), or curvature of the L-curve (largest), there.
  double residual = kUnset;   ///< |rows p - rhs|^2 there.
  double roughness = kUnset;  ///< |roughness p|^2 there.
  double freedom = kUnset;    ///< Effective number of parameters: trace of the influence matrix.
  bool at_edge = false;       ///< No optimum inside the range of weights that matter: an end of it.
};

/// Chooses the weight s in min |rows p - rhs|^2 + s |roughness p|^2, 0 <= p <= upper.
///     gcv:      least n |rows p - rhs|^2 / (n - inflation trace H)^2, n samples, H their influence matrix
///     l_curve:  largest curvature of (ln |rows p - rhs|^2, ln |roughness p|^2), positive at its corner
/// [Golub1979], [Hansen1993]. Ordinates at a bound count as fixed there. One decomposition for each set of ordinates at
/// bounds that occurs; no fit per weight apart from it.
/// @param inflation how many samples carry the information of one: correlated residuals would pass for structure
/// otherwise; 1 for independent ones.
/// @param rule gcv or l_curve.
/// @returns smooth 0 when no roughness is defined (fewer than 3 ordinates a curve).
SmoothingChoice choose_smoothing(const EquationErrorSystem& system, const Eigen::VectorXd& upper, Smoothing rule,
                                 double inflation = 1.0);

}  // namespace crashsim
