#pragma once
/// What to design, and how.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <crashsim/error.hpp>
#include <crashsim/options.hpp>

namespace crashsim {

/// What is minimised or limited.
enum class DesignQuantity {
  none,
  pitch,      ///< Largest pitch, nose down [rad].
  drop,       ///< Largest drop of the centre of gravity, -heave_min_m [m].
  max_crush,  ///< Maximum crush [m].
  olc,        ///< Occupant load criterion [g of 9.81].
  peak_decel  ///< Peak deceleration [g].
};
inline constexpr std::string_view kDesignQuantityNames[] = {"none", "pitch", "drop", "max_crush", "olc", "peak_decel"};
template <>
inline constexpr std::span<const std::string_view> enum_names<DesignQuantity>{kDesignQuantityNames};

/// Parameters of a coupled model, their ranges, the goal and its limits.
///
/// A parameter is a number of HeavePitchModel or VerticalForceLaw by name or flag (`force_height`, `angle`), or an
/// ordinate of the crush curves: `k1`, `k2`, .. of the spring, `c1`, `c2`, .. of the damper, in the order of the knots.
struct DesignOptions {
  std::vector<std::string> parameters;              ///< At least one.
  std::vector<std::string> lower;                   ///< Lower bounds, each with a unit or in SI: "450 mm", "0.45".
  std::vector<std::string> upper;                   ///< Upper bounds.
  DesignQuantity minimise = DesignQuantity::pitch;  ///< `none`: sensitivities alone.
  double max_pitch_rad = kUnset;                    ///< Limits; unset: none.
  double max_drop_m = kUnset;
  double max_crush_m = kUnset;
  double max_olc_g = kUnset;
  double max_peak_decel_g = kUnset;
  DesignQuantity trade_off = DesignQuantity::none;  ///< Whose limit varies along the trade-off curve.
  std::vector<std::string> trade_off_limits;        ///< Its limits with a unit or in SI; "0.5 m..0.7 m:5": 5 limits.
  int starts = 4;                                   ///< Optimisations from different designs; the first is the model.
  std::uint64_t seed = 1;
  int jobs = 0;  ///< Threads; 0: all cores. The result does not depend on it.

  bool operator==(const DesignOptions&) const = default;
};
inline constexpr std::array<Field<DesignOptions>, 14> kDesignFields = {{
    {"parameters", "parameters", "",
     "what may change: keys of [vehicle], angle and friction of [pitch], or ordinates k1, .. and c1, .. of the model",
     &DesignOptions::parameters},
    {"lower", "lower", "", "their lower bounds, each with a unit or in SI", &DesignOptions::lower},
    {"upper", "upper", "", "their upper bounds", &DesignOptions::upper},
    {"minimise", "minimise", "", "what to minimise; none: sensitivities alone", choice<&DesignOptions::minimise>()},
    {"max_pitch_rad", "max-pitch", "rad", "limit of the largest pitch", &DesignOptions::max_pitch_rad, positive()},
    {"max_drop_m", "max-drop", "m", "limit of the drop of the centre of gravity", &DesignOptions::max_drop_m,
     positive()},
    {"max_crush_m", "max-crush", "m", "limit of the maximum crush", &DesignOptions::max_crush_m, positive()},
    {"max_olc_g", "max-olc", "", "limit of the occupant load criterion in g", &DesignOptions::max_olc_g, positive()},
    {"max_peak_decel_g", "max-peak-decel", "", "limit of the peak deceleration in g", &DesignOptions::max_peak_decel_g,
     positive()},
    {"trade_off", "trade-off", "", "whose limit varies along the trade-off curve", choice<&DesignOptions::trade_off>()},
    {"trade_off_limits", "trade-off-limits", "", "its limits, each with a unit or in SI, or a range \"0.5 m..0.7 m:5\"",
     &DesignOptions::trade_off_limits},
    {"starts", "starts", "", "optimisations from different designs; the first is the given one", &DesignOptions::starts,
     between(1, 1e4)},
    {"seed", "seed", "", "seed of the random starts", &DesignOptions::seed},
    {"jobs", "jobs", "", "threads; 0: all cores", &DesignOptions::jobs, between(0, 1024)},
}};
template <>
inline constexpr std::span<const Field<DesignOptions>> fields<DesignOptions>{kDesignFields};

}  // namespace crashsim
