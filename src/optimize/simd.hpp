#pragma once
/// Eight doubles at once, by the widest instructions the machine has. Files that use it are built without contraction
/// of a*b + c, so that every instruction set gives bitwise the same numbers.

#include <cstddef>

namespace crashsim {

inline constexpr std::size_t kLanes = 8;

/// GCC's and Clang's vector type: element-wise operators, [] for one lane.
using Lanes [[gnu::vector_size(64)]] = double;

}  // namespace crashsim

// Compiles a function for several instruction sets and chooses when the program is loaded. Sanitizers are not ready
// then.
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define CRASHSIM_WIDEST_VECTORS __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define CRASHSIM_WIDEST_VECTORS
#endif
#define CRASHSIM_INLINE [[gnu::always_inline]] inline
