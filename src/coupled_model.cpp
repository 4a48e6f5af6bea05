#include <crashsim/coupled_model.hpp>

#include <cmath>

#include <fmt/format.h>

#include <crashsim/option_values.hpp>

namespace crashsim {
namespace {

constexpr double kSameMass = 1e-9;  // relative: what a change of units may leave

/// @throws InvalidInput when only one of two belonging numbers is set.
void require_both(const GroundContact& ground, double GroundContact::*a, double GroundContact::*b) {
  if (!std::isnan(ground.*a)) require_set(ground, b, "GroundContact", "there is a bump stop");
  if (!std::isnan(ground.*b)) require_set(ground, a, "GroundContact", "there is a bump stop");
}

void validate(const GroundContact& ground) {
  validate_options(ground, "GroundContact");
  require_both(ground, &GroundContact::front_bump_gap_m, &GroundContact::front_bump_stiffness_n_per_m);
  require_both(ground, &GroundContact::rear_bump_gap_m, &GroundContact::rear_bump_stiffness_n_per_m);
}

}  // namespace

CoupledModel with_one_mass(const CoupledModel& model) {
  CoupledModel out = model;
  if (std::isnan(out.crush.mass_kg)) out.crush.mass_kg = out.body.mass_kg;
  if (std::isnan(out.body.mass_kg)) out.body.mass_kg = out.crush.mass_kg;
  const double crush = out.crush.mass_kg, body = out.body.mass_kg;
  if (std::abs(crush - body) > kSameMass * std::abs(crush))
    throw InvalidInput(fmt::format(
        "CoupledModel: CrushModel.mass_kg = {} kg but HeavePitchModel.mass_kg = {} kg: it is one vehicle: give one "
        "mass, or leave one unset",
        crush, body));
  out.body.mass_kg = crush;
  return out;
}

void validate(const CoupledModel& model) {
  const CoupledModel whole = with_one_mass(model);
  validate(whole.crush);
  validate(whole.body);
  validate(whole.vertical);
  validate(whole.ground);
  const HeavePitchModel& body = whole.body;
  require_set(body, &HeavePitchModel::cg_height_m, "HeavePitchModel", "the crush force acts at a height");
  require_set(body, &HeavePitchModel::force_height_m, "HeavePitchModel", "the crush force acts at a height");
  if (is_active(whole.vertical))
    require_set(body, &HeavePitchModel::force_arm_m, "HeavePitchModel", "there is a vertical force");
  if (body.formulation != PitchFormulation::derived)
    throw InvalidInput(
        fmt::format("HeavePitchModel.formulation = {}: the coupled model has the derived equations only: set derived",
                    name_of(body.formulation)));
}

}  // namespace crashsim
