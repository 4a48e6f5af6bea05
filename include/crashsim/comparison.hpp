#pragma once
/// A model's curves against a test's, channel by channel.

#include <array>
#include <string>
#include <vector>

#include <crashsim/error.hpp>
#include <crashsim/options.hpp>
#include <crashsim/rating.hpp>
#include <crashsim/trace.hpp>

namespace crashsim {

/// What to compare.
struct CompareOptions {
  std::vector<std::string> channels;  ///< Names, numbers or globs of reference channels; empty: all that both have.
  double start_s = kUnset;            ///< Start of the comparison [s]; unset: where both have begun.
  double end_s = kUnset;              ///< Its end [s]; unset: where one of them ends.

  bool operator==(const CompareOptions&) const = default;
};
inline constexpr std::array<Field<CompareOptions>, 3> kCompareFields = {{
    {"channels", "channel", "", "channel to compare: name, number or glob; default: all that both have",
     &CompareOptions::channels},
    {"start_s", "start", "s", "start of the comparison; default: where both have begun", &CompareOptions::start_s},
    {"end_s", "end", "s", "end of the comparison; default: where one of them ends", &CompareOptions::end_s},
}};
template <>
inline constexpr std::span<const Field<CompareOptions>> fields<CompareOptions>{kCompareFields};

/// One channel of the comparison, over the samples of the reference.
struct ChannelComparison {
  std::string name;       ///< As the reference calls it.
  std::string unit;       ///< SI symbol of its errors.
  ErrorSummary errors;    ///< Of the candidate against the reference.
  Rating rating;          ///< ISO/TS 18571; unset when it does not apply.
  std::string not_rated;  ///< Why it does not, or empty.
};

/// The whole comparison.
struct Comparison {
  double start_s = kUnset, end_s = kUnset;  ///< Range compared [s].
  double dt_s = kUnset;                     ///< Sampling interval compared at [s].
  std::vector<ChannelComparison> channels;
  std::vector<std::string> notes;  ///< What a careful reader should know.
};

/// One comparison of several.
struct NamedComparison {
  std::string name;  ///< In files: "to_max_crush".
  std::string doc;   ///< For people: "to maximum crush".
  Comparison result;
};

/// One metric of a reference's motion beside the candidate's.
struct MetricComparison {
  std::string name;  ///< As in kMetricFields: "max_crush_m".
  std::string doc;   ///< "maximum dynamic crush".
  double reference = kUnset, candidate = kUnset;
  double difference = kUnset;  ///< (candidate - reference) / |reference|.
};

/// Compares the channels of the same name that both sets have samples of; a unit suffix may differ (`accel_g` and
/// `accel_mps2`). The candidate is interpolated linearly at the reference's samples; a reference with non-uniform steps
/// is first brought to uniform ones.
/// @throws InvalidInput when they have no channel or no time in common, or a channel has a missing value.
Comparison compare(const TraceSet& reference, const TraceSet& candidate, const CompareOptions& options = {});

/// All metrics of two longitudinal motions from time 0 to the end of each, side by side. A set holds one when it has
/// acceleration, velocity and displacement on one clock under those names (`accel_mps2`, `accel_g`, ..), with 3 samples
/// from time 0 on and a velocity > 0 there; empty when one of the sets has none.
/// @throws InvalidInput when a motion has a missing value.
std::vector<MetricComparison> compare_metrics(const TraceSet& reference, const TraceSet& candidate);

/// What is out of balance in the motion that a set holds, as check_balance(), each with the set's path; empty without
/// one. @throws InvalidInput when the motion has a missing value.
std::vector<std::string> check_motion(const TraceSet& set);

}  // namespace crashsim
