#pragma once
/// Random families of crush models, as simulate_many() takes them.

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

}  // namespace crashsim::test
