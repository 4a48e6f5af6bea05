#pragma once
/// Random numbers without a generator's state: each depends on its place only, whoever asks first.

#include <cstdint>

namespace crashsim {

/// 64 random bits that depend on (seed, stream, index) only.
std::uint64_t random_bits(std::uint64_t seed, std::uint64_t stream, std::uint64_t index);

/// Uniform number in [0, 1) that depends on (seed, stream, index) only.
inline double uniform_random(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  return static_cast<double>(random_bits(seed, stream, index) >> 11) * 0x1.0p-53;
}

}  // namespace crashsim
