/// What the verdict says of numbers of a heave-pitch model that the data do and do not determine.

#include <cmath>

#include <gmock/gmock.h>

#include "support/pitch_fit_cases.hpp"

namespace crashsim {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using M = HeavePitchModel;

/// Judged at the truth itself.
PitchIdentification refit(const M& truth, const PitchForcing& forcing, double end_s, std::vector<std::string> free) {
  IdentifyPitchOptions options;
  options.free = std::move(free);
  options.starts = 1;
  options.loss = Loss::l2;
  const PitchTarget target = test::target_of(simulate_pitch(truth, forcing, test::to(end_s)));
  return identify_pitch(truth, forcing, target, test::to(end_s), options);
}

TEST(PitchVerdict, TwoHeightsCannotBeToldApart) {
  const PitchIdentification fit =
      refit(test::vehicle_with_heights(), test::both_forces(), 0.5, {"cg_height_m", "force_height_m"});
  EXPECT_TRUE(fit.usable());
  EXPECT_FALSE(fit.verdict.identifiable);
  EXPECT_EQ(fit.verdict.rank, 1);
  // Changes of the same size in metres.
  EXPECT_THAT(fit.verdict.message, StartsWith("the parameters cannot be told apart (rank 1 of 2, condition "));
  EXPECT_THAT(fit.verdict.message, HasSubstr("changing cg_height_m by +0.81 %, force_height_m by +1 % together"));
  for (const ParameterReport& parameter : fit.parameters) EXPECT_TRUE(std::isnan(parameter.standard_error));
}

TEST(PitchVerdict, AShortRecordDoesNotTellSuspensionAxlesAndInertiaApart) {
  const PitchIdentification fit = refit(test::oracle_vehicle(), test::vertical_half_sine(), 0.1,
                                        {"front_stiffness", "rear_stiffness", "front_damping", "rear_damping",
                                         "front_axle", "rear_axle", "pitch_inertia"});
  EXPECT_FALSE(fit.verdict.identifiable);
  EXPECT_GT(fit.verdict.condition, 1e5);
  EXPECT_THAT(fit.verdict.message, AllOf(HasSubstr("be told apart"), HasSubstr("rear_axle_m by "),
                                         HasSubstr("fix one of them, or give more channels or a longer record")));
  EXPECT_THAT(fit.verdict.message, testing::Not(HasSubstr("pitch_inertia_kgm2 by ")));
}

/// With the same ratio of stiffness to damping at both axles, there are three equations for four numbers of each kind.
TEST(PitchVerdict, EqualRatiosOfStiffnessToDampingHideTheAxles) {
  M truth = test::oracle_vehicle();
  truth.front_damping_ns_per_m = 0.08 * truth.front_stiffness_n_per_m;
  truth.rear_damping_ns_per_m = 0.08 * truth.rear_stiffness_n_per_m;
  const PitchIdentification fit =
      refit(truth, test::vertical_half_sine(), 2.0,
            {"front_stiffness", "rear_stiffness", "front_damping", "rear_damping", "front_axle", "rear_axle"});
  EXPECT_EQ(fit.verdict.rank, 5) << fit.verdict.message;
  EXPECT_FALSE(fit.verdict.identifiable);
}

M free_body() {
  M body = test::vehicle_with_heights();
  body.front_stiffness_n_per_m = body.rear_stiffness_n_per_m = 0.0;
  body.front_damping_ns_per_m = body.rear_damping_ns_per_m = 0.0;
  return body;
}

TEST(PitchVerdict, AFreeBodyShowsOnlyTheRatioOfArmAndInertia) {
  const PitchIdentification fit = refit(free_body(), test::vertical_half_sine(), 0.3, {"force_arm", "pitch_inertia"});
  EXPECT_EQ(fit.verdict.rank, 1);
  EXPECT_THAT(fit.verdict.message, HasSubstr("changing force_arm_m by +1 %, pitch_inertia_kgm2 by +1 % together"));
  EXPECT_TRUE(refit(free_body(), test::vertical_half_sine(), 0.3, {"pitch_inertia"}).verdict.identifiable);
}

/// With theta'' = F l_Q / J and no noise, the sensitivity of theta to ln J is -theta: one number, its error closed
/// form.
TEST(PitchVerdict, TheStandardErrorOfAFreeBodysInertiaIsTheClosedForm) {
  constexpr double kClosedForm = 1e-9;  // rounding: of sums over the record
  constexpr double kOff = 0.01;         // of the pitch, by turns
  const M truth = free_body();
  PitchTarget target;
  target.pitch_rad = test::target_of(simulate_pitch(truth, test::vertical_half_sine(), test::to(0.3))).pitch_rad;
  std::vector<double>& pitch = target.pitch_rad.values;
  for (std::size_t i = 0; i < pitch.size(); ++i) pitch[i] *= i % 2 == 0 ? 1.0 + kOff : 1.0 - kOff;
  IdentifyPitchOptions options;
  options.free = {"pitch_inertia"};
  options.loss = Loss::l2;
  options.starts = 1;
  const PitchIdentification fit = identify_pitch(truth, test::vertical_half_sine(), target, test::to(0.3), options);
  const M& found = fit.model;
  const std::vector<double> model = simulate_pitch(found, test::vertical_half_sine(), test::to(0.3)).pitch_rad;
  double residuals = 0.0, sensitivities = 0.0;
  for (std::size_t i = 0; i < pitch.size(); ++i) {
    residuals += (model[i] - pitch[i]) * (model[i] - pitch[i]);
    sensitivities += model[i] * model[i] / (found.pitch_inertia_kgm2 * found.pitch_inertia_kgm2);
  }
  const double expected = std::sqrt(residuals / static_cast<double>(pitch.size() - 1) / sensitivities);
  EXPECT_NEAR(fit.parameters[0].standard_error, expected, kClosedForm * expected);
}

TEST(PitchVerdict, NamesWhatNoSampleDependsOn) {
  const PitchIdentification fit =
      refit(test::vehicle_with_heights(), test::vertical_half_sine(), 0.5, {"rear_damping", "force_height"});
  EXPECT_FALSE(fit.verdict.identifiable);
  EXPECT_THAT(fit.verdict.message, HasSubstr("no sample depends on force_height_m"));
  EXPECT_FALSE(fit.parameters[0].untouched);
  EXPECT_TRUE(fit.parameters[1].untouched);
  EXPECT_TRUE(std::isnan(fit.parameters[1].standard_error));
  EXPECT_TRUE(std::isnan(fit.correlation[0][1]));
}

TEST(PitchVerdict, WithoutForceNothingDependsOnTheSuspension) {
  const TimeSeries noise{{0.0, 0.1, 0.2, 0.3, 0.4, 0.5}, {0.0, 1e-3, -1e-3, 2e-3, 0.0, 1e-3}};
  IdentifyPitchOptions options;
  options.starts = 1;
  const PitchIdentification fit =
      identify_pitch(test::oracle_vehicle(), {}, {noise, {}, {}, {}}, test::to(0.5), options);
  EXPECT_EQ(fit.verdict.message, "no sample depends on any parameter");
  EXPECT_FALSE(fit.verdict.identifiable);
}

/// A body that is hardly held for the time of the record: stiffness between 0 and 1e6 N/m fits noise as well.
TEST(PitchVerdict, NoiseLeavesTheStiffnessOfAFreeBodyOpen) {
  const M truth = free_body();
  const PitchForcing forcing = test::vertical_half_sine();
  PitchTarget target = test::target_of(simulate_pitch(truth, forcing, test::to(0.08)));
  test::Random random(5);
  for (auto* series : {&target.heave_m, &target.pitch_rad, &target.heave_velocity_mps, &target.pitch_rate_radps})
    for (double& value : series->values) value *= 1.0 + random.between(-0.3, 0.3);
  IdentifyPitchOptions options;
  options.starts = 3;
  options.loss = Loss::l2;
  const PitchIdentification fit = identify_pitch(truth, forcing, target, test::to(0.08), options);
  EXPECT_FALSE(fit.verdict.identifiable);
  EXPECT_THAT(fit.verdict.message, AllOf(HasSubstr("the data leave "), HasSubstr("rear_stiffness_n_per_m"),
                                         HasSubstr("open: a standard error of more than a tenth of the way between")));
}

TEST(PitchVerdict, WarnsOfValuesAtTheirBound) {
  const M truth = test::oracle_vehicle();
  IdentifyPitchOptions options;
  options.free = {"front_stiffness", "rear_damping"};
  options.lower = {1e4, kUnset};
  options.upper = {2e4, kUnset};
  options.starts = 2;
  const PitchForcing forcing = test::vertical_half_sine();
  const PitchTarget target = test::target_of(simulate_pitch(truth, forcing, test::to(0.5)));
  const PitchIdentification fit = identify_pitch(truth, forcing, target, test::to(0.5), options);
  EXPECT_EQ(fit.parameters[0].value, 2e4);
  EXPECT_TRUE(fit.parameters[0].at_bound);
  EXPECT_FALSE(fit.parameters[1].at_bound);
  EXPECT_EQ(fit.parameters[1].lower_bound, 3000.0 / 20.0);
  EXPECT_EQ(fit.parameters[1].upper_bound, 3000.0 * 20.0);
  EXPECT_EQ(fit.parameters[1].unit, "N s/m");
  EXPECT_THAT(fit.warnings,
              testing::ElementsAre("front_stiffness_n_per_m = 30000 N/m of the given model is outside its bounds 10000 "
                                   "to 20000 N/m: the first start begins at the nearer one",
                                   "front_stiffness_n_per_m = 20000 N/m is at its bound: the best value may lie "
                                   "beyond it"));
}

TEST(PitchVerdict, WarnsOfAForceThatIsCutOff) {
  const M truth = test::oracle_vehicle();
  PitchForcing forcing = test::vertical_half_sine();
  forcing.vertical_force_n.time_s.resize(21);
  forcing.vertical_force_n.values.resize(21);
  IdentifyPitchOptions options;
  options.starts = 1;
  const PitchTarget target = test::target_of(simulate_pitch(truth, forcing, test::to(0.3)));
  EXPECT_THAT(identify_pitch(truth, forcing, target, test::to(0.3), options).warnings,
              testing::ElementsAre(StartsWith("vertical_force_n ends at 0.04 s with 60000 N, 100 % of its largest")));
}

/// Independent noise of equal size relative to each channel: what least squares assume.
TEST(PitchVerdict, StandardErrorsAreThoseOfRepeatedTests) {
  constexpr int kTests = 60;
  constexpr double kShare = 0.02;    // noise, of each channel's largest
  constexpr double kSampling = 0.3;  // regression: of a standard deviation from kTests, three of its own
  const M truth = test::oracle_vehicle();
  const PitchForcing forcing = test::vertical_half_sine();
  const PitchTarget clean = test::target_of(simulate_pitch(truth, forcing, test::to(0.6, 4e-3)));
  IdentifyPitchOptions options;
  options.starts = 1;
  options.loss = Loss::l2;
  test::Random random(6);
  std::vector<double> sum(4), squares(4), predicted(4);
  for (int i = 0; i < kTests; ++i) {
    PitchTarget noisy = clean;
    for (auto* series : {&noisy.heave_m, &noisy.pitch_rad, &noisy.heave_velocity_mps, &noisy.pitch_rate_radps}) {
      double largest = 0.0;
      for (const double value : series->values) largest = std::max(largest, std::fabs(value));
      for (double& value : series->values) value += kShare * largest * random.between(-1.0, 1.0);
    }
    const PitchIdentification fit = identify_pitch(truth, forcing, noisy, test::to(0.6), options);
    for (std::size_t p = 0; p < 4; ++p) {
      sum[p] += fit.parameters[p].value / kTests;
      squares[p] += fit.parameters[p].value * fit.parameters[p].value / kTests;
      predicted[p] += fit.parameters[p].standard_error / kTests;
    }
  }
  const double truths[] = {truth.front_stiffness_n_per_m, truth.rear_stiffness_n_per_m, truth.front_damping_ns_per_m,
                           truth.rear_damping_ns_per_m};
  for (std::size_t p = 0; p < 4; ++p) {
    const double deviation = std::sqrt(squares[p] - sum[p] * sum[p]);
    EXPECT_NEAR(predicted[p], deviation, kSampling * deviation) << p;
    EXPECT_NEAR(sum[p], truths[p], deviation) << p;
  }
}

}  // namespace
}  // namespace crashsim
