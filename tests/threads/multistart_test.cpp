/// What an identification's numbers depend on: seed and start index, never the number of threads.

#include <atomic>
#include <cmath>

#include <gmock/gmock.h>

#include <crashsim/identify.hpp>

#include "optimize/multistart.hpp"
#include "support/fit_cases.hpp"

namespace crashsim {
namespace {

Pulse disturbed_pulse() {
  constexpr double kDisturbance = 0.03;
  const CrushModel model = test::example_model();
  return test::noisy_pulse(model, model.impact_speed_mps, kDisturbance, 1);
}

IdentifyOptions ten_starts() {
  IdentifyOptions options;
  options.starts = 10;
  return options;
}

std::vector<double> errors_of(const Identification& fit) {
  std::vector<double> errors;
  for (const StartReport& start : fit.starts) errors.push_back(start.error);
  return errors;
}

void expect_bitwise_same(const Identification& a, const Identification& b) {
  EXPECT_EQ(test::ordinates_of(a.model), test::ordinates_of(b.model));
  EXPECT_EQ(errors_of(a), errors_of(b));
  EXPECT_EQ(a.error.total, b.error.total);
  EXPECT_EQ(a.evaluations, b.evaluations);
  EXPECT_EQ(a.starts_at_best, b.starts_at_best);
  EXPECT_EQ(a.verdict.condition, b.verdict.condition);
  ASSERT_EQ(a.ordinates.size(), b.ordinates.size());
  for (std::size_t i = 0; i < a.ordinates.size(); ++i)
    if (!std::isnan(a.ordinates[i].standard_error) || !std::isnan(b.ordinates[i].standard_error)) {
      EXPECT_EQ(a.ordinates[i].standard_error, b.ordinates[i].standard_error);
    }
}

TEST(Multistart, GivesBitwiseTheSameOnAnyNumberOfThreads) {
  const Pulse pulse = disturbed_pulse();
  IdentifyOptions options = ten_starts();
  options.jobs = 1;
  const Identification one = identify(pulse, options);
  for (const int jobs : {2, 7}) {
    options.jobs = jobs;
    SCOPED_TRACE(jobs);
    expect_bitwise_same(identify(pulse, options), one);
  }
}

TEST(Multistart, DependsOnTheSeed) {
  const Pulse pulse = disturbed_pulse();
  IdentifyOptions options = ten_starts();
  const Identification first = identify(pulse, options), again = identify(pulse, options);
  expect_bitwise_same(first, again);
  options.seed = 2;
  const Identification other = identify(pulse, options);
  EXPECT_EQ(other.seed, 2U);
  EXPECT_EQ(errors_of(other)[0], errors_of(first)[0]);  // start 0 is no random one
  EXPECT_NE(errors_of(other), errors_of(first));
}

TEST(Multistart, AStartDependsOnItsIndexOnly) {
  const Pulse pulse = disturbed_pulse();
  IdentifyOptions options = ten_starts();
  const std::vector<double> few = errors_of(identify(pulse, options));
  options.starts = 25;
  std::vector<double> many = errors_of(identify(pulse, options));
  ASSERT_EQ(many.size(), 25U);
  many.resize(few.size());
  EXPECT_EQ(many, few);
}

TEST(Multistart, CountsTheStartsAtTheBest) {
  constexpr double kBest = 1e-3;  // relative, by definition
  const Identification fit = identify(disturbed_pulse(), ten_starts());
  const std::vector<double> errors = errors_of(fit);
  const double best = *std::min_element(errors.begin(), errors.end());
  EXPECT_EQ(fit.starts_at_best,
            std::count_if(errors.begin(), errors.end(), [&](double e) { return e <= (1.0 + kBest) * best; }));
  EXPECT_GE(fit.starts_at_best, 1);
  long evaluations = 0;
  for (const StartReport& start : fit.starts) evaluations += start.evaluations;
  EXPECT_GT(fit.evaluations, evaluations);  // the best start has gone on
  EXPECT_GT(fit.seconds, 0.0);
}

/// The weights change the size of E, not the way to it: the ladder is relative to each channel's largest residual.
TEST(Multistart, FindsTheSameModelWithTheNormalisedWeightsGiven) {
  constexpr double kSameError = 1e-3;  // solver: within which starts agree
  const Pulse pulse = disturbed_pulse();
  const Identification normalised = identify(pulse, ten_starts());
  const FitTarget target = make_target(pulse, kUnset, {});
  IdentifyOptions options = ten_starts();
  const double unit = 1e-3;  // such as would make an absolute ladder far too coarse
  options.weights = {Weights::given,
                     {unit * target.accel_scale, unit * target.velocity_scale, unit * target.displacement_scale}};
  const Identification given = identify(pulse, options);
  const double scaled = given.error.total / (unit * static_cast<double>(target.time_s.size()));
  EXPECT_NEAR(scaled, normalised.error.total, kSameError * normalised.error.total);
  EXPECT_EQ(given.starts_at_best, 10);
  EXPECT_EQ(normalised.starts_at_best, 10);
}

TEST(Multistart, DrawsStartsInsideTheBounds) {
  const FitStructure structure{CrushLaw::stiffness, {0.0, 0.5}, {0.0}};
  const Eigen::Vector3d upper(2.0, 30.0, 400.0), linear(1.0, 2.0, 3.0);
  const Eigen::VectorXd bounds = upper, start = linear;
  const IdentifyOptions options;
  const MultistartProblem problem{structure, {}, options, bounds, start};
  EXPECT_EQ(initial_ordinates(problem, 0), (std::vector<double>{1.0, 2.0, 3.0}));
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  constexpr int kStarts = 4000;
  for (int i = 1; i <= kStarts; ++i) {
    const std::vector<double> drawn = initial_ordinates(problem, i);
    for (std::size_t j = 0; j < drawn.size(); ++j) {
      EXPECT_GE(drawn[j], 0.0);
      EXPECT_LT(drawn[j], upper[static_cast<Eigen::Index>(j)]);
      sum[static_cast<Eigen::Index>(j)] += drawn[j] / upper[static_cast<Eigen::Index>(j)];
    }
  }
  constexpr double kMeanOfUniform = 0.02;  // rounding: four standard deviations of the mean of kStarts
  for (const double s : sum) EXPECT_NEAR(s / kStarts, 0.5, kMeanOfUniform);
}

TEST(Multistart, StoppedKeepsWhatIsFinished) {
  IdentifyOptions options;
  options.starts = 100'000;  // hours
  int calls = 0;
  const Identification fit = identify(disturbed_pulse(), options, [&](int done, int total) {
    EXPECT_EQ(total, options.starts);
    ++calls;
    return done == 0;
  });
  EXPECT_EQ(fit.outcome, IdentifyOutcome::interrupted);
  EXPECT_FALSE(fit.usable());
  EXPECT_GT(calls, 0);
  EXPECT_GT(fit.starts.size(), 0U);
  EXPECT_LT(fit.starts.size(), static_cast<std::size_t>(options.starts));
  EXPECT_EQ(fit.message, "stopped after " + std::to_string(fit.starts.size()) + " of 100000 starts");
  EXPECT_GT(fit.error.total, 0.0);
  EXPECT_FALSE(fit.model.spring.ordinates.empty());
  EXPECT_EQ(fit.ordinates.size(), 14U);
  EXPECT_GT(fit.seconds, 0.0);
  EXPECT_THAT(fit.brief_report(), testing::StartsWith("interrupted: stopped after "));
}

TEST(Multistart, AStartIsNotFinishedWhenStoppedInsideIt) {
  constexpr double kFine = 2e-7;  // some 400 000 samples: a start takes seconds, progress is asked every 0.1 s
  test::Random random(3);
  const CrushModel car = test::random_crush_model(random, CrushLaw::stiffness);
  const auto pulse = test::pulse_of(car, car.impact_speed_mps, kFine);
  ASSERT_TRUE(pulse);
  IdentifyOptions options;
  options.starts = 2;
  options.jobs = 1;
  const Identification fit = identify(*pulse, options, [](int, int) { return false; });
  EXPECT_EQ(fit.outcome, IdentifyOutcome::interrupted);
  EXPECT_EQ(fit.message, "stopped after 0 of 2 starts");
  EXPECT_TRUE(fit.ordinates.empty());
}

TEST(Multistart, PassesOnWhatTheProgressThrows) {
  IdentifyOptions options;
  options.starts = 100'000;
  EXPECT_THROW(identify(disturbed_pulse(), options, [](int, int) -> bool { throw Interrupted("enough"); }),
               Interrupted);
}

}  // namespace
}  // namespace crashsim
