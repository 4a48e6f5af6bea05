#pragma once
/// From a raw channel to a clean one: bias, time zero, channel frequency class filters, resampling, integration.

#include <span>
#include <string_view>
#include <vector>

#include <crashsim/options.hpp>

namespace crashsim {

/// Which definition of the channel frequency class filter.
enum class CfcStandard { j211, iso6487 };
inline constexpr std::string_view kCfcStandardNames[] = {"j211", "iso6487"};
template <>
inline constexpr std::span<const std::string_view> enum_names<CfcStandard>{kCfcStandardNames};

/// Second-order section y_i = b0 x_i + b1 x_(i-1) + b2 x_(i-2) + a1 y_(i-1) + a2 y_(i-2).
struct CfcCoefficients {
  double b0, b1, b2, a1, a2;
};

/// Two-pole Butterworth section of a channel frequency class, SAE J211-1 appendix C or ISO 6487 annex A.
/// @param cfc channel frequency class [Hz], e.g. 60, 180, 600, 1000.
/// @param dt_s sampling interval [s]; 1/dt_s >= 10 cfc.
/// @throws InvalidInput when the rate is too low for the class.
CfcCoefficients cfc_coefficients(double cfc, double dt_s, CfcStandard standard = CfcStandard::j211);

/// Phaseless filter: the section run forward, then backward, over the signal padded at both ends by odd mirror images
/// of 10 ms (at least 100 samples where there are as many).
/// @throws InvalidInput when the rate is too low for the class or there are fewer than 3 samples.
std::vector<double> cfc_filter(std::span<const double> values, double dt_s, double cfc,
                               CfcStandard standard = CfcStandard::j211);

/// Running integral by trapezoids, starting at `initial`; as many values as samples.
std::vector<double> integrate(std::span<const double> time_s, std::span<const double> values, double initial);

/// Derivative by central differences on any grid, one-sided at the ends; exact for parabolas inside.
/// @throws InvalidInput with fewer than 2 samples.
std::vector<double> differentiate(std::span<const double> time_s, std::span<const double> values);

/// Linear interpolation at `at` (increasing, inside the range of time_s).
std::vector<double> resample(std::span<const double> time_s, std::span<const double> values,
                             std::span<const double> at);

/// `count` times start, start + dt, ...
std::vector<double> uniform_times(double start_s, double dt_s, std::size_t count);

/// Mean sampling interval [s] when all steps agree with it within 2 % (text files round their times), else kUnset.
double uniform_step(std::span<const double> time_s);

/// Mean of the samples with from_s <= t < to_s. @throws InvalidInput when there are none.
double mean_between(std::span<const double> time_s, std::span<const double> values, double from_s, double to_s);

/// Time zero [s]: the first sample with |a| >= 5 g, walked back to the last one below 0.5 g.
/// @throws InvalidInput when the trace never reaches 5 g.
double find_time_zero(std::span<const double> time_s, std::span<const double> accel_mps2);

/// @throws InvalidInput naming `what` and the sample when a value is not finite, times do not increase strictly, the
///         lengths differ or there are fewer than `minimum` samples.
void check_series(std::span<const double> time_s, std::span<const double> values, std::string_view what,
                  std::size_t minimum = 3);

}  // namespace crashsim
