#pragma once
/// Names of the fields in an NHTSA EV5 header, and its records as metadata.
/// Source: NHTSA Test Reference Guide, volume I, version 5.

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace crashsim::io {

using Metadata = std::vector<std::pair<std::string, std::string>>;

/// "VEHTWT" of ("VEHICLE", 10); "FIELD82" where the guide knows no name, counted from 1.
std::string nhtsa_field_name(std::string_view section, std::size_t index);

/// Appends the filled fields of a record: {"OCCUPANT[1,01].OCCTYP", "H3"}. Of INSTRUMENTATION records only those that
/// a Trace does not hold by itself.
void append_nhtsa_fields(std::string_view section, const std::vector<std::string_view>& fields, Metadata& metadata);

}  // namespace crashsim::io
