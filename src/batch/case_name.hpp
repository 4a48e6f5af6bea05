#pragma once
/// What a case of a batch may be called: its name is that of a folder, and must not lead out of the batch's.

#include <string>
#include <vector>

#include <crashsim/batch.hpp>

namespace crashsim::batch {

/// @param where stands before the message. @throws InvalidInput when the name is not single, or not UTF-8.
void check_case(const BatchCase& one, const std::string& where);

/// The same for every case of a plan. @throws InvalidInput also when two have one name.
void check_plan(const std::vector<BatchCase>& plan, const std::string& where);

}  // namespace crashsim::batch
