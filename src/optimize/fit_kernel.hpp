#pragma once
/// Inner loops of the fit on one smooth piece of a motion: series of the sensitivities, losses of the samples and their
/// derivatives.
///
/// Every sensitivity s = dx/dtheta obeys m s'' = -(dF/dx) s - (dF/dv) s' - dF/dtheta. Inside a piece only the four
/// parameters of its two segments act (dF/dtheta != 0); all others are combinations of the two homogeneous solutions.
/// So six columns describe any number of parameters. Every instruction set gives the same bits.
///
/// The force is a sum of features of the motion, each times its coefficient:
///     polynomial laws    1, x, x^2;  v, v^2, x v
///     law `rate`         H, x H, x^2 H;  L, x L, x^2 L    with L = ln(1 + per_reference v), H = 1 + rate L

#include <cstddef>

namespace crashsim {

inline constexpr int kFitDegree = 10;           ///< Of the series: that of the Taylor kernel.
inline constexpr std::size_t kHomogeneous = 2;  ///< Columns 0, 1: from a unit displacement, from a unit velocity.
inline constexpr std::size_t kColumns = 6;      ///< Then the acting parameters: two of the spring, two of the damper.
inline constexpr std::size_t kColumnLanes = 8;  ///< Columns padded to whole vectors.

using Series = double[kFitDegree + 1];
using Columns = double[kColumnLanes];
inline constexpr std::size_t kFeatures = 6;  ///< The first three are the spring's, the others the damper's.

/// Motion and force of a piece.
struct FitPiece {
  Series x, v;                               ///< Motion about the start of its step.
  double force[kFeatures];                   ///< Coefficients of the force.
  double basis[kColumns - kHomogeneous][3];  ///< Of the force per acting parameter, in the features of its curve.
  double rate, per_reference;                ///< Of law `rate`.
  double mass;
};

/// Displacement and velocity of the columns as series.
struct alignas(64) SensitivitySeries {
  Columns x[kFitDegree + 1], v[kFitDegree + 1];
};

/// Samples of a target inside a piece; kColumnLanes - 1 more after them may be read.
struct FitSamples {
  const double *time, *accel, *velocity, *displacement;
  std::size_t count;
  double base;  ///< Time of the start of the step.
};

/// How scaled residuals u = scale * (model - data) are penalised.
struct Penalty {
  enum Kind { absolute, rounded, squared, huber } kind = absolute;  ///< rounded: sqrt(u^2 + s^2) - s.
  double accel_scale, velocity_scale, displacement_scale;
  double accel_rounding, velocity_rounding, displacement_rounding;  ///< s of `rounded`; `huber`: its threshold.
};

/// Loss of a piece's samples and its derivatives by the columns.
struct alignas(64) PieceLoss {
  double sum;
  Columns gradient;
  Columns hessian[kColumns];  ///< Gauss-Newton's, each residual weighted as its loss says at its size.
};

struct FitKernel {
  void (*sensitivities)(const FitPiece& piece, SensitivitySeries& series);
  /// Displacement and velocity of the columns at tau.
  void (*columns_at)(const SensitivitySeries& series, double tau, Columns& x, Columns& v);
  void (*loss)(const FitPiece& piece, const FitSamples& samples, const Penalty& penalty, PieceLoss& out);
  void (*loss_and_gradient)(const FitPiece& piece, const SensitivitySeries& series, const FitSamples& samples,
                            const Penalty& penalty, PieceLoss& out);
  /// Gradient and Hessian.
  void (*normal_equations)(const FitPiece& piece, const SensitivitySeries& series, const FitSamples& samples,
                           const Penalty& penalty, PieceLoss& out);
};

extern const FitKernel kFitKernelBaseline, kFitKernelAvx2, kFitKernelAvx512;
extern const FitKernel
    kRateFitKernel;  ///< Of law `rate`, in the baseline's instructions: its logarithms take the time.

}  // namespace crashsim
