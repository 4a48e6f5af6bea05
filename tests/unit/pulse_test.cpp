#include <crashsim/pulse.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <crashsim/table_io.hpp>
#include <crashsim/trace_io.hpp>
#include <crashsim/units.hpp>

#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsNan;
using testing::Not;
using testing::ThrowsMessage;

constexpr double kRounding = 1e-12;         // rounding: sums of a thousand terms of order 1..100
constexpr double kTrapezoid = 8.3e-5;       // discretisation: pi^2 h^2 / 12 T^2 of the impact speed at 100 steps
constexpr double kFilterStart = 1e-4;       // discretisation: what the padding leaves of a start-up, relative
constexpr double kFilterAndBetween = 5e-3;  // discretisation: CFC60 on a 100 ms half-sine, relative
constexpr double kSpeed_mps = 15.0;

/// Deceleration of a half-sine that stops kSpeed_mps in 100 ms, on the trace's clock.
double half_sine(double t_s) {
  constexpr double kDuration_s = 0.1;
  if (t_s <= 0.0 || t_s >= kDuration_s) return 0.0;
  return -kSpeed_mps * std::numbers::pi / (2.0 * kDuration_s) * std::sin(std::numbers::pi * t_s / kDuration_s);
}

std::vector<double> times(double from_s, double to_s, double dt_s) {
  return uniform_times(from_s, dt_s, static_cast<std::size_t>(std::lround((to_s - from_s) / dt_s)) + 1);
}

Trace trace_of(const std::string& id, const std::vector<double>& time_s, const std::vector<double>& values,
               Dimension dimension = Dimension::acceleration) {
  Trace trace;
  trace.id = id;
  trace.name = "ch" + id;
  trace.dimension = dimension;
  trace.time_s = std::make_shared<const std::vector<double>>(time_s);
  trace.values = values;
  return trace;
}

/// A trace of the half-sine with its impact at `t0_s`, scaled and shifted.
Trace crash(const std::string& id, const std::vector<double>& time_s, double scale = 1.0, double offset = 0.0,
            double t0_s = 0.0) {
  std::vector<double> values;
  for (const double t : time_s) values.push_back(scale * half_sine(t - t0_s) + offset);
  return trace_of(id, time_s, values);
}

TraceSet set_of(std::vector<Trace> traces) {
  TraceSet set;
  set.path = "run";
  set.impact_speed_mps = kSpeed_mps;
  set.traces = std::move(traces);
  return set;
}

PulseOptions unfiltered() {
  PulseOptions options;
  options.cfc = 0.0;
  return options;
}

TEST(MakePulse, IntegratesByTrapezoidsFromTheImpactSpeed) {
  const std::vector<double> t = {0.0, 0.01, 0.02, 0.03}, a = {-100, -300, -300, -100};
  const Pulse pulse = make_pulse(t, a, 4.0, 1000.0);
  EXPECT_THAT(pulse.velocity_mps,
              testing::Pointwise(testing::DoubleNear(kRounding), std::vector{4.0, 2.0, -1.0, -3.0}));
  EXPECT_THAT(pulse.displacement_m,
              testing::Pointwise(testing::DoubleNear(kRounding), std::vector{0.0, 0.03, 0.035, 0.015}));
  EXPECT_EQ(pulse.mass_kg, 1000.0);
  EXPECT_NEAR(pulse.t_m_s, 0.01 + 2.0 / 300.0, kRounding);
  EXPECT_NEAR(pulse.max_crush_m, 0.03 + 0.5 * 2.0 * 2.0 / 300.0, kRounding);
}

TEST(MakePulse, RefusesBadSeriesSpeedAndMass) {
  const std::vector<double> t = {0.0, 0.1, 0.2}, a = {-1, -1, -1};
  EXPECT_THAT([&] { make_pulse(t, a, -3.0); },
              ThrowsMessage<InvalidInput>(HasSubstr("impact_speed_mps = -3 m/s: must be > 0")));
  EXPECT_THAT([&] { make_pulse(t, a, 3.0, 0.0); },
              ThrowsMessage<InvalidInput>(HasSubstr("mass_kg = 0 kg: must be > 0")));
  EXPECT_THAT([&] { make_pulse(t, a, 3.0, kUnset, -1.0); }, ThrowsMessage<InvalidInput>(HasSubstr("cfc = -1 Hz")));
  EXPECT_THAT([&] { make_pulse(t, {{-1, -1}}, 3.0); }, ThrowsMessage<InvalidInput>(HasSubstr("3 times but 2 values")));
  EXPECT_THAT(
      [&] {
        make_pulse(std::vector{0.1, 0.2, 0.3}, a, 3.0);
      },
      ThrowsMessage<InvalidInput>(HasSubstr("time_s[0] = 0.1 s: a pulse starts at time zero")));
  EXPECT_THAT(
      [&] {
        make_pulse(std::vector{0.0, 0.001, 0.003}, a, 3.0, kUnset, 60.0);
      },
      ThrowsMessage<InvalidInput>(HasSubstr("a filter needs uniform steps")));
}

TEST(FindMaxCrush, FindsTheRootOfTheParabolaBetweenSamples) {
  // a = -6 t: v = 3 - 3 t^2, x = 3 t - t^3, zero at t = 1, sampled at 0, 0.8, 1.6
  const std::vector<double> t = {0.0, 0.8, 1.6}, a = {0.0, -4.8, -9.6}, v = {3.0, 1.08, -4.68}, x = {0.0, 1.888, 0.704};
  const MaxCrush end = find_max_crush(t, a, v, x);
  EXPECT_NEAR(end.t_m_s, 1.0, kRounding);
  EXPECT_NEAR(end.max_crush_m, 2.0, kRounding);
}

TEST(FindMaxCrush, FindsAStopThatNoSampleShows) {
  // v = 1 - 6 s + 6 s^2 between samples at which v is 1: first zero at (3 - sqrt 3) / 6
  const std::vector<double> t = {0.0, 1.0}, a = {-6.0, 6.0}, v = {1.0, 1.0}, x = {0.0, 0.0};
  EXPECT_NEAR(find_max_crush(t, a, v, x).t_m_s, (3.0 - std::sqrt(3.0)) / 6.0, kRounding);
}

TEST(FindMaxCrush, IsUnsetWhenTheVehicleNeverStopsOrNeverMoved) {
  const std::vector<double> t = {0.0, 1.0}, a = {-1.0, -1.0}, x = {0.0, 1.0};
  EXPECT_THAT(find_max_crush(t, a, std::vector{2.0, 1.0}, x).t_m_s, IsNan());
  EXPECT_THAT(find_max_crush(t, a, std::vector{0.0, -1.0}, x).t_m_s, IsNan());
  EXPECT_THAT(find_max_crush({}, {}, {}, {}).max_crush_m, IsNan());
  EXPECT_EQ(find_max_crush(t, a, std::vector{1.0, 0.0}, x).t_m_s, 1.0) << "a stop on a sample";
}

TEST(MakePulse, TakesOffTheOffsetCutsAtTimeZeroAndStopsTheHalfSine) {
  const TraceSet set = set_of({crash("1", times(-0.05, 0.15, 1e-3), 1.0, 7.0)});
  const Pulse pulse = make_pulse(set, unfiltered());
  EXPECT_EQ(pulse.time_s.front(), 0.0);
  EXPECT_EQ(pulse.time_s.size(), 151u);
  EXPECT_EQ(pulse.velocity_mps.front(), kSpeed_mps);
  EXPECT_EQ(pulse.displacement_m.front(), 0.0);
  EXPECT_NEAR(pulse.velocity_mps.back(), 0.0, kTrapezoid * kSpeed_mps);
  EXPECT_THAT(pulse.steps,
              Contains(HasSubstr("offset: 7 m/s^2 taken off channel 1 ch1, its mean of 50 samples before")));
  EXPECT_THAT(pulse.steps, Contains(HasSubstr("time zero: 0 s, the trace's own")));
  EXPECT_THAT(pulse.channels, ElementsAre("1 ch1"));
}

TEST(MakePulse, OffsetIsNotGuessedFromTooFewSamplesAndCanBeGivenOrLeft) {
  PulseOptions options = unfiltered();
  const auto offset_step = [&](double from_s) {
    return make_pulse(set_of({crash("1", times(from_s, 0.15, 1e-3), 1.0, 7.0)}), options).steps;
  };
  EXPECT_THAT(offset_step(-0.005), Contains(HasSubstr("none taken off, 5 samples before impact are too few to tell")));
  options.bias.rule = Bias::none;
  EXPECT_THAT(offset_step(-0.05), Contains(HasSubstr("offset: none taken off, as asked")));
  options.bias = {Bias::given, {-0.03, -0.01}};
  EXPECT_THAT(offset_step(-0.05),
              Contains(HasSubstr("offset: 7 m/s^2 taken off channel 1 ch1, its mean from -0.03 to")));
  options.bias.numbers = {1.0, 2.0};
  EXPECT_THAT([&] { offset_step(-0.05); },
              ThrowsMessage<InvalidInput>(HasSubstr("run: channel 1 ch1: no samples with 1 s <= time < 2 s")));
  options.bias.numbers = {1.0};
  EXPECT_THAT([&] { offset_step(-0.05); }, ThrowsMessage<InvalidInput>(HasSubstr("a window needs two times")));
}

TEST(MakePulse, FindsTimeZeroAboveAnOffset) {
  PulseOptions options = unfiltered();
  options.t0.rule = TimeZero::automatic;
  const TraceSet set = set_of({crash("1", times(0.0, 0.25, 1e-4), 1.0, 6.0, 0.08)});
  const Pulse pulse = make_pulse(set, options);
  // the last sample below 0.5 g of a half-sine that starts at 80 ms
  const double quiet_s = std::asin(0.5 * kStandardGravity / half_sine(0.05)) * 0.1 / std::numbers::pi;
  EXPECT_THAT(pulse.steps,
              Contains(HasSubstr(fmt::format("time zero: {:.4f} s, found", 0.08 + std::floor(-quiet_s * 1e4) / 1e4))));
  EXPECT_EQ(pulse.time_s.front(), 0.0);
}

TEST(MakePulse, AGivenTimeZeroBetweenSamplesIsInterpolated) {
  PulseOptions options = unfiltered();
  options.t0 = {TimeZero::given, {0.0125}};
  options.bias.rule = Bias::none;
  const Pulse pulse = make_pulse(set_of({crash("1", times(-0.05, 0.15, 1e-3))}), options);
  EXPECT_NEAR(pulse.accel_mps2.front(), 0.5 * (half_sine(0.012) + half_sine(0.013)), kRounding);
  EXPECT_THAT(pulse.time_s, testing::SizeIs(138));
  EXPECT_NEAR(pulse.time_s[1], 1e-3, kRounding);
  EXPECT_THAT(pulse.steps, Contains(HasSubstr("time zero 0.0125 s lies between samples")));
  options.t0.numbers = {0.3};
  EXPECT_THAT([&] { make_pulse(set_of({crash("1", times(-0.05, 0.15, 1e-3))}), options); },
              ThrowsMessage<InvalidInput>(HasSubstr("run: time zero 0.3 s is outside the trace, -0.05 to 0.15 s")));
}

TEST(MakePulse, AveragesChannelsAndTurnsThoseMountedBackward) {
  const auto t = times(-0.05, 0.15, 1e-3);
  PulseOptions options = unfiltered();
  options.channels = {"1", "ch2"};
  const TraceSet set = set_of({crash("1", t, 0.9), crash("2", t, -1.1), crash("3", t, 5.0)});
  const Pulse pulse = make_pulse(set, options);
  for (std::size_t i = 0; i < pulse.time_s.size(); ++i)
    EXPECT_NEAR(pulse.accel_mps2[i], half_sine(pulse.time_s[i]), kRounding);
  EXPECT_THAT(pulse.channels, ElementsAre("1 ch1", "2 ch2"));
  EXPECT_THAT(pulse.steps, Contains("average of 2 channels"));
  EXPECT_THAT(pulse.warnings, Contains("channel 2 ch2: sign turned, because its axis points opposite to the travel"));
  EXPECT_THAT(pulse.warnings, Not(Contains(HasSubstr("channel 1 ch1: sign turned"))));
}

TEST(MakePulse, VelocityChannelsAreDifferentiatedSoThatTheMotionAgrees) {
  const auto t = times(0.0, 0.15, 1e-4);
  std::vector<double> v, backward;
  for (const double x : integrate(t, crash("1", t).values, kSpeed_mps)) v.push_back(x), backward.push_back(-x);
  TraceSet set = set_of({trace_of("1", t, backward, Dimension::speed)});
  set.impact_speed_mps = kUnset;
  const Pulse pulse = make_pulse(set);
  EXPECT_NEAR(pulse.impact_speed_mps, kSpeed_mps, kFilterStart * kSpeed_mps);
  EXPECT_THAT(pulse.steps, Contains(HasSubstr("acceleration: central differences of the filtered velocity")));
  EXPECT_THAT(pulse.warnings, Contains(HasSubstr("sign turned")));
  const auto again = integrate(pulse.time_s, pulse.accel_mps2, pulse.impact_speed_mps);
  EXPECT_EQ(pulse.velocity_mps, again);
  for (std::size_t i = 0; i < v.size(); ++i) EXPECT_NEAR(pulse.velocity_mps[i], v[i], kFilterAndBetween * kSpeed_mps);
  set.impact_speed_mps = 14.0;
  EXPECT_THAT(make_pulse(set).warnings,
              Contains(HasSubstr("velocity channels start at 15 m/s, the impact speed is 14 m/s")));
}

TEST(MakePulse, AnUnevenClockIsResampledAndTold) {
  std::vector<double> uneven;
  for (int i = 0; i <= 1500; ++i) uneven.push_back(1e-4 * (i + 0.3 * std::sin(i)));
  const Pulse pulse = make_pulse(set_of({crash("1", uneven)}));
  EXPECT_THAT(pulse.steps, Contains(HasSubstr("steps of the trace are not uniform; linear onto a uniform step of")));
  EXPECT_FALSE(std::isnan(uniform_step(pulse.time_s)));
  EXPECT_NEAR(pulse.accel_mps2[500], half_sine(pulse.time_s[500]), kFilterAndBetween * -half_sine(0.05));
}

TEST(MakePulse, ChannelsOnDifferentClocksMeetOnTheFirstOnes) {
  PulseOptions options = unfiltered();
  options.channels = {"*"};
  const Pulse pulse =
      make_pulse(set_of({crash("1", times(-0.05, 0.15, 1e-3)), crash("2", times(-0.02, 0.2, 4e-4))}), options);
  EXPECT_THAT(pulse.steps, Contains("channel 2 ch2: resampled onto the clock of channel 1 ch1"));
  EXPECT_THAT(pulse.steps, Contains(HasSubstr("its mean of 20 samples before impact")));
  EXPECT_NEAR(pulse.accel_mps2[50], half_sine(0.05), kFilterAndBetween * -half_sine(0.05));
}

TEST(MakePulse, WarnsWhenThePulseIsUnlikeAnyVehiclesOrNeverEnds) {
  EXPECT_THAT(
      make_pulse(set_of({crash("1", times(0.0, 0.15, 1e-4), 1.05)}), unfiltered()).warnings,
      ElementsAre(AllOf(HasSubstr("peak deceleration 25.2 g is outside 25.5 to 56.3 g"), HasSubstr("check channel"))));
  EXPECT_THAT(
      make_pulse(set_of({crash("1", times(0.0, 0.05, 1e-4))}), unfiltered()).warnings,
      ElementsAre(HasSubstr("velocity does not reach zero within 0.05 s, so there is no time of maximum crush")));
  EXPECT_THAT(make_pulse(set_of({crash("1", times(0.0, 0.15, 1e-4), 9.0)}), unfiltered()).warnings,
              Contains(HasSubstr("maximum crush 0.")));
}

struct BadSet {
  const char* what;
  void (*spoil)(TraceSet& set, PulseOptions& options);
  const char* message;
};
void PrintTo(const BadSet& b, std::ostream* out) { *out << b.what; }

class BadPulse : public testing::TestWithParam<BadSet> {};

TEST_P(BadPulse, IsRefusedWithTheChannelAndTheRule) {
  const auto t = times(-0.05, 0.15, 1e-3);
  TraceSet set = set_of({crash("1", t), crash("2", t)});
  PulseOptions options = unfiltered();
  options.channels = {"1", "2"};
  GetParam().spoil(set, options);
  EXPECT_THAT([&] { make_pulse(set, options); }, ThrowsMessage<InvalidInput>(HasSubstr(GetParam().message)));
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
INSTANTIATE_TEST_SUITE_P(
    Cases, BadPulse,
    testing::Values(
        BadSet{"nan", [](TraceSet& s, PulseOptions&) { s.traces[1].values[7] = kNan; },
               "run: channel 2 ch2: sample 8 at -0.043 s is nan: must be finite"},
        BadSet{"too_few_samples",
               [](TraceSet& s, PulseOptions&) {
                 s.traces[0] = trace_of("1", {0, 1, 2}, {0, 0, 0});
               },
               "run: channel 1 ch1: 3 samples: at least 10 are needed"},
        BadSet{"time_goes_back",
               [](TraceSet& s, PulseOptions&) {
                 auto repeated = *s.traces[0].time_s;
                 repeated[5] = repeated[4];
                 s.traces[0].time_s = std::make_shared<const std::vector<double>>(repeated);
               },
               "run: channel 1 ch1: time of sample 6 is -0.046 s, not after the one before it"},
        BadSet{"rate_too_low", [](TraceSet&, PulseOptions& o) { o.cfc = 180; },
               "run: channel 1 ch1: sampling rate 1000 Hz is too low for CFC180: at least 10 x 180 = 1800 Hz"},
        BadSet{"mixed_dimensions", [](TraceSet& s, PulseOptions&) { s.traces[1].dimension = Dimension::speed; },
               "run: channel 1 ch1 measures acceleration, channel 2 ch2 speed: average channels of one kind"},
        BadSet{"mixed_axes", [](TraceSet& s, PulseOptions&) { s.traces[0].axis = 'X', s.traces[1].axis = 'Z'; },
               "channel 1 ch1 is along X, channel 2 ch2 along Z: average channels of one direction"},
        BadSet{"wrong_dimension", [](TraceSet& s, PulseOptions&) { s.traces[0].dimension = Dimension::force; },
               "run: channel 1 ch1: measures force; a pulse is made from acceleration or velocity"},
        BadSet{"unknown_unit",
               [](TraceSet& s, PulseOptions&) {
                 s.traces[0].dimension = Dimension::unknown;
                 s.traces[0].source_unit = "volt";
               },
               "run: channel 1 ch1: its unit 'volt' is unknown; say it, for example columns = time:s,accel:g"},
        BadSet{"flagged_bad", [](TraceSet& s, PulseOptions&) { s.traces[0].problem = "cable torn"; },
               "run: channel 1 ch1: cable torn; choose others with --channel: 2 (ch2)"},
        BadSet{"not_read", [](TraceSet& s, PulseOptions&) { s.traces[0].has_samples = false; },
               "run: channel 1 ch1: its samples were not read"},
        BadSet{"no_such_channel", [](TraceSet&, PulseOptions& o) { o.channels = {"ch9"}; },
               "run: no channel 'ch9' among 2; nearest: 1 (ch1), 2 (ch2)"},
        BadSet{"no_channel_said", [](TraceSet&, PulseOptions& o) { o.channels = {}; },
               "run: say which channels measure the vehicle's longitudinal motion (--channel); acceleration channels: "
               "1 (ch1)"},
        BadSet{"no_speed", [](TraceSet& s, PulseOptions&) { s.impact_speed_mps = kUnset; },
               "run: impact speed unknown: the file does not say it; give impact_speed_mps (--speed)"},
        BadSet{"negative_speed", [](TraceSet&, PulseOptions& o) { o.impact_speed_mps = -15; },
               "impact_speed_mps = -15 m/s: must be > 0"},
        BadSet{"negative_mass", [](TraceSet&, PulseOptions& o) { o.mass_kg = -3; }, "mass_kg = -3 kg: must be > 0"},
        BadSet{"negative_class", [](TraceSet&, PulseOptions& o) { o.cfc = -60; }, "cfc = -60 Hz: must be >= 0"},
        BadSet{"too_short_after_impact",
               [](TraceSet&, PulseOptions& o) {
                 o.t0 = {TimeZero::given, {0.145}};
               },
               "6 samples from time zero 0.145 s on: at least 10 are needed"},
        BadSet{"quiet",
               [](TraceSet& s, PulseOptions& o) {
                 s.traces = {crash("1", *s.traces[0].time_s, 0.1)};
                 o.channels = {"1"};
                 o.t0.rule = TimeZero::automatic;
               },
               "run: channel 1 ch1: time zero cannot be found: the acceleration never reaches 5 g"},
        BadSet{"no_overlap", [](TraceSet& s, PulseOptions&) { s.traces[1] = crash("2", times(1.0, 1.2, 1e-3)); },
               "run: the chosen channels overlap in 0 samples only: at least 10 are needed"},
        BadSet{"offset_of_velocity",
               [](TraceSet& s, PulseOptions& o) {
                 s.traces[0].dimension = s.traces[1].dimension = Dimension::speed;
                 o.bias = {Bias::given, {-1, 0}};
               },
               "run: bias: an offset window does not apply to velocity channels"}));

class OwnPulse : public testing::Test {
 protected:
  std::string written() const {
    const Pulse pulse = make_pulse(set_of({crash("1", times(-0.05, 0.15, 1e-4))}));
    write_csv(dir_.path("pulse.csv"),
              {{"mass_kg", "1719"}, {"impact_speed_mps", format_number(pulse.impact_speed_mps)}},
              {{"time_s", pulse.time_s},
               {"accel_mps2", pulse.accel_mps2},
               {"velocity_mps", pulse.velocity_mps},
               {"displacement_m", pulse.displacement_m}},
              true);
    return dir_.path("pulse.csv");
  }
  test::TempDir dir_;
};

TEST_F(OwnPulse, ComesBackBitForBit) {
  const Pulse pulse = make_pulse(set_of({crash("1", times(-0.05, 0.15, 1e-4))}));
  const Pulse again = read_pulse(written());
  EXPECT_EQ(again.time_s, pulse.time_s);
  EXPECT_EQ(again.accel_mps2, pulse.accel_mps2);
  EXPECT_EQ(again.velocity_mps, pulse.velocity_mps);
  EXPECT_EQ(again.displacement_m, pulse.displacement_m);
  EXPECT_EQ(again.t_m_s, pulse.t_m_s);
  EXPECT_EQ(again.max_crush_m, pulse.max_crush_m);
  EXPECT_EQ(again.mass_kg, 1719.0);
  EXPECT_EQ(again.impact_speed_mps, kSpeed_mps);
  EXPECT_THAT(again.steps, ElementsAre("taken as written: not filtered or integrated again"));
}

TEST_F(OwnPulse, IsProcessedAgainOnlyWhenItsChannelIsNamed) {
  PulseOptions options;
  options.channels = {"accel_mps2"};
  EXPECT_THAT(read_pulse(written(), options).steps, Contains(HasSubstr("filter: CFC60")));
  options = {};
  options.t0.rule = TimeZero::automatic;
  EXPECT_THAT([&] { read_pulse(written(), options); },
              ThrowsMessage<InvalidInput>(HasSubstr("pulse.csv: is a finished pulse: t0 and bias do not apply")));
}

TEST_F(OwnPulse, RefusesAnotherSpeedAndAnotherStart) {
  PulseOptions options;
  options.impact_speed_mps = 10.0;
  EXPECT_THAT(
      [&] { read_pulse(written(), options); },
      ThrowsMessage<InvalidInput>(HasSubstr("its velocity starts at 15 m/s, which is not the impact speed 10 m/s")));
  const std::string late =
      dir_.file("late.csv", "time_s,accel_mps2,velocity_mps,displacement_m\n1,0,1,0\n2,0,1,1\n3,0,1,2\n");
  EXPECT_THAT([&] { read_pulse(late); },
              ThrowsMessage<InvalidInput>(HasSubstr("late.csv: a pulse starts at time 0, not at 1 s")));
  const std::string hole =
      dir_.file("hole.csv", "time_s,accel_mps2,velocity_mps,displacement_m\n0,0,1,0\n1,,1,1\n2,0,1,2\n");
  EXPECT_THAT([&] { read_pulse(hole); },
              ThrowsMessage<InvalidInput>(HasSubstr("hole.csv: accel_mps2: sample 2 at 1 s is nan")));
}

TEST(ReadPulse, ASimpleCsvNeedsNoChannel) {
  const test::TempDir dir;
  std::string text = "time_ms,accel_g,marker\n";
  for (int i = -500; i <= 1500; ++i) text += fmt::format("{},{},0\n", i / 10.0, half_sine(i / 1e4) / kStandardGravity);
  PulseOptions options;
  options.impact_speed_mps = kSpeed_mps;
  options.mass_kg = 1500;
  const Pulse pulse = read_pulse(dir.file("a.csv", text), options);
  EXPECT_THAT(pulse.channels, ElementsAre("2 accel_g"));
  EXPECT_EQ(pulse.mass_kg, 1500);
  EXPECT_THAT(pulse.input_files, ElementsAre(dir.path("a.csv")));
  EXPECT_NEAR(pulse.max_crush_m, 0.5 * kSpeed_mps * 0.1, kFilterAndBetween * 0.75);
}

}  // namespace
}  // namespace crashsim
