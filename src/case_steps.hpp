#pragma once
/// The steps of a case that its samples take again.

#include <string>

#include <crashsim/case.hpp>

namespace crashsim {

/// Reads the pulse and identifies or reads the model. False when there is no model to go on with.
bool find_model(const Case& study, const Progress& progress, CaseResult& out);

/// Simulates the model's crush and, where the case describes that, heave and pitch.
/// @param impact_speed_mps unset: the model's.
void simulate_model(const Case& study, double impact_speed_mps, CaseResult& out);

/// Speed that a case simulates: its own, else the pulse's, else unset for the model's [m/s].
double speed_of(const Case& study, const CaseResult& out);

/// "completed", or the first outcome that is not. The predictions are not looked at.
std::string outcome_of(const CaseResult& out);

}  // namespace crashsim
