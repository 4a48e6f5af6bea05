/// Equation error: the linear problem in the measured motion.

#include <cmath>

#include <gtest/gtest.h>

#include "optimize/equation_error.hpp"
#include "support/fit_cases.hpp"

namespace crashsim {
namespace {

constexpr double kExact = 1e-7;  // solver: CVODE's motion at rtol 1e-12 times the condition of the problem

std::vector<FitTarget> two_targets(const Setting<Weights>& weights = {}) {
  const CrushModel model = test::example_model();
  return {make_target(test::pulse_of(model, 14.0).value(), kUnset, weights),
          make_target(test::pulse_of(model, 10.0).value(), kUnset, weights)};
}

FitStructure twin_structure() {
  const CrushModel model = test::example_model();
  return {model.law, model.spring.knots, model.damper.knots};
}

Eigen::VectorXd generous() { return Eigen::VectorXd::Constant(14, 1e8); }

double largest_residual(const FitStructure& structure, const FitTarget& target, const Eigen::VectorXd& p) {
  const CrushModel model = make_model(structure, std::vector<double>(p.begin(), p.end()), target.mass_kg, 10.0);
  double worst = 0.0;
  for (std::size_t i = 0; i < target.time_s.size(); ++i)
    worst = std::max(worst,
                     std::fabs(target.mass_kg * target.accel_mps2[i] + spring_force(model, target.displacement_m[i]) +
                               damper_force(model, target.velocity_mps[i])));
  return worst;
}

TEST(EquationError, OfPerfectDataVanishes) {
  const auto targets = two_targets();
  const Eigen::VectorXd p = solve_equation_error(twin_structure(), targets, generous(), 0.0);
  for (const FitTarget& target : targets)
    EXPECT_LT(largest_residual(twin_structure(), target, p), kExact * target.mass_kg / target.accel_scale);
}

/// Weights scale rows: E without a weight on acceleration must not leave it without any force.
TEST(EquationError, DoesNotNeedAWeightOnAcceleration) {
  const auto targets = two_targets({Weights::given, {0.0, 1.0, 1.0}});
  const Eigen::VectorXd p = solve_equation_error(twin_structure(), targets, generous(), 0.0);
  EXPECT_GT(p.maxCoeff(), 0.0);
  for (const FitTarget& target : targets) {
    double largest = 0.0;
    for (const double a : target.accel_mps2) largest = std::max(largest, target.mass_kg * std::fabs(a));
    EXPECT_LT(largest_residual(twin_structure(), target, p), kExact * largest);
  }
}

/// A force that starts at its full height, with a first displacement that rounding made negative.
TEST(EquationError, TakesARoundedZeroForZero) {
  test::Random random(51);
  const CrushModel model = test::random_crush_model(random, CrushLaw::force);
  Pulse pulse = test::pulse_of(model, model.impact_speed_mps).value();
  constexpr double kRounded = -1e-29;  // m
  pulse.displacement_m[0] = kRounded;
  const FitTarget target = make_target(pulse, kUnset, {});
  const FitStructure structure{model.law, model.spring.knots, model.damper.knots};
  const Eigen::VectorXd p = solve_equation_error(structure, {&target, 1}, generous(), 0.0);
  EXPECT_NEAR(p[0], model.spring.ordinates[0], kExact * p.maxCoeff());
}

TEST(EquationError, KeepsToItsBounds) {
  const Eigen::VectorXd upper = Eigen::VectorXd::Constant(14, 2e5);
  const Eigen::VectorXd p = solve_equation_error(twin_structure(), two_targets(), upper, 0.0);
  EXPECT_GE(p.minCoeff(), 0.0);
  EXPECT_LE(p.maxCoeff(), 2e5);
}

TEST(EquationError, SmoothedALotIsStraight) {
  constexpr double kStraight = 1e-4;  // solver: what a weight of kHeavy leaves of second differences
  constexpr double kHeavy = 1e8;
  const Eigen::VectorXd p = solve_equation_error(twin_structure(), two_targets(), generous(), kHeavy);
  for (const Eigen::Index first : {0, 7})
    for (Eigen::Index i = first; i + 2 < first + 7; ++i)
      EXPECT_LT(std::fabs(p[i] - 2.0 * p[i + 1] + p[i + 2]), kStraight * p.segment(first, 7).maxCoeff());
}

/// The same smoothing for one pulse and for the same pulse twice: E is a mean over pulses.
TEST(EquationError, SmoothsAlikeHoweverManyPulses) {
  constexpr double kSame = 1e-6;  // rounding: times the condition of the problem
  constexpr double kSmooth = 1e-2;
  const std::vector<FitTarget> one = {two_targets()[0]}, twice = {one[0], one[0]};
  const Eigen::VectorXd p = solve_equation_error(twin_structure(), one, generous(), kSmooth);
  const Eigen::VectorXd q = solve_equation_error(twin_structure(), twice, generous(), kSmooth);
  EXPECT_LT((p - q).cwiseAbs().maxCoeff(), kSame * p.maxCoeff());
}

}  // namespace
}  // namespace crashsim
