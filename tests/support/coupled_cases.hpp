#pragma once
/// Coupled models that several tests use.

#include <crashsim/simulate_coupled.hpp>

#include "support/crush_cases.hpp"
#include "support/pitch_cases.hpp"

namespace crashsim::test {

/// SYN_A on the oracle cases' vehicle, its force 0.15 m below the centre of gravity; no vertical force, linear axles.
inline CoupledModel coupled_vehicle() {
  CoupledModel model;
  model.crush = syn_a();
  model.body = oracle_vehicle();
  model.body.per_wheel = true;
  model.body.cg_height_m = 0.65;
  model.body.force_height_m = 0.50;
  model.body.force_arm_m = 1.6;
  return model;
}

/// Any model: every crush law and curve, with a height offset to either side, in turn no vertical force, a law and a
/// law bounded by friction, linear axles, or axles that lift off and have bump stops within reach.
inline CoupledModel random_coupled_model(Random& random) {
  CoupledModel model;
  model.crush = random_crush_model(random);
  model.body = random_vehicle(random);
  model.body.mass_kg = kUnset;
  model.body.force_height_m = model.body.cg_height_m + random.between(-0.25, 0.25);
  const int law = random.whole(0, 2);
  if (law > 0) {
    model.vertical.angle_rad = random.between(-0.15, 0.15);
    model.vertical.angle_rate_rad_per_m = random.between(-0.6, 0.6);
    model.vertical.angle_start_m = random.between(0.0, 0.3);
  }
  if (law > 1) model.vertical.friction = random.between(0.02, 0.15);
  if (random.whole(0, 2) == 0) return model;
  model.ground.lift_off = random.whole(0, 3) > 0;
  if (random.whole(0, 1) == 1) {
    model.ground.front_bump_gap_m = random.between(0.0, 0.05);
    model.ground.front_bump_stiffness_n_per_m = random.between(1e5, 1e6);
  }
  if (random.whole(0, 1) == 1) {
    model.ground.rear_bump_gap_m = random.between(0.0, 0.05);
    model.ground.rear_bump_stiffness_n_per_m = random.between(1e5, 1e6);
  }
  return model;
}

}  // namespace crashsim::test
