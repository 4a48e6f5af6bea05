#include <crashsim/crush_model.hpp>

#include <cmath>

#include <fmt/format.h>

#include "solver/crush_force.hpp"

namespace crashsim {
namespace {

double force_at(const ForceAxis& axis, std::span<const double> ordinates, double s) {
  double force = 0.0;
  for (const OrdinateBasis& basis : axis.segments[static_cast<std::size_t>(axis.locate(s, +1))])
    if (basis.ordinate >= 0) force += ordinates[static_cast<std::size_t>(basis.ordinate)] * value(basis.c, s);
  return force;
}

ForceAxis spring_axis(const CrushModel& model) {
  return make_axis(model.spring.knots, model.law == CrushLaw::stiffness, model.extrapolation);
}

}  // namespace

void validate(const CrushModel& model) {
  if (!std::isfinite(model.mass_kg) || model.mass_kg <= 0.0)
    throw InvalidInput(fmt::format("CrushModel.mass_kg = {} kg: must be > 0", model.mass_kg));
  if (!std::isnan(model.impact_speed_mps) && !(std::isfinite(model.impact_speed_mps) && model.impact_speed_mps > 0.0))
    throw InvalidInput(fmt::format("CrushModel.impact_speed_mps = {} m/s: must be > 0", model.impact_speed_mps));
  if (model.spring.knots.empty() && model.damper.knots.empty())
    throw InvalidInput("CrushModel: has neither spring nor damper: give one of them knots and ordinates");
  const auto is_absent = [](const PiecewiseLinear& c) { return c.knots.empty() && c.ordinates.empty(); };
  if (!is_absent(model.spring)) validate(model.spring, "CrushModel.spring");
  if (!is_absent(model.damper)) validate(model.damper, "CrushModel.damper");
}

double spring_force(const CrushModel& model, double x) {
  return force_at(spring_axis(model), model.spring.ordinates, x);
}

double damper_force(const CrushModel& model, double v) {
  return force_at(make_axis(model.damper.knots, true, model.extrapolation), model.damper.ordinates, v);
}

double spring_energy(const CrushModel& model, double x) {
  CrushModel spring_only = model;
  spring_only.damper = {};
  return spring_energy(make_force(spring_only), x);
}

}  // namespace crashsim
