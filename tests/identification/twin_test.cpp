/// Twins: pulses that a known model made, so that what must be found is known.

#include <cmath>

#include <gtest/gtest.h>

#include <crashsim/identify.hpp>

#include "optimize/multistart.hpp"
#include "support/fit_cases.hpp"

namespace crashsim {
namespace {

constexpr double kTotalForce = 1e-6;  // solver: relative to the largest force, as asked

/// Force along the motion that made the pulse [N].
double force_at(const CrushModel& model, const Pulse& pulse, std::size_t i) {
  return spring_force(model, pulse.displacement_m[i]) + damper_force(model, pulse.velocity_mps[i]);
}

/// Largest difference of the total forces over 0..t_m, relative to the largest force.
double force_error(const CrushModel& found, const CrushModel& truth, const Pulse& pulse) {
  double worst = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < pulse.time_s.size() && pulse.time_s[i] <= pulse.t_m_s; ++i) {
    worst = std::max(worst, std::fabs(force_at(found, pulse, i) - force_at(truth, pulse, i)));
    largest = std::max(largest, force_at(truth, pulse, i));
  }
  return worst / largest;
}

/// Options that put the knots where the twin has them and the bounds far above its ordinates: a pulse that hardly
/// reaches a knot does not tell how large its ordinate may be.
IdentifyOptions knots_of(const CrushModel& model) {
  IdentifyOptions options;
  options.law = model.law;
  options.spring_knots = static_cast<int>(model.spring.knots.size());
  options.damper_knots = static_cast<int>(model.damper.knots.size());
  options.knots = {KnotPlacement::given, model.spring.knots};
  constexpr double kFar = 3.0;
  options.spring_upper = kFar * *std::max_element(model.spring.ordinates.begin(), model.spring.ordinates.end());
  if (!model.damper.ordinates.empty())
    options.damper_upper = kFar * *std::max_element(model.damper.ordinates.begin(), model.damper.ordinates.end());
  return options;
}

struct Twin {
  CrushLaw law;
  IdentifyMethod method;
};
void PrintTo(const Twin& twin, std::ostream* out) { *out << name_of(twin.law) << ' ' << name_of(twin.method); }

class TwinOf : public testing::TestWithParam<Twin> {};

TEST_P(TwinOf, RandomModelsHasTheirTotalForce) {
  constexpr int kTwins = 10;
  test::Random random(21);
  int found_twins = 0;
  double worst = 0.0;
  for (int i = 0; i < kTwins; ++i) {
    const CrushModel truth = test::random_crush_model(random, GetParam().law);
    const auto pulse = test::pulse_of(truth, truth.impact_speed_mps);
    if (!pulse) continue;
    IdentifyOptions options = knots_of(truth);
    options.method = GetParam().method;
    options.starts = 3;
    options.jobs = 1;
    const Identification fit = identify(*pulse, options);
    ASSERT_TRUE(fit.usable()) << fit.brief_report();
    const double error = force_error(fit.model, truth, *pulse);
    EXPECT_LT(error, kTotalForce) << "twin " << i;
    worst = std::max(worst, error);
    ++found_twins;
  }
  RecordProperty("worst", std::to_string(1e9 * worst) + "e-9");
  EXPECT_GT(found_twins, kTwins / 2);
}

INSTANTIATE_TEST_SUITE_P(LawsAndMethods, TwinOf,
                         testing::Values(Twin{CrushLaw::stiffness, IdentifyMethod::multistart},
                                         Twin{CrushLaw::stiffness, IdentifyMethod::equation_error},
                                         Twin{CrushLaw::force, IdentifyMethod::multistart},
                                         Twin{CrushLaw::force, IdentifyMethod::equation_error}));

class SpringAlone : public testing::TestWithParam<CrushLaw> {};

/// Without a damper the force is a function of crush alone: nothing is confounded, and the ordinates themselves return.
TEST_P(SpringAlone, IsFoundFromEveryRandomStart) {
  constexpr double kFromAfar = 1e-4;  // solver: |r| is not smooth, a start ends within ftol of the optimum
  test::Random random(22);
  const CrushModel truth = test::random_crush_model(random, GetParam(), 7, 0);
  const Pulse pulse = test::pulse_of(truth, truth.impact_speed_mps).value();
  const FitTarget target = make_target(pulse, kUnset, {});
  const FitStructure structure{truth.law, truth.spring.knots, {}};
  IdentifyOptions options = knots_of(truth);
  options.starts = 12;
  const double most = *std::max_element(truth.spring.ordinates.begin(), truth.spring.ordinates.end());
  const Eigen::VectorXd upper = Eigen::VectorXd::Constant(7, 3.0 * most);
  const Eigen::VectorXd nowhere = Eigen::VectorXd::Constant(7, most);  // instead of the answer, as start 0
  for (const StartResult& start : run_starts({structure, {&target, 1}, options, upper, nowhere}, {})) {
    EXPECT_FALSE(start.report.failed);
    const CrushModel found = make_model(structure, start.parameters, truth.mass_kg, truth.impact_speed_mps);
    EXPECT_LT(force_error(found, truth, pulse), kFromAfar) << "E " << start.report.error;
  }
}

TEST_P(SpringAlone, HasOneOptimumOnADisturbedPulse) {
  constexpr double kDisturbance = 0.03;
  test::Random random(23);
  const CrushModel truth = test::random_crush_model(random, GetParam(), 7, 0);
  const Pulse pulse = test::noisy_pulse(truth, truth.impact_speed_mps, kDisturbance, 5);
  IdentifyOptions options;
  options.law = truth.law;
  options.damper_knots = 0;
  options.starts = 30;
  const Identification fit = identify(pulse, options);
  EXPECT_EQ(fit.starts_at_best, options.starts);
  EXPECT_TRUE(fit.model.damper.knots.empty());
  EXPECT_TRUE(fit.verdict.identifiable) << fit.verdict.message;
  EXPECT_TRUE(std::isnan(fit.verdict.spring_damper_cosine));
}

INSTANTIATE_TEST_SUITE_P(Laws, SpringAlone, testing::Values(CrushLaw::stiffness, CrushLaw::force),
                         [](const auto& law) { return std::string(name_of(law.param)); });

/// A linear damper alone: v falls exponentially and never reaches zero, so that a spring must end the pulse.
TEST(DamperWithOneSpring, IsFound) {
  CrushModel truth;
  truth.mass_kg = 1500.0;
  truth.impact_speed_mps = 14.0;
  truth.spring = {{0.0}, {4e5}};
  truth.damper = {uniform_knots(14.0, 5), {2e4, 1e4, 3e4, 1.5e4, 1e4}};
  const Pulse pulse = test::pulse_of(truth, 14.0).value();
  IdentifyOptions options;
  options.spring_knots = 1;
  options.damper_knots = 5;
  options.starts = 4;
  const Identification fit = identify(pulse, options);
  EXPECT_LT(force_error(fit.model, truth, pulse), kTotalForce);
  constexpr double kOrdinates = 1e-5;  // solver: total force times the condition of one speed
  EXPECT_NEAR(fit.model.spring.ordinates[0], truth.spring.ordinates[0], kOrdinates * truth.spring.ordinates[0]);
}

/// Two speeds tell spring from damper: not only the total force but the curves come back.
TEST(TwoSpeeds, BringBackBothCurves) {
  constexpr double kOrdinates = 1e-4;  // solver: relative to the largest ordinate
  const CrushModel truth = test::example_model();
  const double high = truth.impact_speed_mps, low = 40.0 / 56.0 * high;
  const std::vector<Pulse> pulses = {test::pulse_of(truth, high).value(), test::pulse_of(truth, low).value()};
  IdentifyOptions options = knots_of(truth);
  options.starts = 4;
  const Identification fit = identify(pulses, options);
  ASSERT_TRUE(fit.usable()) << fit.brief_report();
  for (std::size_t j = 0; j < pulses.size(); ++j) EXPECT_LT(force_error(fit.model, truth, pulses[j]), kTotalForce) << j;
  const double stiffest = *std::max_element(truth.spring.ordinates.begin(), truth.spring.ordinates.end());
  const double strongest = *std::max_element(truth.damper.ordinates.begin(), truth.damper.ordinates.end());
  for (std::size_t i = 0; i < truth.spring.knots.size(); ++i) {
    if (fit.ordinates[i].untouched) continue;
    EXPECT_NEAR(fit.model.spring.ordinates[i], truth.spring.ordinates[i], kOrdinates * stiffest) << "k" << i + 1;
  }
  for (std::size_t i = 0; i < truth.damper.knots.size(); ++i)
    EXPECT_NEAR(fit.model.damper.ordinates[i], truth.damper.ordinates[i], kOrdinates * strongest) << "c" << i + 1;
}

}  // namespace
}  // namespace crashsim
