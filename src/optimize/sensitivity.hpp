#pragma once
/// Series of the sensitivities of the motion to the ordinates, for one smooth piece.
///
/// Every sensitivity s = dx/dtheta obeys m s'' = -(dF/dx) s - (dF/dv) s' - dF/dtheta. Inside a piece only the four
/// ordinates of its two segments act (dF/dtheta != 0); all others are combinations of the two homogeneous solutions. So
/// six columns describe any number of ordinates.

#include <array>

#include "optimize/simd.hpp"
#include "solver/crush_events.hpp"

namespace crashsim {

inline constexpr int kHomogeneous = 2;  ///< Columns 0, 1: from a unit displacement, from a unit velocity.
inline constexpr int kColumns = 6;      ///< Then the acting ordinates: two of the spring, two of the damper.

/// Coefficients of the columns' displacements and velocities, one column a lane.
struct SensitivitySeries {
  std::array<Lanes, kMaxDegree + 1> x, v;
  std::array<int, kColumns> ordinate;  ///< Parameter index of an acting column, -1: none; homogeneous columns -1.
};

/// @param damper_offset index of the damper's first ordinate among all parameters.
void sensitivity_series(const CrushProblem& problem, const Region& region, const StepPolynomial& step,
                        int damper_offset, SensitivitySeries& series);

/// Displacements and velocities of the columns at tau.
struct SensitivityValues {
  Lanes x, v;
};
void evaluate(const SensitivitySeries& series, int degree, double tau, SensitivityValues& at);

}  // namespace crashsim
