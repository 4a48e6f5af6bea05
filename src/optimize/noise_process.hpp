#pragma once
/// The noise of a measured acceleration as a stationary process.

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace crashsim {

/// Stationary noise of mean 0 on evenly spaced samples.
struct NoiseProcess {
  std::vector<double> autocovariance;  ///< [(m/s^2)^2] at lags of 0, 1, .. samples; 0 beyond.

  [[nodiscard]] double deviation() const;  ///< Standard deviation [m/s^2].
};

/// Lag beyond which the autocorrelation of a residual is no more than chance (Politis, 2003): the first after which
/// five in a row are within two standard errors, which Bartlett's formula says of the lags before. 0: white.
std::size_t correlation_lag(std::span<const double> residual);

/// Autocovariance of a residual about 0, tapered by Parzen's window of three correlation lags, so that its spectrum is
/// nowhere negative.
/// @param freedom n / (n - p): what the fit of p numbers has taken from the residual's squares.
NoiseProcess estimate_noise(std::span<const double> residual, double freedom);

/// G' Gamma G, Gamma the covariance matrix of as many samples of the noise as G has rows: covariance of G' noise.
Eigen::MatrixXd covariance_of_sums(const NoiseProcess& noise, const Eigen::MatrixXd& g);

/// `count` samples of the noise that depend on (seed, stream) only.
std::vector<double> draw_noise(const NoiseProcess& noise, std::size_t count, std::uint64_t seed, std::uint64_t stream);

/// Standard normal number that depends on (seed, stream, index) only.
double normal_random(std::uint64_t seed, std::uint64_t stream, std::uint64_t index);

}  // namespace crashsim
