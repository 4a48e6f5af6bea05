#pragma once
/// Standard errors of an identification, from the linear problem at what it found.

#include <span>

#include <crashsim/uncertainty.hpp>

#include "optimize/fit_study.hpp"
#include "optimize/linear_fit.hpp"

namespace crashsim {

/// What the errors of a fitted number stand on; whether it is determined is not looked at.
OrdinateState state_of(const OrdinateReport& ordinate, double smooth);

/// The linear problem of a study at what was found in it; its targets are corrected by the errors of the tests that
/// were found, which count as unknown.
LinearFit linear_fit_of(std::span<const Pulse> pulses, const Identification& fit, FitStudy& study);

/// Gives the fitted numbers their standard errors and correlations. @param study as before the fit.
void tell_standard_errors(std::span<const Pulse> pulses, FitStudy study, Identification& fit);

}  // namespace crashsim
