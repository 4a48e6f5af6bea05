#pragma once
/// Objective rating of a model against a test, ISO/TS 18571, and plain errors.

#include <array>
#include <span>
#include <string_view>

#include <crashsim/error.hpp>
#include <crashsim/named_number.hpp>

namespace crashsim {

/// ISO/TS 18571 scores, each 0..1.
struct Rating {
  double overall = kUnset;    ///< R = 0.4 Z + 0.2 (EP + EM + ES).
  double corridor = kUnset;   ///< Z: inside +-5 % of max|reference| 1, outside +-50 % 0, between them a parabola.
  double phase = kUnset;      ///< EP: shift of best Pearson correlation, 1 for none, 0 for 20 % of the length.
  double magnitude = kUnset;  ///< EM: relative L1 distance after the shift and time warping within 10 %, 0 at 0.5.
  double slope = kUnset;      ///< ES: relative L1 distance of the smoothed slopes after the shift, 0 at 2.
};
inline constexpr std::array<NamedNumber<Rating>, 5> kRatingFields = {{
    {"overall", &Rating::overall, "overall rating R"},
    {"corridor", &Rating::corridor, "corridor score Z"},
    {"phase", &Rating::phase, "phase score EP"},
    {"magnitude", &Rating::magnitude, "magnitude score EM"},
    {"slope", &Rating::slope, "slope score ES"},
}};

/// Rates `candidate` against `reference`, sampled alike at `dt_s`. Another rate than the 10 kHz of the standard is
/// brought to it by linear interpolation. Of shifts that correlate equally well the shortest counts, then the
/// candidate's to the left. Where the reference is zero after the shift, or its slope is, an exact match scores 1 and
/// anything else 0.
/// @throws InvalidInput when lengths differ, there are fewer than 10 samples or more than 2 s of them, a value is not
///         finite, dt_s is not > 0 or the reference is zero throughout.
Rating rate(std::span<const double> reference, std::span<const double> candidate, double dt_s);

/// "excellent" (> 0.94), "good" (> 0.80), "fair" (> 0.58), "poor", or "unrated" when `overall` is unset.
std::string_view grade(double overall);

/// Errors of a candidate against a reference on the same samples.
struct ErrorSummary {
  double mean_abs = kUnset;           ///< Mean absolute error [unit of the channel].
  double rms = kUnset;                ///< Root mean square error [unit of the channel].
  double max_abs = kUnset;            ///< Largest absolute error [unit of the channel].
  double mean_abs_relative = kUnset;  ///< mean_abs / max |reference|, unset when the reference is zero throughout.
};
inline constexpr std::array<NamedNumber<ErrorSummary>, 4> kErrorFields = {{
    {"mean_abs", &ErrorSummary::mean_abs, "mean absolute error"},
    {"rms", &ErrorSummary::rms, "root mean square error"},
    {"max_abs", &ErrorSummary::max_abs, "largest absolute error"},
    {"mean_abs_relative", &ErrorSummary::mean_abs_relative, "mean absolute error / largest reference"},
}};

/// @throws InvalidInput when lengths differ, there are no samples or a value is not finite.
ErrorSummary errors(std::span<const double> reference, std::span<const double> candidate);

}  // namespace crashsim
