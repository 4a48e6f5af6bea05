#include <crashsim/sampling.hpp>

#include <algorithm>
#include <array>
#include <bit>

#include <fmt/format.h>

#include <crashsim/error.hpp>

#include "random.hpp"
#include "sobol_table.hpp"

namespace crashsim {
namespace {

constexpr int kSobolBits = 32;
static_assert(std::size(kSobolTable) + 1 == kMostSobolDimensions);

using Directions = std::array<std::uint32_t, kSobolBits>;

/// Direction numbers v_j = m_j 2^(32 - j), by the recurrence of the polynomial x^s + a_1 x^(s-1) + .. + 1:
///     v_j = a_1 v_(j-1) ^ .. ^ a_(s-1) v_(j-s+1) ^ v_(j-s) ^ (v_(j-s) >> s)
Directions directions_of(const SobolDimension& dimension) {
  const int degree = static_cast<int>(std::bit_width(dimension.polynomial)) - 1;
  Directions v{};
  for (int j = 0; j < kSobolBits; ++j) {
    const auto at = static_cast<std::size_t>(j);
    if (j < degree) {
      v[at] = dimension.m[at] << (kSobolBits - 1 - j);
      continue;
    }
    const auto back = [&](int steps) { return v[static_cast<std::size_t>(j - steps)]; };
    v[at] = back(degree) ^ (back(degree) >> degree);
    for (int i = 1; i < degree; ++i)
      if ((dimension.polynomial >> (degree - i) & 1U) != 0) v[at] ^= back(i);
  }
  return v;
}

std::vector<Directions> all_directions() {
  std::vector<Directions> all(kMostSobolDimensions);
  for (int j = 0; j < kSobolBits; ++j) all[0][static_cast<std::size_t>(j)] = 1U << (kSobolBits - 1 - j);
  for (std::size_t i = 1; i < all.size(); ++i) all[i] = directions_of(kSobolTable[i - 1]);
  return all;
}

/// Coordinate of a point of Sobol's sequence as an integer of 32 bits.
std::uint32_t sobol_bits(std::uint64_t index, int dimension) {
  static const std::vector<Directions> directions = all_directions();
  const Directions& v = directions[static_cast<std::size_t>(dimension)];
  std::uint32_t bits = 0;
  std::uint64_t gray = index ^ (index >> 1);
  for (std::size_t j = 0; gray != 0; ++j, gray >>= 1)
    if ((gray & 1U) != 0) bits ^= v[j];
  return bits;
}

void check_sobol(std::uint64_t index, int dimensions) {
  if (dimensions > kMostSobolDimensions)
    throw InvalidInput(fmt::format("Sobol's sequence has {} dimensions here, {} are needed: use latin_hypercube",
                                   kMostSobolDimensions, dimensions));
  if (index >> kSobolBits != 0)
    throw InvalidInput(fmt::format("Sobol's sequence has 2^{} points here: there is no point {}", kSobolBits, index));
}

/// Streams of random numbers: each dimension has its own of every kind.
enum class Stream : std::uint64_t { uniform, order, shift };
std::uint64_t stream_of(Stream kind, int dimension) {
  return static_cast<std::uint64_t>(dimension) * 4 + static_cast<std::uint64_t>(kind);
}

double inside(double uniform) { return std::max(uniform, 0x1.0p-54); }  // of [0, 1): not 0

/// The coordinate, shifted: every digit that the sequence has, or has not, flipped at random.
double shifted_sobol(std::uint64_t index, int dimension, std::uint64_t seed) {
  constexpr int kBits = 53;  // of a double
  const std::uint64_t shift = random_bits(seed, stream_of(Stream::shift, dimension), 0) >> (64 - kBits);
  const std::uint64_t bits = (static_cast<std::uint64_t>(sobol_bits(index, dimension)) << (kBits - kSobolBits)) ^ shift;
  return inside(static_cast<double>(bits) * 0x1.0p-53);
}

double coordinate(const SampleDesign& design, std::uint64_t index, int dimension) {
  if (design.method == SampleMethod::sobol) return shifted_sobol(index, dimension, design.seed);
  const double uniform = uniform_random(design.seed, stream_of(Stream::uniform, dimension), index);
  if (design.method == SampleMethod::random) return inside(uniform);
  const auto count = static_cast<std::uint64_t>(design.samples);
  const std::uint64_t slice = permuted(index, count, design.seed, stream_of(Stream::order, dimension));
  return inside(std::min((static_cast<double>(slice) + uniform) / design.samples, 1.0 - 0x1.0p-53));
}

}  // namespace

std::vector<double> sobol_point(std::uint64_t index, int dimensions) {
  check_sobol(index, dimensions);
  std::vector<double> point;
  for (int i = 0; i < dimensions; ++i) point.push_back(static_cast<double>(sobol_bits(index, i)) * 0x1.0p-32);
  return point;
}

/// A Feistel network permutes the numbers of an even number of bits; what falls beyond `count` is permuted again.
std::uint64_t permuted(std::uint64_t index, std::uint64_t count, std::uint64_t seed, std::uint64_t stream) {
  constexpr std::uint64_t kRounds = 8;
  const int half = std::max((static_cast<int>(std::bit_width(count - 1)) + 1) / 2, 1);
  const std::uint64_t mask = (std::uint64_t{1} << half) - 1;
  do {
    std::uint64_t left = index >> half, right = index & mask;
    for (std::uint64_t round = 0; round < kRounds; ++round) {
      const std::uint64_t mixed = left ^ (random_bits(seed, stream, right * kRounds + round) >> 32 & mask);
      left = right;
      right = mixed;
    }
    index = left << half | right;
  } while (index >= count);
  return index;
}

std::uint64_t point_count(const SampleDesign& design) {
  const auto samples = static_cast<std::uint64_t>(design.samples);
  const bool in_groups = design.method == SampleMethod::saltelli;
  return in_groups ? samples * (static_cast<std::uint64_t>(design.dimensions) + 2) : samples;
}

std::vector<double> sample_point(const SampleDesign& design, std::uint64_t index) {
  if (index >= point_count(design))
    throw InvalidInput(fmt::format("there are {} samples: there is no sample {}", point_count(design), index));
  const int count = design.dimensions;
  std::vector<double> point;
  if (design.method != SampleMethod::saltelli) {
    if (design.method == SampleMethod::sobol) check_sobol(index, count);
    for (int i = 0; i < count; ++i) point.push_back(coordinate(design, index, i));
    return point;
  }
  const auto size = static_cast<std::uint64_t>(count) + 2;
  const std::uint64_t group = index / size, member = index % size;
  check_sobol(group, 2 * count);
  for (int i = 0; i < count; ++i) {
    const bool is_b = member == 1 || member == static_cast<std::uint64_t>(i) + 2;
    point.push_back(shifted_sobol(group, is_b ? count + i : i, design.seed));
  }
  return point;
}

}  // namespace crashsim
