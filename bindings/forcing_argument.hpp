#pragma once
/// What drives heave and pitch, as callers give it.
#include <string>

#include <pybind11/pybind11.h>

#include <crashsim/simulate_pitch.hpp>

namespace crashsim::python {

/// A PitchForcing, a MeasuredForcing, a CrushResponse for its longitudinal force, or a series of the vertical force.
/// @throws TypeError or InvalidInput naming `what` when it is none of them.
PitchForcing forcing_from(const pybind11::handle& force, const std::string& what);

}  // namespace crashsim::python
