#pragma once
/// Vectors of doubles for kernels; only for files that are compiled for one instruction set each.

#include <cstddef>
#include <cstdint>

#define CRASHSIM_INLINE [[gnu::always_inline]] inline

namespace crashsim {
namespace {

/// W doubles, and as many integers of their size; comparisons give -1 where true.
template <std::size_t W>
struct Vectors {
  using Doubles [[gnu::vector_size(8 * W)]] = double;
  using Integers [[gnu::vector_size(8 * W)]] = std::int64_t;
};

template <class T>
CRASHSIM_INLINE T load(const double* numbers) {
  T out;
  __builtin_memcpy(&out, numbers, sizeof(T));
  return out;
}
template <class T>
CRASHSIM_INLINE void store(const T& value, double* numbers) {
  __builtin_memcpy(numbers, &value, sizeof(T));
}

template <class I>
CRASHSIM_INLINE bool any_of(const I& mask) {
  std::int64_t any = 0;
  for (std::size_t l = 0; l < sizeof(I) / sizeof(any); ++l) any |= mask[l];
  return any != 0;
}

template <class D>
CRASHSIM_INLINE D size_of(const D& number) {
  return number < 0.0 ? -number : number;
}

}  // namespace
}  // namespace crashsim
