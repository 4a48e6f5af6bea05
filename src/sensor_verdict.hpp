#pragma once
/// What a solved sensor correction says: numbers, standard errors, and how far they can be believed.

#include <span>

#include <crashsim/sensor_correction.hpp>

#include "sensor_equations.hpp"

namespace crashsim {

/// Fills corrections and their errors, conditions, noise, what the priors determine, and warnings. `out` has its
/// channels.
void take_corrections(const SensorEquations& equations, std::span<const double> units, SensorCorrection& out);

}  // namespace crashsim
