/// Several tests of one structure: laws and curves that are found again, weights, priors, and errors of accelerometers.

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <crashsim/identify.hpp>

#include "optimize/effective_samples.hpp"
#include "optimize/fit_structure.hpp"
#include "support/fit_cases.hpp"

namespace crashsim {
namespace {

using testing::HasSubstr;

constexpr double kMass_kg = 1500.0;
const std::vector<double> kSpeeds_mps = {40.0 / 3.6, 56.0 / 3.6, 72.0 / 3.6};

/// A structure with buckling: its force falls after a first peak.
FitStructure buckling_structure(CrushLaw law, Curve curve = Curve::linear) {
  FitStructure structure{law, uniform_knots(0.8, 5), uniform_knots(law == CrushLaw::crush_damping ? 0.8 : 20.0, 4)};
  if (law == CrushLaw::rate) structure.damper_knots.clear();
  structure.reference_speed_mps = 1.0;
  structure.curve = curve;
  return structure;
}

std::vector<double> buckling_parameters(const FitStructure& structure) {
  std::vector<double> parameters = structure.law == CrushLaw::stiffness
                                       ? std::vector<double>{9e5, 7e5, 4e5, 5e5, 8e5}
                                       : std::vector<double>{6e4, 2.6e5, 1.8e5, 2.4e5, 4.5e5};
  const std::vector<double> damper = {4e3, 9e3, 6e3, 5e3};
  parameters.insert(parameters.end(), damper.begin(),
                    damper.begin() + static_cast<std::ptrdiff_t>(structure.dampers()));
  if (structure.has_rate()) parameters.push_back(0.12);
  return parameters;
}

std::vector<Pulse> pulses_of(const CrushModel& model) {
  std::vector<Pulse> pulses;
  for (const double speed : kSpeeds_mps) pulses.push_back(test::pulse_of(model, speed).value());
  return pulses;
}

IdentifyOptions options_of(const FitStructure& structure) {
  IdentifyOptions options;
  options.law = structure.law;
  options.loss = Loss::l2;
  options.curve = structure.curve;
  options.starts = 4;
  options.spring_knots = static_cast<int>(structure.springs());
  options.damper_knots = static_cast<int>(structure.dampers());
  return options;
}

struct Case {
  const char* name;
  CrushLaw law;
  Curve curve;
  IdentifyMethod method;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class JointTwin : public testing::TestWithParam<Case> {};

/// The knots of the fit reach to the largest crush and speed measured; those of the truth are put there, too.
TEST_P(JointTwin, IsFoundAgainFromThreeSpeeds) {
  constexpr double kFound = 1e-2;  // regression: relative to the largest ordinate, as asked of noise-free twins
  FitStructure structure = buckling_structure(GetParam().law, GetParam().curve);
  const std::vector<double> truth = buckling_parameters(structure);
  const auto crush_of = [&] {
    return test::pulse_of(make_model(structure, truth, kMass_kg, kSpeeds_mps.back()), kSpeeds_mps.back())->max_crush_m;
  };
  for (int i = 0; i < 60; ++i) {  // until the last knot is at the largest crush
    structure.spring_knots = uniform_knots(crush_of(), static_cast<int>(structure.springs()));
    if (structure.law == CrushLaw::crush_damping)
      structure.damper_knots = uniform_knots(crush_of(), static_cast<int>(structure.dampers()));
  }
  const std::vector<Pulse> pulses = pulses_of(make_model(structure, truth, kMass_kg, kSpeeds_mps.back()));
  IdentifyOptions options = options_of(structure);
  options.method = GetParam().method;
  const Identification fit = identify(pulses, options);
  ASSERT_TRUE(fit.usable()) << fit.message;
  EXPECT_LT(fit.error.total, 1e-6);
  ASSERT_EQ(fit.ordinates.size(), truth.size());
  const double spring = *std::max_element(truth.begin(), truth.begin() + 5);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double size = fit.ordinates[i].part == FittedPart::spring ? spring : truth[i];
    EXPECT_NEAR(fit.ordinates[i].value, truth[i], kFound * size) << fit.ordinates[i].name;
  }
}

INSTANTIATE_TEST_SUITE_P(
    LawsAndMethods, JointTwin,
    testing::Values(
        Case{"stiffness", CrushLaw::stiffness, Curve::linear, IdentifyMethod::multistart},
        Case{"crush_damping", CrushLaw::crush_damping, Curve::linear, IdentifyMethod::multistart},
        Case{"rate", CrushLaw::rate, Curve::linear, IdentifyMethod::multistart},
        Case{"rate_by_equation_error", CrushLaw::rate, Curve::linear, IdentifyMethod::equation_error},
        Case{"crush_damping_by_equation_error", CrushLaw::crush_damping, Curve::linear, IdentifyMethod::equation_error},
        Case{"pchip", CrushLaw::force, Curve::pchip, IdentifyMethod::multistart},
        Case{"pchip_by_equation_error", CrushLaw::crush_damping, Curve::pchip, IdentifyMethod::equation_error}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(FreeKnots, FindWhereTheForceBends) {
  constexpr double kFound_m = 2e-3;  // regression
  CrushModel model;
  model.mass_kg = kMass_kg;
  model.impact_speed_mps = 15.0;
  model.law = CrushLaw::force;
  model.spring = {{0.0, 0.07, 0.31, 0.9}, {2e4, 3e5, 1.8e5, 6e5}};
  IdentifyOptions options;
  options.law = CrushLaw::force;
  options.loss = Loss::l2;
  options.spring_knots = 6;
  options.damper_knots = 0;
  options.starts = 20;
  const Pulse pulse = test::pulse_of(model, 15.0).value();
  const Identification even = identify(pulse, options);
  options.knots.rule = KnotPlacement::free;
  const Identification fit = identify(pulse, options);
  ASSERT_TRUE(fit.usable()) << fit.message;
  EXPECT_LT(fit.error.total, 0.05 * even.error.total);
  for (const double bend : {0.07, 0.31}) {
    double nearest = 1.0;
    for (const OrdinateReport& o : fit.ordinates)
      if (o.part == FittedPart::spring_knot) nearest = std::min(nearest, std::fabs(o.value - bend));
    EXPECT_LT(nearest, kFound_m) << bend;
  }
}

/// What an accelerometer with these errors would have made of a pulse.
Pulse with_errors(const Pulse& pulse, double time_shift_s, double gain, double bias_mps2) {
  std::vector<double> accel;
  for (const double t : pulse.time_s) {
    const double position = (t - time_shift_s) / test::kSampling;
    const auto i = static_cast<std::size_t>(std::max(position, 0.0));
    const double true_accel =
        position < 0.0 ? 0.0
                       : std::lerp(pulse.accel_mps2[i], pulse.accel_mps2[std::min(i + 1, pulse.time_s.size() - 1)],
                                   position - static_cast<double>(i));
    accel.push_back(gain * true_accel + bias_mps2);
  }
  std::vector<double> time = pulse.time_s;
  for (int i = 0; i < 300; ++i) {  // so that v surely reaches zero
    time.push_back(time.back() + test::kSampling);
    accel.push_back(accel.back());
  }
  return make_pulse(time, accel, pulse.impact_speed_mps, pulse.mass_kg);
}

TEST(TestCorrections, AreFoundWithTheModel) {
  constexpr double kShift_s = 4e-4, kGain = 1.04, kBias_mps2 = -6.0;  // of the second test
  const FitStructure structure = buckling_structure(CrushLaw::crush_damping);
  const std::vector<double> truth = buckling_parameters(structure);
  std::vector<Pulse> pulses = pulses_of(make_model(structure, truth, kMass_kg, kSpeeds_mps.back()));
  pulses[1] = with_errors(pulses[1], kShift_s, kGain, kBias_mps2);
  IdentifyOptions options = options_of(structure);
  options.knots = {KnotPlacement::given, structure.spring_knots};
  const Identification blind = identify(pulses, options);
  options.time_shift_deviation_s = 1e-3;
  options.gain_deviation = 0.05;
  options.bias_deviation_mps2 = 10.0;
  const Identification fit = identify(pulses, options);
  ASSERT_TRUE(fit.usable()) << fit.message;
  EXPECT_LT(fit.error.total, 0.1 * blind.error.total);
  ASSERT_EQ(fit.tests.size(), 3U);
  // What all tests had in common the model would take: it is their difference that shows.
  const auto beside_others = [&](double TestReport::*number) {
    return fit.tests[1].*number - 0.5 * (fit.tests[0].*number + fit.tests[2].*number);
  };
  EXPECT_NEAR(beside_others(&TestReport::time_shift_s), kShift_s, 0.4 * kShift_s);
  EXPECT_NEAR(beside_others(&TestReport::gain), kGain - 1.0, 0.4 * (kGain - 1.0));
  EXPECT_NEAR(beside_others(&TestReport::bias_mps2), kBias_mps2, 0.4 * std::fabs(kBias_mps2));
  for (const TestReport& test : fit.tests) {
    EXPECT_GT(test.gain_error, 0.0);
    EXPECT_LT(test.gain_error, options.gain_deviation);
  }
  EXPECT_TRUE(std::isnan(blind.tests[1].gain));
}

TEST(TestWeights, DrawTheFitToTheTestThatHasThem) {
  const FitStructure structure = buckling_structure(CrushLaw::force);
  const std::vector<double> truth = buckling_parameters(structure);
  std::vector<Pulse> pulses = pulses_of(make_model(structure, truth, kMass_kg, kSpeeds_mps.back()));
  pulses[0] = with_errors(pulses[0], 0.0, 1.1, 0.0);
  IdentifyOptions options = options_of(structure);
  const Identification equal = identify(pulses, options);
  options.test_weights = {100.0, 1.0, 1.0};
  const Identification drawn = identify(pulses, options);
  ASSERT_TRUE(drawn.usable()) << drawn.message;
  EXPECT_LT(drawn.tests[0].error.total / drawn.tests[0].weight, 0.8 * equal.tests[0].error.total);
  EXPECT_GT(drawn.tests[1].error.total / drawn.tests[1].weight, 1.5 * equal.tests[1].error.total);
  EXPECT_NEAR(drawn.tests[0].weight, 300.0 / 102.0, 1e-12);
  double mean = 0.0;
  for (const TestReport& test : drawn.tests) mean += test.error.total / 3.0;
  EXPECT_NEAR(mean, drawn.error.total, 1e-12);
}

TEST(TestWeights, OfTheChannelsMayDifferByTest) {
  const FitStructure structure = buckling_structure(CrushLaw::force);
  const std::vector<Pulse> pulses =
      pulses_of(make_model(structure, buckling_parameters(structure), kMass_kg, kSpeeds_mps.back()));
  IdentifyOptions options = options_of(structure);
  options.weights = {Weights::given, {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
  const Identification fit = identify(pulses, options);
  ASSERT_TRUE(fit.usable()) << fit.message;
  EXPECT_EQ(fit.tests[0].error.velocity, 0.0);
  EXPECT_EQ(fit.tests[1].error.accel, 0.0);
  EXPECT_EQ(fit.tests[2].error.velocity, 0.0);
  EXPECT_GT(fit.tests[2].error.displacement, 0.0);
}

TEST(Priors, HoldWhereTheyAreSureAndYieldWhereTheyAreNot) {
  const FitStructure structure = buckling_structure(CrushLaw::force);
  const CrushModel truth = make_model(structure, buckling_parameters(structure), kMass_kg, kSpeeds_mps.back());
  const std::vector<Pulse> pulses = {test::noisy_pulse(truth, kSpeeds_mps[1], 0.1, 5)};
  IdentifyOptions options = options_of(structure);
  const Identification free = identify(pulses, options);
  options.damper_prior = {8e3};
  options.prior_deviation = 1e-4;
  const Identification held = identify(pulses, options);
  ASSERT_TRUE(held.usable()) << held.message;
  options.prior_deviation = 1e4;
  const Identification yielding = identify(pulses, options);
  for (std::size_t i = structure.springs(); i < structure.ordinates(); ++i) {
    EXPECT_NEAR(held.ordinates[i].value, 8e3, 80.0) << held.ordinates[i].name;
    EXPECT_LT(held.ordinates[i].standard_error, 80.0);
  }
  EXPECT_NEAR(yielding.error.total, free.error.total, 1e-3 * free.error.total);
  EXPECT_GT(held.error.total, free.error.total);
  EXPECT_LT(held.verdict.condition, free.verdict.condition);
}

/// Noise that a fit of 12 + 12 knots would follow: smoothing chosen from the data comes nearer to the truth.
TEST(ChosenSmoothing, BringsTheCurveNearerToTheTruth) {
  const FitStructure structure = buckling_structure(CrushLaw::force);
  CrushModel truth = make_model(structure, buckling_parameters(structure), kMass_kg, kSpeeds_mps[1]);
  truth.damper = {};
  const Pulse pulse = test::noisy_pulse(truth, kSpeeds_mps[1], 0.15, 8);
  IdentifyOptions options = options_of(structure);
  options.spring_knots = 25;
  options.damper_knots = 0;
  const auto distance = [&](const Identification& fit) {
    double sum = 0.0;
    for (int i = 0; i <= 100; ++i) {
      const double x = 0.01 * i * pulse.max_crush_m;
      sum += std::fabs(spring_force(fit.model, x) - spring_force(truth, x));
    }
    return sum;
  };
  const Identification rough = identify(pulse, options);
  EXPECT_EQ(rough.smooth, 0.0);
  for (const Smoothing rule : {Smoothing::gcv, Smoothing::l_curve}) {
    options.smoothing = rule;
    const Identification fit = identify(pulse, options);
    ASSERT_TRUE(fit.usable()) << fit.message;
    EXPECT_GT(fit.smooth, 0.0) << name_of(rule);
    EXPECT_LT(distance(fit), distance(rough)) << name_of(rule);
  }
}

struct Refusal {
  const char* name;
  void (*spoil)(IdentifyOptions&);
  const char* message;
};
void PrintTo(const Refusal& r, std::ostream* out) { *out << r.name; }
class RefusedJointFit : public testing::TestWithParam<Refusal> {};

TEST_P(RefusedJointFit, SaysWhatIsWrong) {
  const FitStructure structure = buckling_structure(CrushLaw::force);
  const std::vector<Pulse> pulses =
      pulses_of(make_model(structure, buckling_parameters(structure), kMass_kg, kSpeeds_mps.back()));
  IdentifyOptions options = options_of(structure);
  GetParam().spoil(options);
  try {
    identify(pulses, options);
    FAIL() << "no error";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), HasSubstr(GetParam().message));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Options, RefusedJointFit,
    testing::Values(Refusal{"weights_of_two_tests",
                            [](IdentifyOptions& o) {
                              o.test_weights = {1.0, 2.0};
                            },
                            "IdentifyOptions.test_weights = 1,2: 3 numbers > 0 are needed, one a test"},
                    Refusal{"negative_weight",
                            [](IdentifyOptions& o) {
                              o.test_weights = {1.0, -2.0, 1.0};
                            },
                            "numbers > 0 are needed"},
                    Refusal{"prior_of_two",
                            [](IdentifyOptions& o) {
                              o.spring_prior = {1.0, 2.0};
                            },
                            "IdentifyOptions.spring_prior = 1,2: one number for all, or 5 numbers"},
                    Refusal{"free_pchip",
                            [](IdentifyOptions& o) {
                              o.knots.rule = KnotPlacement::free;
                              o.curve = Curve::pchip;
                            },
                            "knots = free: goes with curve = linear"},
                    Refusal{"smooth_and_chosen",
                            [](IdentifyOptions& o) {
                              o.smooth = 0.1;
                              o.smoothing = Smoothing::gcv;
                            },
                            "IdentifyOptions.smooth = 0.1: goes with smoothing = fixed, this is gcv"},
                    Refusal{"rate_without_spring",
                            [](IdentifyOptions& o) {
                              o.law = CrushLaw::rate;
                              o.spring_knots = 0;
                            },
                            "law rate has nothing but its spring"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(EffectiveSamples, AreThoseOfTheAutoregression) {
  constexpr double kPhi = 0.8;  // n_eff / n = (1 - phi)/(1 + phi) of a first-order autoregression
  test::Random random(3);
  std::vector<double> series = {0.0};
  for (int i = 1; i < 200000; ++i) series.push_back(kPhi * series.back() + random.between(-1.0, 1.0));
  EXPECT_NEAR(effective_samples(series) / static_cast<double>(series.size()), (1.0 - kPhi) / (1.0 + kPhi), 0.01);
  EXPECT_EQ(effective_samples(std::vector<double>(5, 0.0)), 5.0);
}

}  // namespace
}  // namespace crashsim
