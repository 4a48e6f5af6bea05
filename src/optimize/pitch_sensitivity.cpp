#include "optimize/pitch_sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

namespace crashsim {
namespace {

/// Largest product of the fastest rate and the step for which one Taylor series is taken.
constexpr double kSeriesRadius = 1.0;
constexpr double kTruncation = 1e-15;  // of a series

using M = HeavePitchModel;

/// Derivative of a matrix that is at most quadratic in the parameter: a central difference of any width is exact.
template <class MatrixOf>
Eigen::Matrix2d derivative(MatrixOf matrix_of, const M& model, const PitchParameter& parameter) {
  const double width = parameter.upper - parameter.lower;
  M above = model, below = model;
  above.*parameter.member += width;
  below.*parameter.member -= width;
  return (matrix_of(above) - matrix_of(below)) / (2.0 * width);
}

double set_or_zero(double value) { return std::isnan(value) ? 0.0 : value; }

ForceSeries series_of(const ForcePiece& piece, Eigen::Index row) {
  return {piece(row, 0), piece(row, 1), 0.5 * piece(row, 2)};
}

ForceSeries minus(const ForceSeries& a, const ForceSeries& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

/// The same force, told from `s` later on.
ForceSeries shifted(const ForceSeries& f, double s) {
  return {f[0] + s * (f[1] + s * f[2]), f[1] + 2.0 * s * f[2], f[2]};
}

ForceTerms shifted(const ForceTerms& f, double s) {
  return {shifted(f.heave, s), shifted(f.moment, s), shifted(f.by_arm, s), shifted(f.by_cg_height, s),
          shifted(f.by_force_height, s)};
}

}  // namespace

PitchSteps make_steps(const HeavePitchModel& model, const PitchForcing& forcing, double start_s,
                      std::span<const double> times) {
  M unit = model;
  unit.mass_kg = unit.pitch_inertia_kgm2 = 1.0;
  unit.force_arm_m = unit.cg_height_m = unit.force_height_m = 0.0;
  const auto grid_with = [&](double M::*arm) {
    M with = unit;
    if (arm != nullptr) with.*arm = 1.0;
    return make_grid(with, forcing, start_s, times, std::numeric_limits<double>::infinity());
  };
  const PitchGrid fixed = grid_with(nullptr), arm = grid_with(&M::force_arm_m), cg = grid_with(&M::cg_height_m),
                  height = grid_with(&M::force_height_m);
  PitchSteps steps;
  steps.samples = fixed.samples;
  for (std::size_t i = 0; i + 1 < fixed.times.size(); ++i) {
    const ForceSeries moment = series_of(fixed.forces[i], 1);
    const auto beyond = [&](const PitchGrid& grid) { return minus(series_of(grid.forces[i], 1), moment); };
    steps.lengths_s.push_back(fixed.times[i + 1] - fixed.times[i]);
    steps.longest_s = std::max(steps.longest_s, steps.lengths_s.back());
    steps.forces.push_back({series_of(fixed.forces[i], 0), moment, beyond(arm), beyond(cg), beyond(height)});
  }
  return steps;
}

PitchEquation::PitchEquation(const HeavePitchModel& model, std::span<const PitchParameter> parameters,
                             double longest_step_s)
    : per_mass_(1.0 / model.mass_kg),
      per_inertia_(1.0 / model.pitch_inertia_kgm2),
      arm_(set_or_zero(model.force_arm_m)),
      cg_height_(set_or_zero(model.cg_height_m)),
      force_height_(set_or_zero(model.force_height_m)) {
  set_matrices(model, parameters);
  set_degree(longest_step_s);
}

void PitchEquation::set_matrices(const HeavePitchModel& model, std::span<const PitchParameter> parameters) {
  const LinearSystem system = linear_system(model);
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      stiffness_.a[i][j] = system.stiffness(i, j);
      damping_.a[i][j] = system.damping(i, j);
    }
  const Eigen::Matrix2d per_mass = mass_matrix(model).inverse();
  for (std::size_t lane = 0; lane < parameters.size(); ++lane) {
    const PitchParameter& p = parameters[lane];
    const Eigen::Matrix2d mass = derivative(mass_matrix, model, p);
    const Eigen::Matrix2d stiffness = per_mass * (derivative(stiffness_matrix, model, p) - mass * system.stiffness);
    const Eigen::Matrix2d damping = per_mass * (derivative(damping_matrix, model, p) - mass * system.damping);
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        stiffness_.slope[i][j][lane] = stiffness(i, j);
        damping_.slope[i][j][lane] = damping(i, j);
      }
    per_mass_slope_[lane] = -mass(0, 0) * per_mass_ * per_mass_;
    per_inertia_slope_[lane] = -mass(1, 1) * per_inertia_ * per_inertia_;
    arm_slope_[lane] = p.member == &M::force_arm_m ? 1.0 : 0.0;
    cg_height_slope_[lane] = p.member == &M::cg_height_m ? 1.0 : 0.0;
    force_height_slope_[lane] = p.member == &M::force_height_m ? 1.0 : 0.0;
  }
}

/// Degree at which the remainder is below kTruncation. Force rates enter three orders late, derivatives by parameters
/// one.
void PitchEquation::set_degree(double longest_step_s) {
  const double radius = std::sqrt(per_mass_ / per_inertia_);  // J = m radius^2 makes the norms free of units
  const auto norm = [radius](const Matrix& m) {
    const double heave = std::fabs(m.a[0][0]) + std::fabs(m.a[0][1]) / radius;
    return std::max(heave, std::fabs(m.a[1][0]) * radius + std::fabs(m.a[1][1]));
  };
  const double rate = std::sqrt(norm(stiffness_)) + norm(damping_);
  longest_series_s_ = kSeriesRadius / rate;
  const double reach = rate * std::min(longest_step_s, longest_series_s_);
  degree_ = 4;
  for (double remainder = 4.0 / 120.0; remainder > kTruncation; ++degree_) remainder *= reach / (degree_ + 2);
}

CRASHSIM_INLINE void PitchEquation::accelerations(const ForceTerms& forces, Accelerations& out) const {
  for (std::size_t n = 0; n < 3; ++n) {
    const double moment = forces.moment[n] + arm_ * forces.by_arm[n] + cg_height_ * forces.by_cg_height[n] +
                          force_height_ * forces.by_force_height[n];
    out.value[0][n] = per_mass_ * forces.heave[n];
    out.value[1][n] = per_inertia_ * moment;
    out.slope[0][n] = per_mass_slope_ * forces.heave[n];
    out.slope[1][n] = per_inertia_slope_ * moment +
                      per_inertia_ * (arm_slope_ * forces.by_arm[n] + cg_height_slope_ * forces.by_cg_height[n] +
                                      force_height_slope_ * forces.by_force_height[n]);
  }
}

/// Terms of order n times h^n: y_(n+1) = h / (n + 1) (rates of y_n).
CRASHSIM_INLINE void PitchEquation::step(const Accelerations& forces, double step_s, State& state) const {
  State term = state;
  double power = 1.0;
  for (int n = 0; n < degree_; ++n) {
    const State last = term;
    const double factor = step_s / (n + 1);
    for (std::size_t i = 0; i < 2; ++i) {
      const double* const k = stiffness_.a[i];
      const double* const c = damping_.a[i];
      const Lanes* const dk = stiffness_.slope[i];
      const Lanes* const dc = damping_.slope[i];
      double value = -(k[0] * last.value[0] + k[1] * last.value[1] + c[0] * last.value[2] + c[1] * last.value[3]);
      Lanes slope = -(k[0] * last.slope[0] + k[1] * last.slope[1] + c[0] * last.slope[2] + c[1] * last.slope[3] +
                      dk[0] * last.value[0] + dk[1] * last.value[1] + dc[0] * last.value[2] + dc[1] * last.value[3]);
      if (n < 3) {
        value += power * forces.value[i][n];
        slope += power * forces.slope[i][n];
      }
      term.value[i] = factor * last.value[i + 2];
      term.slope[i] = factor * last.slope[i + 2];
      term.value[i + 2] = factor * value;
      term.slope[i + 2] = factor * slope;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      state.value[i] += term.value[i];
      state.slope[i] += term.slope[i];
    }
    power *= step_s;
  }
}

CRASHSIM_WIDEST_VECTORS
void PitchEquation::advance(const ForceTerms& forces, double step_s, State& state) const {
  Accelerations at;
  if (step_s <= longest_series_s_) {
    accelerations(forces, at);
    step(at, step_s, state);
    return;
  }
  const double parts = std::ceil(step_s / longest_series_s_);
  for (double i = 0.0; i < parts; ++i) {
    accelerations(shifted(forces, step_s * i / parts), at);
    step(at, step_s / parts, state);
  }
}

}  // namespace crashsim
