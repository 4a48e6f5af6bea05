#include "dtw.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace crashsim {
namespace {

enum Step : std::uint8_t { from_above, from_left, from_diagonal };

/// Choices of every cell in the band, row by row; cell (i, j) is at column j - i + band.
class StepTable {
 public:
  StepTable(std::size_t rows, std::size_t band) : band_(band), width_(2 * band + 1), steps_(rows * width_) {}
  std::uint8_t* row(std::size_t i) { return steps_.data() + i * width_; }
  [[nodiscard]] std::uint8_t at(std::size_t i, std::size_t j) const { return steps_[i * width_ + j + band_ - i]; }

 private:
  std::size_t band_, width_;
  std::vector<std::uint8_t> steps_;
};

StepTable fill(std::span<const double> a, std::span<const double> b, std::size_t band) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const std::size_t n = a.size();
  const std::size_t width = 2 * band + 1;
  StepTable table(n, band);
  // Cost of the row above, overwritten from the left: (i-1, j) is one column right of (i, j), (i-1, j-1) in its column.
  std::vector<double> cost(width + 1, kNever);
  cost[band] = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t first = i > band ? 0 : band - i;
    const std::size_t last = std::min(width, n + band - i);
    std::uint8_t* const steps = table.row(i);
    double left = kNever;
    for (std::size_t c = first; c < last; ++c) {
      const double diagonal = cost[c];
      double best = cost[c + 1];
      std::uint8_t step = from_above;
      if (left < best) {
        best = left;
        step = from_left;
      }
      if (diagonal < best) {
        best = diagonal;
        step = from_diagonal;
      }
      const double gap = a[i] - b[i + c - band];
      left = best + gap * gap;
      cost[c] = left;
      steps[c] = step;
    }
  }
  return table;
}

}  // namespace

std::vector<WarpStep> warp(std::span<const double> a, std::span<const double> b, std::size_t band) {
  band = std::min(band, a.size() - 1);
  const StepTable table = fill(a, b, band);
  WarpStep at{a.size() - 1, a.size() - 1};
  std::vector<WarpStep> path{at};
  while (at.i > 0 || at.j > 0) {
    const std::uint8_t step = table.at(at.i, at.j);
    if (step != from_left) --at.i;
    if (step != from_above) --at.j;
    path.push_back(at);
  }
  return path;
}

}  // namespace crashsim
