#pragma once
/// The law of the vertical force as a file, law.json.

#include <string>

#include <crashsim/identify_vertical.hpp>
#include <crashsim/record.hpp>
#include <crashsim/vertical_force.hpp>

namespace crashsim {

/// The law as JSON under the names of its fields, without those unset; with how it was identified and made, where that
/// is given. @throws InvalidInput on a bad law.
std::string format_vertical_law(const VerticalForceLaw& law, const VerticalIdentification* identification = nullptr,
                                const Record* record = nullptr);

}  // namespace crashsim
