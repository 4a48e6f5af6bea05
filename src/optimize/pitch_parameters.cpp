#include "optimize/pitch_parameters.hpp"

#include <algorithm>

namespace crashsim {
namespace {

using M = HeavePitchModel;

/// Where a number is sought by default: within a factor of the given one, or in a range that cars and trucks stay
/// within when there is none or the factor is 0.
struct DefaultRange {
  double M::*member;
  double factor, low, high;
};
constexpr DefaultRange kDefaultRanges[] = {
    {&M::mass_kg, 5.0, 200.0, 40e3},
    {&M::pitch_inertia_kgm2, 5.0, 50.0, 200e3},
    {&M::front_axle_m, 4.0, 0.3, 5.0},
    {&M::rear_axle_m, 4.0, 0.3, 5.0},
    {&M::front_stiffness_n_per_m, 20.0, 0.0, 1e6},
    {&M::rear_stiffness_n_per_m, 20.0, 0.0, 1e6},
    {&M::front_damping_ns_per_m, 20.0, 0.0, 1e5},
    {&M::rear_damping_ns_per_m, 20.0, 0.0, 1e5},
    {&M::force_arm_m, 0.0, -5.0, 5.0},
    {&M::cg_height_m, 0.0, 0.0, 2.0},
    {&M::force_height_m, 0.0, 0.0, 2.0},
};

void set_default_bounds(PitchParameter& parameter, double guess) {
  const DefaultRange& range = *std::ranges::find(kDefaultRanges, parameter.member, &DefaultRange::member);
  const bool around_guess = range.factor > 0.0 && guess > 0.0;
  parameter.lower = around_guess ? guess / range.factor : range.low;
  parameter.upper = around_guess ? guess * range.factor : range.high;
}

}  // namespace

std::vector<PitchParameter> pitch_parameters(const HeavePitchModel& guess, const IdentifyPitchOptions& options,
                                             std::vector<std::string>& warnings) {
  return read_sought(guess, {"IdentifyPitchOptions", options.free, options.lower, options.upper}, set_default_bounds,
                     warnings);
}

}  // namespace crashsim
