#include "solver/coupled_problem.hpp"

#include <algorithm>
#include <cmath>

#include <crashsim/units.hpp>

namespace crashsim {
namespace {

using coupled::kCrushLoss, coupled::kSuspensionLoss, coupled::kVerticalWork;
using coupled::kHeave, coupled::kHeaveRate, coupled::kPitch, coupled::kPitchRate, coupled::kSpeed, coupled::kTravel;

constexpr LinearFunction kNeverOn = {.constant = -1.0};

/// A displacement z + place theta, and its rate.
LinearFunction rise(double place) { return {.weights = {0.0, 1.0, place, 0.0, 0.0, 0.0}}; }
LinearFunction rise_rate(double place) { return {.weights = {0.0, 0.0, 0.0, 0.0, 1.0, place}}; }

LinearFunction scaled(const LinearFunction& f, double factor, double added = 0.0) {
  LinearFunction out{.constant = factor * f.constant + added};
  for (std::size_t i = 0; i < out.weights.size(); ++i) out.weights[i] = factor * f.weights[i];
  return out;
}

ForceAngle force_angle(const VerticalForceLaw& law) {
  const bool bounded = !std::isnan(law.friction);
  const double limit = bounded ? std::atan(law.friction) : kSteepestAngle;
  ForceAngle angle{.first_rad = std::clamp(law.angle_rad, -limit, limit)};
  if (law.angle_rate_rad_per_m == 0.0) return angle;
  const double last = std::copysign(limit, law.angle_rate_rad_per_m);
  const double start = (angle.first_rad - law.angle_rad) / law.angle_rate_rad_per_m;  // > 0: bounded until then
  const double end = (last - law.angle_rad) / law.angle_rate_rad_per_m;
  if (end <= std::max(0.0, start)) return angle;  // bounded from the beginning, and ever more so
  angle.rate_rad_per_m = law.angle_rate_rad_per_m;
  angle.last_rad = last;
  angle.start_m = law.angle_start_m + std::max(0.0, start);
  angle.end_m = law.angle_start_m + end;
  angle.end_is_error = !bounded;
  return angle;
}

double tangent(const ForceAngle& angle, const CoupledMode& mode, double s) {
  if (mode.on[kAngleEnds]) return std::tan(angle.last_rad);
  if (mode.on[kAngleChanges]) return std::tan(angle.first_rad + angle.rate_rad_per_m * (s - angle.start_m));
  return std::tan(angle.first_rad);
}

/// The series line by line, zero before and after.
std::vector<ForceLine> force_lines(const TimeSeries& series) {
  std::vector<ForceLine> lines{{}};
  for (std::size_t i = 0; i + 1 < series.time_s.size(); ++i)
    lines.push_back({series.time_s[i], series.values[i],
                     (series.values[i + 1] - series.values[i]) / (series.time_s[i + 1] - series.time_s[i])});
  if (!series.empty()) lines.push_back({.start_s = series.time_s.back()});
  return lines;
}

Axle make_axle(double place, double stiffness, double damping, double static_load, double gap, double bump_stiffness) {
  Axle axle{.place_m = place, .stiffness = stiffness, .damping = damping, .static_load_n = static_load};
  if (std::isnan(gap)) return axle;
  axle.bump_gap_m = gap;
  axle.bump_stiffness = bump_stiffness;
  return axle;
}

double droop_of(const Axle& axle) { return axle.static_load_n / axle.stiffness; }

}  // namespace

double value(const LinearFunction& f, const CoupledState& y) {
  double sum = f.constant;
  for (std::size_t i = 0; i < f.weights.size(); ++i) sum += f.weights[i] * y[i];
  return sum;
}

CoupledProblem coupled_problem(const CoupledModel& model, double speed_mps, const TimeSeries& vertical_force_n) {
  const HeavePitchModel body = with_axle_values(model.body);
  const GroundContact& ground = model.ground;
  const double lf = body.front_axle_m, lr = body.rear_axle_m;
  const double weight = body.mass_kg * kStandardGravity;
  const bool has_vertical = is_active(model.vertical) || !vertical_force_n.empty();
  return {
      .force = make_force(model.crush),
      .mass_kg = body.mass_kg,
      .inertia_kgm2 = body.pitch_inertia_kgm2,
      .speed_mps = speed_mps,
      .unloading = model.crush.unloading,
      .lift_off = ground.lift_off,
      .height_m = body.force_height_m - body.cg_height_m,
      .arm_m = has_vertical ? body.force_arm_m : 0.0,
      .follows_law = is_active(model.vertical),
      .angle = force_angle(model.vertical),
      .lines = force_lines(vertical_force_n),
      .axles = {make_axle(-lf, body.front_stiffness_n_per_m, body.front_damping_ns_per_m, weight * lr / (lf + lr),
                          ground.front_bump_gap_m, ground.front_bump_stiffness_n_per_m),
                make_axle(lr, body.rear_stiffness_n_per_m, body.rear_damping_ns_per_m, weight * lf / (lf + lr),
                          ground.rear_bump_gap_m, ground.rear_bump_stiffness_n_per_m)},
  };
}

CoupledMode initial_mode(const CoupledProblem& problem) {
  CoupledMode mode{.crush = initial_region(problem.crush())};
  while (mode.line + 1 < problem.lines.size() && problem.lines[mode.line + 1].start_s <= 0.0) ++mode.line;
  CoupledState y{};
  y[kSpeed] = problem.speed_mps;
  for (std::size_t i = 0; i < kSwitches; ++i) mode.on[i] = value(switch_function(problem, mode, i), y) > 0.0;
  return mode;
}

LinearFunction crush_function(const CoupledProblem& problem) {
  return {.weights = {1.0, 0.0, problem.height_m, 0.0, 0.0, 0.0}};
}

LinearFunction crush_rate_function(const CoupledProblem& problem) {
  return {.weights = {0.0, 0.0, 0.0, 1.0, 0.0, problem.height_m}};
}

namespace {

/// Load of spring, damper and bump stop, which may be a pull.
LinearFunction unbounded_load(const CoupledProblem& problem, const CoupledMode& mode, std::size_t i) {
  const Axle& axle = problem.axles[i];
  const bool bump = mode.is_on(i, AxleSwitch::bump_stop);
  LinearFunction load = scaled(rise(axle.place_m), -axle.stiffness - (bump ? axle.bump_stiffness : 0.0),
                               axle.static_load_n - (bump ? axle.bump_stiffness * axle.bump_gap_m : 0.0));
  const LinearFunction damping = scaled(rise_rate(axle.place_m), -axle.damping);
  for (std::size_t j = 0; j < load.weights.size(); ++j) load.weights[j] += damping.weights[j];
  return load;
}

LinearFunction axle_switch(const CoupledProblem& problem, const CoupledMode& mode, std::size_t i, AxleSwitch which) {
  const Axle& axle = problem.axles[i];
  if (which == AxleSwitch::bump_stop)
    return std::isfinite(axle.bump_gap_m) ? scaled(rise(axle.place_m), -1.0, -axle.bump_gap_m) : kNeverOn;
  if (!problem.lift_off) return kNeverOn;
  if (which == AxleSwitch::lift_off) return scaled(unbounded_load(problem, mode, i), -1.0);
  return axle.stiffness > 0.0 ? scaled(rise(axle.place_m), 1.0, -droop_of(axle)) : kNeverOn;
}

}  // namespace

LinearFunction load_function(const CoupledProblem& problem, const CoupledMode& mode, std::size_t axle) {
  return mode.is_on(axle, AxleSwitch::lift_off) ? LinearFunction{} : unbounded_load(problem, mode, axle);
}

LinearFunction switch_function(const CoupledProblem& problem, const CoupledMode& mode, std::size_t which) {
  for (const std::size_t axle : {0U, 1U})
    for (const auto kind : {AxleSwitch::bump_stop, AxleSwitch::droop, AxleSwitch::lift_off})
      if (which == index_of(axle, kind)) return axle_switch(problem, mode, axle, kind);
  const double bound = which == kAngleChanges ? problem.angle.start_m : problem.angle.end_m;
  if (!problem.follows_law || mode.crush.separated || !std::isfinite(bound)) return kNeverOn;
  return scaled(crush_function(problem), 1.0, -bound);
}

CoupledForces forces(const CoupledProblem& problem, const CoupledMode& mode, double t, const CoupledState& y) {
  const RegionForce crush = region_force(problem.crush(), mode.crush);
  const double s = y[kTravel] + problem.height_m * y[kPitch];
  CoupledForces out{.spring_n = value(crush.spring, s),
                    .damper_n = crush.damper_at(s, y[kSpeed] + problem.height_m * y[kPitchRate])};
  if (problem.follows_law) {
    out.vertical_n = out.longitudinal_n() * tangent(problem.angle, mode, s);
  } else {
    const ForceLine& line = problem.lines[mode.line];
    out.vertical_n = line.slope_n_per_s == 0.0 ? line.value_n : line.value_n + line.slope_n_per_s * (t - line.start_s);
  }
  for (const std::size_t i : {0U, 1U}) out.load_n[i] = value(load_function(problem, mode, i), y);
  return out;
}

CoupledState rates(const CoupledProblem& problem, const CoupledMode& mode, double t, const CoupledState& y) {
  const CoupledForces force = forces(problem, mode, t, y);
  CoupledState rate{};
  rate[kTravel] = y[kSpeed];
  rate[kHeave] = y[kHeaveRate];
  rate[kPitch] = y[kPitchRate];
  double lift = -force.vertical_n;
  double moment = -force.longitudinal_n() * problem.height_m + force.vertical_n * problem.arm_m;
  for (const std::size_t i : {0U, 1U}) {
    const Axle& axle = problem.axles[i];
    const double change = force.load_n[i] - axle.static_load_n;
    lift += change;
    moment += axle.place_m * change;
    const double d = y[kHeave] + axle.place_m * y[kPitch];
    const double d_rate = y[kHeaveRate] + axle.place_m * y[kPitchRate];
    double stored = mode.is_on(i, AxleSwitch::droop) ? axle.static_load_n : axle.stiffness * d;
    if (mode.is_on(i, AxleSwitch::bump_stop)) stored += axle.bump_stiffness * (d + axle.bump_gap_m);
    rate[kSuspensionLoss] -= (change + stored) * d_rate;
  }
  rate[kSpeed] = -force.longitudinal_n() / problem.mass_kg;
  rate[kHeaveRate] = lift / problem.mass_kg;
  rate[kPitchRate] = moment / problem.inertia_kgm2;
  rate[kCrushLoss] = force.damper_n * (y[kSpeed] + problem.height_m * y[kPitchRate]);
  rate[kVerticalWork] = force.vertical_n * (y[kHeaveRate] - problem.arm_m * y[kPitchRate]);
  return rate;
}

double axle_energy(const CoupledProblem& problem, std::size_t i, const CoupledState& y) {
  const Axle& axle = problem.axles[i];
  const double d = y[kHeave] + axle.place_m * y[kPitch];
  const double elastic = problem.lift_off && axle.stiffness > 0.0 ? std::min(d, droop_of(axle)) : d;
  double energy = 0.5 * axle.stiffness * elastic * elastic + axle.static_load_n * (d - elastic);
  if (d < -axle.bump_gap_m) energy += 0.5 * axle.bump_stiffness * (d + axle.bump_gap_m) * (d + axle.bump_gap_m);
  return energy;
}

}  // namespace crashsim
