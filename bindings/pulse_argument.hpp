#pragma once
/// Pulses of one structure, as callers give them.
#include <vector>

#include <pybind11/pybind11.h>

#include <crashsim/pulse.hpp>

namespace crashsim::python {

/// A Pulse, or a list of them. @throws TypeError when it is neither.
std::vector<Pulse> pulses_of(const pybind11::object& given);

}  // namespace crashsim::python
