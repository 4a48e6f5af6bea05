#pragma once
/// Heave and pitch with their derivatives by parameters of the model, stepped by Taylor series: exact to rounding for
/// any step, so that a target may have its own times.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "optimize/pitch_parameters.hpp"
#include "optimize/simd.hpp"
#include "solver/pitch_grid.hpp"

namespace crashsim {

/// Taylor coefficients of a force about the start of a step.
using ForceSeries = std::array<double, 3>;

/// The generalised forces over a step: Q_z, and Q_theta = moment + l_Q by_arm + h_cg by_cg_height + h_F
/// by_force_height.
struct ForceTerms {
  ForceSeries heave, moment, by_arm, by_cg_height, by_force_height;
};

/// Times at which the motion is known exactly, and the forces between them; nothing here depends on a parameter.
struct PitchSteps {
  std::vector<double> lengths_s;
  std::vector<ForceTerms> forces;    ///< As many as lengths.
  std::vector<std::size_t> samples;  ///< Number of steps before each sample time.
  double longest_s = 0.0;
};
PitchSteps make_steps(const HeavePitchModel& model, const PitchForcing& forcing, double start_s,
                      std::span<const double> times);

/// M q'' + C q' + K q = Q per unit mass, with derivatives by up to kLanes parameters, one in each lane.
class PitchEquation {
 public:
  /// @param longest_step_s longer ones are not asked for.
  PitchEquation(const HeavePitchModel& model, std::span<const PitchParameter> parameters, double longest_step_s);

  /// z, theta, z', theta' and their derivatives.
  struct State {
    std::array<double, 4> value = {};
    std::array<Lanes, 4> slope = {};
  };

  /// Carries a state over a step.
  void advance(const ForceTerms& forces, double step_s, State& state) const;

 private:
  struct Matrix {
    double a[2][2] = {};
    Lanes slope[2][2] = {};
  };
  struct Accelerations {
    double value[2][3];
    Lanes slope[2][3];
  };
  void set_matrices(const HeavePitchModel& model, std::span<const PitchParameter> parameters);
  void set_degree(double longest_step_s);
  void accelerations(const ForceTerms& forces, Accelerations& out) const;
  void step(const Accelerations& forces, double step_s, State& state) const;

  Matrix stiffness_, damping_;
  double per_mass_ = 0.0, per_inertia_ = 0.0, arm_ = 0.0, cg_height_ = 0.0, force_height_ = 0.0;
  Lanes per_mass_slope_ = {}, per_inertia_slope_ = {}, arm_slope_ = {}, cg_height_slope_ = {}, force_height_slope_ = {};
  double longest_series_s_ = 0.0;  ///< Longer steps are divided.
  int degree_ = 0;
};

}  // namespace crashsim
