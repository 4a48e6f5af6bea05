#pragma once
/// Replicates of a fit: the parameters that other noise would have given.

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "optimize/linear_fit.hpp"

namespace crashsim {

/// Draws of the fit's linear problem, each with a noise of its own, minimised over the bounds. What the data do not
/// determine is drawn evenly between the bounds: a row a parameter says so, which weighs nothing beside data.
class LinearReplicates {
 public:
  LinearReplicates(const LinearFit& fit, const Eigen::VectorXd& upper);

  /// Depends on (seed, index) only.
  [[nodiscard]] std::vector<double> draw(std::uint64_t seed, int index) const;

 private:
  Eigen::VectorXd upper_;
  Eigen::MatrixXd rows_;      ///< Of data and smoothing, then one a parameter of the bounds.
  Eigen::VectorXd solution_;  ///< Right-hand side of the first without noise.
  Eigen::MatrixXd noise_;     ///< Times independent standard normal numbers: that of the right-hand side.
  Eigen::VectorXd bound_rows_;
};

/// How the noise of a test made anew comes about.
struct Renewal {
  bool by_blocks = false;  ///< Blocks of the test's own residual in random order; false: drawn from the process.
  int block = 0;           ///< Samples; 0: as long as the noise is correlated, and at least the cube root of all.
};

/// Tests as the model at its solution would have been measured: its motion, the noise added to acceleration and, by
/// trapezoids, to velocity and displacement. Depends on (seed, index) only.
std::vector<FitTarget> renewed_tests(const FitStudy& study, const LinearFit& fit,
                                     const std::vector<FittedMotion>& motions, const Renewal& how, std::uint64_t seed,
                                     int index);

/// The fit again from its solution. @returns the parameters, none when its simulations failed or `go_on` said false.
std::vector<double> fit_again(const FitStudy& study, const std::vector<FitTarget>& targets, const Eigen::VectorXd& from,
                              const std::function<bool()>& go_on);

}  // namespace crashsim
