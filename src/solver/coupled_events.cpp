#include "solver/coupled_events.hpp"

#include <algorithm>
#include <optional>

#include <crashsim/units.hpp>

namespace crashsim {
namespace {

constexpr double kRounding = 1e-13;  // of a switch, relative to a crash's way or the weight

ValueAndDerivative value_and_slope(const Coefficients& c, int degree, double tau) {
  return {horner(c, degree, tau), horner_derivative(c, degree, tau)};
}

/// First event of the crush force. Between turns of the crush rate both it and, where it keeps its sign, crush are
/// monotone, so that no crossing hides inside a part.
Event first_crush_event(const CoupledProblem& problem, const CoupledMode& mode, const CoupledStep& step) {
  if (mode.crush.separated) return {.tau = step.to};
  const CrushProblem crush = problem.crush();
  StepPolynomial part{.base = step.base, .from = step.from, .to = step.to, .degree = step.degree};
  part.x = step.polynomial(crush_function(problem));
  part.v = step.polynomial(crush_rate_function(problem));
  for (const double turn :
       SignChanges(derivative_of(part.v, step.degree), std::max(step.degree - 1, 0), step.from, step.to)) {
    part.to = turn;
    part.set_ends();
    if (const Event event = first_event(crush, mode.crush, part); event.kind != EventKind::none) return event;
    part.from = turn;
  }
  part.to = step.to;
  part.set_ends();
  return first_event(crush, mode.crush, part);
}

/// When `g`, negative so far, has become positive by more than rounding.
std::optional<double> first_rise(const Coefficients& g, const CoupledStep& step, double to, double margin) {
  double from = step.from;
  const auto rise_until = [&](double end) -> std::optional<double> {
    if (!(horner(g, step.degree, end) > margin)) return std::nullopt;
    if (horner(g, step.degree, from) >= 0.0) return from;
    return bracketed_root([&](double tau) { return value_and_slope(g, step.degree, tau); }, from, end);
  };
  for (const double turn : SignChanges(derivative_of(g, step.degree), std::max(step.degree - 1, 0), from, to)) {
    if (const auto tau = rise_until(turn)) return tau;
    from = turn;
  }
  return rise_until(to);
}

}  // namespace

CoupledState CoupledStep::state(double tau) const {
  CoupledState y{};
  for (std::size_t i = 0; i < y.size(); ++i) y[i] = horner(c[i], degree, tau);
  return y;
}

Coefficients CoupledStep::polynomial(const LinearFunction& f) const {
  Coefficients out{};
  for (std::size_t k = 0; k <= static_cast<std::size_t>(degree); ++k)
    for (std::size_t i = 0; i < f.weights.size(); ++i) out[k] += f.weights[i] * c[i][k];
  out[0] += f.constant;
  return out;
}

SignChanges::SignChanges(const Coefficients& c, int degree, double from, double to) {
  double low = from, at_low = horner(c, degree, from);
  for (int i = 1; i <= kIntervals; ++i) {
    const double high = i == kIntervals ? to : from + (to - from) * i / kIntervals;
    const double at_high = horner(c, degree, high);
    if ((at_low < 0.0 && at_high > 0.0) || (at_low > 0.0 && at_high < 0.0))
      at_[count_++] = bracketed_root([&](double tau) { return value_and_slope(c, degree, tau); }, low, high);
    if (at_high == 0.0) continue;  // the sign before it decides
    low = high;
    at_low = at_high;
  }
}

Coefficients derivative_of(const Coefficients& c, int degree) {
  Coefficients out{};
  for (std::size_t k = 1; k <= static_cast<std::size_t>(degree); ++k) out[k - 1] = static_cast<double>(k) * c[k];
  return out;
}

CoupledEvent first_event(const CoupledProblem& problem, const CoupledMode& mode, const CoupledStep& step) {
  CoupledEvent event{.crush = first_crush_event(problem, mode, step)};
  const double length = kRounding * problem.speed_mps * kCrashTime;
  const double force = kRounding * problem.mass_kg * kStandardGravity;
  for (std::size_t i = 0; i < kSwitches; ++i) {
    Coefficients g = step.polynomial(switch_function(problem, mode, i));
    if (mode.on[i])
      for (double& c : g) c = -c;
    const bool is_force = i == index_of(0, AxleSwitch::lift_off) || i == index_of(1, AxleSwitch::lift_off);
    const auto tau = first_rise(g, step, event.crush.tau, is_force ? force : length);
    if (!tau || (event.happens() && *tau >= event.crush.tau)) continue;
    event = {.crush = {.tau = *tau}, .toggled = i};
  }
  return event;
}

}  // namespace crashsim
