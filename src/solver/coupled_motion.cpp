#include "solver/coupled_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/cvode.hpp"
#include "solver/return_line.hpp"

namespace crashsim {
namespace {

using coupled::kCrushLoss, coupled::kSpeed, coupled::kSuspensionLoss, coupled::kVerticalWork;
using coupled::kHeave, coupled::kHeaveRate, coupled::kPitch, coupled::kPitchRate, coupled::kTravel;

constexpr long kMostSteps = 100'000;  // without a new line of the given force
constexpr double kSmallest = 1e-3;    // share of the larger of two scales that the smaller one has at least
constexpr double kStandstill = 1e-9;  // of the impact speed: scale of a body that nothing moves

/// Absolute tolerances from how fast the crush and the vertical force can move the body.
CoupledState absolute_tolerances(const CoupledProblem& problem, double rtol) {
  const double speed = problem.speed_mps, mass = problem.mass_kg, inertia = problem.inertia_kgm2;
  const double impulse = mass * speed;
  double vertical = 0.0;  // impulse
  if (problem.follows_law) {
    const ForceAngle& angle = problem.angle;
    const double turned = std::abs(angle.first_rad) + std::abs(angle.rate_rad_per_m) * speed * kCrashTime;
    vertical = impulse * std::tan(std::min(turned, kSteepestAngle));
  }
  for (std::size_t i = 0; i + 1 < problem.lines.size(); ++i) {
    const ForceLine& line = problem.lines[i];
    if (std::isfinite(line.start_s)) vertical += std::abs(line.value_n) * (problem.lines[i + 1].start_s - line.start_s);
  }
  double heave_rate = std::min(vertical / mass, speed);
  double pitch_rate = (impulse * std::abs(problem.height_m) + mass * heave_rate * std::abs(problem.arm_m)) / inertia;
  heave_rate = std::max({heave_rate, kSmallest * pitch_rate, kStandstill * speed});
  pitch_rate = std::max(pitch_rate, kSmallest * heave_rate);
  const double energy = 0.5 * mass * speed * speed;
  CoupledState atol{};
  atol[kTravel] = speed * kCrashTime;
  atol[kHeave] = heave_rate * kCrashTime;
  atol[kPitch] = pitch_rate * kCrashTime;
  atol[kSpeed] = speed;
  atol[kHeaveRate] = heave_rate;
  atol[kPitchRate] = pitch_rate;
  atol[kCrushLoss] = atol[kSuspensionLoss] = atol[kVerticalWork] = energy;
  for (double& a : atol) a *= rtol;
  return atol;
}

CoupledState as_state(std::span<const double> y) {
  CoupledState state{};
  std::copy(y.begin(), y.end(), state.begin());
  return state;
}

/// One run.
class Motion {
 public:
  Motion(const CoupledProblem& problem, double end_time_s, double rtol, const PieceVisitor& on_piece)
      : problem_(problem),
        end_time_s_(end_time_s),
        on_piece_(on_piece),
        mode_(initial_mode(problem)),
        cvode_(static_cast<int>(coupled::kUnknowns), [this](double t, const double* y, double* ydot) {
          const CoupledState rate = rates(problem_, mode_, t, as_state({y, coupled::kUnknowns}));
          std::copy(rate.begin(), rate.end(), ydot);
        }) {
    y_[kSpeed] = problem.speed_mps;
    cvode_.set_tolerances(rtol, absolute_tolerances(problem, rtol));
  }

  CoupledSummary run() {
    while (t_ < end_time_s_ && may_go_on()) run_piece();
    out_.end_time_s = t_;
    out_.last = y_;
    out_.mode = mode_;
    out_.rhs_evaluations = cvode_.rhs_evaluations();
    return out_;
  }

 private:
  [[nodiscard]] double next_line_s() const {
    return mode_.line + 1 < problem_.lines.size() ? problem_.lines[mode_.line + 1].start_s
                                                  : std::numeric_limits<double>::infinity();
  }

  /// Sets the end where the motion must not continue.
  bool may_go_on() {
    const auto& force = problem_.force;
    if (force.spring.forbidden(mode_.crush.spring) || force.damper.forbidden(mode_.crush.damper))
      out_.end = CoupledEnd::left_knot_range;
    else if (mode_.crush.unloading && returns_too_much(problem_.crush(), mode_.crush, out_.max_crush_m))
      out_.end = CoupledEnd::unloading_too_soft;
    else if (problem_.angle.end_is_error && mode_.on[kAngleEnds])
      out_.end = CoupledEnd::too_steep;
    else if (steps_on_line_ >= kMostSteps)
      out_.end = CoupledEnd::step_limit;
    return out_.end == CoupledEnd::end_time;
  }

  /// Integrates to the next event, line of the given force, or the end.
  void run_piece() {
    const double stop = std::min(end_time_s_, next_line_s());
    if (t_ < stop) {
      cvode_.start(t_, y_);
      cvode_.set_stop_time(stop);
    }
    bool smooth = true;
    while (t_ < stop && smooth && may_go_on()) smooth = advance();
    if (!smooth || t_ < next_line_s()) return;
    ++mode_.line;
    steps_on_line_ = 0;
  }

  /// One step, or its part to the first event: false then.
  bool advance() {
    const CoupledStep step = take_step();
    if (!std::isfinite(horner(step.c[kSpeed], step.degree, 0.0)) ||
        !std::isfinite(step.c[kSpeed][static_cast<std::size_t>(step.degree)])) {
      out_.end = CoupledEnd::diverged;
      return false;
    }
    const CoupledEvent event = first_event(problem_, mode_, step);
    const double tau = event.crush.tau;
    const bool at_once = event.happens() && tau <= step.from;  // no piece of this mode at all
    if (!at_once) on_piece_(mode_, step, tau);
    t_ = event.happens() ? step.base + tau : cvode_.time();
    y_ = step.state(tau);
    if (event.happens()) apply(event);
    return !event.happens();
  }

  CoupledStep take_step() {
    const double t = cvode_.step();
    ++out_.steps;
    ++steps_on_line_;
    CoupledStep step{.base = t, .from = -cvode_.last_step(), .degree = cvode_.last_order()};
    double factorial = 1.0;
    for (int k = 0; k <= step.degree; ++k) {
      if (k > 1) factorial *= k;
      const auto d = cvode_.derivative(t, k);
      for (std::size_t i = 0; i < d.size(); ++i) step.c[i][static_cast<std::size_t>(k)] = d[i] / factorial;
    }
    return step;
  }

  void apply(const CoupledEvent& event) {
    ++out_.events;
    if (event.toggled != kSwitches) {
      toggle(event.toggled);
      return;
    }
    const double s =
        event.crush.kind == EventKind::spring_knot ? event.crush.level : value(crush_function(problem_), y_);
    const double rate =
        event.crush.kind == EventKind::damper_knot ? event.crush.level : value(crush_rate_function(problem_), y_);
    const CrushProblem crush = problem_.crush();
    const Region before = mode_.crush;
    mode_.crush = next_region(crush, before, event.crush, s, rate);
    if (mode_.crush.unloading != before.unloading || mode_.crush.separated)
      y_[kCrushLoss] += stored_energy(crush, before, s) - stored_energy(crush, mode_.crush, s);
    if (is_max_crush(event.crush) && std::isnan(out_.t_m_s)) {
      out_.t_m_s = t_;
      out_.max_crush_m = s;
      out_.max_crush_force_n = value(region_force(crush, before).spring, s);
    }
    if (mode_.crush.separated) separate(s);
  }

  void separate(double s) {
    out_.separation_s = t_;
    if (std::isnan(out_.t_m_s)) return;
    out_.static_crush_m = s;
    out_.rebound_velocity_mps = y_[kSpeed];
  }

  void toggle(std::size_t which) {
    mode_.on[which] = !mode_.on[which];
    for (const std::size_t axle : {0U, 1U})
      if (which == index_of(axle, AxleSwitch::lift_off) && mode_.on[which] && std::isnan(out_.lift_off_s[axle]))
        out_.lift_off_s[axle] = t_;
  }

  const CoupledProblem& problem_;
  double end_time_s_;
  const PieceVisitor& on_piece_;
  CoupledMode mode_;
  Cvode cvode_;
  CoupledState y_{};
  double t_ = 0.0;
  long steps_on_line_ = 0;
  CoupledSummary out_;
};

}  // namespace

CoupledSummary integrate_coupled(const CoupledProblem& problem, double end_time_s, double local_rtol,
                                 const PieceVisitor& on_piece) {
  return Motion(problem, end_time_s, local_rtol, on_piece).run();
}

}  // namespace crashsim
