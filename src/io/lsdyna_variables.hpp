#pragma once
/// What LS-DYNA calls its time histories, the same for its ASCII files and its binout.

#include <string>
#include <string_view>

#include <crashsim/trace.hpp>

namespace crashsim::io {

/// One quantity of a database, by the name that binout gives it.
struct LsdynaVariable {
  std::string_view database;  ///< "nodout", "rcforc", "glstat".
  std::string_view name;      ///< "x_velocity", "kinetic_energy".
};

/// What a variable measures: length for "x_displacement", angle for "rx_displacement", force for "x_force"; unknown for
/// names that LS-DYNA does not use.
Dimension lsdyna_dimension(LsdynaVariable variable);

/// A trace without samples for a variable of an entity: a node, part, wall or contact by its number and title ("" when
/// it has none); both "" for a quantity of the whole model. Its id is "nodout/1100002/x_velocity"
/// ("glstat/kinetic_energy" for the whole model), its name "1100002_VX" or, with a title, "LEFT REAR_VX".
Trace lsdyna_trace(LsdynaVariable variable, std::string_view entity, std::string_view title);

}  // namespace crashsim::io
