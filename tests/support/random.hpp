#pragma once
/// Random numbers that are the same on every platform.

#include <cstdint>
#include <random>

namespace crashsim::test {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Uniform on [low, high).
  double between(double low, double high) {
    constexpr int kDroppedBits = 11;  // a double holds 53 of the 64
    return low + (high - low) * static_cast<double>(engine_() >> kDroppedBits) * 0x1p-53;
  }
  /// Uniform among low, low + 1, ... high.
  int whole(int low, int high) { return low + static_cast<int>(between(0.0, high - low + 1.0)); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace crashsim::test
