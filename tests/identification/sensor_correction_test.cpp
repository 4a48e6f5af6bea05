/// Corrections of accelerometers: known faults found again, standard errors that hold, and what the data do not tell.

#include <crashsim/sensor_correction.hpp>

#include <cmath>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "support/sensor_cases.hpp"

namespace crashsim {
namespace {

using test::kSensorRebound_mps;
using test::normal_number;
using test::sensor_traces;
using test::sensor_velocity;
using test::SensorFault;
using test::untouched;
using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsNan;
using testing::Not;
using testing::SizeIs;
using testing::ThrowsMessage;

const std::vector<SensorFault> kFaults = {{1.5, 1.02, 2e-4}, {-2.0, 0.99, 1e-4}, {0.7, 1.01, -1e-4}};

/// Velocities known at three times: enough for what the channels have in common.
SensorCorrectionOptions with_velocities(double velocity_sd_mps) {
  SensorCorrectionOptions options;
  options.velocity_times_s = {0.035, 0.08, 0.15};
  for (const double t : options.velocity_times_s) options.velocities_mps.push_back(sensor_velocity(t));
  options.velocity_sd_mps = velocity_sd_mps;
  return options;
}

TEST(SensorCorrection, FindsFaultsWithoutNoise) {
  // regression: cubic between samples 0.5 ms apart, and the priors' pull against the least noise
  constexpr double kExact_mps = 1e-6, kBias_mps2 = 2e-2, kGain = 2e-4, kShift_s = 1e-6, kAccel_mps2 = 3e-2;
  const SensorCorrection found = correct_sensors(sensor_traces(kFaults), untouched(), with_velocities(kExact_mps));
  ASSERT_TRUE(found.usable()) << found.message;
  for (std::size_t c = 0; c < kFaults.size(); ++c) {
    EXPECT_NEAR(found.channels[c].bias_mps2, kFaults[c].bias_mps2, kBias_mps2);
    EXPECT_NEAR(found.channels[c].gain, kFaults[c].gain, kGain);
    EXPECT_NEAR(found.channels[c].time_shift_s, kFaults[c].time_shift_s, kShift_s);
  }
  const Trace& mean = found.corrected.traces.front();
  for (std::size_t i = 0; i < mean.values.size(); ++i)
    ASSERT_NEAR(mean.values[i], test::sensor_accel(mean.times()[i]), kAccel_mps2) << mean.times()[i];
  EXPECT_THAT(found.by_prior, IsEmpty());
  EXPECT_THAT(found.warnings, IsEmpty());
}

/// How many of the errors lie within their 95 % interval, over repetitions with faults drawn from the priors.
struct Coverage {
  int inside = 0, all = 0;

  void count(double found, double truth, double standard_error) {
    constexpr double k95 = 1.959964;
    inside += std::abs(found - truth) <= k95 * standard_error ? 1 : 0;
    ++all;
  }
  [[nodiscard]] double share() const { return static_cast<double>(inside) / all; }
};

TEST(SensorCorrection, StandardErrorsCoverTheTruth) {
  constexpr int kRepetitions = 100;
  constexpr double kNoise_mps2 = 8.0, kLeast = 0.90, kMost = 0.985;
  SensorCorrectionOptions options = with_velocities(0.1);
  const std::vector<double> exact = options.velocities_mps;
  Coverage bias, gain, shift;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    test::Random random(static_cast<std::uint64_t>(1000 + repetition));
    std::vector<SensorFault> faults(3);
    for (SensorFault& fault : faults)
      fault = {options.bias_sd_mps2 * normal_number(random), 1.0 + options.gain_sd * normal_number(random),
               options.time_shift_sd_s * normal_number(random)};
    for (std::size_t i = 0; i < exact.size(); ++i)
      options.velocities_mps[i] = exact[i] + options.velocity_sd_mps * normal_number(random);
    PulseOptions pulse = untouched();
    pulse.cfc = 60.0;
    const SensorCorrection found =
        correct_sensors(sensor_traces(faults, kNoise_mps2, static_cast<std::uint64_t>(repetition)), pulse, options);
    ASSERT_TRUE(found.usable()) << found.message;
    for (std::size_t c = 0; c < faults.size(); ++c) {
      const ChannelCorrection& channel = found.channels[c];
      bias.count(channel.bias_mps2, faults[c].bias_mps2, channel.bias_error_mps2);
      gain.count(channel.gain, faults[c].gain, channel.gain_error);
      shift.count(channel.time_shift_s, faults[c].time_shift_s, channel.time_shift_error_s);
    }
  }
  for (const Coverage& coverage : {bias, gain, shift}) {
    EXPECT_GE(coverage.share(), kLeast);
    EXPECT_LE(coverage.share(), kMost);
  }
}

TEST(SensorCorrection, AgreementAloneTellsWhatIsBetweenChannels) {
  constexpr double kGain = 2e-4, kShift_s = 2e-6;  // regression, as above
  const SensorCorrection found = correct_sensors(sensor_traces({{0.0, 1.02, 1e-4}, {0.0, 0.99, -1e-4}}), untouched());
  ASSERT_TRUE(found.usable());
  EXPECT_NEAR(found.channels[0].gain / found.channels[1].gain, 1.02 / 0.99, kGain);
  EXPECT_NEAR(found.channels[0].time_shift_s - found.channels[1].time_shift_s, 2e-4, kShift_s);
  EXPECT_LT(found.channels[0].rms_after_mps2, 0.01 * found.channels[0].rms_before_mps2);
  EXPECT_THAT(found.by_prior, Contains(HasSubstr("gain common to all channels: 100 % of its prior")));
  EXPECT_THAT(found.by_prior, Contains(HasSubstr("bias common to all channels")));
  EXPECT_THAT(found.by_prior, Each(Not(HasSubstr("against the others"))));
  EXPECT_THAT(found.warnings, Contains(HasSubstr("compared with each other only")));
}

TEST(SensorCorrection, OneChannelAndOneVelocityDetermineNothingByThemselves) {
  SensorCorrectionOptions options;
  options.velocity_times_s = {0.15};
  options.velocities_mps = {kSensorRebound_mps};
  const SensorCorrection found = correct_sensors(sensor_traces({{0.0, 1.03, 0.0}}), untouched(), options);
  ASSERT_TRUE(found.usable());
  ASSERT_THAT(found.by_prior, SizeIs(3));
  EXPECT_THAT(found.by_prior[0], HasSubstr("bias of the channel: "));
  EXPECT_THAT(found.by_prior[1], HasSubstr("gain of the channel: "));
  EXPECT_THAT(found.by_prior[2], HasSubstr("time shift of the channel: "));
  EXPECT_THAT(found.noise_mps2, IsNan());
  ASSERT_THAT(found.conditions, SizeIs(1));
  const CorrectionCondition& condition = found.conditions[0];
  EXPECT_EQ(condition.name, "velocity at 0.15 s");
  EXPECT_LT(std::abs(condition.after_mps - condition.known_mps), condition.standard_deviation_mps);
  EXPECT_GT(std::abs(condition.before_mps - condition.known_mps), 2.0 * condition.standard_deviation_mps);
}

/// One channel whose bias alone is sought, by one velocity: the scalar Bayesian estimate, in closed form.
TEST(SensorCorrection, OfOneBiasIsTheClosedForm) {
  constexpr double kRounding = 1e-6;  // solver: where Gauss and Newton's steps end
  constexpr double kTime_s = 0.15, kBias_mps2 = 3.0;
  SensorCorrectionOptions options;
  options.gain_sd = options.time_shift_sd_s = 0.0;
  options.velocity_times_s = {kTime_s};
  options.velocities_mps = {sensor_velocity(kTime_s)};
  const SensorCorrection found = correct_sensors(sensor_traces({{kBias_mps2, 1.0, 0.0}}), untouched(), options);
  const double prior = std::pow(options.bias_sd_mps2, -2), data = std::pow(kTime_s / options.velocity_sd_mps, 2);
  EXPECT_NEAR(found.channels[0].bias_mps2, kBias_mps2 * data / (data + prior), kRounding);
  EXPECT_NEAR(found.channels[0].bias_error_mps2, 1.0 / std::sqrt(data + prior), kRounding);
  EXPECT_THAT(found.channels[0].gain, IsNan());
  EXPECT_THAT(found.channels[0].time_shift_error_s, IsNan());
}

TEST(SensorCorrection, PriorsHoldWhatTheyAreSureOf) {
  constexpr double kSure_mps2 = 1e-4;
  SensorCorrectionOptions options = with_velocities(0.1);
  options.bias_sd_mps2 = kSure_mps2;
  options.gain_sd = 0.0;
  const SensorCorrection found = correct_sensors(sensor_traces(kFaults), untouched(), options);
  ASSERT_TRUE(found.usable());
  for (const ChannelCorrection& channel : found.channels) {
    EXPECT_LT(std::abs(channel.bias_mps2), 10.0 * kSure_mps2);
    EXPECT_THAT(channel.gain, IsNan());
    EXPECT_FALSE(std::isnan(channel.time_shift_s));
  }
}

TEST(SensorCorrection, ReboundIsTheSmallestVelocityWhereverItIs) {
  constexpr double kNear_mps = 1e-3;
  SensorCorrectionOptions options;
  options.rebound_velocity_mps = kSensorRebound_mps;
  options.velocity_sd_mps = 1e-4;
  options.bias_sd_mps2 = 0.0;
  const SensorCorrection found =
      correct_sensors(sensor_traces({{0.0, 1.03, 0.0}, {0.0, 1.01, 0.0}}), untouched(), options);
  ASSERT_THAT(found.conditions, SizeIs(1));
  EXPECT_EQ(found.conditions[0].name, "rebound velocity");
  EXPECT_NEAR(found.conditions[0].after_mps, kSensorRebound_mps, kNear_mps);
  EXPECT_NEAR(found.channels[0].gain, 1.03, kNear_mps);
  EXPECT_NEAR(found.channels[1].gain, 1.01, kNear_mps);
}

/// A wall that shows `gain` times the force on 1500 kg.
LoadCellWall wall_of(double gain) {
  LoadCellWall wall;
  for (int i = -100; i <= 400; ++i) {
    wall.time_s.push_back(i * 5e-4);
    wall.total_force_n.push_back(-gain * 1500.0 * test::sensor_accel(wall.time_s.back()));
  }
  return wall;
}

class SensorWall : public testing::TestWithParam<WallUse> {};

TEST_P(SensorWall, ThatIsExactTellsTheGainOfTheChannels) {
  constexpr double kNear = 1e-3;
  const LoadCellWall wall = wall_of(1.0);
  SensorCorrectionOptions options;
  options.wall_use = GetParam();
  options.wall_gain_sd = options.bias_sd_mps2 = 0.0;
  options.velocity_sd_mps = 1e-3;
  const SensorCorrection found =
      correct_sensors(sensor_traces({{0.0, 1.03, 0.0}, {0.0, 0.98, 0.0}}), untouched(), options, &wall);
  EXPECT_NEAR(found.channels[0].gain, 1.03, kNear);
  EXPECT_NEAR(found.channels[1].gain, 0.98, kNear);
  EXPECT_THAT(found.wall_gain, IsNan());
}

TEST_P(SensorWall, IsCorrectedWhereTheChannelsAreSure) {
  constexpr double kNear = 1e-3;
  const LoadCellWall wall = wall_of(1.05);
  SensorCorrectionOptions options;
  options.wall_use = GetParam();
  options.wall_gain_sd = 0.05;
  options.gain_sd = 1e-4;
  options.bias_sd_mps2 = 1e-3;
  options.velocity_sd_mps = 1e-3;
  const SensorCorrection found = correct_sensors(sensor_traces({{}, {}}), untouched(), options, &wall);
  EXPECT_NEAR(found.wall_gain, 1.05, kNear);
  EXPECT_LT(found.wall_gain_error, kNear);
}

INSTANTIATE_TEST_SUITE_P(Uses, SensorWall, testing::Values(WallUse::impulse, WallUse::force),
                         [](const auto& use) { return std::string(name_of(use.param)); });

TEST(SensorCorrection, WarnsOfImplausibleCorrectionsAndOfWhatIsMissed) {
  SensorCorrectionOptions options = with_velocities(0.01);
  options.bias_sd_mps2 = 0.0;
  EXPECT_THAT(correct_sensors(sensor_traces({{0.0, 1.10, 0.0}, {0.0, 1.10, 0.0}}), untouched(), options).warnings,
              Contains(AllOf(HasSubstr("channel 1 SENSOR 1: gain 1.1 is 5.0 of its prior standard deviations"),
                             HasSubstr("look at the channel"))));
  options.gain_sd = 1e-3;
  EXPECT_THAT(correct_sensors(sensor_traces({{0.0, 1.10, 0.0}, {0.0, 1.10, 0.0}}), untouched(), options).warnings,
              Contains(AllOf(HasSubstr("velocity at 0.15 s: known as -1.4 m/s, but the corrected channels say"),
                             HasSubstr("of its standard deviations away"))));
}

TEST(SensorCorrection, MakesAPulseThatKeepsWhatWasCorrected) {
  constexpr double kSame_m = 2e-4, kSame_mps = 2e-3;  // regression: of 0.7 m, 15 m/s; the filter starts at impact
  SensorCorrectionOptions options = with_velocities(1e-3);
  const SensorCorrection found = correct_sensors(sensor_traces(kFaults), {}, options);
  ASSERT_TRUE(found.usable());
  const Pulse corrected = make_pulse(found.corrected), truth = make_pulse(sensor_traces({{}}));
  EXPECT_EQ(corrected.channels, std::vector<std::string>{"mean accel_mps2"});
  EXPECT_EQ(corrected.impact_speed_mps, truth.impact_speed_mps);
  EXPECT_EQ(corrected.mass_kg, truth.mass_kg);
  EXPECT_NEAR(corrected.max_crush_m, truth.max_crush_m, kSame_m);
  EXPECT_NEAR(corrected.velocity_mps.back(), truth.velocity_mps.back(), kSame_mps);
}

TEST(SensorCorrection, TurnsChannelsThatPointBackward) {
  TraceSet set = sensor_traces({{0.0, 1.02, 0.0}, {0.0, 0.98, 0.0}});
  for (double& value : set.traces[1].values) value = -value;
  const SensorCorrection found = correct_sensors(set, untouched(), with_velocities(1e-3));
  EXPECT_NEAR(found.channels[1].gain, 0.98, 2e-3);
  EXPECT_THAT(found.warnings, Contains(HasSubstr("channel 2 SENSOR 2: sign turned")));
}

TEST(SensorCorrection, WeighsChannelsAsTold) {
  SensorCorrectionOptions options = with_velocities(0.1);
  options.channel_weights = {1.0, 1e6};
  const SensorCorrection found = correct_sensors(sensor_traces({{2.0, 1.0, 0.0}, {}}), untouched(), options);
  EXPECT_LT(found.channels[1].rms_before_mps2, 1e-3);
  EXPECT_GT(found.channels[0].rms_before_mps2, 1.0);
}

TEST(SensorCorrection, CountsFromATimeZeroBetweenSamples) {
  constexpr double kLate_s = 1.2e-4;
  TraceSet set = sensor_traces(kFaults);
  auto late = std::make_shared<std::vector<double>>(*set.traces[0].time_s);
  for (double& t : *late) t += kLate_s;
  for (Trace& trace : set.traces) trace.time_s = late;
  PulseOptions pulse = untouched();
  pulse.t0 = {TimeZero::given, {kLate_s}};
  const SensorCorrection found = correct_sensors(set, pulse, with_velocities(1e-3));
  const SensorCorrection expected = correct_sensors(sensor_traces(kFaults), untouched(), with_velocities(1e-3));
  EXPECT_NEAR(found.time_zero_s, kLate_s, 1e-12);
  for (std::size_t c = 0; c < kFaults.size(); ++c) EXPECT_NEAR(found.channels[c].gain, expected.channels[c].gain, 1e-6);
  EXPECT_EQ(found.corrected.traces[0].times().front(), 0.0);
}

TEST(SensorCorrection, GivesTheSameBitsAgain) {
  const TraceSet set = sensor_traces(kFaults, 5.0);
  const SensorCorrection a = correct_sensors(set, {}, with_velocities(0.1));
  const SensorCorrection b = correct_sensors(set, {}, with_velocities(0.1));
  EXPECT_EQ(a.corrected.traces[0].values, b.corrected.traces[0].values);
  EXPECT_THAT(a.brief_report(), HasSubstr("3 channels corrected: largest difference to their mean"));
  EXPECT_EQ(SensorCorrection().brief_report(), "not run");
  EXPECT_FALSE(SensorCorrection().usable());
}

struct Refused {
  const char* what;
  std::function<void(TraceSet&, PulseOptions&, SensorCorrectionOptions&)> spoil;
  const char* message;
};
void PrintTo(const Refused& r, std::ostream* out) { *out << r.what; }

class RefusedCorrection : public testing::TestWithParam<Refused> {};

TEST_P(RefusedCorrection, SaysWhatToDo) {
  TraceSet set = sensor_traces(kFaults);
  PulseOptions pulse = untouched();
  SensorCorrectionOptions options = with_velocities(0.1);
  GetParam().spoil(set, pulse, options);
  EXPECT_THAT([&] { static_cast<void>(correct_sensors(set, pulse, options)); },
              ThrowsMessage<InvalidInput>(HasSubstr(GetParam().message)));
}

using Set = TraceSet&;
using Read = PulseOptions&;
using How = SensorCorrectionOptions&;
INSTANTIATE_TEST_SUITE_P(
    Inputs, RefusedCorrection,
    testing::Values(Refused{"velocities_differ", [](Set, Read, How how) { how.velocities_mps.pop_back(); },
                            "velocity_times_s has 3 numbers but velocities_mps 2: give a velocity for each"},
                    Refused{"velocity_after_the_record", [](Set, Read, How how) { how.velocity_times_s[1] = 0.3; },
                            "velocity_times_s: 0.3 s: must be after impact and in the record, to 0.2 s"},
                    Refused{"velocity_unset", [](Set, Read, How how) { how.velocities_mps[0] = kUnset; },
                            "velocities_mps: nan: must be finite"},
                    Refused{"nothing_to_correct",
                            [](Set, Read, How how) { how.bias_sd_mps2 = how.gain_sd = how.time_shift_sd_s = 0.0; },
                            "bias_sd_mps2, gain_sd and time_shift_sd_s are all 0: nothing is to be corrected"},
                    Refused{"one_channel_alone",
                            [](Set set, Read, How how) {
                              set = sensor_traces({{}});
                              how = {};
                            },
                            "one channel and nothing it could be compared with"},
                    Refused{"speed_unknown", [](Set set, Read, How) { set.impact_speed_mps = kUnset; },
                            "what is known of velocity needs the impact speed: give impact_speed_mps (--speed)"},
                    Refused{"weights_differ", [](Set, Read, How how) { how.channel_weights = {1.0}; },
                            "channel_weights: 1 numbers for 3 channels"},
                    Refused{"weight_of_zero",
                            [](Set, Read, How how) {
                              how.channel_weights = {1.0, 0.0, 1.0};
                            },
                            "channel_weights: 0: must be > 0"},
                    Refused{"window_empty", [](Set, Read, How how) { how.start_s = 0.149; },
                            "fewer than 20 samples between 0.149 and 0.15 s after impact"},
                    Refused{"gain_too_wide", [](Set, Read, How how) { how.gain_sd = 0.5; },
                            "SensorCorrectionOptions.gain_sd = 0.5: must be >= 0 and <= 0.09"},
                    Refused{"zero_channel", [](Set set, Read, How) { set.traces[1].values.assign(501, 0.0); },
                            "made-up: channel 2 SENSOR 2 is zero throughout: leave it out"},
                    Refused{"no_accelerometer",
                            [](Set set, Read, How) {
                              for (Trace& trace : set.traces) trace.dimension = Dimension::speed;
                            },
                            "measures speed: corrections are for accelerometers"}));

TEST(RefusedCorrection, WallNeedsMassAndRecord) {
  TraceSet set = sensor_traces(kFaults);
  LoadCellWall wall = wall_of(1.0);
  const auto correct = [&] { static_cast<void>(correct_sensors(set, untouched(), {}, &wall)); };
  set.mass_kg = kUnset;
  EXPECT_THAT(correct, ThrowsMessage<InvalidInput>(HasSubstr("the wall's force needs the test mass: give mass_kg")));
  set.mass_kg = 1500.0;
  wall.time_s.resize(250);
  wall.total_force_n.resize(250);
  EXPECT_THAT(correct, ThrowsMessage<InvalidInput>(HasSubstr("does not cover the time from impact to 0.15 s")));
}

}  // namespace
}  // namespace crashsim
