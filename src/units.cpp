#include <crashsim/units.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <crashsim/error.hpp>

#include "number.hpp"
#include "text.hpp"

namespace crashsim {
namespace {

constexpr double kInch = 0.0254;
constexpr double kFoot = 12.0 * kInch;
constexpr double kMile = 5280.0 * kFoot;
constexpr double kPound = 0.45359237;
constexpr double kPoundForce = kPound * kStandardGravity;
constexpr double kDegree = std::numbers::pi / 180.0;

struct DimensionNames {
  Dimension dimension;
  std::string_view si_symbol, name;
};
constexpr std::array kDimensions = std::to_array<DimensionNames>({
    {Dimension::none, "", "pure number"},
    {Dimension::unknown, "", "unknown"},
    {Dimension::time, "s", "time"},
    {Dimension::length, "m", "length"},
    {Dimension::speed, "m/s", "speed"},
    {Dimension::acceleration, "m/s^2", "acceleration"},
    {Dimension::mass, "kg", "mass"},
    {Dimension::force, "N", "force"},
    {Dimension::moment, "N m", "moment"},
    {Dimension::stiffness, "N/m", "stiffness"},
    {Dimension::damping, "N s/m", "damping"},
    {Dimension::energy, "J", "energy"},
    {Dimension::impulse, "N s", "impulse"},
    {Dimension::angle, "rad", "angle"},
    {Dimension::angular_rate, "rad/s", "angular rate"},
    {Dimension::angular_acceleration, "rad/s^2", "angular acceleration"},
    {Dimension::inertia, "kg m^2", "moment of inertia"},
    {Dimension::frequency, "Hz", "frequency"},
    {Dimension::angle_per_length, "rad/m", "angle per length"},
});

/// A unit and the ways to spell it, as normalised() leaves them, separated by blanks.
struct Spellings {
  Unit unit;
  std::string_view spellings;
};
/// Where one spelling has two meanings the first entry is what it means without context.
constexpr std::array kUnits = std::to_array<Spellings>({
    {{"-", Dimension::none, 1.0}, "1"},
    {{"%", Dimension::none, 0.01}, "% pct percent"},
    {{"s", Dimension::time, 1.0}, "s sec second seconds"},
    {{"ms", Dimension::time, 1e-3}, "ms msec millisecond milliseconds"},
    {{"us", Dimension::time, 1e-6}, "us usec µs μs microsecond microseconds"},
    {{"m", Dimension::length, 1.0}, "m meter metre meters metres"},
    {{"mm", Dimension::length, 1e-3}, "mm millimeter millimetre millimeters millimetres"},
    {{"cm", Dimension::length, 1e-2}, "cm centimeter centimetre centimeters centimetres"},
    {{"um", Dimension::length, 1e-6}, "um µm μm micron microns"},
    {{"km", Dimension::length, 1e3}, "km"},
    {{"in", Dimension::length, kInch}, "in inch inches"},
    {{"ft", Dimension::length, kFoot}, "ft foot feet"},
    {{"m/s", Dimension::speed, 1.0}, "m/s mps ms1"},
    {{"mm/s", Dimension::speed, 1e-3}, "mm/s mmps"},
    {{"cm/s", Dimension::speed, 1e-2}, "cm/s"},
    {{"mm/ms", Dimension::speed, 1.0}, "mm/ms"},
    {{"km/h", Dimension::speed, 1.0 / 3.6}, "km/h km/hr kmh kph kmph"},
    {{"mph", Dimension::speed, kMile / 3600.0}, "mph mi/h mile/h miles/h"},
    {{"ft/s", Dimension::speed, kFoot}, "ft/s fps"},
    {{"in/s", Dimension::speed, kInch}, "in/s"},
    {{"m/s^2", Dimension::acceleration, 1.0}, "m/s2 m/ss m/s/s mps2 ms2"},
    {{"g", Dimension::acceleration, kStandardGravity}, "g G gs gn gee"},
    {{"mm/s^2", Dimension::acceleration, 1e-3}, "mm/s2 mm/ss mm/s/s mmps2"},
    {{"mm/ms^2", Dimension::acceleration, 1e3}, "mm/ms2 mm/msms"},
    {{"cm/s^2", Dimension::acceleration, 1e-2}, "cm/s2"},
    {{"ft/s^2", Dimension::acceleration, kFoot}, "ft/s2 ft/s/s"},
    {{"in/s^2", Dimension::acceleration, kInch}, "in/s2 in/s/s"},
    {{"kg", Dimension::mass, 1.0}, "kg kgs kilogram kilograms"},
    {{"t", Dimension::mass, 1e3}, "t Mg tonne tonnes"},
    {{"g", Dimension::mass, 1e-3}, "g gram grams"},
    {{"mg", Dimension::mass, 1e-6}, "mg"},
    {{"lb", Dimension::mass, kPound}, "lb lbs lbm pound pounds"},
    {{"N", Dimension::force, 1.0}, "N nwt newton newtons"},
    {{"kN", Dimension::force, 1e3}, "kN kilonewton kilonewtons"},
    {{"MN", Dimension::force, 1e6}, "MN"},
    {{"mN", Dimension::force, 1e-3}, "mN"},
    {{"lbf", Dimension::force, kPoundForce}, "lbf"},
    {{"N m", Dimension::moment, 1.0}, "Nm nwm"},
    {{"N mm", Dimension::moment, 1e-3}, "Nmm"},
    {{"kN m", Dimension::moment, 1e3}, "kNm"},
    {{"lbf ft", Dimension::moment, kPoundForce* kFoot}, "lbfft ftlbf"},
    {{"lbf in", Dimension::moment, kPoundForce* kInch}, "lbfin inlbf"},
    {{"N/m", Dimension::stiffness, 1.0}, "N/m"},
    {{"N/mm", Dimension::stiffness, 1e3}, "N/mm"},
    {{"kN/m", Dimension::stiffness, 1e3}, "kN/m"},
    {{"kN/mm", Dimension::stiffness, 1e6}, "kN/mm"},
    {{"MN/m", Dimension::stiffness, 1e6}, "MN/m"},
    {{"lbf/in", Dimension::stiffness, kPoundForce / kInch}, "lbf/in lb/in"},
    {{"N s/m", Dimension::damping, 1.0}, "Ns/m N/m/s"},
    {{"N s/mm", Dimension::damping, 1e3}, "Ns/mm"},
    {{"kN s/m", Dimension::damping, 1e3}, "kNs/m"},
    {{"J", Dimension::energy, 1.0}, "J joule joules Nm"},
    {{"kJ", Dimension::energy, 1e3}, "kJ kNm"},
    {{"MJ", Dimension::energy, 1e6}, "MJ"},
    {{"mJ", Dimension::energy, 1e-3}, "mJ Nmm"},
    {{"N s", Dimension::impulse, 1.0}, "Ns kgm/s Mgmm/s tmm/s"},
    {{"kN s", Dimension::impulse, 1e3}, "kNs"},
    {{"rad", Dimension::angle, 1.0}, "rad radian radians"},
    {{"mrad", Dimension::angle, 1e-3}, "mrad"},
    {{"deg", Dimension::angle, kDegree}, "deg degree degrees"},
    {{"rad/s", Dimension::angular_rate, 1.0}, "rad/s radps"},
    {{"deg/s", Dimension::angular_rate, kDegree}, "deg/s dps degps"},
    {{"rad/s^2", Dimension::angular_acceleration, 1.0}, "rad/s2 rad/ss rad/s/s radps2"},
    {{"deg/s^2", Dimension::angular_acceleration, kDegree}, "deg/s2 deg/ss deg/s/s degps2"},
    {{"kg m^2", Dimension::inertia, 1.0}, "kgm2"},
    {{"kg mm^2", Dimension::inertia, 1e-6}, "kgmm2"},
    {{"t mm^2", Dimension::inertia, 1e-3}, "tmm2 Mgmm2"},
    {{"Hz", Dimension::frequency, 1.0}, "Hz hertz"},
    {{"kHz", Dimension::frequency, 1e3}, "kHz"},
    {{"MHz", Dimension::frequency, 1e6}, "MHz"},
    {{"rad/m", Dimension::angle_per_length, 1.0}, "rad/m"},
    {{"deg/m", Dimension::angle_per_length, kDegree}, "deg/m"},
});

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

/// The spelling without what different hands write differently: `m / sec**2` and `m/s²` become `m/s2`.
std::string normalised(std::string_view name) {
  std::string text(name);
  static constexpr std::pair<std::string_view, std::string_view> kReplacements[] = {
      {"²", "2"}, {"°", "deg"}, {"·", ""}, {"_per_", "/"}, {"/sec", "/s"}};
  for (const auto& [from, to] : kReplacements) replace_all(text, from, to);
  std::erase_if(text, [](char c) { return is_blank(c) || std::string_view("*.^'()-_").find(c) != std::string::npos; });
  return text;
}

template <class Same>
bool is_spelling(std::string_view spellings, std::string_view text, Same same) {
  while (!spellings.empty()) {
    const std::size_t end = std::min(spellings.find(' '), spellings.size());
    if (same(spellings.substr(0, end), text)) return true;
    spellings.remove_prefix(std::min(end + 1, spellings.size()));
  }
  return false;
}

/// The unit spelled `name`, of the wanted dimension if there is one: as spelled, else with any letter case where that
/// leaves one meaning.
std::optional<Unit> look_up(std::string_view name, std::optional<Dimension> wanted) {
  if (trimmed(name) == "-") return kUnits.front().unit;
  const std::string text = normalised(name);
  const auto fits = [&](const Unit& unit) { return !wanted || unit.dimension == *wanted; };
  for (const auto& [unit, spellings] : kUnits)
    if (fits(unit) && is_spelling(spellings, text, std::equal_to<>())) return unit;
  std::optional<Unit> found;
  for (const auto& [unit, spellings] : kUnits) {
    if (!fits(unit) || !is_spelling(spellings, text, same_ignoring_case)) continue;
    if (!found) found = unit;
    if (found->dimension == unit.dimension && found->to_si != unit.to_si) return std::nullopt;
  }
  return found;
}

std::string units_of(Dimension dimension) {
  std::string list;
  for (const auto& [unit, spellings] : kUnits)
    if (unit.dimension == dimension) list += fmt::format("{}{}", list.empty() ? "" : ", ", unit.name);
  return list;
}

const DimensionNames& names_of(Dimension dimension) {
  return *std::find_if(kDimensions.begin(), kDimensions.end(),
                       [&](const DimensionNames& d) { return d.dimension == dimension; });
}

double unit_factor(std::string_view text, std::string_view unit_name, Dimension dimension, std::string_view what) {
  if (unit_name.front() == ',')
    throw InvalidInput(fmt::format("{} = '{}': is not a number; the decimal mark is '.'", what, text));
  if (const auto unit = look_up(unit_name, dimension)) return unit->to_si;
  const auto other = find_unit(unit_name);
  const std::string remedy = dimension == Dimension::none ? "give a pure number"
                                                          : fmt::format("use one of {}, or a bare number in {}",
                                                                        units_of(dimension), si_symbol(dimension));
  if (other)
    throw InvalidInput(fmt::format("{} = '{}': '{}' measures {}, not {}; {}", what, text, unit_name,
                                   dimension_name(other->dimension), dimension_name(dimension), remedy));
  throw InvalidInput(fmt::format("{} = '{}': unknown unit '{}'; {}", what, text, unit_name, remedy));
}

}  // namespace

std::string_view si_symbol(Dimension dimension) { return names_of(dimension).si_symbol; }

std::string_view dimension_name(Dimension dimension) { return names_of(dimension).name; }

std::optional<Unit> find_unit(std::string_view name) { return look_up(name, std::nullopt); }

std::optional<Unit> find_unit(std::string_view name, Dimension dimension) { return look_up(name, dimension); }

Dimension dimension_of(std::string_view symbol) {
  for (const DimensionNames& d : kDimensions)
    if (d.si_symbol == symbol) return d.dimension;
  throw InvalidInput(fmt::format("'{}' is not the symbol of an SI unit", symbol));
}

double quantity(std::string_view text, Dimension dimension, std::string_view what) {
  const std::string_view all = trimmed(text);
  double value = kUnset;
  const char* end = scan_number(all.data(), all.data() + all.size(), value);
  if (end == all.data() || !std::isfinite(value))
    throw InvalidInput(fmt::format("{} = '{}': is not a finite number", what, text));
  const std::string_view unit = trimmed({end, all.data() + all.size()});
  return unit.empty() ? value : value * unit_factor(text, unit, dimension, what);
}

std::optional<double> parse_number(std::string_view text) {
  const std::string_view all = trimmed(text);
  double value = kUnset;
  const char* end = scan_number(all.data(), all.data() + all.size(), value);
  if (all.empty() || end != all.data() + all.size()) return std::nullopt;
  return value;
}

std::string format_number(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

}  // namespace crashsim
