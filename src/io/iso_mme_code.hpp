#pragma once
/// Channel codes of ISO-MME, 16 characters: test object 1, position 1, main location 4, fine locations 2 + 2 + 2,
/// physical dimension 2, direction 1, filter class 1. Source: ISO/TS 13499, related electronic document B.

#include <string>
#include <string_view>
#include <vector>

#include <crashsim/trace.hpp>
#include <crashsim/units.hpp>

namespace crashsim::io {

inline constexpr std::size_t kIsoMmeCodeLength = 16;

/// Whether a text is built as a channel code: 16 letters, digits and `?`.
bool is_iso_mme_code(std::string_view text);

/// What the code's physical dimension (AC, VE, FO..) is; unknown for others, and when it is no code.
Dimension iso_mme_dimension(std::string_view code);

/// The two letters of a dimension, "" when the standard has none.
std::string_view iso_mme_letters(Dimension dimension);

/// 'X' for the directions X and 1, which is longitudinal too but with another sign than SAE J211's; so Y, Z; else ' '.
char iso_mme_axis(std::string_view code);

/// Main and fine locations without zeros at their end: "VEHCCG", "SEATLERE".
std::string iso_mme_location(std::string_view code);

/// How the channel was filtered before it came into the file: "CFC 60"; "" when it was not, or not below CFC 1000.
std::string_view iso_mme_filter(std::string_view code);

/// The filter class of a channel frequency class, '0' unfiltered, 'S' when it has none of its own.
char iso_mme_filter_class(double cfc);

/// Indices of the traces that measure the longitudinal acceleration of the first vehicle's compartment, from the best
/// place that has any: rear seat, sill or cross-member; centre of gravity or tunnel; those without "rear", and the
/// lower B-pillar. A sled counts where there is no vehicle. Unfiltered channels go before filtered ones of the same
/// place.
std::vector<std::size_t> iso_mme_compartment(const TraceSet& set, const std::vector<bool>& usable);

}  // namespace crashsim::io
