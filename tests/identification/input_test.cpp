/// What identification says about input it cannot use, and how it ends when the numbers fail.

#include <functional>
#include <string>

#include <gmock/gmock.h>

#include <crashsim/identify.hpp>
#include <crashsim/option_values.hpp>

#include "support/fit_cases.hpp"

namespace crashsim {
namespace {

Pulse good_pulse() {
  const CrushModel model = test::example_model();
  return test::pulse_of(model, 14.0).value();
}

struct BadInput {
  const char* name;
  std::function<void(Pulse&, IdentifyOptions&)> spoil;
  const char* message;
};
void PrintTo(const BadInput& bad, std::ostream* out) { *out << bad.name; }

class Refused : public testing::TestWithParam<BadInput> {};

TEST_P(Refused, SaysWhy) {
  Pulse pulse = good_pulse();
  IdentifyOptions options;
  options.starts = 1;
  GetParam().spoil(pulse, options);
  try {
    identify(pulse, options);
    FAIL() << "accepted";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), testing::StartsWith(GetParam().message));
  }
}

const BadInput kBadInputs[] = {
    {"no_mass", [](Pulse& p, IdentifyOptions&) { p.mass_kg = kUnset; },
     "IdentifyOptions.mass_kg: not given, and the pulse does not say it: give the test mass"},
    {"negative_mass", [](Pulse&, IdentifyOptions& o) { o.mass_kg = -3.0; },
     "IdentifyOptions.mass_kg = -3 kg: must be > 0"},
    {"empty_pulse", [](Pulse& p, IdentifyOptions&) { p = {}; }, "pulse: impact_speed_mps = nan m/s: must be > 0"},
    {"no_speed", [](Pulse& p, IdentifyOptions&) { p.impact_speed_mps = kUnset; },
     "pulse: impact_speed_mps = nan m/s: must be > 0"},
    {"no_crush", [](Pulse& p, IdentifyOptions&) { p.max_crush_m = kUnset; }, "pulse: max_crush_m = nan m: must be > 0"},
    {"few_samples", [](Pulse& p, IdentifyOptions&) { p.t_m_s = p.time_s[5]; },
     "pulse: 6 samples up to t_m = 0.0005 s are too few: at least 10 are needed"},
    {"short_channel", [](Pulse& p, IdentifyOptions&) { p.accel_mps2.resize(3); },
     "pulse: accel_mps2 has 3 samples but time_s has "},
    {"not_finite", [](Pulse& p, IdentifyOptions&) { p.velocity_mps[7] = kUnset; },
     "pulse: velocity_mps[7] = nan: must be finite"},
    {"repeated_time", [](Pulse& p, IdentifyOptions&) { p.time_s[2] = p.time_s[1]; },
     "pulse: time_s[2] = 0.0001 s: times must increase from 0"},
    {"negative_time", [](Pulse& p, IdentifyOptions&) { p.time_s[0] = -1.0; },
     "pulse: time_s[0] = -1 s: times must increase from 0"},
    {"no_deceleration", [](Pulse& p, IdentifyOptions&) { p.accel_mps2.assign(p.time_s.size(), 0.0); },
     "pulse: accel_mps2 is zero up to t_m: there is no force to identify"},
    {"two_weights",
     [](Pulse&, IdentifyOptions& o) {
       o.weights = {Weights::given, {1.0, 2.0}};
     },
     "IdentifyOptions.weights = 1,2: three numbers >= 0, not all 0, are needed, for acceleration, velocity and "
     "displacement"},
    {"negative_weight",
     [](Pulse&, IdentifyOptions& o) {
       o.weights = {Weights::given, {1.0, -2.0, 3.0}};
     },
     "IdentifyOptions.weights = 1,-2,3: three numbers >= 0"},
    {"zero_weights",
     [](Pulse&, IdentifyOptions& o) {
       o.weights = {Weights::given, {0.0, 0.0, 0.0}};
     },
     "IdentifyOptions.weights = 0,0,0: three numbers >= 0, not all 0"},
    {"infinite_weight",
     [](Pulse&, IdentifyOptions& o) {
       o.weights = {Weights::given, {1.0, INFINITY, 3.0}};
     },
     "IdentifyOptions.weights = inf: must be finite"},
    {"knots_not_from_zero",
     [](Pulse&, IdentifyOptions& o) {
       o.knots = {KnotPlacement::given, {0.1, 0.2}};
     },
     "IdentifyOptions.knots[0] = 0.1 m: knots must start at 0 and increase strictly"},
    {"knots_not_increasing",
     [](Pulse&, IdentifyOptions& o) {
       o.knots = {KnotPlacement::given, {0.0, 0.2, 0.2}};
     },
     "IdentifyOptions.knots[2] = 0.2 m: knots must start at 0 and increase strictly"},
    {"knots_missing",
     [](Pulse&, IdentifyOptions& o) {
       o.knots = {KnotPlacement::given, {}};
     },
     "IdentifyOptions.knots: no numbers given: give the spring's knots in m, from 0"},
    {"no_knots", [](Pulse&, IdentifyOptions& o) { o.spring_knots = o.damper_knots = 0; },
     "IdentifyOptions.spring_knots = 0 and damper_knots = 0: there is nothing to identify"},
    {"too_many_knots", [](Pulse&, IdentifyOptions& o) { o.spring_knots = 101; },
     "IdentifyOptions.spring_knots = 101: must be >= 0 and <= 100"},
    {"more_knots_than_samples",
     [](Pulse& p, IdentifyOptions& o) {
       p.t_m_s = p.time_s[11];
       o.damper_knots = 8;
     },
     "12 samples up to t_m cannot determine 15 ordinates: use fewer knots"},
    {"no_starts", [](Pulse&, IdentifyOptions& o) { o.starts = 0; },
     "IdentifyOptions.starts = 0: must be >= 1 and <= 1e+06"},
    {"negative_jobs", [](Pulse&, IdentifyOptions& o) { o.jobs = -1; },
     "IdentifyOptions.jobs = -1: must be >= 0 and <= 1024"},
    {"negative_smoothing", [](Pulse&, IdentifyOptions& o) { o.smooth = -0.5; },
     "IdentifyOptions.smooth = -0.5: must be >= 0"},
    {"zero_bound", [](Pulse&, IdentifyOptions& o) { o.spring_upper = 0.0; },
     "IdentifyOptions.spring_upper = 0: must be > 0"},
};
INSTANTIATE_TEST_SUITE_P(Inputs, Refused, testing::ValuesIn(kBadInputs),
                         [](const auto& bad) { return std::string(bad.param.name); });

TEST(IdentifyInput, NeedsAPulse) {
  try {
    identify(std::span<const Pulse>());
    FAIL() << "accepted";
  } catch (const InvalidInput& error) {
    EXPECT_STREQ(error.what(), "identify: no pulse given");
  }
}

TEST(IdentifyInput, TheMassGivenWinsOverThePulses) {
  IdentifyOptions options;
  options.method = IdentifyMethod::equation_error;
  const Pulse pulse = good_pulse();
  const Identification own = identify(pulse, options);
  options.mass_kg = 2.0 * pulse.mass_kg;
  const Identification doubled = identify(pulse, options);
  EXPECT_EQ(own.model.mass_kg, pulse.mass_kg);
  EXPECT_EQ(doubled.model.mass_kg, 2.0 * pulse.mass_kg);
  constexpr double kSameMotion = 1e-6;  // solver: mass and forces scaled together leave the trace unchanged
  EXPECT_NEAR(doubled.error.total, own.error.total, kSameMotion);
}

/// A speed that drops within the first sample and then creeps for a thousand seconds: a damper that explains the first
/// sample has ten million time constants in the rest.
Pulse creeping_pulse() {
  constexpr int kSeconds = 1000;
  constexpr double kSpeed = 10.0, kCreep = 1e-3;  // m/s
  Pulse pulse;
  pulse.mass_kg = 1000.0;
  pulse.impact_speed_mps = kSpeed;
  pulse.t_m_s = kSeconds;
  for (int t = 0; t <= kSeconds; ++t) {
    pulse.time_s.push_back(t);
    pulse.accel_mps2.push_back(t == 0 ? -1e5 : 0.0);
    pulse.velocity_mps.push_back(t == 0 ? kSpeed : kCreep);
    pulse.displacement_m.push_back(t == 0 ? 0.0 : kSpeed / 1e4 + kCreep * t);
  }
  pulse.max_crush_m = pulse.displacement_m.back();
  return pulse;
}

TEST(IdentifyOutcome, EveryStartFailedSaysWhy) {
  IdentifyOptions options;
  options.spring_knots = 0;
  options.damper_knots = 1;
  options.starts = 1;
  const Identification fit = identify(creeping_pulse(), options);
  EXPECT_EQ(fit.outcome, IdentifyOutcome::every_start_failed);
  EXPECT_EQ(fit.message,
            "all 1 starts failed: their simulations did not reach the end of the pulse within 100000 steps: check the "
            "pulse's times and units, or lower the bounds");
  EXPECT_FALSE(fit.usable());
  EXPECT_THAT(fit.brief_report(), testing::StartsWith("every_start_failed: all 1 starts failed"));
  ASSERT_EQ(fit.starts.size(), 1U);
  EXPECT_TRUE(fit.starts[0].failed);
  EXPECT_EQ(fit.starts[0].error, INFINITY);
  EXPECT_EQ(fit.starts_at_best, 0);
  EXPECT_TRUE(std::isnan(fit.error.total));
  EXPECT_TRUE(fit.ordinates.empty());
  EXPECT_GT(fit.seconds, 0.0);
}

TEST(IdentifyOutcome, EquationErrorThatCannotBeSimulatedSaysSo) {
  IdentifyOptions options;
  options.spring_knots = 0;
  options.damper_knots = 1;
  options.method = IdentifyMethod::equation_error;
  const Identification fit = identify(creeping_pulse(), options);
  EXPECT_EQ(fit.outcome, IdentifyOutcome::every_start_failed);
  EXPECT_THAT(fit.message, testing::StartsWith("the equation-error model's simulation did not reach the end"));
}

TEST(IdentifyOutcome, APulseThatDoesNotStopHasNoModel) {
  Pulse pulse;
  pulse.mass_kg = pulse.impact_speed_mps = 10.0;
  pulse.time_s = {0.0, 0.1};
  pulse.velocity_mps = {10.0, 9.0};
  const Identification fit = identify(pulse);
  EXPECT_EQ(fit.outcome, IdentifyOutcome::no_max_crush);
  EXPECT_FALSE(fit.usable());
  EXPECT_EQ(fit.brief_report(),
            "no_max_crush: pulse: has no time of maximum crush: its velocity (9 m/s at 0.1 s) never reaches zero; a "
            "longer trace or the right impact speed is needed");
}

TEST(IdentifyOutcome, NothingIsKnownBeforeTheRun) {
  const Identification fit;
  EXPECT_EQ(fit.outcome, IdentifyOutcome::not_run);
  EXPECT_FALSE(fit.usable());
  EXPECT_EQ(fit.brief_report(), "not run");
  EXPECT_TRUE(std::isnan(fit.error.total));
  EXPECT_FALSE(fit.verdict.identifiable);
}

template <class Value>
IdentifyOptions with(std::string_view flag, const Value& value) {
  IdentifyOptions options;
  set_option(options, find_field<IdentifyOptions>(flag, "identify"), OptionValue(std::string(value)), flag);
  return options;
}

TEST(IdentifyOptionsTable, HasTheSpellingsOfTheCommandLine) {
  for (const char* flag : {"mass", "starts", "seed", "loss", "weights", "spring-knots", "damper-knots", "knots",
                           "method", "algorithm", "jobs", "smooth"})
    EXPECT_EQ(find_field<IdentifyOptions>(flag, "identify").flag, flag);
  EXPECT_EQ(with("loss", "huber").loss, Loss::huber);
  EXPECT_EQ(with("weights", "paper").weights.rule, Weights::paper);
  EXPECT_EQ(with("weights", "1,2,3").weights, (Setting<Weights>{Weights::given, {1.0, 2.0, 3.0}}));
  EXPECT_EQ(with("knots", "quantile").knots.rule, KnotPlacement::quantile);
  EXPECT_EQ(with("knots", "0,100mm,0.5").knots, (Setting<KnotPlacement>{KnotPlacement::given, {0.0, 0.1, 0.5}}));
  EXPECT_EQ(with("method", "equation-error").method, IdentifyMethod::equation_error);
  EXPECT_EQ(with("mass", "2.58t").mass_kg, 2580.0);
}

TEST(IdentifyOptionsTable, AlgorithmsHaveTheNamesOfNloptToo) {
  EXPECT_EQ(with("algorithm", "slsqp").algorithm, Algorithm::slsqp);
  EXPECT_EQ(with("algorithm", "LD_LBFGS").algorithm, Algorithm::lbfgs);
  EXPECT_EQ(with("algorithm", "LD_SLSQP").algorithm, Algorithm::slsqp);
  EXPECT_EQ(with("algorithm", "LD_TNEWTON_PRECOND_RESTART").algorithm, Algorithm::tnewton);
  EXPECT_EQ(with("algorithm", "LD_VAR2").algorithm, Algorithm::var2);
  EXPECT_THROW(with("algorithm", "LD_MMA"), InvalidInput);
}

}  // namespace
}  // namespace crashsim
