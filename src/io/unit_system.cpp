#include "io/unit_system.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
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

constexpr double kGravity = 9.81;           // as decks write it
constexpr double kGravityTolerance = 0.01;  // 9.80665, 9.8 and 9.81 are all meant
constexpr double kSameStart = 1e-3;

double largest_size(const std::vector<double>& values) {
  double size = 0.0;
  for (const double value : values) size = std::abs(value) > size ? std::abs(value) : size;  // passes over NaN
  return size;
}

bool is_gravity(double size) { return std::abs(size - kGravity) <= kGravityTolerance * kGravity; }

/// The value with which most vertical accelerations start, NaN when they do not agree.
double common_start(const TraceSet& set) {
  std::vector<double> starts;
  for (const Trace& trace : set.traces)
    if (trace.axis == 'Z' && trace.dimension == Dimension::acceleration && trace.source_unit.empty() &&
        !trace.values.empty() && std::isfinite(trace.values.front()))
      starts.push_back(trace.values.front());
  if (starts.empty()) return std::nan("");
  const auto middle = starts.begin() + std::ssize(starts) / 2;
  std::nth_element(starts.begin(), middle, starts.end());
  const double median = *middle;
  const auto same = std::count_if(starts.begin(), starts.end(), [median](double start) {
    return std::abs(start - median) <= kSameStart * std::abs(median);
  });
  return 2 * same > std::ssize(starts) ? median : std::nan("");
}

/// Systems in which an acceleration that was converted by `system` is gravity: "t-mm-s, kg-mm-ms".
std::string systems_with_gravity(double acceleration, const UnitSystem& system) {
  std::string names;
  std::vector<UnitSystem> seen;
  for (const Named& known : kSystems) {
    if (std::find(seen.begin(), seen.end(), known.system) != seen.end()) continue;
    seen.push_back(known.system);
    const double other = to_si(known.system, Dimension::acceleration) / to_si(system, Dimension::acceleration);
    if (is_gravity(std::abs(acceleration) * other))
      names += fmt::format("{}{}", names.empty() ? "" : " or ", known.name);
  }
  return names;
}

std::string name_of(const UnitSystem& system) {
  for (const Named& known : kSystems)
    if (known.system == system) return std::string(known.name);
  return fmt::format("{:g} kg, {:g} m, {:g} s", system.mass_kg, system.length_m, system.time_s);
}

/// At rest or sliding on a rigid ground, the first vertical accelerations of a run are its gravity.
bool warn_of_gravity(TraceSet& set, const UnitSystem& system) {
  const double start = common_start(set);
  if (std::isnan(start) || start == 0.0) return false;
  const double power = std::round(std::log10(std::abs(start) / kGravity));
  if (power == 0.0 || !is_gravity(std::abs(start) / std::pow(10.0, power))) return false;
  const std::string names = systems_with_gravity(start, system);
  set.warnings.push_back(
      fmt::format("{}: vertical accelerations start at {:.6g} m/s^2, which is gravity in other units than {}: {}",
                  set.path, start, name_of(system),
                  names.empty() ? "no system known makes it 9.81 m/s^2" : "it is 9.81 m/s^2 with units = " + names));
  return true;
}

/// What to do about a size that cannot be.
std::string units_remedy(const UnitSystem& system) {
  if (system == UnitSystem{}) return "are its units not SI? say so, for example units = t-mm-s";
  return fmt::format("are its units not {}? say others, for example units = kg-m-s", name_of(system));
}

}  // namespace

UnitSystem parse_unit_system(const std::string& name) {
  if (name.empty()) return {};
  for (const Named& known : kSystems)
    if (same_ignoring_case(known.name, trimmed(name))) return known.system;
  std::string known;
  for (const Named& system : kSystems)
    known += fmt::format("{}{}", known.empty() ? "" : &system == std::end(kSystems) - 1 ? " or " : ", ", system.name);
  throw InvalidInput(fmt::format("units = '{}': unknown system of units; use {}", name, known));
}

double to_si(const UnitSystem& system, Dimension dimension) {
  const Exponents e = exponents_of(dimension);
  return std::pow(system.mass_kg, e.mass) * std::pow(system.length_m, e.length) * std::pow(system.time_s, e.time);
}

void scale(std::vector<double>& values, double factor) {
  if (factor == 1.0) return;
  for (double& value : values) value *= factor;
}

Dimension fe_dimension(std::string_view variable) {
  static constexpr std::pair<std::string_view, Dimension> kExact[] = {
      {"TIME", Dimension::time},           {"TIME STEP", Dimension::time},
      {"MASS", Dimension::mass},           {"IE", Dimension::energy},
      {"KE", Dimension::energy},           {"HE", Dimension::energy},
      {"RIE", Dimension::energy},          {"RKE", Dimension::energy},
      {"TURBKE", Dimension::energy},       {"KERB", Dimension::energy},
      {"RKERB", Dimension::energy},        {"HEAT", Dimension::energy},
      {"PLASTIC WORK", Dimension::energy}, {"EXTERNAL WORK", Dimension::energy},
      {"XMOM", Dimension::impulse},        {"YMOM", Dimension::impulse},
      {"ZMOM", Dimension::impulse},        {"X-MOMENTUM", Dimension::impulse},
      {"Y-MOMENTUM", Dimension::impulse},  {"Z-MOMENTUM", Dimension::impulse}};
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
  if (kind == "VR") return Dimension::angular_rate;
  if (kind == "AR") return Dimension::angular_acceleration;
  if (kind == "FN" || kind == "FT" || kind == "F") return Dimension::force;
  return Dimension::unknown;
}

void warn_when_implausible(TraceSet& set, const UnitSystem& system) {
  if (warn_of_gravity(set, system)) return;
  for (const Trace& trace : set.traces) {
    if (trace.values.empty()) continue;
    const double span_s = trace.times().back() - trace.times().front();
    if (span_s > kLongestCrash_s) {
      set.warnings.push_back(
          fmt::format("{}: lasts {:g} s, too long for a crash: {}", set.path, span_s, units_remedy(system)));
      return;
    }
    for (const Limit& limit : kLimits) {
      if (trace.dimension != limit.dimension || largest_size(trace.values) <= limit.size) continue;
      set.warnings.push_back(fmt::format("{}: channel {} reaches {:g} {}, too much for a vehicle: {}", set.path,
                                         trace.name, largest_size(trace.values), si_symbol(trace.dimension),
                                         units_remedy(system)));
      return;
    }
  }
}

}  // namespace crashsim::io
