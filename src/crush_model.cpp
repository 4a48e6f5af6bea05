#include <crashsim/crush_model.hpp>

#include <cmath>

#include <fmt/format.h>

#include <crashsim/option_values.hpp>

#include "solver/crush_force.hpp"

namespace crashsim {
namespace {

/// The force where the model is at crush x and velocity v.
RegionForce force_at(const CrushModel& model, double x, double v) {
  const CrushForce force = make_force(model);
  return region_force(force, force.spring.locate(x, +1), force.damper.locate(v, +1));
}

/// Unset, or finite and in the range.
bool is_unset_or(double number, const Range& range) {
  return std::isnan(number) || (std::isfinite(number) && detail::in_range(number, range));
}

void validate(const Unloading& unloading) {
  const double k_u = unloading.unloading_stiffness_n_per_m, e = unloading.restitution;
  if (!is_unset_or(k_u, positive()))
    throw InvalidInput(fmt::format("CrushModel.unloading.unloading_stiffness_n_per_m = {} N/m: must be > 0", k_u));
  if (!is_unset_or(e, between(0.0, 1.0)))
    throw InvalidInput(fmt::format("CrushModel.unloading.restitution = {}: must be >= 0 and <= 1", e));
  const int given = (std::isnan(k_u) ? 0 : 1) + (std::isnan(e) ? 0 : 1);
  if (unloading.kind == UnloadingKind::plastic && given != 1)
    throw InvalidInput(
        fmt::format("CrushModel.unloading: kind plastic has {} unloading_stiffness_n_per_m {} restitution: give one",
                    given == 0 ? "neither" : "both", given == 0 ? "nor" : "and"));
  if (unloading.kind == UnloadingKind::elastic && given != 0)
    throw InvalidInput(
        fmt::format("CrushModel.unloading.{}: goes with kind plastic, this is elastic: choose plastic or leave it out",
                    std::isnan(k_u) ? "restitution" : "unloading_stiffness_n_per_m"));
}

/// The numbers of law `rate`, which no other law has.
void validate_rate(const CrushModel& model) {
  const double r = model.rate_coefficient, v_ref = model.reference_speed_mps;
  if (model.law != CrushLaw::rate) {
    if (std::isnan(r) && std::isnan(v_ref)) return;
    throw InvalidInput(fmt::format("CrushModel.{}: goes with law rate, this is {}: choose rate or leave it out",
                                   std::isnan(r) ? "reference_speed_mps" : "rate_coefficient", name_of(model.law)));
  }
  if (!std::isfinite(r) || r < 0.0)
    throw InvalidInput(fmt::format("CrushModel.rate_coefficient = {}: must be >= 0 with law rate", r));
  if (!std::isfinite(v_ref) || v_ref <= 0.0)
    throw InvalidInput(fmt::format("CrushModel.reference_speed_mps = {} m/s: must be > 0 with law rate", v_ref));
  if (!model.damper.knots.empty())
    throw InvalidInput("CrushModel.damper: law rate has none: its rate effect is rate_coefficient");
}

}  // namespace

bool Unloading::operator==(const Unloading& other) const {
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  return kind == other.kind && bilateral == other.bilateral &&
         same(unloading_stiffness_n_per_m, other.unloading_stiffness_n_per_m) && same(restitution, other.restitution);
}

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
  validate_rate(model);
  validate(model.unloading);
}

double spring_force(const CrushModel& model, double x) { return value(force_at(model, x, 0.0).spring, x); }

double damper_force(const CrushModel& model, double x, double v) { return force_at(model, x, v).damper_at(x, v); }

double damper_force(const CrushModel& model, double v) {
  if (model.law == CrushLaw::crush_damping || model.law == CrushLaw::rate)
    throw InvalidInput(
        fmt::format("damper_force: with law {} the damper's force depends on the crush, too: give crush and velocity",
                    name_of(model.law)));
  return damper_force(model, 0.0, v);
}

double spring_energy(const CrushModel& model, double x) {
  CrushModel spring_only = model;
  spring_only.damper = {};
  return spring_energy(make_force(spring_only), x);
}

}  // namespace crashsim
