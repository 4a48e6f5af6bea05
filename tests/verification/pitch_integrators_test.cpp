/// The two engines of Phase II against each other.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <crashsim/simulate_pitch.hpp>

#include "support/pitch_cases.hpp"

namespace crashsim {
namespace {

constexpr double kAgreement = 1e-9;  // relative to each channel's largest value, as asked
constexpr double kRtol = 1e-12;      // of CVODE, whose global error is 10 to 300 times as large

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double v : values) most = std::max(most, std::abs(v));
  return most;
}

/// Largest difference over all states, relative to each channel's largest value.
double disagreement(const PitchResponse& a, const PitchResponse& b) {
  double worst = 0.0;
  for (const auto member : {&PitchResponse::heave_m, &PitchResponse::pitch_rad, &PitchResponse::heave_velocity_mps,
                            &PitchResponse::pitch_rate_radps}) {
    double most = 0.0;
    for (std::size_t i = 0; i < (a.*member).size(); ++i)
      most = std::max(most, std::abs((a.*member)[i] - (b.*member)[i]));
    worst = std::max(worst, most / largest(a.*member));
  }
  return worst;
}

TEST(PitchIntegrators, CvodeAgreesWithThePropagatorOnRandomSystems) {
  constexpr int kSystems = 1000;
  test::Random random(31);
  double worst = 0.0;
  for (int i = 0; i < kSystems; ++i) {
    HeavePitchModel model = test::random_vehicle(random);
    model.per_wheel = i % 5 == 0;
    if (i % 4 == 0) model.formulation = PitchFormulation::as_printed;
    PitchForcing forcing;
    forcing.vertical_force_n = test::random_series(random, -0.02, 0.18, random.whole(2, 16), -6e4, 6e4);
    if (i % 2 == 0) forcing.longitudinal_force_n = test::random_series(random, 0.0, 0.12, random.whole(2, 8), 0.0, 6e5);
    if (i % 3 == 0) forcing.force_height_m = test::random_series(random, 0.0, 0.1, random.whole(2, 5), 0.3, 0.9);
    PitchOptions options;
    options.start = {PitchStart::given, {random.between(-0.01, 0.06)}};
    options.end_time_s = 0.2;
    options.dt_s = 0.0021;
    options.heave_m = random.between(-0.05, 0.05);
    options.pitch_rate_radps = random.between(-0.5, 0.5);
    const PitchResponse exact = simulate_pitch(model, forcing, options);
    options.integrator = PitchIntegrator::cvode;
    options.rtol = kRtol;
    const PitchResponse integrated = simulate_pitch(model, forcing, options);
    ASSERT_TRUE(exact.usable() && integrated.usable()) << integrated.message;
    const double difference = disagreement(exact, integrated);
    EXPECT_LT(difference, kAgreement) << "system " << i;
    EXPECT_NEAR(exact.pitch_max_rad, integrated.pitch_max_rad, kAgreement);
    EXPECT_NEAR(exact.heave_min_m, integrated.heave_min_m, kAgreement);
    EXPECT_NEAR(exact.heave_velocity_min_mps, integrated.heave_velocity_min_mps, kAgreement);
    worst = std::max(worst, difference);
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_GT(worst, 0.0);  // they are two engines
}

TEST(PitchIntegrators, CvodeAgreesAtItsDefaultTolerance) {
  constexpr double kDefaultAgreement = 1e-7;  // relative: 1000 times the default rtol
  PitchForcing forcing;
  forcing.vertical_force_n = test::sampled_half_sine(200);
  PitchOptions options;
  options.start.rule = PitchStart::impact;
  const PitchResponse exact = simulate_pitch(test::oracle_vehicle(), forcing, options);
  options.integrator = PitchIntegrator::cvode;
  const PitchResponse integrated = simulate_pitch(test::oracle_vehicle(), forcing, options);
  EXPECT_LT(disagreement(exact, integrated), kDefaultAgreement);
  EXPECT_GT(integrated.statistics.force_evaluations, integrated.statistics.steps);
  EXPECT_EQ(exact.statistics.force_evaluations, 0);
}

}  // namespace
}  // namespace crashsim
