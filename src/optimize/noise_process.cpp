#include "optimize/noise_process.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>

#include <unsupported/Eigen/FFT>

#include <crashsim/distribution.hpp>

#include "random.hpp"

namespace crashsim {
namespace {

using Eigen::Index;

constexpr std::size_t kShortestTail = 5;  // lags within chance that end the search
constexpr std::size_t kLargestShare = 8;  // of the samples: longer lags have too few pairs
constexpr std::size_t kWindow = 3;        // Parzen's window in correlation lags
constexpr double kChance = 2.0;           // standard errors

double autocovariance(std::span<const double> residual, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t i = 0; i + lag < residual.size(); ++i) sum += residual[i] * residual[i + lag];
  return sum / static_cast<double>(residual.size());
}

double parzen(double z) {
  if (z <= 0.5) return 1.0 - 6.0 * z * z * (1.0 - z);
  return z < 1.0 ? 2.0 * std::pow(1.0 - z, 3) : 0.0;
}

/// Spectrum of the noise on a circle that `count` samples and the lags after them fit on: its covariance matrix is
/// there diagonal, and among those samples what it is on a line.
class Circle {
 public:
  Circle(const NoiseProcess& noise, std::size_t count)
      : size_(static_cast<Index>(std::bit_ceil(count + noise.autocovariance.size()))) {
    fft_.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    Eigen::VectorXd circle = Eigen::VectorXd::Zero(size_);
    for (std::size_t lag = 0; lag < noise.autocovariance.size(); ++lag)
      circle[static_cast<Index>(lag)] = circle[lag == 0 ? 0 : size_ - static_cast<Index>(lag)] =
          noise.autocovariance[lag];
    spectrum_ = transform(circle).real().cwiseMax(0.0);
  }

  [[nodiscard]] Index size() const { return size_; }
  [[nodiscard]] const Eigen::VectorXd& spectrum() const { return spectrum_; }  ///< From frequency 0 to the largest.

  /// Half spectrum of samples, with zeros to the end of the circle.
  Eigen::VectorXcd transform(const Eigen::VectorXd& samples) {
    Eigen::VectorXd padded = Eigen::VectorXd::Zero(size_);
    padded.head(samples.size()) = samples;
    Eigen::VectorXcd half;
    fft_.fwd(half, padded);
    return half;
  }

  Eigen::VectorXd inverse(const Eigen::VectorXcd& half) {
    Eigen::VectorXd samples;
    fft_.inv(samples, half, size_);
    return samples;
  }

 private:
  Eigen::FFT<double> fft_;
  Index size_;
  Eigen::VectorXd spectrum_;
};

}  // namespace

double NoiseProcess::deviation() const { return autocovariance.empty() ? 0.0 : std::sqrt(autocovariance.front()); }

std::size_t correlation_lag(std::span<const double> residual) {
  const double variance = autocovariance(residual, 0);
  if (!(variance > 0.0)) return 0;
  const std::size_t most = residual.size() / kLargestShare;
  double squares = 1.0;  // 1 + 2 sum rho^2 over the lags before
  std::size_t lag = 0;   // the last beyond chance
  for (std::size_t i = 1; i <= most && i <= lag + kShortestTail; ++i) {
    const double rho = autocovariance(residual, i) / variance;
    if (std::fabs(rho) <= kChance * std::sqrt(squares / static_cast<double>(residual.size()))) continue;
    lag = i;
    squares += 2.0 * rho * rho;
  }
  return lag;
}

NoiseProcess estimate_noise(std::span<const double> residual, double freedom) {
  const std::size_t lags = kWindow * correlation_lag(residual) + 1;
  NoiseProcess noise;
  for (std::size_t lag = 0; lag < std::min(lags, residual.size()); ++lag)
    noise.autocovariance.push_back(freedom * autocovariance(residual, lag) *
                                   parzen(static_cast<double>(lag) / static_cast<double>(lags)));
  return noise;
}

Eigen::MatrixXd covariance_of_sums(const NoiseProcess& noise, const Eigen::MatrixXd& g) {
  Circle circle(noise, static_cast<std::size_t>(g.rows()));
  const Index half = circle.spectrum().size();
  Eigen::MatrixXd parts(2 * half, g.cols());  // real and imaginary, such that their products are the covariance
  for (Index j = 0; j < g.cols(); ++j) {
    const Eigen::VectorXcd transformed = circle.transform(g.col(j));
    for (Index k = 0; k < half; ++k) {
      const bool is_alone = k == 0 || 2 * k == circle.size();
      const double weight =
          std::sqrt((is_alone ? 1.0 : 2.0) * circle.spectrum()[k] / static_cast<double>(circle.size()));
      parts(2 * k, j) = weight * transformed[k].real();
      parts(2 * k + 1, j) = weight * transformed[k].imag();
    }
  }
  return parts.transpose() * parts;
}

std::vector<double> draw_noise(const NoiseProcess& noise, std::size_t count, std::uint64_t seed, std::uint64_t stream) {
  Circle circle(noise, count);
  const Index half = circle.spectrum().size();
  const auto size = static_cast<double>(circle.size());
  Eigen::VectorXcd waves(half);
  for (Index k = 0; k < half; ++k) {
    const bool is_alone = k == 0 || 2 * k == circle.size();
    const double amplitude = std::sqrt(circle.spectrum()[k] * size * (is_alone ? 1.0 : 0.5));
    const auto index = static_cast<std::uint64_t>(2 * k);
    const double real = normal_random(seed, stream, index);
    waves[k] = amplitude * std::complex<double>(real, is_alone ? 0.0 : normal_random(seed, stream, index + 1));
  }
  const Eigen::VectorXd samples = circle.inverse(waves);
  return {samples.data(), samples.data() + count};
}

double normal_random(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  const auto bits = static_cast<double>(random_bits(seed, stream, index) >> 12);
  return normal_quantile((bits + 0.5) * 0x1p-52);  // never 0 nor 1, whose quantiles are infinite
}

}  // namespace crashsim
