#pragma once
/// Random families of crush models, as simulate_many() takes them.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <crashsim/simulate_many.hpp>

#include "support/random.hpp"

namespace crashsim::test {

/// Models of one law, extrapolation, unloading and number of knots.
inline CrushModels random_family(std::uint64_t seed, std::size_t count) {
  Random random(seed);
  const auto one_in = [&](int n) { return random.whole(1, n) == 1; };
  CrushModels models;
  CrushModel& common = models.common;
  common.law = one_in(2) ? CrushLaw::stiffness : CrushLaw::force;
  common.extrapolation = one_in(3) ? Extrapolation::linear : Extrapolation::constant;
  common.unloading.bilateral = one_in(3);
  if (one_in(3)) {
    common.unloading.kind = UnloadingKind::plastic;
    common.unloading.restitution = 0.0;
    models.restitution.resize(count);
    for (double& e : models.restitution) e = one_in(5) ? 0.0 : random.between(0.02, 0.4);
  }
  const int springs = random.whole(1, 9), dampers = one_in(4) ? 0 : random.whole(1, 9);
  common.spring = {uniform_knots(0.7, springs), std::vector<double>(static_cast<std::size_t>(springs))};
  if (dampers > 0)
    common.damper = {uniform_knots(15.0, dampers), std::vector<double>(static_cast<std::size_t>(dampers))};
  models.mass_kg.resize(count);
  models.impact_speed_mps.resize(count);
  const auto rows = static_cast<Eigen::Index>(count);
  models.spring_ordinates.resize(rows, springs);
  models.damper_ordinates.resize(dampers > 0 ? rows : 0, dampers);
  const double spring_size = common.law == CrushLaw::stiffness ? 1.2e6 : 5e5;
  for (Eigen::Index i = 0; i < rows; ++i) {
    models.mass_kg[static_cast<std::size_t>(i)] = random.between(600.0, 3000.0);
    // The speed of the last damper knot, every other time: v starts on a knot.
    models.impact_speed_mps[static_cast<std::size_t>(i)] = one_in(2) ? 15.0 : random.between(3.0, 25.0);
    for (Eigen::Index j = 0; j < springs; ++j)
      models.spring_ordinates(i, j) = one_in(6) ? 0.0 : random.between(0.0, spring_size);
    for (Eigen::Index j = 0; dampers > 0 && j < dampers; ++j)
      models.damper_ordinates(i, j) = one_in(6) ? 0.0 : random.between(0.0, 3e4);
  }
  return models;
}

/// The same of law `crush_damping` or `rate`.
inline CrushModels random_family_of(CrushLaw law, std::uint64_t seed, std::size_t count) {
  constexpr double kForcePerStiffness = 0.4;  // m
  CrushModels models = random_family(seed, count);
  CrushModel& common = models.common;
  if (common.law == CrushLaw::stiffness) models.spring_ordinates *= kForcePerStiffness;
  common.law = law;
  Random random(seed + 1000);
  if (law == CrushLaw::crush_damping) {
    const double last = random.whole(1, 3) == 1 ? 0.7 : random.between(0.2, 0.9);  // 0.7: a knot of both curves
    common.damper.knots = uniform_knots(last, static_cast<int>(common.damper.knots.size()));
    return models;
  }
  common.damper = {};
  models.damper_ordinates.resize(0, 0);
  // Not far below: the force near standstill depends on the error of v by that of v_ref.
  common.reference_speed_mps = std::pow(10.0, random.between(-1.0, 1.0));
  models.rate_coefficient.resize(count);
  for (double& r : models.rate_coefficient) r = random.between(0.0, 0.4);
  return models;
}

}  // namespace crashsim::test
