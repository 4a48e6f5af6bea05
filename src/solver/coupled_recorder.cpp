#include "solver/coupled_recorder.hpp"

#include <algorithm>
#include <cmath>

#include <crashsim/units.hpp>

namespace crashsim {
namespace {

using coupled::kHeave, coupled::kHeaveRate, coupled::kPitch, coupled::kPitchRate, coupled::kSpeed, coupled::kTravel;

/// Raises `best` to the largest value of `sign` times `c` along a piece.
void raise(Peak& best, const Coefficients& c, double sign, const CoupledStep& step, double tau_end) {
  const auto consider = [&](double tau) {
    const double value = sign * horner(c, step.degree, tau);
    if (!(value <= best.value)) best = {step.base + tau, value};
  };
  consider(step.from);
  for (const double turn : SignChanges(derivative_of(c, step.degree), std::max(step.degree - 1, 0), step.from, tau_end))
    consider(turn);
  consider(tau_end);
}

double kinetic_energy(const CoupledProblem& problem, const CoupledState& y) {
  return 0.5 * (problem.mass_kg * (y[kSpeed] * y[kSpeed] + y[kHeaveRate] * y[kHeaveRate]) +
                problem.inertia_kgm2 * y[kPitchRate] * y[kPitchRate]);
}

double crush_energy(const CoupledProblem& problem, const CoupledMode& mode, const CoupledState& y) {
  return stored_energy(problem.crush(), mode.crush, value(crush_function(problem), y)) + y[coupled::kCrushLoss];
}

double suspension_energy(const CoupledProblem& problem, const CoupledState& y) {
  return axle_energy(problem, 0, y) + axle_energy(problem, 1, y);
}

}  // namespace

CoupledRecorder::CoupledRecorder(const CoupledProblem& problem, const std::vector<double>& times, CoupledResponse& out)
    : problem_(problem), times_(times), out_(out) {}

void CoupledRecorder::on_piece(const CoupledMode& mode, const CoupledStep& step, double tau_end) {
  const double t_end = step.base + tau_end;
  while (out_.time_s.size() + 1 < times_.size() && times_[out_.time_s.size()] < t_end) {
    const double t = times_[out_.time_s.size()];
    record(mode, t, step.state(t - step.base));
  }
  raise(travel_, step.c[kTravel], 1.0, step, tau_end);
  raise(decel_, derivative_of(step.c[kSpeed], step.degree), -1.0, step, tau_end);
  raise(pitch_, step.c[kPitch], 1.0, step, tau_end);
  raise(drop_, step.c[kHeave], -1.0, step, tau_end);
  raise(drop_rate_, step.c[kHeaveRate], -1.0, step, tau_end);
  const Coefficients front = step.polynomial(load_function(problem_, mode, 0));
  raise(front_load_, front, 1.0, step, tau_end);
  raise(front_unload_, front, -1.0, step, tau_end);
  raise(rear_unload_, step.polynomial(load_function(problem_, mode, 1)), -1.0, step, tau_end);
}

void CoupledRecorder::record(const CoupledMode& mode, double t, const CoupledState& y) {
  const CoupledForces force = forces(problem_, mode, t, y);
  const CoupledState rate = rates(problem_, mode, t, y);
  const double initial = 0.5 * problem_.mass_kg * problem_.speed_mps * problem_.speed_mps;
  out_.time_s.push_back(t);
  out_.displacement_m.push_back(y[kTravel]);
  out_.velocity_mps.push_back(y[kSpeed]);
  out_.accel_mps2.push_back(rate[kSpeed]);
  out_.crush_m.push_back(value(crush_function(problem_), y));
  out_.heave_m.push_back(y[kHeave]);
  out_.heave_velocity_mps.push_back(y[kHeaveRate]);
  out_.heave_accel_mps2.push_back(rate[kHeaveRate]);
  out_.pitch_rad.push_back(y[kPitch]);
  out_.pitch_rate_radps.push_back(y[kPitchRate]);
  out_.pitch_accel_radps2.push_back(rate[kPitchRate]);
  out_.longitudinal_force_n.push_back(force.longitudinal_n());
  out_.vertical_force_n.push_back(force.vertical_n);
  out_.front_axle_load_n.push_back(force.load_n[0]);
  out_.rear_axle_load_n.push_back(force.load_n[1]);
  out_.energy_residual_j.push_back(kinetic_energy(problem_, y) - initial + crush_energy(problem_, mode, y) +
                                   suspension_energy(problem_, y) + y[coupled::kSuspensionLoss] +
                                   y[coupled::kVerticalWork]);
}

void CoupledRecorder::finish(const CoupledSummary& summary) {
  record(summary.mode, summary.end_time_s, summary.last);
  out_.displacement_max_m = travel_.value;
  out_.displacement_max_time_s = travel_.time_s;
  out_.peak_decel_g = decel_.value / kStandardGravity;
  out_.pitch_max_rad = pitch_.value;
  out_.pitch_max_time_s = pitch_.time_s;
  out_.heave_min_m = -drop_.value;
  out_.heave_min_time_s = drop_.time_s;
  out_.heave_velocity_min_mps = -drop_rate_.value;
  out_.front_axle_load_max_n = front_load_.value;
  out_.front_axle_load_min_n = -front_unload_.value;
  out_.rear_axle_load_min_n = -rear_unload_.value;
  out_.kinetic_energy_j = kinetic_energy(problem_, summary.last);
  out_.crush_energy_j = crush_energy(problem_, summary.mode, summary.last);
  out_.suspension_energy_j = suspension_energy(problem_, summary.last);
  out_.suspension_dissipated_j = summary.last[coupled::kSuspensionLoss];
  out_.vertical_work_j = summary.last[coupled::kVerticalWork];
}

}  // namespace crashsim
