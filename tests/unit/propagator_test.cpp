#include "solver/propagator.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/random.hpp"

namespace crashsim {
namespace {

constexpr double kRounding = 1e-13;    // relative, of one step
constexpr double kManySteps = 1e-11;   // relative, of thousands of steps
constexpr double kStiff = 1e-9;        // rounding, times a damping of 1e6 per step
constexpr double kRungeKutta = 1e-11;  // error of the reference integration below

LinearSystem random_system(test::Random& random) {
  LinearSystem system;
  system.stiffness << random.between(10, 300), random.between(-30, 30), random.between(-30, 30),
      random.between(10, 300);
  system.damping << random.between(0, 10), random.between(-2, 2), random.between(-2, 2), random.between(0, 10);
  return system;
}
PitchState random_state(test::Random& random) {
  return {random.between(-0.1, 0.1), random.between(-0.1, 0.1), random.between(-1, 1), random.between(-1, 1)};
}
ForcePiece random_force(test::Random& random) {
  ForcePiece force;
  for (double& f : force.reshaped()) f = random.between(-50, 50);
  force.col(1) *= 10.0;
  force.col(2) *= 100.0;
  return force;
}

/// Classical Runge-Kutta steps.
PitchState runge_kutta(const LinearSystem& system, const PitchState& from, const ForcePiece& force, double h,
                       int steps) {
  const auto rate = [&](double s, const PitchState& y) {
    PitchState dy;
    dy << y.tail<2>(), system.acceleration(y, value(force, s));
    return dy;
  };
  PitchState y = from;
  const double d = h / steps;
  for (int i = 0; i < steps; ++i) {
    const double s = d * i;
    const PitchState k1 = rate(s, y);
    const PitchState k2 = rate(s + 0.5 * d, y + 0.5 * d * k1);
    const PitchState k3 = rate(s + 0.5 * d, y + 0.5 * d * k2);
    const PitchState k4 = rate(s + d, y + d * k3);
    y += d / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return y;
}

TEST(Propagator, AgreesWithRungeKuttaForAnyStep) {
  test::Random random(11);
  for (const double h : {1e-4, 3e-3, 0.02, 0.3}) {
    for (int i = 0; i < 20; ++i) {
      const LinearSystem system = random_system(random);
      const PitchState from = random_state(random);
      const ForcePiece force = random_force(random);
      const PitchState reference = runge_kutta(system, from, force, h, 4000);
      const PitchState step = Propagator(system, 0.0).step(from, force, h);
      EXPECT_LT((step - reference).norm(), kRungeKutta * reference.norm()) << "h = " << h;
    }
  }
}

TEST(Propagator, RecurringStepsAreTheSameAsSingleOnes) {
  test::Random random(12);
  const LinearSystem system = random_system(random);
  constexpr std::size_t kSteps = 3000;
  std::vector<double> times{0.0};
  std::vector<ForcePiece> forces;
  for (std::size_t i = 0; i < kSteps; ++i) {
    times.push_back(times.back() + (i % 3 == 0 ? 1e-4 : i % 3 == 1 ? 2.5e-4 : random.between(1e-5, 1e-3)));
    forces.push_back(random_force(random));
  }
  std::vector<PitchState> states(times.size(), random_state(random));
  Propagator(system, 1e-15).run(times, forces, states);
  const Propagator plain(system, 0.0);
  PitchState y = states[0];
  for (std::size_t i = 0; i < kSteps; ++i) y = plain.step(y, forces[i], times[i + 1] - times[i]);
  EXPECT_LT((states.back() - y).norm(), kManySteps * y.norm());
}

TEST(Propagator, TwoStepsMakeOne) {
  test::Random random(13);
  for (int i = 0; i < 100; ++i) {
    const Propagator propagator(random_system(random), 0.0);
    const PitchState from = random_state(random);
    const ForcePiece force = random_force(random);
    const double a = random.between(0.0, 0.1), b = random.between(0.0, 0.1);
    const PitchState middle = propagator.step(from, force, a);
    const PitchState twice = propagator.step(middle, shifted(force, a), b);
    const PitchState once = propagator.step(from, force, a + b);
    EXPECT_LT((twice - once).norm(), kRounding * (once.norm() + from.norm() + force.norm()));
  }
}

TEST(Propagator, OscillatesAndDecaysAsTheClosedFormSays) {
  const double w = 7.0, zeta = 0.3, wd = w * std::sqrt(1.0 - zeta * zeta);
  LinearSystem system{.stiffness = Eigen::Matrix2d::Identity() * w * w,
                      .damping = Eigen::Matrix2d::Identity() * 2.0 * zeta * w};
  const PitchState from(1.0, 0.0, 0.0, 2.0);
  for (const double t : {1e-3, 0.1, 1.0, 5.0}) {
    const PitchState y = Propagator(system, 0.0).step(from, ForcePiece::Zero(), t);
    const double decay = std::exp(-zeta * w * t);
    EXPECT_NEAR(y[0], decay * (std::cos(wd * t) + zeta * w / wd * std::sin(wd * t)), kRounding);
    EXPECT_NEAR(y[1], decay * 2.0 / wd * std::sin(wd * t), kRounding);
  }
}

TEST(Propagator, StiffMotionsDecayWithoutHarm) {
  LinearSystem system{.stiffness = Eigen::Matrix2d::Identity() * 100.0,
                      .damping = Eigen::Vector2d(1e6, 1.0).asDiagonal()};
  const PitchState y = Propagator(system, 0.0).step({1.0, 1.0, 0.0, 0.0}, ForcePiece::Zero(), 1.0);
  EXPECT_NEAR(y[0], std::exp(-100.0 / 1e6), kStiff);  // creeps with k/c
  EXPECT_NEAR(y[2], -100.0 / 1e6 * y[0], kStiff);
}

TEST(Propagator, AFreeBodyFollowsTheForceExactly) {
  LinearSystem system{.stiffness = Eigen::Matrix2d::Zero(), .damping = Eigen::Matrix2d::Zero()};
  ForcePiece force;
  force << 6.0, 12.0, 24.0, 0.0, 6.0, 0.0;
  const PitchState y = Propagator(system, 0.0).step({1.0, 0.0, 2.0, 0.0}, force, 2.0);
  EXPECT_NEAR(y[0], 1.0 + 4.0 + 12.0 + 16.0 + 16.0, kRounding * 49.0);
  EXPECT_NEAR(y[2], 2.0 + 12.0 + 24.0 + 32.0, kRounding * 70.0);
  EXPECT_NEAR(y[1], 8.0, kRounding * 8.0);
  EXPECT_NEAR(y[3], 12.0, kRounding * 12.0);
}

}  // namespace
}  // namespace crashsim
