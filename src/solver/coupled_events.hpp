#pragma once
/// What ends a step of the coupled motion early.

#include <array>

#include "solver/coupled_problem.hpp"

namespace crashsim {

/// All unknowns as polynomials in tau = t - base, valid for from <= tau <= to.
struct CoupledStep {
  double base = 0.0, from = 0.0, to = 0.0;
  int degree = 0;
  std::array<Coefficients, coupled::kUnknowns> c{};

  [[nodiscard]] CoupledState state(double tau) const;
  /// A linear function of the state along the step.
  [[nodiscard]] Coefficients polynomial(const LinearFunction& f) const;
};

/// Where a polynomial changes its sign in (from, to), in order.
class SignChanges {
 public:
  SignChanges(const Coefficients& c, int degree, double from, double to);
  [[nodiscard]] const double* begin() const { return at_.data(); }
  [[nodiscard]] const double* end() const { return at_.data() + count_; }

 private:
  static constexpr int kIntervals = 8;  // far more than an integrator's step has turns
  std::array<double, kIntervals> at_{};
  std::size_t count_ = 0;
};

/// Derivative of a polynomial; its degree is one less.
Coefficients derivative_of(const Coefficients& c, int degree);

/// First event of a step taken in `mode`: of the crush force, or a switch.
struct CoupledEvent {
  Event crush;  ///< Its kind is `none` and its tau the step's end when there is no event; tau holds for switches too.
  std::size_t toggled = kSwitches;  ///< The switch, or kSwitches.

  [[nodiscard]] bool happens() const { return crush.kind != EventKind::none || toggled != kSwitches; }
};
CoupledEvent first_event(const CoupledProblem& problem, const CoupledMode& mode, const CoupledStep& step);

}  // namespace crashsim
