#pragma once
/// Pairs of pulses that C++ and tests/support/iso18571_reference.py make alike, bit for bit: only + - * / on doubles
/// made from a 64-bit congruential generator.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crashsim::test {

struct RatingPair {
  std::vector<double> reference, candidate;
};

/// Uniform numbers on [0, 1).
class Congruential {
 public:
  explicit Congruential(std::uint64_t seed) : state_(seed) {
    for (int i = 0; i < 8; ++i) next();
  }
  double next() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state_ >> 11) / 9007199254740992.0;
  }
  double between(double low, double high) { return low + (high - low) * next(); }

 private:
  std::uint64_t state_;
};

/// Adds noise of the given amplitude, smoothed over 5 samples.
inline void add_noise(std::vector<double>& values, double amplitude, Congruential& random) {
  std::vector<double> raw(values.size() + 4);
  for (double& value : raw) value = random.between(-amplitude, amplitude);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = values[i] + (raw[i] + raw[i + 1] + raw[i + 2] + raw[i + 3] + raw[i + 4]) / 5.0;
}

/// Pair number `seed`: four bumps (1 - z^2)^2 each with noise; the candidate's are scaled, shifted and stretched.
inline RatingPair rating_pair(std::uint64_t seed) {
  Congruential random(seed);
  const auto n = static_cast<std::size_t>(random.between(120.0, 1600.0));
  const auto length = static_cast<double>(n);
  const double scale = random.between(0.6, 1.4);
  const double shift = random.between(-0.12, 0.12) * length;
  const double stretch = random.between(0.8, 1.25);
  RatingPair pair{std::vector<double>(n, 0.0), std::vector<double>(n, 0.0)};
  for (int bump = 0; bump < 4; ++bump) {
    const double height = random.between(-400.0, 100.0);
    const double centre = random.between(0.2, 0.8) * length;
    const double width = random.between(0.1, 0.35) * length;
    for (std::size_t i = 0; i < n; ++i) {
      const auto t = static_cast<double>(i);
      const double z = (t - centre) / width;
      if (z * z < 1.0) pair.reference[i] = pair.reference[i] + height * (1.0 - z * z) * (1.0 - z * z);
      const double y = (t - shift - centre) / (width * stretch);
      if (y * y < 1.0) pair.candidate[i] = pair.candidate[i] + scale * height * (1.0 - y * y) * (1.0 - y * y);
    }
  }
  add_noise(pair.reference, 10.0, random);
  add_noise(pair.candidate, 10.0, random);
  return pair;
}

}  // namespace crashsim::test
