#pragma once
/// Points of the unit cube to sample a model at. Each depends on the design, the seed and its index only, so any can be
/// had alone: by any thread, on any machine, after any restart.

#include <cstdint>
#include <string_view>
#include <vector>

#include <crashsim/options.hpp>

namespace crashsim {

/// How the points are spread.
enum class SampleMethod {
  random,           ///< Independently.
  latin_hypercube,  ///< One in each of as many slices as there are points, along every dimension.
  sobol,            ///< Sobol's sequence with a random digital shift.
  saltelli          ///< Points of `sobol` in groups from which Sobol' indices follow, first order and total.
};
inline constexpr std::string_view kSampleMethodNames[] = {"random", "latin_hypercube", "sobol", "saltelli"};
template <>
inline constexpr std::span<const std::string_view> enum_names<SampleMethod>{kSampleMethodNames};

/// Dimensions of Sobol's sequence here; `saltelli` uses two for each of its own.
inline constexpr int kMostSobolDimensions = 128;

/// Point `index` of Sobol's sequence in [0, 1): in the order of Gray codes, direction numbers of Joe and Kuo (2008).
/// The first point is 0.
/// @throws InvalidInput when there are more than kMostSobolDimensions or index is not below 2^32.
std::vector<double> sobol_point(std::uint64_t index, int dimensions);

/// Where `index` goes in a random order of 0 .. count-1 that depends on (seed, stream) only.
std::uint64_t permuted(std::uint64_t index, std::uint64_t count, std::uint64_t seed, std::uint64_t stream);

/// Points to sample at.
struct SampleDesign {
  SampleMethod method = SampleMethod::sobol;
  int samples = 1024;  ///< Points; of `saltelli` groups of points.
  std::uint64_t seed = 1;
  int dimensions = 1;
};

/// Points of a design: of `saltelli` samples * (dimensions + 2).
std::uint64_t point_count(const SampleDesign& design);

/// Point `index` of a design, each coordinate inside (0, 1). `saltelli`: of a group with two points a and b, first a,
/// then b, then for each dimension a with this coordinate from b.
/// @throws InvalidInput when the index is not below point_count() or Sobol's sequence has too few dimensions.
std::vector<double> sample_point(const SampleDesign& design, std::uint64_t index);

}  // namespace crashsim
