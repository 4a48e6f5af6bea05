#include "shown_number.hpp"

#include <cmath>

#include <fmt/format.h>

namespace crashsim::cli {
namespace {

constexpr Shown kShown[] = {
    // the longest suffix first
    {"_ns_per_m", 1e-3, "kN s/m"},
    {"_ns", 1.0, "N s"},
    {"_n_per_m", 1e-3, "kN/m"},
    {"_rad_per_m", 1.0, "rad/m"},
    {"_kgm2", 1.0, "kg m^2"},
    {"_mps2", 1.0, "m/s^2"},
    {"_mps", 1.0, "m/s"},
    {"_kg", 1.0, "kg"},
    {"_rad", 1.0, "rad"},
    {"_m", 1e3, "mm"},
    {"_s", 1e3, "ms"},
    {"_g", 1.0, "g"},
    {"_n", 1e-3, "kN"},
    {"_j", 1e-3, "kJ"},
};

}  // namespace

Shown shown_as(std::string_view name) {
  for (const Shown& shown : kShown)
    if (name.ends_with(shown.suffix)) return shown;
  return {"", 1.0, ""};
}

std::string shown_number(std::string_view name, double value) {
  if (std::isnan(value)) return "-";
  if (name == "seconds") return fmt::format("{:.3g} s", value);
  const Shown shown = shown_as(name);
  return fmt::format("{:.5g}{}{}", value * shown.factor, shown.unit.empty() ? "" : " ", shown.unit);
}

}  // namespace crashsim::cli
