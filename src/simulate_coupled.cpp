#include <crashsim/simulate_coupled.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include <fmt/format.h>

#include <crashsim/option_values.hpp>
#include <crashsim/signal.hpp>

#include "output_times.hpp"
#include "solver/coupled_recorder.hpp"
#include "solver/cvode.hpp"
#include "solver/return_line.hpp"

namespace crashsim {
namespace {

constexpr double kDefaultEnd = 0.3;           // [s]
constexpr double kLocalTolerance = 1e-4;      // CVODE's global error is up to 9,000 times its local tolerance here
constexpr double kTightestTolerance = 1e-14;  // CVODE cannot keep to less
constexpr double kSmallAngle = 0.2;           // sin and cos are off by 0.7 % and 2 % [rad]
constexpr double kNegligible = 0.01;          // of the largest: what may go unnoticed

double impact_speed(const CoupledModel& model, const CoupledOptions& options) {
  const double speed = std::isnan(options.impact_speed_mps) ? model.crush.impact_speed_mps : options.impact_speed_mps;
  if (!std::isnan(speed)) return speed;
  throw InvalidInput("CoupledOptions.impact_speed_mps: not given, and the crush model has none: give a speed");
}

void check(const CoupledModel& model, const TimeSeries& vertical_force_n) {
  if (vertical_force_n.empty()) return;
  check_series(vertical_force_n.time_s, vertical_force_n.values, "vertical_force_n", 2);
  if (is_active(model.vertical))
    throw InvalidInput(
        "vertical_force_n: there is also a VerticalForceLaw with an angle: give either a series or a law");
  require_set(model.body, &HeavePitchModel::force_arm_m, "HeavePitchModel", "there is a vertical force");
}

void judge(const CoupledSummary& summary, const CrushProblem& problem, CoupledResponse& out) {
  const double t = summary.end_time_s;
  switch (summary.end) {
    case CoupledEnd::left_knot_range:
      out.outcome = CoupledOutcome::left_knot_range;
      out.message = fmt::format(
          "at t = {:.6g} s the motion left the knots (crush {:.6g} m, v = {:.6g} m/s) and extrapolation is 'error': "
          "extend the curves or choose extrapolation 'constant'",
          t, out.crush_m.back(), out.velocity_mps.back());
      return;
    case CoupledEnd::unloading_too_soft:
      out.outcome = CoupledOutcome::unloading_too_soft;
      out.message = why_too_soft(problem, summary.max_crush_force_n, summary.max_crush_m);
      return;
    case CoupledEnd::too_steep:
      out.outcome = CoupledOutcome::failed;
      out.message = fmt::format(
          "at t = {:.6g} s, crush {:.6g} m, the angle of the vertical force law reaches {} rad: give friction, or a "
          "smaller angle_rate_rad_per_m",
          t, out.crush_m.back(), kSteepestAngle);
      return;
    case CoupledEnd::step_limit:
      out.outcome = CoupledOutcome::step_limit;
      out.message =
          fmt::format("{} steps reached only t = {:.6g} s: loosen rtol or check the model's numbers", summary.steps, t);
      return;
    case CoupledEnd::diverged:
      out.outcome = CoupledOutcome::failed;
      out.message = fmt::format("the motion grows without bound after t = {:.6g} s: check the model's numbers", t);
      return;
    case CoupledEnd::end_time:
      break;
  }
  out.outcome = std::isnan(summary.t_m_s) ? CoupledOutcome::no_max_crush : CoupledOutcome::completed;
  if (out.usable()) return;
  out.message = fmt::format(
      "no maximum crush: the crush rate did not reach zero within 0..{:.6g} s (v = {:.6g} m/s at the end, from {:.6g} "
      "m/s): simulate longer, or the structure is too weak",
      t, out.velocity_mps.back(), out.impact_speed_mps);
}

void note_pull(double load_n, std::string_view axle, std::vector<std::string>& notes) {
  if (load_n < 0.0)
    notes.push_back(fmt::format(
        "the ground pulls the {} axle with up to {:.4g} N: with lift_off the wheels would leave it", axle, -load_n));
}

void note_force_after_separation(const TimeSeries& force, double separation_s, std::vector<std::string>& notes) {
  if (std::isnan(separation_s)) return;
  double largest = 0.0, later = 0.0;
  for (std::size_t i = 0; i < force.time_s.size(); ++i) {
    largest = std::max(largest, std::abs(force.values[i]));
    if (force.time_s[i] > separation_s) later = std::max(later, std::abs(force.values[i]));
  }
  if (later > kNegligible * largest)
    notes.push_back(fmt::format("the given vertical force still reaches {:.4g} N after contact is lost at {:.4g} s",
                                later, separation_s));
}

void add_notes(const TimeSeries& vertical_force_n, CoupledResponse& out) {
  const double crush = std::ranges::max(out.crush_m);
  if (crush > out.max_crush_m * (1.0 + kNegligible))
    out.notes.push_back(fmt::format("crush is up to {:.4g} m after t_m: pitching drives the front in again", crush));
  const auto apart = std::ranges::upper_bound(out.time_s, out.separation_s) - out.time_s.begin();  // NaN: the end
  const auto after = std::span(out.crush_m).subspan(static_cast<std::size_t>(apart));
  if (!after.empty() && std::ranges::max(after) > out.static_crush_m)
    out.notes.push_back(
        fmt::format("contact was lost at {:.4g} m of crush, but pitching drives the front in to {:.4g} m: the barrier "
                    "does not push "
                    "again in this model, so do not rely on the motion after {:.4g} s",
                    out.static_crush_m, std::ranges::max(after), out.separation_s));
  const auto [least, most] = std::ranges::minmax(out.pitch_rad);
  if (std::max(-least, most) > kSmallAngle)
    out.notes.push_back(
        fmt::format("pitch goes from {:.3g} to {:.3g} rad: the equations are for small angles", least, most));
  note_pull(out.front_axle_load_min_n, "front", out.notes);
  note_pull(out.rear_axle_load_min_n, "rear", out.notes);
  note_force_after_separation(vertical_force_n, out.separation_s, out.notes);
}

/// Takes over what the integration found.
void set_events(const CoupledSummary& summary, CoupledResponse& out) {
  out.t_m_s = summary.t_m_s;
  out.max_crush_m = summary.max_crush_m;
  out.separation_s = summary.separation_s;
  out.static_crush_m = summary.static_crush_m;
  out.rebound_velocity_mps = summary.rebound_velocity_mps;
  out.front_lift_off_s = summary.lift_off_s[0];
  out.rear_lift_off_s = summary.lift_off_s[1];
  out.statistics = {.steps = summary.steps, .force_evaluations = summary.rhs_evaluations, .events = summary.events};
}

}  // namespace

CoupledResponse simulate_coupled(const CoupledModel& model, const CoupledOptions& options,
                                 const TimeSeries& vertical_force_n) {
  validate(model);
  validate_options(options, "CoupledOptions");
  check(model, vertical_force_n);
  CoupledResponse out;
  out.impact_speed_mps = impact_speed(model, options);
  const double end_s = std::isnan(options.end_time_s) ? kDefaultEnd : options.end_time_s;
  const std::vector<double> times = output_times(0.0, end_s, options.dt_s, "CoupledOptions.dt_s");
  const CoupledProblem problem = coupled_problem(with_one_mass(model), out.impact_speed_mps, vertical_force_n);
  CoupledRecorder recorder(problem, times, out);
  try {
    const CoupledSummary summary = integrate_coupled(
        problem, end_s, std::max(options.rtol * kLocalTolerance, kTightestTolerance),
        [&](const CoupledMode& mode, const CoupledStep& step, double tau) { recorder.on_piece(mode, step, tau); });
    recorder.finish(summary);
    set_events(summary, out);
    judge(summary, problem.crush(), out);
  } catch (const SolverError& error) {
    out.outcome = CoupledOutcome::failed;
    out.message = error.what();
  }
  if (out.usable()) add_notes(vertical_force_n, out);
  return out;
}

std::string CoupledResponse::brief_report() const {
  if (outcome == CoupledOutcome::not_run) return "not run";
  if (!usable()) return fmt::format("{}: {}", name_of(outcome), message);
  return fmt::format(
      "maximum crush {:.4f} m at {:.2f} ms from {:.3f} m/s, largest pitch {:.4g} rad ({:.3g} deg) at {:.4f} s, lowest "
      "heave {:.4g} m at {:.4f} s",
      max_crush_m, 1e3 * t_m_s, impact_speed_mps, pitch_max_rad, pitch_max_rad * 180.0 / std::numbers::pi,
      pitch_max_time_s, heave_min_m, heave_min_time_s);
}

}  // namespace crashsim
