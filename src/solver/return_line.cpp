#include "solver/return_line.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace crashsim {
namespace {

// Relative. An elastic spring's own line is on the limit, and what is integrated coarsely must not fall off it.
constexpr double kSoftness = 1e-5;

}  // namespace

double return_stiffness(const CrushProblem& problem, double force_n) {
  if (!std::isnan(problem.unloading.unloading_stiffness_n_per_m)) return problem.unloading.unloading_stiffness_n_per_m;
  const double root = force_n / (problem.unloading.restitution * problem.speed_mps);
  return root * root / problem.mass_kg;
}

Quadratic return_line(const CrushProblem& problem, double force_n, double max_crush_m) {
  const double stiffness = return_stiffness(problem, force_n);
  if (!(force_n > 0.0) || !std::isfinite(stiffness)) return {};
  return {force_n - stiffness * max_crush_m, stiffness, 0.0};
}

double return_line_energy(const Quadratic& line, double x) {
  const double force = value(line, x);
  return line[1] > 0.0 ? force * force / (2.0 * line[1]) : 0.0;
}

double softest_return(const CrushProblem& problem, double force_n, double max_crush_m) {
  const double root = force_n / problem.speed_mps;
  return std::max(root * root / problem.mass_kg, force_n / max_crush_m);
}

std::string why_too_soft(const CrushProblem& problem, double force_n, double max_crush_m) {
  const double least = softest_return(problem, force_n, max_crush_m);
  const std::string why = fmt::format(
      "from F_m = {:.6g} N at C = {:.6g} m a return line of {:.6g} N/m would give back more energy than was absorbed, "
      "or "
      "push ahead of the undeformed front",
      force_n, max_crush_m, return_stiffness(problem, force_n));
  if (!std::isnan(problem.unloading.unloading_stiffness_n_per_m))
    return fmt::format("{}: unloading_stiffness_n_per_m must be at least {:.6g}", why, least);
  const double most = force_n / (std::sqrt(least * problem.mass_kg) * problem.speed_mps);
  return fmt::format("{}: restitution = {:.6g} must be at most {:.6g} here", why, problem.unloading.restitution, most);
}

bool returns_too_much(const CrushProblem& problem, const Region& region, double max_crush_m) {
  const double force = value(region.return_line, max_crush_m);
  return region.return_line[1] < (1.0 - kSoftness) * softest_return(problem, force, max_crush_m);
}

}  // namespace crashsim
