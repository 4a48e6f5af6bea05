#include <algorithm>
#include <cmath>

#include <crashsim/export.hpp>

namespace crashsim {
namespace {

constexpr double kSampling = 2e-4;        // of the largest force; leaves room for rounding in the cards
constexpr double kBeyond = 1.5;           // how far past the last knot
constexpr double kRamp = 1e-3;            // of the last knot, for a force that starts with a jump
constexpr double kReachOfConstant = 1.0;  // m or m/s, for a curve of one knot

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

template <class Force>
ForceCurve curve_of(const PiecewiseLinear& law, Extrapolation extrapolation, const Force& force) {
  if (law.knots.empty()) return {};
  std::vector<double> ends = law.knots;
  if (ends.size() == 1) ends.push_back(kReachOfConstant);
  const std::size_t knots = ends.size();
  const double last = ends.back(), ramp = std::min(kRamp * last, 0.5 * ends[1]);
  if (extrapolation != Extrapolation::error || law.knots.size() == 1) ends.push_back(kBeyond * last);
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
  return curve_of(model.damper, model.extrapolation, [&](double v) { return damper_force(model, v); });
}

}  // namespace crashsim
