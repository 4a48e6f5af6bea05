#pragma once
/// What OpenRadioss calls its time histories, the same for its binary file and the tables made of it.

#include <string>
#include <string_view>

#include <crashsim/trace.hpp>

namespace crashsim::io {

struct RadiossVariable {
  std::string_view name;  ///< "VX"; "" for a code that is not known.
  Dimension dimension = Dimension::unknown;
};

/// Kinds of time-history groups as the binary file numbers them.
inline constexpr int kRadiossNodes = 0, kRadiossWalls = 102;

/// A variable of the whole model, by its code: 1 is "INTERNAL ENERGY".
RadiossVariable radioss_global_variable(int code);

/// A variable of a part or subset, by its code: 1 is "IE".
RadiossVariable radioss_part_variable(int code);

/// A variable of a group's entities, by the kind of group and its code: code 4 of nodes is "VX". Forces of walls,
/// contacts, sections and rigid bodies are the run's cumulative impulses.
RadiossVariable radioss_group_variable(int kind, int code);

/// A trace without samples: "LEFT_REAR_VX", or the variable alone for the whole model (no entity).
/// @param column of the table that the converter makes: the first variable stands in 2, after time.
Trace radioss_trace(const std::string& entity, const std::string& variable, Dimension dimension, std::size_t column);

}  // namespace crashsim::io
