#include "solver/crush_force.hpp"

#include <algorithm>
#include <limits>

namespace crashsim {
namespace {

/// Basis of the ordinate at `knot` on the segment towards `other`: (other - |s|)/(other - knot), times s if multiplied,
/// with |s| = sign * s.
OrdinateBasis hat(int ordinate, double knot, double other, double sign, bool multiplied) {
  const double width = other - knot;
  const double constant = other / width;
  const double slope = -sign / width;
  if (multiplied) return {ordinate, {0.0, constant, slope}};
  return {ordinate, {sign * constant, sign * slope, 0.0}};
}

OrdinateBasis held(int ordinate, double sign, bool multiplied) {
  if (multiplied) return {ordinate, {0.0, 1.0, 0.0}};
  return {ordinate, {sign, 0.0, 0.0}};
}

void fill_polynomials(const ForceAxis& axis, std::span<const double> ordinates, std::vector<Quadratic>& polynomials) {
  polynomials.assign(axis.segments.size(), Quadratic{});
  for (std::size_t s = 0; s < polynomials.size(); ++s)
    for (const OrdinateBasis& basis : axis.segments[s]) {
      if (basis.ordinate < 0) continue;
      const double ordinate = ordinates[static_cast<std::size_t>(basis.ordinate)];
      for (std::size_t j = 0; j < 3; ++j) polynomials[s][j] += ordinate * basis.c[j];
    }
}

}  // namespace

double ForceAxis::lower(int segment) const {
  return segment == 0 ? -std::numeric_limits<double>::infinity() : breaks[static_cast<std::size_t>(segment) - 1];
}

double ForceAxis::upper(int segment) const {
  return segment == count() - 1 ? std::numeric_limits<double>::infinity() : breaks[static_cast<std::size_t>(segment)];
}

int ForceAxis::locate(double s, int direction) const {
  const auto at = direction > 0 ? std::upper_bound(breaks.begin(), breaks.end(), s)
                                : std::lower_bound(breaks.begin(), breaks.end(), s);
  return static_cast<int>(at - breaks.begin());
}

ForceAxis make_axis(std::span<const double> knots, bool multiplied, Extrapolation extrapolation) {
  ForceAxis axis;
  const int n = static_cast<int>(knots.size());
  axis.outer_is_error = n > 1 && extrapolation == Extrapolation::error;
  if (n < 2) {
    axis.breaks = {0.0};
    for (const double sign : {-1.0, 1.0})
      axis.segments.push_back({n == 1 ? held(0, sign, multiplied) : OrdinateBasis{}, OrdinateBasis{}});
    return axis;
  }
  const auto knot = [&](int i) { return knots[static_cast<std::size_t>(i)]; };
  const auto inner = [&](int i, double sign) -> std::array<OrdinateBasis, 2> {
    return {hat(i, knot(i), knot(i + 1), sign, multiplied), hat(i + 1, knot(i + 1), knot(i), sign, multiplied)};
  };
  const auto outer = [&](double sign) -> std::array<OrdinateBasis, 2> {
    if (extrapolation == Extrapolation::linear) return inner(n - 2, sign);
    return {held(n - 1, sign, multiplied), OrdinateBasis{}};
  };
  axis.segments.push_back(outer(-1.0));
  for (int i = n - 1; i > 0; --i) {
    axis.breaks.push_back(-knot(i));
    axis.segments.push_back(inner(i - 1, -1.0));
  }
  for (int i = 0; i < n - 1; ++i) {
    axis.breaks.push_back(knot(i));
    axis.segments.push_back(inner(i, 1.0));
  }
  axis.breaks.push_back(knot(n - 1));
  axis.segments.push_back(outer(1.0));
  return axis;
}

void CrushForce::set_ordinates(std::span<const double> spring_ordinates, std::span<const double> damper_ordinates) {
  fill_polynomials(spring, spring_ordinates, spring_polynomials);
  fill_polynomials(damper, damper_ordinates, damper_polynomials);
}

double spring_energy(const CrushForce& force, double x) {
  const auto primitive = [](const Quadratic& c, double s) { return s * (c[0] + s * (c[1] / 2.0 + s * c[2] / 3.0)); };
  const int direction = x < 0.0 ? -1 : +1;
  double energy = 0.0, from = 0.0;
  for (int s = force.spring.locate(0.0, direction);; s += direction) {
    const double bound = direction > 0 ? force.spring.upper(s) : force.spring.lower(s);
    const bool last = !(direction > 0 ? x > bound : x < bound);  // also when x is not a number
    const Quadratic& c = force.spring_polynomials[static_cast<std::size_t>(s)];
    energy += primitive(c, last ? x : bound) - primitive(c, from);
    if (last) return energy;
    from = bound;
  }
}

CrushForce make_force(const CrushModel& model) {
  CrushForce force;
  force.spring = make_axis(model.spring.knots, model.law == CrushLaw::stiffness, model.extrapolation);
  force.damper = make_axis(model.damper.knots, true, model.extrapolation);
  force.set_ordinates(model.spring.ordinates, model.damper.ordinates);
  return force;
}

}  // namespace crashsim
