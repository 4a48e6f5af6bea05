/// How far ordinates can be believed: bounds, untouched ordinates, standard errors, correlations, identifiability.

#include <cmath>

#include <gmock/gmock.h>
#include <Eigen/LU>

#include <crashsim/identify.hpp>

#include "optimize/verdict.hpp"
#include "support/fit_cases.hpp"

namespace crashsim {
namespace {

constexpr double kDisturbance = 0.03;
constexpr double kLinear = 1e-9;  // rounding: two ways to the same inverse

Pulse disturbed_pulse(double speed_mps) { return test::noisy_pulse(test::example_model(), speed_mps, kDisturbance, 9); }
double kmh(double speed) { return speed / 3.6; }

IdentifyOptions few_starts() {
  IdentifyOptions options;
  options.starts = 4;
  return options;
}

TEST(Verdict, OneSpeedDoesNotTellSpringFromDamperAndTwoDo) {
  const Pulse fast = disturbed_pulse(kmh(56.0)), slow = disturbed_pulse(kmh(40.0));
  const Identification one = identify(fast, few_starts());
  EXPECT_FALSE(one.verdict.identifiable);
  EXPECT_THAT(one.verdict.message, testing::HasSubstr("spring and damper are not separable from one speed"));
  const std::vector<Pulse> both = {fast, slow};
  const Identification joint = identify(both, few_starts());
  EXPECT_TRUE(joint.verdict.identifiable) << joint.verdict.message;
  EXPECT_THAT(joint.verdict.message, testing::StartsWith("every ordinate is determined (rank 14 of 14"));
  EXPECT_LT(joint.verdict.condition, one.verdict.condition);
  EXPECT_LT(joint.verdict.spring_damper_cosine, one.verdict.spring_damper_cosine);
  EXPECT_EQ(joint.verdict.rank, 14);
}

TEST(Verdict, SmoothingNarrowsWhatOneSpeedLeavesOpen) {
  const Pulse pulse = disturbed_pulse(kmh(56.0));
  IdentifyOptions options = few_starts();
  const Identification rough = identify(pulse, options);
  options.smooth = 10.0;
  const Identification smooth = identify(pulse, options);
  const auto largest_error = [](const Identification& fit) {
    double largest = 0.0;
    for (const OrdinateReport& k : fit.ordinates) largest = std::max(largest, k.standard_error / k.upper_bound);
    return largest;
  };
  EXPECT_LT(largest_error(smooth), largest_error(rough));
  EXPECT_GT(smooth.error.total, rough.error.total);
  const auto roughness = [](const Identification& fit) {
    const auto& k = fit.model.spring.ordinates;
    double sum = 0.0;
    for (std::size_t i = 0; i + 2 < k.size(); ++i) sum += std::pow(k[i] - 2.0 * k[i + 1] + k[i + 2], 2);
    return sum;
  };
  EXPECT_LT(roughness(smooth), roughness(rough));
}

TEST(Verdict, OrdinatesBeyondTheReachedCrushAreUntouchedAndHeld) {
  const Pulse pulse = disturbed_pulse(kmh(56.0));
  IdentifyOptions options = few_starts();
  const double c = pulse.max_crush_m;
  options.knots = {KnotPlacement::given, {0.0, 0.3 * c, 0.6 * c, 0.9 * c, 1.5 * c, 2.0 * c, 3.0 * c}};
  options.damper_knots = 0;
  const Identification fit = identify(pulse, options);
  ASSERT_EQ(fit.ordinates.size(), 7U);
  for (std::size_t i = 0; i < 7; ++i) {
    const bool beyond = i > 4;
    EXPECT_EQ(fit.ordinates[i].untouched, beyond) << fit.ordinates[i].name;
    const bool is_held = beyond || fit.ordinates[i].at_bound;
    EXPECT_EQ(std::isnan(fit.ordinates[i].standard_error), is_held) << fit.ordinates[i].name;
    EXPECT_EQ(std::isnan(fit.correlation[i][0]), is_held || fit.ordinates[0].at_bound) << fit.ordinates[i].name;
    if (beyond) {
      EXPECT_EQ(fit.ordinates[i].value, fit.ordinates[4].value);
    }
  }
  EXPECT_FALSE(fit.verdict.identifiable);
  EXPECT_THAT(fit.verdict.message, testing::EndsWith("; 2 ordinates no sample depends on"));
  EXPECT_EQ(test::ordinates_of(fit.model)[6], fit.ordinates[4].value);
}

TEST(Verdict, BoundsAreChosenFromTheDataOrGivenAndReported) {
  const Pulse pulse = disturbed_pulse(kmh(56.0));
  IdentifyOptions options = few_starts();
  const Identification free = identify(pulse, options);
  double most_force = 0.0;
  for (const double a : pulse.accel_mps2) most_force = std::max(most_force, pulse.mass_kg * std::fabs(a));
  for (const OrdinateReport& ordinate : free.ordinates) {
    EXPECT_GT(ordinate.upper_bound, 0.0) << ordinate.name;
    EXPECT_TRUE(std::isfinite(ordinate.upper_bound)) << ordinate.name;
    EXPECT_GE(ordinate.value, 0.0);
    EXPECT_LE(ordinate.value, ordinate.upper_bound);
  }
  EXPECT_GE(free.ordinates[6].upper_bound, most_force / pulse.max_crush_m / 2.0);
  options.spring_upper = 1e5;
  options.damper_upper = 2e4;
  const Identification tight = identify(pulse, options);
  int at_bound = 0;
  for (const OrdinateReport& ordinate : tight.ordinates) {
    EXPECT_EQ(ordinate.upper_bound, ordinate.name[0] == 'k' ? 1e5 : 2e4);
    if (ordinate.at_bound) ++at_bound;
    EXPECT_EQ(ordinate.at_bound,
              ordinate.value <= 1e-6 * ordinate.upper_bound || ordinate.value >= (1.0 - 1e-6) * ordinate.upper_bound);
  }
  EXPECT_GT(at_bound, 0);
  EXPECT_GT(tight.error.total, free.error.total);
}

/// True ordinates must be inside the bounds that the data suggest, or nothing could find them.
TEST(Verdict, BoundsHoldTheModelThatMadeThePulse) {
  constexpr int kModels = 60;
  test::Random random(31);
  for (int i = 0; i < kModels; ++i) {
    const CrushLaw law = i % 2 == 0 ? CrushLaw::stiffness : CrushLaw::force;
    const CrushModel model = test::random_crush_model(random, law, random.whole(1, 9), random.whole(1, 9));
    const auto pulse = test::pulse_of(model, model.impact_speed_mps);
    if (!pulse) continue;
    IdentifyOptions options;
    options.law = law;
    options.method = IdentifyMethod::equation_error;
    options.spring_knots = static_cast<int>(model.spring.knots.size());
    options.damper_knots = static_cast<int>(model.damper.knots.size());
    const Identification fit = identify(*pulse, options);
    const std::size_t springs = model.spring.knots.size();
    for (std::size_t j = 0; j < fit.ordinates.size(); ++j) {
      const bool is_spring = j < springs;
      // The twin's curve at the fit's knots: springs of the fit end at C.
      const double truth =
          is_spring ? evaluate(model.spring, fit.model.spring.knots[j]) : model.damper.ordinates[j - springs];
      EXPECT_LE(truth, fit.ordinates[j].upper_bound) << "model " << i << " " << fit.ordinates[j].name;
    }
  }
}

TEST(Verdict, NamesSpringThenDamper) {
  IdentifyOptions options = few_starts();
  options.spring_knots = 2;
  options.damper_knots = 1;
  std::vector<std::string> names;
  for (const OrdinateReport& ordinate : identify(disturbed_pulse(kmh(56.0)), options).ordinates)
    names.push_back(ordinate.name);
  EXPECT_THAT(names, testing::ElementsAre("k1", "k2", "c1"));
}

/// A linear problem whose covariance is known: variance (J'J)^-1.
class LinearProblem : public testing::Test {
 protected:
  LinearProblem() : jacobian_(40, 4) {
    test::Random random(33);
    for (double& entry : jacobian_.reshaped()) entry = random.between(-1.0, 1.0);
    jacobian_.col(2) *= 1e-5;  // ordinates are of very different size
    upper_ << 1.0, 1.0, 1e5, 1.0;
  }
  [[nodiscard]] Identifiability judged() const {
    return judge_identifiability(structure_, parameters_, upper_, jacobian_, Eigen::MatrixXd(0, 4), kVariance, 1);
  }

  static constexpr double kVariance = 0.37;
  FitStructure structure_{CrushLaw::stiffness, {0.0, 0.5}, {0.0, 10.0}};
  std::vector<double> parameters_ = {0.5, 0.0, 4e4, 1.0};
  Eigen::MatrixXd jacobian_;
  Eigen::VectorXd upper_ = Eigen::VectorXd(4);
};

TEST_F(LinearProblem, StandardErrorsAndCorrelationsAreTheClosedForm) {
  const Identifiability found = judged();
  const Eigen::MatrixXd covariance = kVariance * (jacobian_.transpose() * jacobian_).inverse();
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double expected = std::sqrt(covariance(i, i));
    EXPECT_NEAR(found.ordinates[static_cast<std::size_t>(i)].standard_error, expected, kLinear * expected);
    for (Eigen::Index j = 0; j < 4; ++j)
      EXPECT_NEAR(found.correlation[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)],
                  covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j)), kLinear);
  }
  EXPECT_EQ(found.verdict.rank, 4);
  EXPECT_TRUE(found.verdict.identifiable);
}

TEST_F(LinearProblem, FlagsBothBounds) {
  const Identifiability found = judged();
  EXPECT_FALSE(found.ordinates[0].at_bound);
  EXPECT_TRUE(found.ordinates[1].at_bound);
  EXPECT_FALSE(found.ordinates[2].at_bound);
  EXPECT_TRUE(found.ordinates[3].at_bound);
}

TEST_F(LinearProblem, ConditionIsThatOfUnitColumns) {
  jacobian_.setZero();
  const double angle = 0.01;  // between the columns of k1 and c1
  jacobian_(0, 0) = 3.0;
  jacobian_(1, 1) = 2.0;
  jacobian_(2, 3) = 1e-3;
  jacobian_(0, 2) = std::cos(angle) * 1e-5;
  jacobian_(3, 2) = std::sin(angle) * 1e-5;
  const Identifiability found = judged();
  const double expected = std::sqrt((1.0 + std::cos(angle)) / (1.0 - std::cos(angle)));
  constexpr double kCondition = 1e-8;  // rounding: eps times the condition squared
  EXPECT_NEAR(found.verdict.condition, expected, kCondition * expected);
  EXPECT_NEAR(found.verdict.spring_damper_cosine, std::cos(angle), kLinear);
  EXPECT_FALSE(found.verdict.identifiable);
  EXPECT_THAT(found.verdict.message, testing::HasSubstr("not separable from one speed"));
}

TEST_F(LinearProblem, DependentColumnsLowerTheRank) {
  jacobian_.col(1) = 2.0 * jacobian_.col(0);
  const Identifiability found = judged();
  EXPECT_EQ(found.verdict.rank, 3);
  EXPECT_FALSE(found.verdict.identifiable);
  EXPECT_THAT(found.verdict.message, testing::StartsWith("the ordinates are not well determined from one speed (rank 3 "
                                                         "of 4"));
  for (const OrdinateReport& ordinate : found.ordinates) EXPECT_TRUE(std::isnan(ordinate.standard_error));
}

TEST_F(LinearProblem, SmoothingRowsDetermineButDoNotTouch) {
  jacobian_.col(1).setZero();
  EXPECT_TRUE(judged().ordinates[1].untouched);
  EXPECT_TRUE(std::isnan(judged().ordinates[1].standard_error));
  Eigen::MatrixXd roughness(1, 4);
  roughness << 1.0, -2.0, 0.0, 0.0;
  const Identifiability found =
      judge_identifiability(structure_, parameters_, upper_, jacobian_, roughness, kVariance, 2);
  EXPECT_TRUE(found.ordinates[1].untouched);
  EXPECT_FALSE(std::isnan(found.ordinates[1].standard_error));
  EXPECT_THAT(found.verdict.message, testing::EndsWith("; 1 ordinate no sample depends on"));
}

TEST_F(LinearProblem, WithoutAnyDependenceSaysSo) {
  jacobian_.setZero();
  const Identifiability found = judged();
  EXPECT_EQ(found.verdict.message, "no sample depends on any ordinate");
  EXPECT_FALSE(found.verdict.identifiable);
}

TEST(HoldUntouched, TakesTheNearestOfTheSameCurve) {
  const FitStructure structure{CrushLaw::stiffness, {0.0, 0.1, 0.2, 0.3}, {0.0, 5.0, 10.0}};
  std::vector<double> parameters = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0};
  hold_untouched(structure, {false, true, false, false, false, false, true}, parameters);
  EXPECT_THAT(parameters, testing::ElementsAre(2.0, 2.0, 2.0, 2.0, 7.0, 7.0, 7.0));
  parameters = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0};
  hold_untouched(structure, {true, false, true, true, false, false, false}, parameters);
  EXPECT_THAT(parameters, testing::ElementsAre(1.0, 1.0, 3.0, 4.0, 5.0, 6.0, 7.0));
}

}  // namespace
}  // namespace crashsim
