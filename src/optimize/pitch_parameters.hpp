#pragma once
/// Numbers of a heave-pitch model that are sought, and the range in which they are.

#include <span>
#include <string>
#include <vector>

#include <crashsim/identify_pitch.hpp>

namespace crashsim {

/// One number of the model, sought between bounds: evenly on a logarithmic scale when both are positive, else evenly.
struct PitchParameter {
  const Field<HeavePitchModel>* field = nullptr;
  double HeavePitchModel::*member = nullptr;
  double lower = kUnset, upper = kUnset;
  double first = kUnset;  ///< Value of start 0.

  [[nodiscard]] bool is_logarithmic() const { return lower > 0.0; }
  /// Value at a place 0..1 between the bounds.
  [[nodiscard]] double value_at(double place) const;
  /// Derivative of value_at() where it has this value.
  [[nodiscard]] double slope_at(double value) const;
  [[nodiscard]] double place_of(double value) const;
};

/// Reads options.free with its bounds. Notes in `warnings` where the given model lies outside.
/// @throws InvalidInput naming the name or bound that is not allowed.
std::vector<PitchParameter> pitch_parameters(const HeavePitchModel& guess, const IdentifyPitchOptions& options,
                                             std::vector<std::string>& warnings);

/// The model with these numbers.
HeavePitchModel with_values(const HeavePitchModel& model, std::span<const PitchParameter> parameters,
                            std::span<const double> values);

}  // namespace crashsim
