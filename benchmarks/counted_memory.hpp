#pragma once
/// What the program has allocated by new, for benchmarks: counted_memory.cpp replaces the operators.

#include <cstddef>

namespace crashsim::bench {

/// Bytes allocated now.
std::size_t allocated_bytes();

/// The most that were allocated at once since the last call of forget_peak().
std::size_t peak_allocated_bytes();
void forget_peak();

}  // namespace crashsim::bench
