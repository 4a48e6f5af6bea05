/// The gradient of the objective against complex steps through an integrator of the tests' own.

#include <cmath>
#include <complex>
#include <ostream>

#include <gtest/gtest.h>

#include "optimize/fit_objective.hpp"
#include "support/fit_cases.hpp"
#include "support/reference_motion.hpp"

namespace crashsim {
namespace {

using Complex = std::complex<double>;

constexpr double kGradient = 1e-7;      // solver: of the largest scaled derivative, as asked
constexpr double kComplexStep = 1e-30;  // no rounding, no truncation
constexpr double kSmoothing = 1e-2;     // of a rung of the ladder

Complex penalty(Loss loss, Complex u, double smoothing) {
  constexpr double kThreshold = 0.05;
  const double size = std::fabs(u.real());
  if (loss == Loss::l2) return u * u;
  if (loss == Loss::huber && size <= kThreshold) return u * u / (2.0 * kThreshold);
  if (loss == Loss::l1 && smoothing > 0.0) return std::sqrt(u * u + smoothing * smoothing) - smoothing;
  return (u.real() < 0.0 ? -u : u) - (loss == Loss::huber ? kThreshold / 2.0 : 0.0);
}

/// E as a complex number: its imaginary part over the step is the derivative by the ordinate `moved`.
Complex reference_error(const CrushModel& model, const std::vector<double>& ordinates, std::size_t moved,
                        const FitTarget& target, Loss loss, double smoothing) {
  std::vector<Complex> complex(ordinates.begin(), ordinates.end());
  complex[moved] += Complex(0.0, kComplexStep);
  test::ReferenceMotion<Complex> motion(model, complex, target.impact_speed_mps);
  const auto samples = motion.at(target.time_s);
  Complex sum = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto add = [&](Complex value, double data, double scale, double size) {
      sum += penalty(loss, scale * (value - data), smoothing * size);
    };
    add(samples[i].a, target.accel_mps2[i], target.accel_scale, target.accel_size);
    add(samples[i].v, target.velocity_mps[i], target.velocity_scale, target.velocity_size);
    add(samples[i].x, target.displacement_m[i], target.displacement_scale, target.displacement_size);
  }
  return target.factor * sum;
}

struct Case {
  CrushLaw law;
  Loss loss;
  double smoothing;
};

FitStructure structure_of(const CrushModel& model) { return {model.law, model.spring.knots, model.damper.knots}; }

/// Largest difference of the derivatives, each times its ordinate's scale, relative to the largest of them.
double gradient_error(const CrushModel& model, const std::vector<double>& ordinates, const FitTarget& target,
                      const Case& how) {
  FitObjective objective(structure_of(model), {&target, 1}, how.loss, 0.0);
  std::vector<double> gradient(ordinates.size());
  const double value = objective.evaluate(ordinates, how.smoothing, gradient);
  const ForceScale scale = force_scale(model.law, {&target, 1});
  double worst = 0.0, largest = 0.0;
  for (std::size_t p = 0; p < ordinates.size(); ++p) {
    const Complex reference = reference_error(model, ordinates, p, target, how.loss, how.smoothing);
    EXPECT_NEAR(value, reference.real(), kGradient * value);
    const double size = p < model.spring.knots.size() ? scale.spring : scale.damper;
    worst = std::max(worst, size * std::fabs(gradient[p] - reference.imag() / kComplexStep));
    largest = std::max(largest, size * std::fabs(reference.imag() / kComplexStep));
  }
  EXPECT_GT(largest, 0.0);
  return worst / largest;
}

/// Ordinates off the model's, so that no residual is zero, where |r| has no derivative.
std::vector<double> moved_ordinates(const CrushModel& model) {
  std::vector<double> ordinates = test::ordinates_of(model);
  for (double& ordinate : ordinates) ordinate *= 1.3;
  return ordinates;
}

constexpr double kCoarseSampling = 1e-3;  // s: complex steps are slow

void PrintTo(const Case& c, std::ostream* out) { *out << name_of(c.law) << ' ' << name_of(c.loss); }

class Gradient : public testing::TestWithParam<Case> {};

TEST_P(Gradient, OfRandomModelsIsThatOfComplexSteps) {
  constexpr int kModels = 6;
  test::Random random(11);
  double worst = 0.0;
  for (int i = 0; i < kModels; ++i) {
    const CrushModel model = test::random_crush_model(random, GetParam().law);
    const auto pulse = test::pulse_of(model, model.impact_speed_mps, kCoarseSampling);
    if (!pulse) continue;
    const FitTarget target = make_target(*pulse, kUnset, {});
    std::vector<double> ordinates = test::ordinates_of(model);
    for (double& ordinate : ordinates) ordinate *= random.between(0.3, 3.0);
    const double error = gradient_error(model, ordinates, target, GetParam());
    EXPECT_LT(error, kGradient) << "model " << i;
    worst = std::max(worst, error);
  }
  RecordProperty("worst", std::to_string(worst * 1e12) + "e-12");
  EXPECT_GT(worst, 0.0);
}

/// Springs without a first or a middle part, no damper at all: ordinates at their lower bound, forces that start at 0.
TEST_P(Gradient, IsRightAtTheLowerBound) {
  test::Random random(12);
  const CrushModel model = test::random_crush_model(random, GetParam().law);
  const FitTarget target =
      make_target(test::pulse_of(model, model.impact_speed_mps, kCoarseSampling).value(), kUnset, {});
  std::vector<double> ordinates = moved_ordinates(model);
  for (const std::size_t zero : {1U, 2U, 4U, 8U, 9U, 13U}) {
    ordinates[zero] = 0.0;
    EXPECT_LT(gradient_error(model, ordinates, target, GetParam()), kGradient) << "down to ordinate " << zero;
  }
  std::fill(ordinates.begin() + 7, ordinates.end(), 0.0);
  EXPECT_LT(gradient_error(model, ordinates, target, GetParam()), kGradient) << "no damper";
}

/// A model stiff enough to stop early and leave the barrier long before the pulse ends.
TEST_P(Gradient, IsRightThroughReboundAndSeparation) {
  test::Random random(13);
  const CrushModel model = test::random_crush_model(random, GetParam().law);
  const FitTarget target =
      make_target(test::pulse_of(model, model.impact_speed_mps, kCoarseSampling).value(), kUnset, {});
  std::vector<double> ordinates = moved_ordinates(model);
  for (std::size_t i = 0; i < model.spring.knots.size(); ++i) ordinates[i] *= 12.0;
  EXPECT_LT(gradient_error(model, ordinates, target, GetParam()), kGradient);
}

/// A constant force stops the car with v = v0 - (F/m) t: knots are met exactly at samples.
TEST_P(Gradient, IsRightWhereSamplesAreOnKnots) {
  constexpr double kSpeed = 16.0, kDecel = 256.0;  // m/s, m/s^2: powers of two, so that samples fall on knots exactly
  CrushModel model;
  model.mass_kg = 1024.0;
  model.law = GetParam().law;
  model.impact_speed_mps = kSpeed;
  model.damper = {uniform_knots(kSpeed, 5), std::vector<double>(5, 0.0)};
  model.spring = {uniform_knots(kSpeed * kSpeed / (2.0 * kDecel), 5), std::vector<double>(5, model.mass_kg * kDecel)};
  Pulse pulse;
  pulse.mass_kg = model.mass_kg;
  pulse.impact_speed_mps = kSpeed;
  pulse.t_m_s = kSpeed / kDecel;
  pulse.max_crush_m = kSpeed * pulse.t_m_s / 2.0;
  for (int i = 0; i <= 64; ++i) {
    const double t = pulse.t_m_s * i / 64.0;
    pulse.time_s.push_back(t);
    pulse.accel_mps2.push_back(-1.1 * kDecel);
    pulse.velocity_mps.push_back(1.02 * kSpeed - kDecel * t);
    pulse.displacement_m.push_back(kSpeed * t - 0.49 * kDecel * t * t);
  }
  const FitTarget target = make_target(pulse, kUnset, {});
  EXPECT_LT(gradient_error(model, test::ordinates_of(model), target, GetParam()), kGradient);
}

INSTANTIATE_TEST_SUITE_P(LawsAndLosses, Gradient,
                         testing::Values(Case{CrushLaw::stiffness, Loss::l1, kSmoothing},
                                         Case{CrushLaw::stiffness, Loss::l1, 0.0},
                                         Case{CrushLaw::stiffness, Loss::l2, 0.0},
                                         Case{CrushLaw::stiffness, Loss::huber, 0.0},
                                         Case{CrushLaw::force, Loss::l1, kSmoothing},
                                         Case{CrushLaw::force, Loss::l2, 0.0}, Case{CrushLaw::force, Loss::huber, 0.0}),
                         [](const auto& c) {
                           return std::string(name_of(c.param.law)) + "_" + std::string(name_of(c.param.loss)) +
                                  (c.param.smoothing > 0.0 ? "_smoothed" : "");
                         });

/// At the model that made the pulses all residuals vanish, and the squared loss's Hessian is 2 J'J over the tests.
TEST(Jacobian, IsTheHessianOfTheSquaredLossWithoutResiduals) {
  constexpr double kStep = 1e-4;         // of an ordinate
  constexpr double kDifferences = 1e-6;  // central differences of the exact gradient: truncation of the order kStep^2
  const CrushModel model = test::example_model();
  const std::vector<FitTarget> targets = {make_target(test::pulse_of(model, 11.0).value(), kUnset, {}),
                                          make_target(test::pulse_of(model, 13.0).value(), kUnset, {})};
  const std::vector<double> ordinates = test::ordinates_of(model);
  FitObjective objective(structure_of(model), targets, Loss::l2, 0.0);
  const Eigen::MatrixXd jacobian = objective.jacobian(ordinates);
  const Eigen::MatrixXd hessian = 2.0 / static_cast<double>(targets.size()) * jacobian.transpose() * jacobian;
  std::vector<double> after(ordinates.size()), before(ordinates.size());
  for (std::size_t p = 0; p < ordinates.size(); ++p) {
    std::vector<double> moved = ordinates;
    moved[p] = ordinates[p] * (1.0 + kStep);
    objective.evaluate(moved, 0.0, after);
    moved[p] = ordinates[p] * (1.0 - kStep);
    objective.evaluate(moved, 0.0, before);
    for (std::size_t q = 0; q < ordinates.size(); ++q) {
      const auto i = static_cast<Eigen::Index>(p), j = static_cast<Eigen::Index>(q);
      const double size = std::sqrt(hessian(i, i) * hessian(j, j));
      EXPECT_NEAR((after[q] - before[q]) / (2.0 * kStep * ordinates[p]), hessian(i, j), kDifferences * size)
          << p << ", " << q;
    }
  }
}

}  // namespace
}  // namespace crashsim
