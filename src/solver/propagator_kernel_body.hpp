#pragma once
/// The kernel, for the files that compile it for one instruction set each; see instruction_set.hpp.

#include "solver/propagator_kernel.hpp"
#include "vector_types.hpp"

namespace crashsim {
namespace {

template <std::size_t W>
CRASHSIM_INLINE void run(const double* matrix, const double* forces, double* states, std::size_t steps) {
  using D = typename Vectors<W>::Doubles;
  constexpr std::size_t kState = 4, kForce = 6, kParts = kState / W;
  D of_state[kState][kParts], of_force[kForce][kParts], y[kParts];
#pragma GCC unroll 4
  for (std::size_t p = 0; p < kParts; ++p) {
#pragma GCC unroll 4
    for (std::size_t c = 0; c < kState; ++c) of_state[c][p] = load<D>(matrix + kState * c + W * p);
#pragma GCC unroll 6
    for (std::size_t c = 0; c < kForce; ++c) of_force[c][p] = load<D>(matrix + kState * (kState + c) + W * p);
    y[p] = load<D>(states + W * p);
  }
  for (std::size_t i = 0; i < steps; ++i) {
    const double* const f = forces + kForce * i;
    const double y0 = y[0][0], y1 = y[0][1], y2 = y[2 / W][2 % W], y3 = y[3 / W][3 % W];
#pragma GCC unroll 4
    for (std::size_t p = 0; p < kParts; ++p) {
      const D forced = (f[0] * of_force[0][p] + f[1] * of_force[1][p]) +
                       (f[2] * of_force[2][p] + f[3] * of_force[3][p]) +
                       (f[4] * of_force[4][p] + f[5] * of_force[5][p]);
      y[p] = ((y0 * of_state[0][p] + y1 * of_state[1][p]) + (y2 * of_state[2][p] + y3 * of_state[3][p])) + forced;
      store(y[p], states + kState * (i + 1) + W * p);
    }
  }
}

template <std::size_t W>
constexpr PropagatorKernel kKernel = {[](const double* matrix, const double* forces, double* states,
                                         std::size_t steps) { run<W>(matrix, forces, states, steps); }};

}  // namespace
}  // namespace crashsim
