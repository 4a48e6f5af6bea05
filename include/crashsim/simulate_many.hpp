#pragma once
/// Simulation of many crush models at once: sweeps, Monte Carlo, surrogates.

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <crashsim/crush_model.hpp>
#include <crashsim/metrics.hpp>
#include <crashsim/options.hpp>
#include <crashsim/simulate.hpp>

namespace crashsim {

/// Numbers of many models or many responses: a row each.
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Models of one structure. What has an array has one value, or one row, a model; an empty array says that all have
/// what `common` has.
struct CrushModels {
  CrushModel common;                     ///< Law, extrapolation, unloading, and all that has no array.
  std::vector<double> mass_kg;           ///< [kg], > 0.
  std::vector<double> impact_speed_mps;  ///< [m/s], > 0.
  std::vector<double> restitution;       ///< Of plastic unloading, 0..1.
  std::vector<double> rate_coefficient;  ///< Of law `rate`, >= 0.
  RowMatrix spring_ordinates;  ///< [N] (law `stiffness`: [N/m]); as many columns as `common` has spring knots.
  RowMatrix damper_ordinates;  ///< [N s/m]
  RowMatrix spring_knots;      ///< [m], each row from 0 and increasing.
  RowMatrix damper_knots;      ///< [m/s], law `crush_damping` [m].

  /// Number of models: the length of the arrays, 1 without any.
  /// @throws InvalidInput when two arrays have different lengths.
  [[nodiscard]] std::size_t count() const;
  /// One of them. @throws InvalidInput when `index` is none.
  [[nodiscard]] CrushModel model(std::size_t index) const;
};

/// Which metrics a simulation of many models gives: those of the motion's events (t_m_s, max_crush_m, static_crush_m,
/// mean_decel_g, rebound_velocity_mps, restitution, centroid_s, energy_j), or all of Metrics.
enum class ManyMetrics { events, all };
inline constexpr std::string_view kManyMetricsNames[] = {"events", "all"};
template <>
inline constexpr std::span<const std::string_view> enum_names<ManyMetrics>{kManyMetricsNames};

/// Which engine integrates many models.
///     taylor       the Taylor kernel, a model a SIMD lane: as accurate as rtol says, and the fastest
///     cvode        simulate() by CVODE, one after another: the integrator of record
///     cvode_batch  CVODE with 64 models as one problem, which share its steps: accurate to about 1e-6
/// With `cvode_batch` at rtol = 1e-8, 90 % of models with 7 + 7 ordinates are within 1e-6 of each channel's maximum,
/// and single ones within some 1e-5: knots are crossed inside steps. The error goes as rtol^0.8 and is larger with more
/// knots. Outcomes are those of `cvode`, but where a motion comes as near to another one as that error. A model's
/// numbers depend, within the error, on those it shares a problem with: models 0..63, 64..127 and so on. Motions that
/// others would have to wait for are simulated alone: of a bilateral elastic force that jumps at x = 0, and those that
/// grow without bound. Models of law `rate` are always simulated alone, with `taylor` by simulate()'s Taylor kernel,
/// with the others by CVODE.
enum class ManyIntegrator { taylor, cvode, cvode_batch };
inline constexpr std::string_view kManyIntegratorNames[] = {"taylor", "cvode", "cvode_batch"};
template <>
inline constexpr std::span<const std::string_view> enum_names<ManyIntegrator>{kManyIntegratorNames};

/// How to simulate many models.
struct SimulateManyOptions {
  double end_time_s = kUnset;   ///< Unset: 0.2 s.
  double dt_s = 1e-4;           ///< Output interval; samples at 0, dt, ... and at the end.
  std::vector<double> times_s;  ///< Output times instead, increasing from >= 0; the last is the end.
  double rtol = 1e-8;           ///< Relative accuracy of the result.
  ManyIntegrator integrator = ManyIntegrator::taylor;
  bool samples = true;  ///< Give the motions, too; false: only outcomes and metrics.
  ManyMetrics metrics = ManyMetrics::events;
  int jobs = 0;  ///< Threads; 0: all cores.

  bool operator==(const SimulateManyOptions&) const = default;
};
inline constexpr std::array<Field<SimulateManyOptions>, 8> kSimulateManyFields = {{
    {"end_time_s", "end", "s", "time to simulate to; default 0.2 s", &SimulateManyOptions::end_time_s,
     positive_up_to(kLongestMotion_s)},
    {"dt_s", "dt", "s", "output interval", &SimulateManyOptions::dt_s, positive()},
    {"times_s", "times", "s", "output times instead of an interval", &SimulateManyOptions::times_s},
    {"rtol", "rtol", "", "relative accuracy", &SimulateManyOptions::rtol, between(1e-12, 1e-2)},
    {"integrator", "integrator", "", "engine", choice<&SimulateManyOptions::integrator>()},
    {"samples", "samples", "", "give the motions, too", &SimulateManyOptions::samples},
    {"metrics", "metrics", "", "which metrics", choice<&SimulateManyOptions::metrics>()},
    {"jobs", "jobs", "", "threads; 0: all cores", &SimulateManyOptions::jobs, between(0, 1024)},
}};
template <>
inline constexpr std::span<const Field<SimulateManyOptions>> fields<SimulateManyOptions>{kSimulateManyFields};

/// What a simulation of many models gives: a row or an entry a model, in their order.
struct CrushResponses {
  std::vector<double> time_s;  ///< Output times [s], the same for all.
  RowMatrix accel_mps2;        ///< dv/dt [m/s^2]; NaN after a motion that broke off.
  RowMatrix velocity_mps;      ///< [m/s]
  RowMatrix displacement_m;    ///< Crush [m].
  std::vector<CrushOutcome> outcome;
  std::vector<Metrics> metrics;  ///< Unset where the motion broke off.
  long steps = 0;                ///< Of the integrator, all models together; one that 64 models share counts once.

  /// Number of models whose outcome is `completed`.
  [[nodiscard]] std::size_t completed() const;
};

/// Simulates every model from impact. The numbers of a model do not depend on the threads, nor, but for `cvode_batch`,
/// on the other models.
/// @throws InvalidInput on arrays that do not fit together, a bad value (named with its model) or a bad option.
CrushResponses simulate_many(const CrushModels& models, const SimulateManyOptions& options = {});
/// The same into the memory of earlier responses: of many calls in turn, each of one size, only the first allocates.
void simulate_many(const CrushModels& models, const SimulateManyOptions& options, CrushResponses& out);

}  // namespace crashsim
