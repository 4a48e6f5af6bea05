#pragma once
/// Losses of the samples in one smooth piece of a motion, and the moments of their derivatives.

#include "optimize/fit_target.hpp"
#include "optimize/sensitivity.hpp"

namespace crashsim {

/// Sum of the losses, and sum over samples of d(loss)/d(channel) tau^n for each power n: with these the gradient's cost
/// per sample does not depend on the number of parameters.
struct LossMoments {
  double sum = 0.0;
  Coefficients x, v, a;
};

/// How residuals are penalised.
struct Penalty {
  Loss loss = Loss::l1;
  double smoothing = 0.0;  ///< Relative to each channel's largest scaled value.
  bool with_moments = false;
};

/// Samples [first, last) of a target, which lie in the piece `step` up to `tau_end`, with its force.
void loss_moments(const FitTarget& target, std::size_t first, std::size_t last, const StepPolynomial& step,
                  double tau_end, const RegionForce& force, const Penalty& penalty, LossMoments& out);

}  // namespace crashsim
