#include "solver/crush_force.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

namespace crashsim {
namespace {

/// y(|s|) = constant + slope s on one side of 0, |s| = sign * s, as what the kind makes of it.
OrdinateBasis basis_of(int ordinate, double constant, double slope, double sign, OrdinateKind kind) {
  switch (kind) {
    case OrdinateKind::stiffness:
      return {ordinate, {0.0, constant, slope}};
    case OrdinateKind::force:
      return {ordinate, {sign * constant, sign * slope, 0.0}};
    case OrdinateKind::factor:
      break;
  }
  return {ordinate, {constant, slope, 0.0}};
}

/// Of the ordinate at `knot` on the segment towards `other`: (other - |s|)/(other - knot).
OrdinateBasis hat(int ordinate, double knot, double other, double sign, OrdinateKind kind) {
  const double width = other - knot;
  return basis_of(ordinate, other / width, -sign / width, sign, kind);
}

OrdinateBasis held(int ordinate, double sign, OrdinateKind kind) { return basis_of(ordinate, 1.0, 0.0, sign, kind); }

using Segments = std::vector<std::array<OrdinateBasis, 2>>;

void fill_polynomials(const Segments& segments, std::span<const double> ordinates,
                      std::vector<Quadratic>& polynomials) {
  polynomials.assign(segments.size(), Quadratic{});
  for (std::size_t s = 0; s < polynomials.size(); ++s)
    for (const OrdinateBasis& basis : segments[s]) {
      if (basis.ordinate < 0) continue;
      const double ordinate = ordinates[static_cast<std::size_t>(basis.ordinate)];
      for (std::size_t j = 0; j < 3; ++j) polynomials[s][j] += ordinate * basis.c[j];
    }
}

/// The same axis with more breaks.
ForceAxis refined(const ForceAxis& axis, const std::vector<double>& breaks) {
  ForceAxis fine;
  fine.breaks = breaks;
  const auto covering = [&](int segment) {  // of the coarse axis
    const auto s = static_cast<std::size_t>(segment);
    return s == 0 ? 0 : axis.locate(breaks[s - 1], +1);
  };
  const int count = static_cast<int>(breaks.size()) + 1;
  fine.first_allowed = count;
  for (int s = 0; s < count; ++s) {
    const int coarse = covering(s);
    fine.segments.push_back(axis.segments[static_cast<std::size_t>(coarse)]);
    if (axis.forbidden(coarse)) continue;
    fine.first_allowed = std::min(fine.first_allowed, s);
    fine.last_allowed = s;
  }
  return fine;
}

/// Gives the spring's axis the breaks of both, and the damper's ordinates to its segments.
void add_damping(const ForceAxis& damping, CrushForce& force) {
  std::vector<double> breaks;
  std::set_union(force.spring.breaks.begin(), force.spring.breaks.end(), damping.breaks.begin(), damping.breaks.end(),
                 std::back_inserter(breaks));
  const ForceAxis fine = refined(damping, breaks);
  force.spring = refined(force.spring, breaks);
  force.spring.first_allowed = std::max(force.spring.first_allowed, fine.first_allowed);
  force.spring.last_allowed = std::min(force.spring.last_allowed, fine.last_allowed);
  force.damping = fine.segments;
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

ForceAxis make_axis(std::span<const double> knots, OrdinateKind kind, Extrapolation extrapolation) {
  ForceAxis axis;
  const int n = static_cast<int>(knots.size());
  if (n < 2) {
    axis.breaks = {0.0};
    for (const double sign : {-1.0, 1.0})
      axis.segments.push_back({n == 1 ? held(0, sign, kind) : OrdinateBasis{}, OrdinateBasis{}});
    axis.last_allowed = 1;
    return axis;
  }
  const auto knot = [&](int i) { return knots[static_cast<std::size_t>(i)]; };
  const auto inner = [&](int i, double sign) -> std::array<OrdinateBasis, 2> {
    return {hat(i, knot(i), knot(i + 1), sign, kind), hat(i + 1, knot(i + 1), knot(i), sign, kind)};
  };
  const auto outer = [&](double sign) -> std::array<OrdinateBasis, 2> {
    if (extrapolation == Extrapolation::linear) return inner(n - 2, sign);
    return {held(n - 1, sign, kind), OrdinateBasis{}};
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
  const int margin = extrapolation == Extrapolation::error ? 1 : 0;
  axis.first_allowed = margin;
  axis.last_allowed = axis.count() - 1 - margin;
  return axis;
}

void CrushForce::set_ordinates(std::span<const double> spring_ordinates, std::span<const double> damper_ordinates) {
  fill_polynomials(spring.segments, spring_ordinates, spring_polynomials);
  fill_polynomials(damper.segments, damping.empty() ? damper_ordinates : std::span<const double>(), damper_polynomials);
  fill_polynomials(damping, damper_ordinates, damping_polynomials);
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

CrushForce make_force(const ForceShape& shape) {
  CrushForce force;
  const bool is_stiffness = shape.law == CrushLaw::stiffness, has_damping = shape.law == CrushLaw::crush_damping;
  force.spring =
      make_axis(shape.spring_knots, is_stiffness ? OrdinateKind::stiffness : OrdinateKind::force, shape.extrapolation);
  force.damper = make_axis(has_damping ? std::span<const double>() : shape.damper_knots, OrdinateKind::stiffness,
                           shape.extrapolation);
  if (has_damping) add_damping(make_axis(shape.damper_knots, OrdinateKind::factor, shape.extrapolation), force);
  if (shape.law == CrushLaw::rate) force.per_reference_speed = 1.0 / shape.reference_speed_mps;
  return force;
}

CrushForce make_force(const CrushModel& model) {
  CrushForce force =
      make_force({model.law, model.extrapolation, model.spring.knots, model.damper.knots, model.reference_speed_mps});
  if (model.law == CrushLaw::rate) force.rate_coefficient = model.rate_coefficient;
  force.set_ordinates(model.spring.ordinates, model.damper.ordinates);
  return force;
}

RegionForce region_force(const CrushForce& force, int spring, int damper) {
  const auto s = static_cast<std::size_t>(spring), d = static_cast<std::size_t>(damper);
  RegionForce out{force.spring_polynomials[s], force.damper_polynomials[d]};
  if (!force.damping.empty()) {
    out.damper[1] += force.damping_polynomials[s][0];
    out.cross = force.damping_polynomials[s][1];
  }
  if (force.per_reference_speed != 0.0) {
    out.rate = force.rate_coefficient;
    out.per_reference = force.damper.upper(damper) <= 0.0 ? -force.per_reference_speed : force.per_reference_speed;
  }
  return out;
}

}  // namespace crashsim
