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

  friend bool operator==(const UnitSystem&, const UnitSystem&) = default;
};

/// "kg-m-s", "t-mm-s", "kg-mm-ms" or "g-mm-ms"; SI when empty. @throws InvalidInput listing them.
UnitSystem parse_unit_system(const std::string& name);

/// SI value of one unit of a dimension.
double to_si(const UnitSystem& system, Dimension dimension);

/// Multiplies every value by a factor.
void scale(std::vector<double>& values, double factor);

/// What a finite-element variable measures, by the name that FE codes give it: DX VY AZ (motion), FNX (force), IE KE HE
/// (energy), XMOM (momentum), MASS, time. unknown for others.
Dimension fe_dimension(std::string_view variable);

/// Warns when numbers show that the deck used other units than those they were converted by: vertical accelerations
/// start at a power of ten times gravity, or a channel has a size that no vehicle crash has.
/// @param system what the samples were converted by; columns that say their own unit are not judged by it.
void warn_when_implausible(TraceSet& set, const UnitSystem& system = {});

}  // namespace crashsim::io
