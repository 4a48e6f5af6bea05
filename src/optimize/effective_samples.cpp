#include "optimize/effective_samples.hpp"

#include <algorithm>
#include <cstddef>

namespace crashsim {

double effective_samples(std::span<const double> residuals) {
  const std::size_t n = residuals.size();
  const auto covariance = [&](std::size_t lag) {
    double sum = 0.0;
    for (std::size_t i = 0; i + lag < n; ++i) sum += residuals[i] * residuals[i + lag];
    return sum;
  };
  const double variance = covariance(0);
  const auto count = static_cast<double>(n);
  if (!(variance > 0.0)) return count;
  double sum = -0.5;  // the pair of lags 0 and 1 holds the whole variance, the sum half of it
  for (std::size_t lag = 0; lag + 1 < n; lag += 2) {
    const double pair = (covariance(lag) + covariance(lag + 1)) / variance;
    if (pair <= 0.0) break;
    sum += pair;
  }
  return std::clamp(count / std::max(2.0 * sum, 1e-300), 1.0, count);
}

}  // namespace crashsim
