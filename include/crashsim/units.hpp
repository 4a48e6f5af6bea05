#pragma once
/// Units at the borders: text such as `56km/h` or a column's `g` becomes SI here and nowhere else.

#include <optional>
#include <string>
#include <string_view>

namespace crashsim {

/// Standard acceleration of gravity, one `g` [m/s^2].
inline constexpr double kStandardGravity = 9.80665;

/// What a number measures. `none` is a pure number, `unknown` a channel whose file does not say.
enum class Dimension {
  unknown,
  none,
  time,
  length,
  speed,
  acceleration,
  mass,
  force,
  moment,
  stiffness,
  damping,
  energy,
  impulse,
  angle,
  angular_rate,
  angular_acceleration,
  inertia,
  frequency,
  angle_per_length
};

/// One unit of measure: value in SI = value * to_si.
struct Unit {
  std::string_view name;
  Dimension dimension = Dimension::unknown;
  double to_si = 1.0;
};

/// Symbol of the SI unit of a dimension: "m/s^2", "N", ...; "" for none and unknown.
std::string_view si_symbol(Dimension dimension);

/// Name of a dimension for messages: "acceleration".
std::string_view dimension_name(Dimension dimension);

/// Looks a unit up by its name as files and people spell it (`g`, `G'S`, `mm/s`, `km/h`, `kN`, `NWM`); letter case is
/// ignored where that is unambiguous. Empty when unknown.
std::optional<Unit> find_unit(std::string_view name);

/// The unit of a dimension that is spelled so: `g` of mass is a gram, `Nm` of energy a joule. Empty when there is none.
std::optional<Unit> find_unit(std::string_view name, Dimension dimension);

/// Dimension of an SI symbol as the option tables spell it ("m/s"). @throws InvalidInput on an unknown symbol.
Dimension dimension_of(std::string_view si_symbol);

/// Reads a quantity such as `56km/h`, `35 mph`, `1.719t`, `120ms` as SI; a bare number is SI already.
/// @param what names the option in messages.
/// @throws InvalidInput when it is no number, the unit is unknown, or the unit measures something else.
double quantity(std::string_view text, Dimension dimension, std::string_view what = "quantity");

/// Parses a whole text as a finite or non-finite floating-point number with '.' as decimal mark; empty when it is none.
std::optional<double> parse_number(std::string_view text);

/// Shortest text that reads back as the same double.
std::string format_number(double value);

}  // namespace crashsim
