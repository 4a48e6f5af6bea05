/// Predictions of other speeds: bands, what is beyond what was seen, and models that say little of themselves.
#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include <crashsim/files.hpp>
#include <crashsim/model_io.hpp>
#include <crashsim/outputs.hpp>
#include <crashsim/predict.hpp>
#include <crashsim/simulate.hpp>

#include "support/noisy_tests.hpp"
#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kNoise = 0.03;

/// A model identified at 40, 56 and 72 km/h, with its ensemble.
struct Identified {
  CrushModel truth = test::three_speed_model();
  IdentifyOptions how = test::one_descent(truth);
  std::vector<Pulse> pulses = test::measured_tests(truth, kNoise, 5);
  Identification fit = identify(pulses, how);
  Uncertainty errors = uncertainty(pulses, how, fit);
  PredictionBasis basis = prediction_basis(fit, errors);
};
const Identified& identified() {
  static const Identified once;
  return once;
}

PredictOptions at(std::vector<std::string> speeds) {
  PredictOptions options;
  options.speeds = std::move(speeds);
  return options;
}

TEST(Speeds, AreReadAsPeopleListThem) {
  const PredictionBasis& basis = identified().basis;
  EXPECT_THAT(speeds_of(at({"36km/h", "12"}), basis), ElementsAre(10.0, 12.0));
  EXPECT_THAT(speeds_of(at({"10..20:3"}), basis), ElementsAre(10.0, 15.0, 20.0));
  EXPECT_EQ(speeds_of(at({"40km/h..72km/h"}), basis).size(), 9U);
  EXPECT_EQ(speeds_of(at({}), basis).size(), 3U);  // those identified
}

TEST(Speeds, ThatAreNoneAreRefused) {
  const PredictionBasis& basis = identified().basis;
  EXPECT_THAT(test::refusal_of([&] { speeds_of(at({"-3"}), basis); }),
              HasSubstr("PredictOptions.speeds[0] = -3 m/s: must be > 0"));
  PredictionBasis unknown;
  unknown.model = basis.model;
  unknown.model.impact_speed_mps = kUnset;
  EXPECT_THAT(test::refusal_of([&] { speeds_of(at({}), unknown); }), HasSubstr("give the speeds to predict"));
}

/// Between the speeds identified, the truth is inside the bands and the model is what simulate() says.
TEST(Prediction, BetweenTheSpeedsHoldsTheTruth) {
  const SpeedPrediction prediction = predict(identified().basis, at({"48km/h", "64km/h"}));
  ASSERT_TRUE(prediction.usable());
  EXPECT_EQ(prediction.replicates, 200U);
  for (const PredictedSpeed& row : prediction.speeds) {
    EXPECT_FALSE(row.extrapolated());
    EXPECT_THAT(row.reasons, IsEmpty());
    EXPECT_EQ(row.without_max_crush, 0.0);
    SimulateOptions options;
    options.impact_speed_mps = row.impact_speed_mps;
    const CrushResponse truth = simulate(identified().truth, options),
                        own = simulate(identified().basis.model, options);
    constexpr double kEngines = 1e-6;  // solver
    EXPECT_NEAR(row.value.max_crush_m, own.max_crush_m, kEngines);
    EXPECT_NEAR(row.value.t_m_s, own.t_m_s, kEngines);
    constexpr double kHalfAgain = 0.5;  // of the band: five per cent of truths lie outside
    const double crush = kHalfAgain * (row.high.max_crush_m - row.low.max_crush_m);
    EXPECT_GE(truth.max_crush_m, row.low.max_crush_m - crush);
    EXPECT_LE(truth.max_crush_m, row.high.max_crush_m + crush);
    EXPECT_LT(row.low.t_m_s, row.high.t_m_s);
    EXPECT_LT(row.low.olc_g, row.high.olc_g);
    EXPECT_LT(row.low.peak_decel_g, row.high.peak_decel_g);
  }
}

TEST(Prediction, BeyondTheSpeedsIsFlagged) {
  const SpeedPrediction prediction = predict(identified().basis, at({"30km/h", "90km/h"}));
  EXPECT_TRUE(prediction.speeds[0].outside_speeds);
  EXPECT_FALSE(prediction.speeds[0].beyond_crush);
  EXPECT_THAT(prediction.speeds[0].reasons, ElementsAre("slower than the speeds identified, 40.0..72.0 km/h"));
  EXPECT_TRUE(prediction.speeds[1].outside_speeds && prediction.speeds[1].beyond_crush);
  EXPECT_THAT(prediction.speeds[1].reasons, Contains(HasSubstr("is beyond the deepest seen")));
  EXPECT_THAT(prediction.brief_report(), HasSubstr("2 speeds, 2 of them extrapolated"));
}

TEST(Prediction, WithoutAnEnsembleHasNoBandsAndSaysSo) {
  PredictionBasis bare;
  bare.model = identified().fit.model;
  const SpeedPrediction prediction = predict(bare, at({"48km/h"}));
  EXPECT_EQ(prediction.replicates, 0U);
  EXPECT_TRUE(std::isnan(prediction.level));
  EXPECT_TRUE(std::isnan(prediction.speeds[0].low.t_m_s));
  EXPECT_TRUE(std::isnan(prediction.speeds[0].without_max_crush));
  EXPECT_THAT(prediction.message, HasSubstr("no bands: the model carries no ensemble"));
  EXPECT_TRUE(prediction.speeds[0].outside_speeds);  // it only knows its own speed
}

TEST(Prediction, FromOneSpeedSaysThatItIsNotDetermined) {
  const Identified& all = identified();
  IdentifyOptions how = all.how;
  how.knots = {};
  how.spring_knots = how.damper_knots = 7;
  const std::vector<Pulse> one = {all.pulses[1]};
  const Identification fit = identify(one, how);
  const PredictionBasis basis = prediction_basis(fit, uncertainty(one, how, fit));
  const SpeedPrediction prediction = predict(basis, at({"48km/h", "56km/h"}));
  EXPECT_THAT(prediction.message, HasSubstr("the identification from one speed did not determine the ordinates"));
  const SpeedPrediction joint = predict(all.basis, at({"48km/h"}));
  const auto width = [](const PredictedSpeed& row) { return row.high.max_crush_m - row.low.max_crush_m; };
  constexpr double kMuchWider = 2.0;
  EXPECT_GT(width(prediction.speeds[0]), kMuchWider * width(joint.speeds[0]));
  EXPECT_GT(width(prediction.speeds[0]), kMuchWider * width(prediction.speeds[1]));  // its own speed is known
  EXPECT_TRUE(prediction.speeds[0].outside_speeds);
  EXPECT_FALSE(prediction.speeds[1].outside_speeds);
}

/// Replicates that never come to rest leave the upper end of t_m and crush open.
TEST(Prediction, LeavesAnEndOpenThatReplicatesDoNotReach) {
  PredictionBasis basis;
  basis.model.mass_kg = 1500.0;
  basis.model.impact_speed_mps = 15.0;
  basis.model.spring = {{0.0}, {4e5}};
  basis.replicates.common = basis.model;
  basis.replicates.spring_ordinates.resize(4, 1);
  basis.replicates.spring_ordinates << 4e5, 3.9e5, 4.1e5, 10.0;  // the last takes seconds
  const SpeedPrediction prediction = predict(basis, at({"15"}));
  const PredictedSpeed& row = prediction.speeds.front();
  EXPECT_EQ(row.without_max_crush, 0.25);
  EXPECT_TRUE(std::isnan(row.high.t_m_s));
  EXPECT_TRUE(std::isnan(row.high.max_crush_m));
  EXPECT_GT(row.low.t_m_s, 0.0);
  EXPECT_THAT(row.reasons, Contains("25 % of the replicates do not come to rest by 0.2 s"));
  EXPECT_FALSE(row.outside_speeds);
}

TEST(Prediction, GivesCurvesWithBands) {
  PredictOptions options = at({"48km/h"});
  options.curves = true;
  options.end_time_s = 0.1;
  const SpeedPrediction prediction = predict(identified().basis, options);
  const PredictedSpeed& row = prediction.speeds.front();
  ASSERT_EQ(row.time_s.size(), 1001U);
  for (const PredictedCurve* curve : {&row.accel_mps2, &row.velocity_mps, &row.displacement_m}) {
    ASSERT_EQ(curve->value.size(), row.time_s.size());
    ASSERT_EQ(curve->low.size(), row.time_s.size());
    int inside = 0;
    for (std::size_t i = 0; i < row.time_s.size(); ++i)
      if (curve->low[i] <= curve->value[i] && curve->value[i] <= curve->high[i]) ++inside;
    constexpr int kMost = 950;  // the model is near the median of its replicates
    EXPECT_GT(inside, kMost);
  }
}

TEST(Prediction, IsTheSameBitsOnAnyNumberOfThreads) {
  PredictOptions options = at({"40km/h..60km/h:3"});
  options.jobs = 1;
  const SpeedPrediction alone = predict(identified().basis, options);
  options.jobs = 3;
  const SpeedPrediction together = predict(identified().basis, options);
  for (std::size_t i = 0; i < alone.speeds.size(); ++i)
    for (const MetricField& field : kMetricFields) {
      if (std::isnan(alone.speeds[i].low.*field.member)) continue;
      EXPECT_EQ(alone.speeds[i].low.*field.member, together.speeds[i].low.*field.member) << field.name;
      EXPECT_EQ(alone.speeds[i].high.*field.member, together.speeds[i].high.*field.member) << field.name;
    }
}

TEST(ModelFile, KeepsWhatPredictionsRestOn) {
  const Identified& all = identified();
  const test::TempDir folder;
  const std::string path = folder.file("model.json", format_model(all.fit.model, &all.fit, nullptr, &all.errors));
  const PredictionBasis read = read_prediction_basis(path);
  ASSERT_EQ(read.tests.size(), all.fit.tests.size());
  EXPECT_EQ(read.tests[2].impact_speed_mps, all.fit.tests[2].impact_speed_mps);
  EXPECT_EQ(read.tests[2].max_crush_m, all.fit.tests[2].max_crush_m);
  EXPECT_EQ(read.verdict.identifiable, all.fit.verdict.identifiable);
  EXPECT_EQ(read.level, all.errors.level);
  EXPECT_EQ(replicate_count(read.replicates), replicate_count(all.errors.replicates));
  constexpr double kNineDigits = 1e-8;
  const RowMatrix& written = all.errors.replicates.damper_ordinates;
  EXPECT_LT((read.replicates.damper_ordinates - written).cwiseAbs().maxCoeff(), kNineDigits * written.maxCoeff());
  const SpeedPrediction now = predict(all.basis, at({"48km/h"})), later = predict(read, at({"48km/h"}));
  EXPECT_NEAR(now.speeds[0].high.max_crush_m, later.speeds[0].high.max_crush_m, kNineDigits);
  EXPECT_EQ(now.message, later.message);
  EXPECT_EQ(read_model(path).spring, all.fit.model.spring);  // still a model like any other
}

TEST(ModelFile, ThatDoesNotFitItsReplicatesIsRefused) {
  const test::TempDir folder;
  const std::string model = R"({"format": "crashsim.crush_model", "version": 1, "mass_kg": 1500,
    "spring": {"knots_m": [0, 0.5], "ordinates_n_per_m": [4e5, 5e5]}, "uncertainty": )";
  const auto refusal = [&](const std::string& uncertainty) {
    const std::string path = folder.file("model.json", model + uncertainty + "}");
    return test::refusal_of([&] { static_cast<void>(read_prediction_basis(path)); });
  };
  EXPECT_THAT(refusal(R"({"replicates": {"spring_ordinates": [[4e5, 5e5], [4e5]]}})"),
              HasSubstr("uncertainty: replicates: spring_ordinates[1]: has 1 numbers: the model's curve has 2 knots"));
  EXPECT_THAT(refusal(R"({"replicates": {"springs": []}})"),
              HasSubstr("uncertainty: replicates: unknown name 'springs' (known: spring_ordinates, "));
  EXPECT_THAT(refusal(R"({"level": 2})"), HasSubstr("uncertainty: level = 2: must be > 0 and < 1"));
  EXPECT_THAT(refusal(R"({"replicates": {"spring_ordinates": 3}})"), HasSubstr("spring_ordinates: must be a list"));
  EXPECT_EQ(refusal("{}"), "");
}

TEST(PredictionFile, HasARowASpeedAndABandAMetric) {
  const SpeedPrediction prediction = predict(identified().basis, at({"48km/h", "90km/h"}));
  const std::string text = format_prediction(prediction, {});
  EXPECT_THAT(text, HasSubstr("\nimpact_speed_mps,outcome,extrapolated,without_max_crush,t_m_s,t_m_s_low,t_m_s_high,"
                              "max_crush_m,max_crush_m_low,max_crush_m_high,"));
  EXPECT_THAT(text, HasSubstr("\n25,completed,1,0,"));
  EXPECT_THAT(text, HasSubstr("# at_25_mps = faster than the speeds identified"));
  const std::string json = prediction_json(prediction);
  EXPECT_THAT(json, HasSubstr("\"olc_g_high\": "));
}

}  // namespace
}  // namespace crashsim
