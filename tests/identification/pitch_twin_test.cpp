/// Twins: numbers of a heave-pitch model found again from its own motion.

#include <functional>
#include <ostream>

#include <gmock/gmock.h>

#include <crashsim/option_values.hpp>

#include "support/pitch_fit_cases.hpp"

namespace crashsim {
namespace {

using M = HeavePitchModel;

constexpr double kRecovered = 1e-6;  // solver: relative, as asked

void expect_same_numbers(const M& found, const M& truth) {
  for (const Field<M>& field : fields<M>) {
    const auto* member = std::get_if<double M::*>(&field.member);
    if (member == nullptr || std::isnan(truth.**member)) continue;
    EXPECT_NEAR(found.**member, truth.**member, kRecovered * std::fabs(truth.**member)) << field.name;
  }
}

IdentifyPitchOptions four_starts() {
  IdentifyPitchOptions options;
  options.starts = 4;
  return options;
}

struct Twin {
  const char* name;
  std::vector<std::string> free;
  std::function<void(M& truth, M& guess, PitchForcing&, PitchOptions&, IdentifyPitchOptions&)> change;
};
void PrintTo(const Twin& twin, std::ostream* out) { *out << twin.name; }

class PitchTwin : public testing::TestWithParam<Twin> {};

TEST_P(PitchTwin, IsFoundAgain) {
  M truth = test::vehicle_with_heights(), guess = test::wrong_suspension(truth);
  PitchForcing forcing = test::vertical_half_sine();
  PitchOptions simulation = test::to(1.0);
  IdentifyPitchOptions options = four_starts();
  options.free = GetParam().free;
  GetParam().change(truth, guess, forcing, simulation, options);
  const PitchTarget target = test::target_of(simulate_pitch(truth, forcing, simulation));
  const PitchIdentification fit = identify_pitch(guess, forcing, target, simulation, options);
  ASSERT_TRUE(fit.usable()) << fit.message;
  expect_same_numbers(fit.model, truth);
  EXPECT_TRUE(fit.verdict.identifiable) << fit.verdict.message;
  EXPECT_EQ(fit.verdict.rank, static_cast<int>(options.free.size()));
  EXPECT_GE(fit.starts_at_best, 2);
  ASSERT_EQ(fit.parameters.size(), options.free.size());
  for (const ParameterReport& parameter : fit.parameters) {
    EXPECT_FALSE(parameter.at_bound || parameter.untouched) << parameter.name;
    EXPECT_LT(parameter.standard_error, kRecovered * std::fabs(parameter.value)) << parameter.name;
  }
}

const std::vector<std::string> kSuspension = test::kSuspension;
const Twin kTwins[] = {
    {"suspension", kSuspension, [](auto&&...) {}},
    {"squared_loss", kSuspension,
     [](M&, M&, PitchForcing&, PitchOptions&, IdentifyPitchOptions& how) { how.loss = Loss::l2; }},
    {"huber_loss", kSuspension,
     [](M&, M&, PitchForcing&, PitchOptions&, IdentifyPitchOptions& how) { how.loss = Loss::huber; }},
    {"short_record", kSuspension,
     [](M&, M&, PitchForcing&, PitchOptions& simulation, IdentifyPitchOptions&) { simulation = test::to(0.3); }},
    {"per_wheel", kSuspension,
     [](M& truth, M& guess, PitchForcing&, PitchOptions&, IdentifyPitchOptions&) {
       truth.per_wheel = guess.per_wheel = true;
     }},
    {"as_printed", kSuspension,
     [](M& truth, M& guess, PitchForcing&, PitchOptions&, IdentifyPitchOptions&) {
       truth.formulation = guess.formulation = PitchFormulation::as_printed;
     }},
    {"nothing_known_of_the_suspension", kSuspension,
     [](M&, M& guess, PitchForcing&, PitchOptions&, IdentifyPitchOptions&) {
       guess.front_stiffness_n_per_m = guess.rear_stiffness_n_per_m = guess.front_damping_ns_per_m = kUnset;
       guess.rear_damping_ns_per_m = 0.0;
     }},
    {"inertia_and_arm_as_well",
     {"front_stiffness", "rear_stiffness", "front_damping", "rear_damping", "pitch_inertia", "force-arm"},
     [](M&, M& guess, PitchForcing&, PitchOptions& simulation, IdentifyPitchOptions& how) {
       simulation = test::to(2.0);
       guess.pitch_inertia_kgm2 = 4000.0;
       guess.force_arm_m = kUnset;
       how.loss = Loss::l2;
     }},
    {"force_height_and_suspension",
     {"force_height_m", "front_stiffness", "rear_stiffness", "front_damping", "rear_damping"},
     [](M&, M& guess, PitchForcing& forcing, PitchOptions&, IdentifyPitchOptions&) {
       forcing = test::both_forces();
       guess.force_height_m = kUnset;
     }},
    {"axles",
     {"front_axle", "rear_axle"},
     [](M& truth, M& guess, PitchForcing&, PitchOptions&, IdentifyPitchOptions&) {
       guess = truth;
       guess.front_axle_m = 2.0;
       guess.rear_axle_m = 2.0;
     }},
    {"moving_at_maximum_crush", kSuspension,
     [](M&, M&, PitchForcing& forcing, PitchOptions& simulation, IdentifyPitchOptions&) {
       forcing.t_m_s = 0.035;
       simulation.start.rule = PitchStart::t_m;
       simulation.heave_m = -0.01;
       simulation.pitch_rad = 0.02;
       simulation.heave_velocity_mps = 0.3;
       simulation.pitch_rate_radps = -0.2;
     }},
    {"residual_energy_at_maximum_crush", kSuspension,
     [](M&, M&, PitchForcing& forcing, PitchOptions& simulation, IdentifyPitchOptions&) {
       forcing.t_m_s = 0.05;
       simulation.start.rule = PitchStart::t_m;
       simulation.residual_energy_j = 400.0;
     }},
    {"error_by_cvode", kSuspension,
     [](M&, M&, PitchForcing&, PitchOptions& simulation, IdentifyPitchOptions&) {
       simulation.integrator = PitchIntegrator::cvode;
     }},
};
INSTANTIATE_TEST_SUITE_P(Cases, PitchTwin, testing::ValuesIn(kTwins),
                         [](const auto& twin) { return std::string(twin.param.name); });

class OneChannel : public testing::TestWithParam<int> {};

TEST_P(OneChannel, OfALongRecordFindsTheSuspension) {
  constexpr TimeSeries PitchTarget::*kChannels[] = {&PitchTarget::heave_m, &PitchTarget::pitch_rad,
                                                    &PitchTarget::heave_velocity_mps, &PitchTarget::pitch_rate_radps};
  constexpr double PitchFitError::*kErrors[] = {&PitchFitError::heave, &PitchFitError::pitch,
                                                &PitchFitError::heave_velocity, &PitchFitError::pitch_rate};
  const auto channel = static_cast<std::size_t>(GetParam());
  const M truth = test::oracle_vehicle();
  const PitchForcing forcing = test::vertical_half_sine();
  const PitchTarget all = test::target_of(simulate_pitch(truth, forcing, test::to(2.0)));
  PitchTarget target;
  target.*kChannels[channel] = all.*kChannels[channel];
  const PitchIdentification fit =
      identify_pitch(test::wrong_suspension(truth), forcing, target, test::to(2.0), four_starts());
  expect_same_numbers(fit.model, truth);
  EXPECT_EQ(fit.error.*kErrors[channel], fit.error.total);
  for (std::size_t other = 0; other < 4; ++other) EXPECT_EQ(std::isnan(fit.error.*kErrors[other]), other != channel);
}

INSTANTIATE_TEST_SUITE_P(Channels, OneChannel, testing::Range(0, 4));

TEST(PitchTwins, ChannelsMayHaveClocksOfTheirOwn) {
  const M truth = test::oracle_vehicle();
  const PitchForcing forcing = test::vertical_half_sine();
  PitchTarget target = test::target_of(simulate_pitch(truth, forcing, test::to(0.6, 1e-3)));
  target.pitch_rad = {};
  target.pitch_rate_radps = test::target_of(simulate_pitch(truth, forcing, test::to(0.55, 7.3e-4))).pitch_rate_radps;
  const PitchIdentification fit =
      identify_pitch(test::wrong_suspension(truth), forcing, target, test::to(0.6), four_starts());
  expect_same_numbers(fit.model, truth);
}

TEST(PitchTwins, OnlySamplesInTheWindowCount) {
  const M truth = test::oracle_vehicle();
  const PitchForcing forcing = test::vertical_half_sine();
  PitchTarget target = test::target_of(simulate_pitch(truth, forcing, test::to(1.0)));
  target.pitch_rad.values[199] = target.pitch_rad.values[801] = 1.0;
  IdentifyPitchOptions options = four_starts();
  options.from_s = 0.2;
  options.to_s = 0.8;
  expect_same_numbers(identify_pitch(test::wrong_suspension(truth), forcing, target, test::to(1.0), options).model,
                      truth);
  options.to_s = kUnset;  // the end of the simulation does the same
  expect_same_numbers(identify_pitch(test::wrong_suspension(truth), forcing, target, test::to(0.8), options).model,
                      truth);
  target.heave_m.values[500] = 1.0;
  EXPECT_GT(identify_pitch(test::wrong_suspension(truth), forcing, target, test::to(0.8), options).error.total,
            kRecovered);
}

void expect_bitwise_same(const PitchIdentification& a, const PitchIdentification& b) {
  ASSERT_EQ(a.parameters.size(), b.parameters.size());
  for (std::size_t i = 0; i < a.parameters.size(); ++i) {
    EXPECT_EQ(a.parameters[i].value, b.parameters[i].value);
    EXPECT_EQ(a.parameters[i].standard_error, b.parameters[i].standard_error);
  }
  ASSERT_EQ(a.starts.size(), b.starts.size());
  for (std::size_t i = 0; i < a.starts.size(); ++i) EXPECT_EQ(a.starts[i].error, b.starts[i].error);
  EXPECT_EQ(a.evaluations, b.evaluations);
  EXPECT_EQ(a.error.total, b.error.total);
  EXPECT_EQ(a.verdict.condition, b.verdict.condition);
}

/// A record that no model of the kind explains.
struct Disturbed {
  M guess = test::wrong_suspension(test::oracle_vehicle());
  PitchForcing forcing = test::vertical_half_sine();
  PitchOptions simulation = test::to(0.5);
  PitchTarget target = test::target_of(simulate_pitch(test::oracle_vehicle(), forcing, simulation));

  Disturbed() {
    for (std::size_t i = 0; i < target.pitch_rad.time_s.size(); ++i) {
      target.pitch_rad.values[i] += 2e-3 * std::sin(90.0 * target.pitch_rad.time_s[i]);
      target.heave_velocity_mps.values[i] += 0.03 * std::sin(130.0 * target.heave_m.time_s[i]);
    }
  }
  [[nodiscard]] PitchIdentification identified(const IdentifyPitchOptions& options,
                                               const Progress& progress = {}) const {
    return identify_pitch(guess, forcing, target, simulation, options, progress);
  }
};

TEST(PitchMultistart, GivesBitwiseTheSameOnAnyNumberOfThreads) {
  const Disturbed record;
  IdentifyPitchOptions options;
  options.starts = 8;
  options.jobs = 1;
  const PitchIdentification alone = record.identified(options);
  EXPECT_GT(alone.error.total, 1e-3);
  EXPECT_EQ(alone.starts_at_best, 8);
  for (const int jobs : {2, 5}) {
    options.jobs = jobs;
    expect_bitwise_same(alone, record.identified(options));
  }
}

TEST(PitchMultistart, AStartDependsOnItsIndexAndTheSeedOnly) {
  const Disturbed record;
  IdentifyPitchOptions options;
  options.starts = 4;
  const PitchIdentification four = record.identified(options);
  options.starts = 6;
  const PitchIdentification six = record.identified(options);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(four.starts[i].error, six.starts[i].error);
  options.seed = 2;
  const PitchIdentification other = record.identified(options);
  EXPECT_EQ(other.starts[0].error, six.starts[0].error);
  EXPECT_NE(other.starts[1].error, six.starts[1].error);
  EXPECT_EQ(other.seed, 2U);
}

TEST(PitchMultistart, KeepsWhatWasFinishedWhenStopped) {
  const Disturbed record;
  IdentifyPitchOptions options;
  options.starts = 100'000;
  options.jobs = 1;
  const PitchIdentification fit = record.identified(options, [](int done, int) { return done < 2; });
  EXPECT_EQ(fit.outcome, IdentifyOutcome::interrupted);
  EXPECT_FALSE(fit.usable());
  EXPECT_THAT(fit.brief_report(), testing::StartsWith("interrupted: stopped after "));
  EXPECT_GE(fit.starts.size(), 2U);
  EXPECT_EQ(fit.parameters.size(), 4U);
}

TEST(PitchIdentification, ReportsNothingUntilRun) {
  const PitchIdentification fit;
  EXPECT_EQ(fit.brief_report(), "not run");
  EXPECT_TRUE(std::isnan(fit.error.total));
}

}  // namespace
}  // namespace crashsim
