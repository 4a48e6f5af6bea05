#include "io/unit_system.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "text.hpp"

namespace crashsim::io {
namespace {

struct Named {
  std::string_view name;
  UnitSystem system;
};
constexpr Named kSystems[] = {{"kg-m-s", {1.0, 1.0, 1.0}},     {"t-mm-s", {1e3, 1e-3, 1.0}},
                              {"kg-mm-ms", {1.0, 1e-3, 1e-3}}, {"g-mm-ms", {1e-3, 1e-3, 1e-3}},
                              {"Mg-mm-s", {1e3, 1e-3, 1.0}},   {"SI", {1.0, 1.0, 1.0}}};

/// Exponents of mass, length and time.
struct Exponents {
  int mass, length, time;
};
Exponents exponents_of(Dimension dimension) {
  switch (dimension) {
    case Dimension::time:
      return {0, 0, 1};
    case Dimension::length:
      return {0, 1, 0};
    case Dimension::speed:
      return {0, 1, -1};
    case Dimension::acceleration:
      return {0, 1, -2};
    case Dimension::mass:
      return {1, 0, 0};
    case Dimension::force:
      return {1, 1, -2};
    case Dimension::moment:
    case Dimension::energy:
      return {1, 2, -2};
    case Dimension::stiffness:
      return {1, 0, -2};
    case Dimension::damping:
      return {1, 0, -1};
    case Dimension::impulse:
      return {1, 1, -1};
    case Dimension::angular_rate:
    case Dimension::frequency:
      return {0, 0, -1};
    case Dimension::angular_acceleration:
      return {0, 0, -2};
    case Dimension::inertia:
      return {1, 2, 0};
    case Dimension::angle_per_length:
      return {0, -1, 0};
    case Dimension::angle:
    case Dimension::none:
    case Dimension::unknown:
      break;
  }
  return {0, 0, 0};
}

/// Sizes beyond which a number is no vehicle's in SI units.
struct Limit {
  Dimension dimension;
  double size;
};
constexpr Limit kLimits[] = {{Dimension::length, 30.0}, {Dimension::speed, 150.0}, {Dimension::acceleration, 2e5},
                             {Dimension::mass, 60e3},   {Dimension::force, 50e6},  {Dimension::energy, 50e6}};
constexpr double kLongestCrash_s = 10.0;

double largest_size(const std::vector<double>& values) {
  double size = 0.0;
  for (const double value : values) size = std::fmax(size, std::abs(value));
  return size;
}

}  // namespace

UnitSystem parse_unit_system(const std::string& name) {
  if (name.empty()) return {};
  for (const Named& known : kSystems)
    if (same_ignoring_case(known.name, trimmed(name))) return known.system;
  throw InvalidInput(
      fmt::format("units = '{}': unknown system of units; use kg-m-s, t-mm-s, kg-mm-ms or g-mm-ms", name));
}

double to_si(const UnitSystem& system, Dimension dimension) {
  const Exponents e = exponents_of(dimension);
  return std::pow(system.mass_kg, e.mass) * std::pow(system.length_m, e.length) * std::pow(system.time_s, e.time);
}

Dimension fe_dimension(std::string_view variable) {
  static constexpr std::pair<std::string_view, Dimension> kExact[] = {
      {"TIME", Dimension::time},          {"TIME STEP", Dimension::time},      {"MASS", Dimension::mass},
      {"IE", Dimension::energy},          {"KE", Dimension::energy},           {"HE", Dimension::energy},
      {"HEAT", Dimension::energy},        {"PLASTIC WORK", Dimension::energy}, {"EXTERNAL WORK", Dimension::energy},
      {"XMOM", Dimension::impulse},       {"YMOM", Dimension::impulse},        {"ZMOM", Dimension::impulse},
      {"X-MOMENTUM", Dimension::impulse}, {"Y-MOMENTUM", Dimension::impulse},  {"Z-MOMENTUM", Dimension::impulse}};
  for (const auto& [name, dimension] : kExact)
    if (same_ignoring_case(name, variable)) return dimension;
  if (variable.ends_with(" ENERGY")) return Dimension::energy;
  if (variable.ends_with(" MASS") && !variable.starts_with("PERCENTAGE")) return Dimension::mass;
  const bool along_axis = !variable.empty() && std::string_view("XYZ").find(variable.back()) != std::string_view::npos;
  if (!along_axis) return Dimension::unknown;
  const std::string_view kind = variable.substr(0, variable.size() - 1);
  if (kind == "D") return Dimension::length;
  if (kind == "V") return Dimension::speed;
  if (kind == "A") return Dimension::acceleration;
  if (kind == "FN" || kind == "FT" || kind == "F") return Dimension::force;
  return Dimension::unknown;
}

void warn_when_implausible(TraceSet& set) {
  for (const Trace& trace : set.traces) {
    if (trace.values.empty()) continue;
    const double span_s = trace.times().back() - trace.times().front();
    if (span_s > kLongestCrash_s) {
      set.warnings.push_back(
          fmt::format("{}: lasts {:g} s, too long for a crash: are its units not SI? say so, for example units = "
                      "t-mm-s or kg-mm-ms",
                      set.path, span_s));
      return;
    }
    for (const Limit& limit : kLimits) {
      if (trace.dimension != limit.dimension || largest_size(trace.values) <= limit.size) continue;
      set.warnings.push_back(fmt::format(
          "{}: channel {} reaches {:g} {}, too much for a vehicle: are its units not SI? say so, for example "
          "units = t-mm-s",
          set.path, trace.name, largest_size(trace.values), si_symbol(trace.dimension)));
      return;
    }
  }
}

}  // namespace crashsim::io
