#pragma once
/// The record as a JSON object, for the outputs that hold it.

#include <crashsim/record.hpp>

#include "json.hpp"

namespace crashsim {

Json record_json(const Record& record);

}  // namespace crashsim
