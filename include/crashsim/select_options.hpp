#pragma once
/// Which models to compare, and how each is identified.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <crashsim/error.hpp>
#include <crashsim/identify_options.hpp>
#include <crashsim/options.hpp>

namespace crashsim {

/// Candidates are all combinations of laws, numbers of knots, placements and curves; those that say the same count
/// once. The other options are identify()'s.
struct SelectOptions {
  std::vector<std::string> laws = {"stiffness", "force", "crush_damping", "rate"};
  std::vector<double> spring_knots = {7.0};            ///< Whole numbers; 0: no spring.
  std::vector<double> damper_knots = {0.0, 1.0, 7.0};  ///< Whole numbers; 0: no damper. Law `rate` has none.
  std::vector<std::string> placements = {"uniform"};   ///< Names of KnotPlacement but `given`.
  std::vector<std::string> curves = {"linear"};        ///< Names of Curve.
  IdentifyMethod method = IdentifyMethod::multistart;
  int starts = 4;  ///< Of each fit; start 0 is the equation-error solution.
  std::uint64_t seed = 1;
  Loss loss = Loss::l1;
  Setting<Weights> weights;  ///< Numbers: three, for all tests.
  double mass_kg = kUnset;   ///< Unset: each pulse's.
  double smooth = 0.0;       ///< Weight of squared second differences of the ordinates.
  double reference_speed_mps = 1.0;
  int jobs = 0;  ///< Threads; 0: all cores. The result does not depend on it.

  bool operator==(const SelectOptions&) const = default;
};
inline constexpr std::array<Field<SelectOptions>, 14> kSelectFields = {{
    {"laws", "law", "", "law: stiffness, force, crush_damping, rate; repeat for several", &SelectOptions::laws},
    {"spring_knots", "spring-knots", "", "numbers of knots of the spring; 0: no spring", &SelectOptions::spring_knots},
    {"damper_knots", "damper-knots", "", "numbers of knots of the damper; 0: no damper", &SelectOptions::damper_knots},
    {"placements", "placement", "", "placement of the knots: uniform, quantile, free; repeat for several",
     &SelectOptions::placements},
    {"curves", "curve", "", "curve between knots: linear, pchip; repeat for several", &SelectOptions::curves},
    {"method", "method", "", "multistart optimisation, or equation error alone", choice<&SelectOptions::method>()},
    {"starts", "starts", "", "starts of each fit; the first is the equation-error solution", &SelectOptions::starts,
     between(1, 1e6)},
    {"seed", "seed", "", "seed of the random starts", &SelectOptions::seed},
    {"loss", "loss", "", "penalty on residuals", choice<&SelectOptions::loss>()},
    {"weights", "weights", "", "weights of acceleration, velocity, displacement", setting<&SelectOptions::weights>()},
    {"mass_kg", "mass", "kg", "test mass; default: each pulse's", &SelectOptions::mass_kg, positive()},
    {"smooth", "smooth", "", "weight of squared second differences of the ordinates", &SelectOptions::smooth,
     at_least(0.0)},
    {"reference_speed_mps", "reference-speed", "m/s", "v_ref of law rate", &SelectOptions::reference_speed_mps,
     positive()},
    {"jobs", "jobs", "", "threads; 0: all cores", &SelectOptions::jobs, between(0, 1024)},
}};
template <>
inline constexpr std::span<const Field<SelectOptions>> fields<SelectOptions>{kSelectFields};

}  // namespace crashsim
