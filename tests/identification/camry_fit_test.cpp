/// Identification from a real test: NHTSA 10146, mean of the rear seat cross-members, 7 + 7 knots.

#include <gmock/gmock.h>

#include <crashsim/identify.hpp>

#include "support/fit_cases.hpp"
#include "support/reference_motion.hpp"

namespace crashsim {
namespace {

constexpr double kKnownError = 0.0711;      // regression: E that 100 starts must reach
constexpr int kStartsThatAgree = 95;        // regression: of 100
constexpr double kIndependentError = 1e-6;  // solver: between two integrators
constexpr double kEquationError = 1e-3;     // solver: how near the single start from the linear solution comes

class CamryFit : public testing::Test {
 protected:
  void SetUp() override {
    const auto pulse = test::camry_pulse();
    if (!pulse) GTEST_SKIP() << test::kNoSharedData;
    pulse_ = *pulse;
  }
  Pulse pulse_;
};

TEST_F(CamryFit, HundredStartsAgreeAndSayWhatOneSpeedCannotTell) {
  const Identification fit = identify(pulse_);
  ASSERT_TRUE(fit.usable()) << fit.brief_report();
  EXPECT_EQ(fit.starts.size(), 100U);
  EXPECT_LE(fit.error.total, kKnownError);
  EXPECT_GE(fit.starts_at_best, kStartsThatAgree);
  EXPECT_FALSE(fit.verdict.identifiable);
  EXPECT_THAT(fit.verdict.message, testing::HasSubstr("not separable from one speed"));
  EXPECT_THAT(fit.brief_report(), testing::HasSubstr("not separable from one speed"));
  EXPECT_EQ(fit.model.mass_kg, 1719.0);
  EXPECT_EQ(fit.model.spring.knots.size(), 7U);
  EXPECT_EQ(fit.model.damper.knots.size(), 7U);
  EXPECT_DOUBLE_EQ(fit.model.spring.knots.back(), pulse_.max_crush_m);
  EXPECT_DOUBLE_EQ(fit.model.damper.knots.back(), pulse_.impact_speed_mps);

  IdentifyOptions one_start;
  one_start.starts = 1;
  EXPECT_LT(identify(pulse_, one_start).error.total, (1.0 + kEquationError) * fit.error.total);
}

TEST_F(CamryFit, ReportsTheErrorThatAnIndependentIntegratorFinds) {
  IdentifyOptions options;
  options.starts = 2;
  const Identification fit = identify(pulse_, options);
  std::vector<double> times;
  for (const double t : pulse_.time_s)
    if (t <= pulse_.t_m_s) times.push_back(t);
  const auto samples =
      test::ReferenceMotion<double>(fit.model, test::ordinates_of(fit.model), pulse_.impact_speed_mps).at(times);
  double accel = 0.0, velocity = 0.0, displacement = 0.0, most_a = 0.0, most_v = 0.0, most_x = 0.0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    accel += std::fabs(samples[i].a - pulse_.accel_mps2[i]);
    velocity += std::fabs(samples[i].v - pulse_.velocity_mps[i]);
    displacement += std::fabs(samples[i].x - pulse_.displacement_m[i]);
    most_a = std::max(most_a, std::fabs(pulse_.accel_mps2[i]));
    most_v = std::max(most_v, std::fabs(pulse_.velocity_mps[i]));
    most_x = std::max(most_x, std::fabs(pulse_.displacement_m[i]));
  }
  const auto n = static_cast<double>(times.size());
  EXPECT_NEAR(fit.error.accel, accel / n / most_a, kIndependentError * fit.error.total);
  EXPECT_NEAR(fit.error.velocity, velocity / n / most_v, kIndependentError * fit.error.total);
  EXPECT_NEAR(fit.error.displacement, displacement / n / most_x, kIndependentError * fit.error.total);
  EXPECT_NEAR(fit.error.total, accel / n / most_a + velocity / n / most_v + displacement / n / most_x,
              kIndependentError * fit.error.total);
}

TEST_F(CamryFit, EquationErrorAloneComesNear) {
  constexpr double kNear = 1.2;  // regression: E of the linear solution relative to the optimum
  IdentifyOptions options;
  options.method = IdentifyMethod::equation_error;
  const Identification fit = identify(pulse_, options);
  ASSERT_TRUE(fit.usable()) << fit.brief_report();
  EXPECT_LE(fit.error.total, kNear * kKnownError);
  EXPECT_THAT(fit.starts, testing::IsEmpty());
  EXPECT_EQ(fit.evaluations, 0);
}

class CamryAlgorithm : public CamryFit, public testing::WithParamInterface<Algorithm> {};

TEST_P(CamryAlgorithm, ReachesTheOptimum) {
  IdentifyOptions options;
  options.algorithm = GetParam();
  options.starts = 10;
  EXPECT_LE(identify(pulse_, options).error.total, kKnownError);
}

INSTANTIATE_TEST_SUITE_P(Algorithms, CamryAlgorithm,
                         testing::Values(Algorithm::lbfgs, Algorithm::slsqp, Algorithm::tnewton, Algorithm::var2),
                         [](const auto& algorithm) { return std::string(name_of(algorithm.param)); });

}  // namespace
}  // namespace crashsim
