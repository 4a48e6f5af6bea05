#pragma once
/// The inner loops of many motions in one CVODE problem: forces of all models, and the operations on vectors of all
/// unknowns, in the widest instructions the machine has. Numbers do not depend on the width.
///
/// Every vector has kBatch crushes, then kBatch velocities, and starts at a multiple of 64 bytes.

#include <cstddef>
#include <cstdint>

namespace crashsim {

inline constexpr std::size_t kBatch = 64;      ///< Models of a problem: cheapest of 32..128 by measurement.
inline constexpr std::size_t kBatchGroup = 8;  ///< Models that are looked after together.
inline constexpr std::size_t kBatchGroups = kBatch / kBatchGroup;
inline constexpr std::size_t kBatchLength = 2 * kBatch;
using BatchNumbers = double[kBatch];
/// Not 0 where a model of the group needs attention.
using BatchFlags = std::int64_t[kBatchGroups];

/// dv/dt = constant + x1 x + x2 x^2 + v1 v + v2 v^2 + xv x v and dx/dt = moves v, inside the bounds.
struct alignas(64) BatchForce {
  BatchNumbers constant{}, x1{}, x2{}, v1{}, v2{}, xv{};
  BatchNumbers moves{};  ///< 1, or 0 for a model that has left the problem.
  BatchNumbers x_low{}, x_high{}, v_low{}, v_high{};
  bool has_xv = false;  ///< A model may have an xv other than 0. Last, so that the numbers stay aligned.
};

/// What a model may reach without anything to be done about it.
struct alignas(64) BatchLimits {
  BatchNumbers x_low{}, x_high{}, v_low{}, v_high{}, accel_high{};
};

struct BatchKernel {
  /// Sets the flags of groups with a model beyond the bounds of its polynomials. @returns whether there is one.
  bool (*rates)(const BatchForce& force, const double* y, double* ydot, BatchFlags& outside);
  /// The same for models beyond their limits.
  bool (*beyond)(const BatchLimits& limits, const double* y, const double* ydot, BatchFlags& flags);
  void (*linear_sum)(double a, const double* x, double b, const double* y, double* z);  ///< z = a x + b y
  void (*scale)(double c, const double* x, double* z);                                  ///< z = c x
  /// z = sum_k c[k] x[k], without those terms whose c[k] is 0.
  void (*linear_combination)(int count, const double* c, const double* const* x, double* z);
  /// z[k] = a[k] x + y[k]
  void (*scale_add)(int count, const double* a, const double* x, const double* const* y, double* const* z);
  double (*weighted_square)(const double* x, const double* w);  ///< sum of (x w)^2
};

extern const BatchKernel kBatchKernelBaseline, kBatchKernelAvx2, kBatchKernelAvx512;

}  // namespace crashsim
