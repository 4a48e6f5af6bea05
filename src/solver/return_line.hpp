#pragma once
/// Plastic unloading: the straight line that the force runs down after maximum crush.

#include <string>

#include "solver/crush_events.hpp"

namespace crashsim {

/// Stiffness k_u of the return line from maximum crush with force F_m: as given, or F_m^2 / (e^2 m v0^2). Infinite when
/// nothing shall come back.
double return_stiffness(const CrushProblem& problem, double force_n);

/// Force F_m - k_u (C - x) of the return line over x; no force when nothing comes back, with F_m = 0 or infinite k_u.
Quadratic return_line(const CrushProblem& problem, double force_n, double max_crush_m);

/// Energy that the return line gives back from crush x, F^2 / (2 k_u).
double return_line_energy(const Quadratic& line, double x);

/// Least k_u that neither gives back more than m v0^2 / 2 nor still pushes where x < 0, ahead of the undeformed front.
double softest_return(const CrushProblem& problem, double force_n, double max_crush_m);

/// That a return line from there gives back too much, in words, with what to give instead.
std::string why_too_soft(const CrushProblem& problem, double force_n, double max_crush_m);

/// Whether a region's return line is softer than that at maximum crush.
bool returns_too_much(const CrushProblem& problem, const Region& region, double max_crush_m);

}  // namespace crashsim
