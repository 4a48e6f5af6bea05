#include <crashsim/simulate.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <crashsim/option_values.hpp>

#include "crush_outcome.hpp"
#include "output_times.hpp"
#include "solver/crush_motion.hpp"
#include "solver/cvode_crush.hpp"
#include "solver/return_line.hpp"
#include "solver/taylor.hpp"

namespace crashsim {
namespace {

constexpr std::size_t kMaxSamples = 10'000'000;

/// The arrays beside the times.
std::array<std::vector<double>*, 6> columns_of(CrushResponse& out) {
  return {&out.accel_mps2,     &out.velocity_mps,   &out.displacement_m,
          &out.spring_force_n, &out.damper_force_n, &out.energy_residual_j};
}

/// Samples the pieces of a motion at its output times.
class Recorder {
 public:
  Recorder(const CrushProblem& problem, const SimulateOptions& options, CrushResponse& out)
      : problem_(problem), options_(options), out_(out), last_region_(initial_region(problem)) {
    last_.v[0] = problem.speed_mps;
  }

  void on_piece(const Region& region, const StepPolynomial& step, double tau_end) {
    const double t_end = step.base + tau_end;
    const std::size_t first = out_.time_s.size();
    for (double t = next_time(); t <= t_end; t = next_time()) out_.time_s.push_back(t);
    record(region, step, tau_end, first);
    last_ = step;
    last_region_ = region;
    last_tau_ = tau_end;
  }

  void on_event(const Region&, const Region&, double, double) {}

  /// Adds the end of the motion unless it is a sample already.
  void finish() {
    const double t = last_.base + last_tau_;
    const double least_gap = 1e-9 * options_.dt_s;
    const bool on_grid = options_.times_s.empty();
    if (out_.time_s.empty() || (on_grid && t - out_.time_s.back() > least_gap)) {
      out_.time_s.push_back(t);
      record(last_region_, last_, last_tau_, out_.time_s.size() - 1);
    }
    const double v = last_.v_at(last_tau_);
    out_.kinetic_energy_j = 0.5 * problem_.mass_kg * v * v;
    out_.dissipated_energy_j = last_.dissipated_at(last_tau_);
    out_.spring_energy_j = stored_energy(problem_, last_region_, last_.x_at(last_tau_));
  }

 private:
  [[nodiscard]] double next_time() const {
    const std::size_t i = out_.time_s.size();
    if (options_.times_s.empty()) return options_.dt_s * static_cast<double>(i);
    return i < options_.times_s.size() ? options_.times_s[i] : std::numeric_limits<double>::infinity();
  }

  /// Fills the samples from `first` on, which lie in the step up to `tau_end`.
  void record(const Region& region, const StepPolynomial& step, double tau_end, std::size_t first) {
    const std::size_t count = out_.time_s.size();
    if (first == count) return;
    for (std::vector<double>* column : columns_of(out_)) column->resize(count);
    const RegionForce force = region_force(problem_, region);
    const std::array<double, 4> energy = stored_energy_polynomial(problem_, region, step.x_at(tau_end));
    const double half_mass = 0.5 * problem_.mass_kg, speed = problem_.speed_mps;
    for (std::size_t i = first; i < count; ++i) {
      const double tau = std::min(out_.time_s[i] - step.base, tau_end);
      const double x = step.x_at(tau), v = step.v_at(tau);
      const double spring = value(force.spring, x), damper = force.damper_at(x, v);
      const double absorbed = energy[0] + x * (energy[1] + x * (energy[2] + x * energy[3])) + step.dissipated_at(tau);
      out_.displacement_m[i] = x;
      out_.velocity_mps[i] = v;
      out_.accel_mps2[i] = -(spring + damper) / problem_.mass_kg;
      out_.spring_force_n[i] = spring;
      out_.damper_force_n[i] = damper;
      out_.energy_residual_j[i] = half_mass * (v * v - speed * speed) + absorbed;
    }
  }

  const CrushProblem& problem_;
  const SimulateOptions& options_;
  CrushResponse& out_;
  StepPolynomial last_;
  Region last_region_;
  double last_tau_ = 0.0;
};

double end_time(const SimulateOptions& options) {
  check_output_times(options.times_s, "SimulateOptions.times_s");
  if (!options.times_s.empty()) return options.times_s.back();
  return std::isnan(options.end_time_s) ? kDefaultEnd_s : options.end_time_s;
}

std::size_t sample_count(const SimulateOptions& options, double end_time_s) {
  if (!options.times_s.empty()) return options.times_s.size();
  const double samples = end_time_s / options.dt_s + 2.0;
  if (samples > static_cast<double>(kMaxSamples))
    throw InvalidInput(
        fmt::format("SimulateOptions.dt_s = {} s: {:.3g} samples to {} s are more than {}: choose a larger interval",
                    options.dt_s, samples, end_time_s, kMaxSamples));
  return static_cast<std::size_t>(samples);
}

void reserve(CrushResponse& out, std::size_t samples) {
  out.time_s.reserve(samples);
  for (std::vector<double>* column : columns_of(out)) column->reserve(samples);
}

MotionSummary run(const CrushProblem& problem, const SimulateOptions& options, double end_time_s, Recorder& recorder,
                  SolverStatistics& statistics) {
  const MotionLimits limits{end_time_s, options.to_max_crush};
  if (options.integrator == Integrator::taylor) {
    TaylorStepper stepper(options.rtol * kLocalPerGlobal, true);
    const MotionSummary summary = integrate_motion(problem, limits, stepper, recorder);
    statistics.force_evaluations = summary.steps * kTaylorDegree;
    return summary;
  }
  CvodeStepper stepper(std::max(options.rtol * kLocalPerGlobal, 1e-14));
  const MotionSummary summary = integrate_motion(problem, limits, stepper, recorder);
  statistics.force_evaluations = stepper.rhs_evaluations();
  return summary;
}

/// Empty for a usable result.
std::string why_not_usable(const MotionSummary& summary, const CrushProblem& problem, const CrushResponse& out) {
  const double t = summary.end_time_s;
  switch (out.outcome) {
    case CrushOutcome::left_knot_range:
      return fmt::format(
          "at t = {:.6g} s the motion left the knots (x = {:.6g} m, v = {:.6g} m/s) and extrapolation is 'error': "
          "extend the curves or choose extrapolation 'constant'",
          t, out.displacement_m.back(), out.velocity_mps.back());
    case CrushOutcome::unloading_too_soft:
      return why_too_soft(problem, summary.max_crush_force_n, summary.max_crush_m);
    case CrushOutcome::step_limit:
      return fmt::format("{} steps reached only t = {:.6g} s: loosen rtol or check the model's ordinates",
                         summary.steps, t);
    case CrushOutcome::failed:
      return fmt::format(
          "the motion grows without bound after t = {:.6g} s (x = {:.6g} m, v = {:.6g} m/s): check the model's "
          "ordinates and extrapolation",
          t, out.displacement_m.back(), out.velocity_mps.back());
    case CrushOutcome::no_max_crush:
      return fmt::format(
          "no maximum crush: v did not reach zero within 0..{:.6g} s (v = {:.6g} m/s at the end, from {:.6g} m/s): "
          "simulate longer, or the structure is too weak",
          t, out.velocity_mps.back(), problem.speed_mps);
    case CrushOutcome::not_run:
    case CrushOutcome::completed:
      break;
  }
  return {};
}

void judge(const MotionSummary& summary, const CrushProblem& problem, CrushResponse& out) {
  out.t_m_s = summary.t_m_s;
  out.max_crush_m = summary.max_crush_m;
  out.separation_s = summary.separation_s;
  out.static_crush_m = summary.static_crush_m;
  out.rebound_velocity_mps = summary.rebound_velocity_mps;
  out.statistics.steps = summary.steps;
  out.statistics.events = summary.events;
  out.outcome = outcome_of(summary);
  out.message = why_not_usable(summary, problem, out);
}

}  // namespace

CrushResponse simulate(const CrushModel& model, const SimulateOptions& options) {
  validate(model);
  validate_options(options, "SimulateOptions");
  CrushResponse out;
  out.impact_speed_mps = std::isnan(options.impact_speed_mps) ? model.impact_speed_mps : options.impact_speed_mps;
  if (std::isnan(out.impact_speed_mps))
    throw InvalidInput("SimulateOptions.impact_speed_mps: not given, and the model has none: give a speed");
  const double end_time_s = end_time(options);
  reserve(out, sample_count(options, end_time_s));

  const CrushForce force = make_force(model);
  const CrushProblem problem{force, model.mass_kg, out.impact_speed_mps, model.unloading};
  Recorder recorder(problem, options, out);
  try {
    const MotionSummary summary = run(problem, options, end_time_s, recorder, out.statistics);
    recorder.finish();
    judge(summary, problem, out);
  } catch (const SolverError& error) {
    out.outcome = CrushOutcome::failed;
    out.message = error.what();
  }
  return out;
}

std::string CrushResponse::brief_report() const {
  if (outcome == CrushOutcome::not_run) return "not run";
  if (!usable()) return fmt::format("{}: {}", name_of(outcome), message);
  return fmt::format("maximum crush {:.4f} m at {:.2f} ms from {:.3f} m/s ({} steps)", max_crush_m, 1e3 * t_m_s,
                     impact_speed_mps, statistics.steps);
}

}  // namespace crashsim
