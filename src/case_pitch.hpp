#pragma once
/// Heave and pitch in a case: simulated in two phases, coupled, and against what was measured.

#include <crashsim/case.hpp>

namespace crashsim {

/// Simulates heave and pitch after the crush in `out`, and coupled with it where the case asks for that.
void simulate_heave_and_pitch(const Case& study, double impact_speed_mps, CaseResult& out);

/// Compares them with the measured motion that the case names.
void compare_heave_and_pitch(const Case& study, CaseResult& out);

}  // namespace crashsim
