#include "optimize/equation_error.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "optimize/bounded_least_squares.hpp"

namespace crashsim {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kMostSteps = 50, kMostHalvings = 8;
constexpr double kSettled = 1e-12;  // relative decrease of the sum of squares that ends the steps

std::span<const double> view(const VectorXd& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }

/// Features of fit_kernel.hpp at one state: those of the spring, then those of the damper.
std::array<double, 6> features_at(const RegionForce& force, bool is_rate, double x, double v) {
  if (!is_rate) return {1.0, x, x * x, v, v * v, x * v};
  const double log = std::log1p(force.per_reference * v), hardening = 1.0 + force.rate * log;
  return {hardening, x * hardening, x * x * hardening, log, x * log, x * x * log};
}

/// What a sample says: how its force deviates, and which parameters can change it.
class SampleRow {
 public:
  SampleRow(const FitStructure& structure, const FitForce& fit) : is_rate_(structure.has_rate()), fit_(fit) {}

  double force_at(double x, double v) {
    const CrushForce& force = fit_.force();
    const int s = force.spring.locate(x, +1), d = force.damper.locate(v, +1);
    const RegionForce here = region_force(force, s, d);
    fit_.set_action(s, d, action_);
    features_ = features_at(here, is_rate_, x, v);
    return here.at(x, v);
  }
  void add_derivatives(double weight, Eigen::MatrixXd::RowXpr row) const {
    for (const auto& [parameter, column, factor] : action_.entries()) {
      const double* const basis = action_.basis[column];
      const double* const of = features_.data() + (column < 2 ? 0 : 3);
      row[static_cast<Index>(parameter)] += weight * factor * (basis[0] * of[0] + basis[1] * of[1] + basis[2] * of[2]);
    }
  }

 private:
  bool is_rate_;
  const FitForce& fit_;
  Action action_{};
  std::array<double, 6> features_{};
};

/// Force residuals and penalties: what is to be least.
class Problem {
 public:
  Problem(const FitStructure& structure, std::span<const FitTarget> targets, const Penalties& penalties)
      : structure_(structure), targets_(targets), penalties_(penalties) {}

  [[nodiscard]] ForceResiduals at(const VectorXd& parameters) const {
    ForceResiduals out = force_residuals(structure_, targets_, view(parameters));
    if (penalties_.rows.rows() == 0) return out;
    const Index samples = out.residuals.size(), rows = penalties_.rows.rows();
    const double root = std::sqrt(static_cast<double>(targets_.size()));  // E is the targets' mean, this their sum
    out.residuals.conservativeResize(samples + rows);
    out.jacobian.conservativeResize(samples + rows, Eigen::NoChange);
    out.residuals.tail(rows) = root * (penalties_.rows * parameters - penalties_.aims);
    out.jacobian.bottomRows(rows) = root * penalties_.rows;
    return out;
  }

 private:
  const FitStructure& structure_;
  std::span<const FitTarget> targets_;
  const Penalties& penalties_;
};

/// Solves the problem as it looks from `from`.
VectorXd solve_linearised(const ForceResiduals& here, const VectorXd& from, const VectorXd& upper) {
  return bounded_least_squares(here.jacobian, here.jacobian * from - here.residuals, upper);
}

VectorXd solve_by_steps(const Problem& problem, VectorXd parameters, const VectorXd& upper) {
  ForceResiduals here = problem.at(parameters);
  for (int step = 0; step < kMostSteps; ++step) {
    const double before = here.residuals.squaredNorm();
    const VectorXd aim = solve_linearised(here, parameters, upper);
    double part = 1.0;
    for (int halving = 0; halving < kMostHalvings; ++halving, part *= 0.5) {
      const VectorXd trial = parameters + part * (aim - parameters);
      ForceResiduals there = problem.at(trial);
      if (!(there.residuals.squaredNorm() < before)) continue;
      parameters = trial;
      here = std::move(there);
      break;
    }
    if (!(before - here.residuals.squaredNorm() > kSettled * before)) break;
  }
  return parameters;
}

void check_count(const FitStructure& structure, std::span<const FitTarget> targets) {
  std::size_t samples = 0;
  for (const FitTarget& target : targets) samples += target.time_s.size();
  if (samples < structure.size())
    throw InvalidInput(
        fmt::format("{} samples up to t_m cannot determine {} ordinates: use fewer knots", samples, structure.size()));
}

/// No force, and knots in the middle of where they may be.
VectorXd first_guess(const FitStructure& structure, const VectorXd& upper) {
  VectorXd guess = VectorXd::Zero(static_cast<Index>(structure.size()));
  const auto knots = static_cast<Index>(structure.size() - structure.first_knot());
  guess.tail(knots) = 0.5 * upper.tail(knots);
  return guess;
}

}  // namespace

ForceResiduals force_residuals(const FitStructure& structure, std::span<const FitTarget> targets,
                               std::span<const double> parameters) {
  FitForce fit(structure);
  fit.set(parameters);
  Index samples = 0;
  for (const FitTarget& target : targets) samples += static_cast<Index>(target.time_s.size());
  ForceResiduals out{VectorXd(samples), Eigen::MatrixXd::Zero(samples, static_cast<Index>(fit.inner_size()))};
  SampleRow sample(structure, fit);
  Index row = 0;
  for (const FitTarget& target : targets) {
    // Acceleration without weight in E still has to say what the force is.
    const double scale =
        target.accel_scale > 0.0 ? target.accel_scale : target.velocity_scale + target.displacement_scale;
    const double weight = scale * std::sqrt(target.factor) / target.mass_kg;
    for (std::size_t i = 0; i < target.time_s.size(); ++i, ++row) {
      // v > 0 up to t_m: a negative x is rounding, and must not turn a force that does not vanish at 0.
      const double force = sample.force_at(std::max(target.displacement_m[i], 0.0), target.velocity_mps[i]);
      out.residuals[row] = weight * (force + target.mass_kg * target.accel_mps2[i]);
      sample.add_derivatives(weight, out.jacobian.row(row));
    }
  }
  if (fit.by_parameters().size() > 0) out.jacobian *= fit.by_parameters();
  return out;
}

EquationErrorSystem assemble_equation_error(const FitStructure& structure, std::span<const FitTarget> targets,
                                            const VectorXd& upper) {
  check_count(structure, targets);
  const VectorXd guess = first_guess(structure, upper);
  ForceResiduals force = force_residuals(structure, targets, view(guess));
  const double root = std::sqrt(static_cast<double>(targets.size()));  // E is the targets' mean, this their sum
  VectorXd rhs = force.jacobian * guess - force.residuals;
  return {std::move(force.jacobian), std::move(rhs),
          root * make_penalties(structure, force_scale(structure.law, targets), 1.0, {}).rows};
}

VectorXd solve_equation_error(const FitStructure& structure, std::span<const FitTarget> targets, const VectorXd& upper,
                              double smooth, const Prior& prior) {
  check_count(structure, targets);
  const Penalties penalties = make_penalties(structure, force_scale(structure.law, targets), smooth, prior);
  const Problem problem(structure, targets, penalties);
  const VectorXd guess = first_guess(structure, upper);
  const bool is_linear = structure.curve == Curve::linear && !structure.has_rate() && !structure.has_free_knots;
  return is_linear ? solve_linearised(problem.at(guess), guess, upper) : solve_by_steps(problem, guess, upper);
}

}  // namespace crashsim
