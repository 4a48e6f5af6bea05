#pragma once
/// The kernel, for the files that compile it for one instruction set each; see instruction_set.hpp.

#include "solver/batch_kernel.hpp"
#include "vector_types.hpp"

namespace crashsim {
namespace {

constexpr int kMostTerms = 16;  // more than an Adams method has

template <std::size_t W, bool HasXv>
[[gnu::noinline]] bool rates_of(const BatchForce& force, const double* y, double* ydot, BatchFlags& outside) {
  using D = typename Vectors<W>::Doubles;
  using I = typename Vectors<W>::Integers;
  std::int64_t any = 0;
  for (std::size_t group = 0; group < kBatchGroups; ++group) {
    I out = I{};
    for (std::size_t i = group * kBatchGroup; i < (group + 1) * kBatchGroup; i += W) {
      const D x = load<D>(y + i), v = load<D>(y + kBatch + i);
      D accel = (load<D>(force.constant + i) + x * (load<D>(force.x1 + i) + x * load<D>(force.x2 + i))) +
                v * (load<D>(force.v1 + i) + v * load<D>(force.v2 + i));
      if constexpr (HasXv) accel += load<D>(force.xv + i) * (x * v);
      store(D(v * load<D>(force.moves + i)), ydot + i);
      store(accel, ydot + kBatch + i);
      out |= (x < load<D>(force.x_low + i)) | (x > load<D>(force.x_high + i)) | (v < load<D>(force.v_low + i)) |
             (v > load<D>(force.v_high + i));
    }
    any |= outside[group] = any_of(out) ? 1 : 0;
  }
  return any != 0;
}

template <std::size_t W>
bool rates(const BatchForce& force, const double* y, double* ydot, BatchFlags& outside) {
  return force.has_xv ? rates_of<W, true>(force, y, ydot, outside) : rates_of<W, false>(force, y, ydot, outside);
}

template <std::size_t W>
bool beyond(const BatchLimits& limits, const double* y, const double* ydot, BatchFlags& flags) {
  using D = typename Vectors<W>::Doubles;
  using I = typename Vectors<W>::Integers;
  std::int64_t any = 0;
  for (std::size_t group = 0; group < kBatchGroups; ++group) {
    I out = I{};
    for (std::size_t i = group * kBatchGroup; i < (group + 1) * kBatchGroup; i += W) {
      const D x = load<D>(y + i), v = load<D>(y + kBatch + i), accel = load<D>(ydot + kBatch + i);
      out |= (x < load<D>(limits.x_low + i)) | (x > load<D>(limits.x_high + i)) | (v < load<D>(limits.v_low + i)) |
             (v > load<D>(limits.v_high + i)) | (accel > load<D>(limits.accel_high + i));
    }
    any |= flags[group] = any_of(out) ? 1 : 0;
  }
  return any != 0;
}

template <std::size_t W>
void linear_sum(double a, const double* x, double b, const double* y, double* z) {
  using D = typename Vectors<W>::Doubles;
  if (a == 1.0 && b == 1.0) {
    for (std::size_t i = 0; i < kBatchLength; i += W) store(D(load<D>(x + i) + load<D>(y + i)), z + i);
    return;
  }
  for (std::size_t i = 0; i < kBatchLength; i += W) store(D(a * load<D>(x + i) + b * load<D>(y + i)), z + i);
}

template <std::size_t W>
void scale(double c, const double* x, double* z) {
  using D = typename Vectors<W>::Doubles;
  for (std::size_t i = 0; i < kBatchLength; i += W) store(D(c * load<D>(x + i)), z + i);
}

template <std::size_t W>
void linear_combination(int count, const double* c, const double* const* x, double* z) {
  using D = typename Vectors<W>::Doubles;
  const double* terms[kMostTerms];
  double factors[kMostTerms];
  int used = 0;
  for (int k = 0; k < count; ++k) {
    if (c[k] == 0.0) continue;
    terms[used] = x[k];
    factors[used++] = c[k];
  }
  for (std::size_t i = 0; i < kBatchLength; i += W) {
    D sum = D{};
    for (int k = 0; k < used; ++k) sum += factors[k] * load<D>(terms[k] + i);
    store(sum, z + i);
  }
}

template <std::size_t W>
void scale_add(int count, const double* a, const double* x, const double* const* y, double* const* z) {
  using D = typename Vectors<W>::Doubles;
  for (int k = 0; k < count; ++k)
    for (std::size_t i = 0; i < kBatchLength; i += W) store(D(a[k] * load<D>(x + i) + load<D>(y[k] + i)), z[k] + i);
}

/// By eight sums, whatever W.
template <std::size_t W>
double weighted_square(const double* x, const double* w) {
  using D = typename Vectors<W>::Doubles;
  D sums[8 / W] = {};
  for (std::size_t i = 0; i < kBatchLength; i += 8)
    for (std::size_t j = 0; j < 8 / W; ++j) {
      const D product = load<D>(x + i + j * W) * load<D>(w + i + j * W);
      sums[j] += product * product;
    }
  double each[8];
  for (std::size_t j = 0; j < 8 / W; ++j) store(sums[j], each + j * W);
  return ((each[0] + each[4]) + (each[1] + each[5])) + ((each[2] + each[6]) + (each[3] + each[7]));
}

template <std::size_t W>
constexpr BatchKernel kKernel = {rates<W>,     beyond<W>,         linear_sum<W>, scale<W>, linear_combination<W>,
                                 scale_add<W>, weighted_square<W>};

}  // namespace
}  // namespace crashsim
