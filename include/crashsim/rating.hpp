#pragma once
/// Objective rating of a model against a test, ISO/TS 18571.

#include <span>
#include <string_view>

#include <crashsim/error.hpp>

namespace crashsim {

/// ISO/TS 18571 scores, each 0..1.
struct Rating {
  double overall = kUnset;    ///< R = 0.4 Z + 0.2 (EP + EM + ES).
  double corridor = kUnset;   ///< Z.
  double phase = kUnset;      ///< EP.
  double magnitude = kUnset;  ///< EM.
  double slope = kUnset;      ///< ES.
};

/// Rates `candidate` against `reference`, sampled alike at `dt_s`; both are brought to 10 kHz first when they are not.
/// @throws InvalidInput when lengths differ, there are fewer than 10 samples, a value is not finite, or the reference
/// is
///         zero throughout.
Rating rate(std::span<const double> reference, std::span<const double> candidate, double dt_s);

/// "excellent" (> 0.94), "good" (> 0.80), "fair" (> 0.58) or "poor".
std::string_view grade(double overall);

/// Errors of a candidate against a reference on the same samples.
struct ErrorSummary {
  double mean_abs = kUnset;           ///< Mean absolute error [unit of the channel].
  double rms = kUnset;                ///< Root mean square error [unit of the channel].
  double max_abs = kUnset;            ///< Largest absolute error [unit of the channel].
  double mean_abs_relative = kUnset;  ///< mean_abs / max |reference|.
};
ErrorSummary errors(std::span<const double> reference, std::span<const double> candidate);

}  // namespace crashsim
