#pragma once
/// The numbers of a case that may vary, by their keys.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <crashsim/case.hpp>

namespace crashsim {

/// A number of a case.
struct CaseNumber {
  std::string section, key;  ///< "vehicle", "mass"
  std::string name;          ///< Its field: "mass_kg".
  std::string unit;          ///< SI symbol.
  Range range;
  bool is_whole = false;  ///< Only whole numbers.
  double value = kUnset;  ///< What the case says.

  [[nodiscard]] std::string full_key() const { return section + "." + key; }
};

/// The number of a full key; empty when a case has no such number.
std::optional<CaseNumber> case_number(const Case& study, std::string_view full_key);

/// Sets a number by its full key. @throws InvalidInput when it is out of range, or no whole number where it must be.
void set_number(Case& study, std::string_view full_key, double value);

/// An ordinate of the crush curves: "crush.k3"; number 0: all of the curve. Law `rate` has one more, its coefficient.
inline constexpr const char* kRateCoefficientKey = "crush.rate_coefficient";
struct OrdinateKey {
  char curve = 'k';  ///< 'k', 'c', or 'r': the rate coefficient.
  std::size_t number = 0;
};
std::optional<OrdinateKey> ordinate_key(std::string_view full_key);

/// The full key that a name means: "vehicle.mass_kg", "mass" -> "vehicle.mass".
/// @param others further names that were possible, for the message.
/// @throws InvalidInput naming `what` and the nearest key when there is none, or the sections when there are several.
std::string full_key_of(std::string_view name, std::string_view what, const std::vector<std::string>& others = {});

/// The distribution of a variation in SI, or of its factor. @throws InvalidInput naming `what`.
Distribution distribution_of(const Variation& variation, std::string_view unit, const std::string& what);

/// Takes an entry of [sweep] or [monte_carlo] that is none of its options. @throws InvalidInput naming its place.
void add_variation(const ConfigEntry& entry, std::vector<Variation>& vary, const std::vector<std::string>& options);

/// The variations as entries of a section, from which they come back.
std::vector<ConfigEntry> entries_of(const std::vector<Variation>& vary, std::string_view section);

/// What a case asks for, [sweep] or [monte_carlo].
const std::vector<Variation>& variations_of(const Case& study);

/// How messages call a variation: "case.toml: [sweep] vehicle.mass".
std::string what_varies(const Case& study, const Variation& variation);

/// @throws InvalidInput when the case varies something that it cannot, as far as can be told without the model.
void check_variations(const Case& study);

}  // namespace crashsim
