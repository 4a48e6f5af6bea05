#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "export_cards.hpp"

namespace crashsim {
namespace {

constexpr double kSampling = 2e-4;        // of the largest force; leaves room for rounding in the cards
constexpr double kBeyond = 1.5;           // how far past the last knot
constexpr double kRamp = 1e-3;            // of the last knot, for a force that starts with a jump
constexpr double kReachOfConstant = 1.0;  // m or m/s, for a curve of one knot
constexpr double kFastest_mps = 50.0;     // to which a rate factor goes
constexpr double kMostRatePoints = 1000.0;

/// Points on a law that is quadratic between the ends, close enough for lines between them.
template <class Force>
ForceCurve sample(const std::vector<double>& ends, std::size_t knots, const Force& force) {
  const auto middle = [](double a, double b) { return 0.5 * (a + b); };
  double peak = 0.0;
  for (std::size_t i = 0; i + 1 < knots; ++i)
    for (const double s : {middle(ends[i], ends[i + 1]), ends[i + 1]}) peak = std::max(peak, std::abs(force(s)));
  ForceCurve curve{{0.0}, {0.0}};
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double from = ends[i], to = ends[i + 1];
    const double bend = std::abs(force(middle(from, to)) - middle(force(from), force(to)));
    const double pieces = peak > 0.0 ? std::max(1.0, std::ceil(std::sqrt(bend / (kSampling * peak)))) : 1.0;
    for (double piece = 1.0; piece <= pieces; piece += 1.0) {
      curve.argument.push_back(piece < pieces ? from + (to - from) * piece / pieces : to);
      curve.force_n.push_back(force(curve.argument.back()));
    }
  }
  return curve;
}

/// Knots of a curve that is not absent, at least two, and how far it goes beyond.
struct Ends {
  std::vector<double> ends;
  std::size_t knots;
};
Ends ends_of(const PiecewiseLinear& law, Extrapolation extrapolation) {
  Ends out{law.knots, 0};
  if (out.ends.size() == 1) out.ends.push_back(kReachOfConstant);
  out.knots = out.ends.size();
  const double last = out.ends.back();
  if (extrapolation != Extrapolation::error || law.knots.size() == 1) out.ends.push_back(kBeyond * last);
  return out;
}

template <class Force>
ForceCurve curve_of(const PiecewiseLinear& law, Extrapolation extrapolation, const Force& force) {
  if (law.knots.empty()) return {};
  const auto [ends, knots] = ends_of(law, extrapolation);
  const double last = ends[knots - 1], ramp = std::min(kRamp * last, 0.5 * ends[1]);
  ForceCurve curve = sample(ends, knots, force);
  if (force(0.0) > 0.0) {
    curve.argument.insert(curve.argument.begin() + 1, ramp);
    curve.force_n.insert(curve.force_n.begin() + 1, force(ramp));
  }
  return curve;
}

}  // namespace

ForceCurve spring_curve(const CrushModel& model) {
  return curve_of(model.spring, model.extrapolation, [&](double x) { return spring_force(model, x); });
}

ForceCurve damper_curve(const CrushModel& model) {
  if (model.law != CrushLaw::crush_damping)
    return curve_of(model.damper, model.extrapolation, [&](double v) { return damper_force(model, v); });
  const std::vector<double>& c = model.damper.ordinates;
  if (std::ranges::any_of(c, [&](double other) { return other != c.front(); }))
    throw InvalidInput(
        "CrushModel.law = crush_damping: the damper's force is no curve over velocity, but for a damping that is the "
        "same at every crush");
  if (c.empty()) return {};
  return curve_of({{0.0}, {c.front()}}, model.extrapolation, [&](double v) { return c.front() * v; });
}

CardCurve damping_over_crush(const CrushModel& model) {
  if (model.damper.knots.empty()) return {};
  CardCurve curve{ends_of(model.damper, model.extrapolation).ends, {}};
  for (const double x : curve.argument) curve.force.push_back(damper_force(model, x, 1.0));
  return curve;
}

CardCurve rate_factor(const CrushModel& model) {
  const double r = model.rate_coefficient, v_ref = model.reference_speed_mps;
  const double end = std::log1p(kFastest_mps / v_ref);  // of u = ln(1 + v / v_ref)
  // Between points du apart a line is r du^2 / 8 off.
  const double points = std::clamp(std::ceil(end * std::sqrt(r / (8.0 * kSampling))), 1.0, kMostRatePoints);
  CardCurve curve;
  for (double i = 0.0; i <= points; i += 1.0) {
    const double u = end * i / points;
    curve.argument.push_back(v_ref * std::expm1(u));
    curve.force.push_back(1.0 + r * u);
  }
  return curve;
}

}  // namespace crashsim
