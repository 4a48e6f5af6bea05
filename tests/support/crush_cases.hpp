#pragma once
/// Crush models that several tests use.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <crashsim/simulate.hpp>

#include "support/random.hpp"

namespace crashsim::test {

inline constexpr Integrator kBothIntegrators[] = {Integrator::cvode, Integrator::taylor};

/// Constant stiffness and damping: the Kelvin model.
inline CrushModel kelvin_model(double mass_kg, double stiffness, double damping, double speed) {
  CrushModel model;
  model.mass_kg = mass_kg;
  model.impact_speed_mps = speed;
  model.spring = {{0.0}, {stiffness}};
  model.damper = {{0.0}, {damping}};
  return model;
}

/// Oracle case SYN_A: 7 knots each, the last damper knot on the impact speed.
inline CrushModel syn_a() {
  CrushModel model;
  model.mass_kg = 2582.0;
  model.impact_speed_mps = 56.0 / 3.6;
  model.spring = {{0.0, 0.1, 0.2, 0.35, 0.5, 0.6, 0.7}, {3.0e6, 1.6e6, 1.2e6, 0.9e6, 0.8e6, 0.9e6, 1.1e6}};
  model.damper = {{0.0, 3.0, 6.0, 9.0, 12.0, 14.0, model.impact_speed_mps}, {60e3, 40e3, 30e3, 25e3, 20e3, 15e3, 10e3}};
  return model;
}

/// Oracle case SYN_B: SYN_A without its damper.
inline CrushModel syn_b() {
  CrushModel model = syn_a();
  model.damper = {};
  return model;
}

/// 2 to 20 uneven knots on [0, last] with ordinates between 0 and 2 `typical`, one in eight of them 0.
inline PiecewiseLinear random_curve(Random& random, double last, double typical) {
  PiecewiseLinear curve;
  const int count = random.whole(2, 20);
  for (int i = 0; i < count; ++i) {
    const double jitter = i == 0 || i == count - 1 ? 0.0 : random.between(-0.4, 0.4);
    curve.knots.push_back(last * (i + jitter) / (count - 1));
    curve.ordinates.push_back(random.between(0.0, 1.0) < 0.125 ? 0.0 : typical * random.between(0.05, 2.0));
  }
  return curve;
}

/// Any model: both laws, constant or linear extrapolation, with a spring, a damper or both, knots within and beyond the
/// reach of the motion, a damper knot on the impact speed in half of them, and one in four bilateral.
inline CrushModel random_crush_model(Random& random) {
  CrushModel model;
  model.mass_kg = random.between(700.0, 4000.0);
  const double speed = random.between(3.0, 25.0);
  model.impact_speed_mps = speed;
  model.law = random.whole(0, 1) == 0 ? CrushLaw::stiffness : CrushLaw::force;
  model.extrapolation = random.whole(0, 1) == 0 ? Extrapolation::constant : Extrapolation::linear;
  model.unloading.bilateral = random.whole(0, 3) == 0;
  const double frequency = random.between(15.0, 50.0);  // 1/s
  const double damping = model.mass_kg * frequency * random.between(0.02, 0.8);
  const double typical_spring = model.mass_kg * frequency * (model.law == CrushLaw::stiffness ? frequency : speed);
  const int parts = random.whole(0, 9);
  if (parts != 0) model.spring = random_curve(random, speed / frequency * random.between(0.3, 1.3), typical_spring);
  if (parts != 1) {
    const int placement = random.whole(0, 3);
    model.damper = random_curve(random, placement < 2 ? speed : speed * random.between(0.5, 1.4), damping);
    if (placement == 1) {  // an inner knot on the impact speed
      const std::size_t inner = model.damper.knots.size() / 2;
      const double scale = speed / model.damper.knots[inner];
      for (double& knot : model.damper.knots) knot *= scale;
      model.damper.knots[inner] = speed;
    }
  }
  // Where nothing but a damper acts, a speed without damping is approached for ever, and passed by the smallest error.
  if (model.spring.knots.empty())
    for (double& c : model.damper.ordinates) c += 0.05 * damping;
  else
    model.spring.ordinates.back() += 0.05 * typical_spring;
  // A bilateral yield force makes an oscillation whose frequency grows as it decays.
  if (model.unloading.bilateral && model.law == CrushLaw::force && !model.spring.knots.empty())
    model.spring.ordinates.front() = 0.0;
  // A falling last line turns negative somewhere: a damper's, or a spring's that pulls, drives a motion without bound.
  const auto raise_last_line = [](std::vector<double>& ordinates) {
    if (ordinates.size() > 1 && *(ordinates.end() - 2) > ordinates.back())
      std::swap(*(ordinates.end() - 2), ordinates.back());
  };
  if (model.extrapolation == Extrapolation::linear) raise_last_line(model.damper.ordinates);
  if (model.extrapolation == Extrapolation::linear && model.unloading.bilateral)
    raise_last_line(model.spring.ordinates);
  return model;
}

/// The same with law `crush_damping`, its damper over the reach of the crush (at times with the spring's knots, at
/// times with one knot), or `rate`, its reference speed from far below the impact's to beyond it.
inline CrushModel random_model_of(CrushLaw law, Random& random) {
  CrushModel model;
  do {
    model = random_crush_model(random);
  } while (model.law != CrushLaw::force || (law == CrushLaw::rate && model.spring.knots.empty()));
  model.law = law;
  if (law == CrushLaw::rate) {
    model.damper = {};
    model.rate_coefficient = random.whole(0, 7) == 0 ? 0.0 : random.between(0.01, 0.5);
    model.reference_speed_mps = model.impact_speed_mps * std::pow(10.0, random.between(-4.0, 0.5));
    return model;
  }
  if (model.damper.knots.empty()) return model;
  const int kind = random.whole(0, 5);
  if (kind == 0) model.damper = {{0.0}, {model.damper.ordinates.back()}};
  if (kind == 1 && !model.spring.knots.empty()) {
    const double most = model.damper.ordinates.back();
    model.damper = {model.spring.knots, std::vector<double>(model.spring.knots.size())};
    for (double& c : model.damper.ordinates) c = most * random.between(0.0, 1.5);
    std::ranges::sort(model.damper.ordinates);  // so that no last line falls
    return model;
  }
  const double metre_per_speed = random.between(0.005, 0.04);
  for (double& knot : model.damper.knots) knot *= metre_per_speed;
  return model;
}

/// Plastic unloading, by restitution or by stiffness.
inline void make_plastic(CrushModel& model, Random& random) {
  model.unloading.kind = UnloadingKind::plastic;
  if (random.whole(0, 1) == 0) {
    model.unloading.restitution = random.between(0.05, 1.0);
  } else {
    const double frequency = random.between(20.0, 400.0);  // 1/s
    model.unloading.unloading_stiffness_n_per_m = model.mass_kg * frequency * frequency;
  }
}

}  // namespace crashsim::test
