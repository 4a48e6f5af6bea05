#pragma once
/// Checks a struct against its table of fields.

#include <cmath>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/options.hpp>

namespace crashsim {

/// "> 0", ">= 0", "between 0 and 1" or "finite".
inline std::string rule_text(const Range& range) {
  if (std::isfinite(range.min) && std::isfinite(range.max))
    return fmt::format("between {} and {}", range.min, range.max);
  if (std::isfinite(range.min)) return fmt::format("{} {}", range.open_min ? ">" : ">=", range.min);
  if (std::isfinite(range.max)) return fmt::format("<= {}", range.max);
  return "finite";
}

inline bool satisfies(const Range& range, double value) {
  return std::isfinite(value) && value >= range.min && value <= range.max && !(range.open_min && value == range.min);
}

/// Checks every number of `s` that is set against its field's range. `what` names the struct.
/// @throws InvalidInput "CrushModel.mass_kg = -3 kg: must be > 0".
template <class S>
void check_ranges(const S& s, std::string_view what) {
  for (const Field<S>& field : fields<S>) {
    const auto* member = std::get_if<double S::*>(&field.member);
    if (member == nullptr || std::isnan(s.**member) || satisfies(field.range, s.**member)) continue;
    throw InvalidInput(fmt::format("{}.{} = {}{}{}: must be {}", what, field.name, s.**member,
                                   field.unit.empty() ? "" : " ", field.unit, rule_text(field.range)));
  }
}

/// @throws InvalidInput "CrushModel.mass_kg is not set: give the vehicle mass in kg, > 0" when `member` is NaN.
template <class S>
void require_set(const S& s, std::string_view what, double S::*member, std::string_view why = "") {
  if (!std::isnan(s.*member)) return;
  for (const Field<S>& field : fields<S>) {
    const auto* described = std::get_if<double S::*>(&field.member);
    if (described != nullptr && *described == member)
      throw InvalidInput(fmt::format("{}.{} is not set{}: give the {} in {}, {}", what, field.name, why, field.doc,
                                     field.unit, rule_text(field.range)));
  }
}

}  // namespace crashsim
