#pragma once
/// Exact motion of a linear two-degree-of-freedom system under a force that is a parabola over a step.

#include <array>
#include <span>

#include <Eigen/Core>

namespace crashsim {

/// Positions (z, theta), then their rates.
using PitchState = Eigen::Vector4d;

/// Force per unit mass over a step: its value, rate and second rate at the start of the step, as columns.
using ForcePiece = Eigen::Matrix<double, 2, 3>;

inline Eigen::Vector2d value(const ForcePiece& piece, double s) {
  return piece.col(0) + s * (piece.col(1) + 0.5 * s * piece.col(2));
}

/// The same force, told from `s` later on.
inline ForcePiece shifted(const ForcePiece& piece, double s) {
  ForcePiece later;
  later << value(piece, s), piece.col(1) + s * piece.col(2), piece.col(2);
  return later;
}

/// q'' = f(t) - damping q' - stiffness q: matrices per unit mass.
struct LinearSystem {
  Eigen::Matrix2d stiffness, damping;

  [[nodiscard]] Eigen::Vector2d acceleration(const PitchState& y, const Eigen::Vector2d& force) const {
    return force - damping * y.tail<2>() - stiffness * y.head<2>();
  }
};

/// Steps of a linear system: y(t + h) by the exponential of the system augmented with the derivatives of its force.
/// Exact to rounding for any h > 0. Steps that recur share one matrix, others cost one Taylor series of the vector.
class Propagator {
 public:
  /// @param same_step_s steps that differ by no more are the same: the rounding of the times they come from [s].
  Propagator(const LinearSystem& system, double same_step_s);

  /// State after a step of `h` from `y`.
  [[nodiscard]] PitchState step(const PitchState& y, const ForcePiece& force, double h) const;

  /// States at all times from states[0]; forces[i] acts from times[i] to times[i + 1]. Remembers recurring steps.
  void run(std::span<const double> times, std::span<const ForcePiece> forces, std::span<PitchState> states);

 private:
  static constexpr int kSize = 10;  // state, force, force rate, second force rate
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  using StepMatrix = Eigen::Matrix<double, 4, kSize>;
  struct Recurring {
    double h = -1.0;
    bool has_matrix = false;
    StepMatrix matrix = StepMatrix::Zero();
  };

  template <int Columns>
  void multiply_by_exponential(Eigen::Matrix<double, kSize, Columns>& v, double h) const;
  [[nodiscard]] Matrix exponential(double h) const;
  const StepMatrix* matrix_if_recurring(double h);

  Matrix generator_;
  double norm_, same_step_s_;
  std::array<Recurring, 4> recurring_;
  std::size_t oldest_ = 0;
};

}  // namespace crashsim
