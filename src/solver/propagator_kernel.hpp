#pragma once
/// Steps of a four-dimensional linear recurrence, compiled for each instruction set; the same bits from every one.

#include <cstddef>

namespace crashsim {

struct PropagatorKernel {
  /// states[i + 1] = matrix * (states[i], forces[i]) for i below `steps`. `matrix` has 4 rows and 10 columns, column by
  /// column; a state is 4 numbers, a force 6.
  void (*run)(const double* matrix, const double* forces, double* states, std::size_t steps);
};

extern const PropagatorKernel kPropagatorKernelBaseline, kPropagatorKernelAvx2, kPropagatorKernelAvx512;

}  // namespace crashsim
