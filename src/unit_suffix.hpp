#pragma once
/// Names that end in their unit: `accel_mps2`, `k_n_per_m`, `impulse_N_s`.

#include <algorithm>
#include <string_view>

#include <crashsim/units.hpp>

#include "text.hpp"

namespace crashsim {

/// Whether a suffix is one unit. `_` joins only what are units by themselves: the `K_N` of `row_K_N` is no kilonewton,
/// the `G_N` no standard gravity.
inline bool is_unit_suffix(std::string_view suffix) {
  const auto unit = find_unit(suffix);
  if (!unit || unit->dimension == Dimension::none) return false;
  if (suffix.find('_') == std::string_view::npos || suffix.find("_per_") != std::string_view::npos) return true;
  const auto pieces = split(suffix, '_');
  return std::all_of(pieces.begin(), pieces.end(), [](std::string_view piece) {
    while (!piece.empty() && is_digit(piece.back())) piece.remove_suffix(1);  // m_s2
    const auto factor = find_unit(piece);
    return factor && factor->dimension != Dimension::acceleration;
  });
}

/// Where the `_` before the unit stands; npos when the name has none.
inline std::size_t before_unit_suffix(std::string_view name) {
  std::size_t at = name.find('_', 1);
  while (at != std::string_view::npos && !is_unit_suffix(name.substr(at + 1))) at = name.find('_', at + 1);
  return at;
}

}  // namespace crashsim
