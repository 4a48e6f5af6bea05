#pragma once
/// Dynamic time warping within a band.

#include <cstddef>
#include <span>
#include <vector>

namespace crashsim {

/// One matched pair of samples.
struct WarpStep {
  std::size_t i;  ///< Index into the first series.
  std::size_t j;  ///< Index into the second series.
};

/// Alignment of two series of equal length that minimises the sum of (a_i - b_j)^2 over steps (1,0), (0,1), (1,1) with
/// |i - j| <= band; from the last pair back to the first. Of equally cheap predecessors (i-1, j) is taken, then
/// (i, j-1). Needs n (2 band + 1) bytes and as many cell updates.
std::vector<WarpStep> warp(std::span<const double> a, std::span<const double> b, std::size_t band);

}  // namespace crashsim
