#pragma once
/// Systems of units that finite-element decks use: "t-mm-s" and the like.

#include <optional>
#include <string>
#include <vector>

#include <crashsim/trace.hpp>
#include <crashsim/units.hpp>

namespace crashsim::io {

/// What one unit of mass, length and time is in SI.
struct UnitSystem {
  double mass_kg = 1.0, length_m = 1.0, time_s = 1.0;
};

/// "kg-m-s", "t-mm-s", "kg-mm-ms" or "g-mm-ms"; SI when empty. @throws InvalidInput listing them.
UnitSystem parse_unit_system(const std::string& name);

/// SI value of one unit of a dimension.
double to_si(const UnitSystem& system, Dimension dimension);

/// What a finite-element variable measures, by the name that FE codes give it: DX VY AZ (motion), FNX (force), IE KE HE
/// (energy), XMOM (momentum), MASS, time. unknown for others.
Dimension fe_dimension(std::string_view variable);

/// Warns about each channel whose size no vehicle crash has in SI units: the deck used others.
void warn_when_implausible(TraceSet& set);

}  // namespace crashsim::io
