#include <crashsim/simulate_many.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/summary.hpp>

#include "support/crush_cases.hpp"
#include "support/many_models.hpp"

namespace crashsim {
namespace {

using testing::HasSubstr;

constexpr double kSolver = 1e-7;    // solver: relative, 10 times the default rtol
constexpr double kSampling = 1e-5;  // what metrics make of samples that differ by the solver's error

/// SYN_A at three masses.
CrushModels three_masses() {
  CrushModels models;
  models.common = test::syn_a();
  models.mass_kg = {2000.0, 2582.0, 3000.0};
  return models;
}

template <class F>
std::string refusal_of(F f) {
  try {
    f();
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "nothing was refused";
}

TEST(SimulateMany, GivesWhatSimulateGives) {
  const CrushModels models = three_masses();
  const CrushResponses many = simulate_many(models);
  ASSERT_EQ(many.outcome.size(), 3u);
  ASSERT_EQ(many.displacement_m.rows(), 3);
  EXPECT_EQ(many.completed(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const CrushResponse one = simulate(models.model(i));
    ASSERT_EQ(static_cast<std::size_t>(many.displacement_m.cols()), one.time_s.size());
    EXPECT_EQ(many.time_s, one.time_s);
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t j = 0; j < one.time_s.size(); j += 50) {
      const auto column = static_cast<Eigen::Index>(j);
      EXPECT_NEAR(many.displacement_m(row, column), one.displacement_m[j], kSolver);
      EXPECT_NEAR(many.velocity_mps(row, column), one.velocity_mps[j], kSolver * one.impact_speed_mps);
      EXPECT_NEAR(many.accel_mps2(row, column), one.accel_mps2[j], kSolver * 1e3);
    }
    EXPECT_NEAR(many.metrics[i].t_m_s, one.t_m_s, kSolver * one.t_m_s);
    EXPECT_NEAR(many.metrics[i].max_crush_m, one.max_crush_m, kSolver);
    EXPECT_NEAR(many.metrics[i].static_crush_m, one.static_crush_m, kSolver);
    EXPECT_TRUE(std::isnan(many.metrics[i].olc_g)) << "not asked for";
  }
}

TEST(SimulateMany, GivesEveryMetricWithoutKeepingTheMotions) {
  CrushModels models = three_masses();
  SimulateManyOptions options;
  options.samples = false;
  options.metrics = ManyMetrics::all;
  const CrushResponses many = simulate_many(models, options);
  EXPECT_EQ(many.displacement_m.size(), 0);
  for (std::size_t i = 0; i < 3; ++i) {
    const CrushModel model = models.model(i);
    const Metrics expected = metrics_of(simulate(model), model.mass_kg);
    for (const MetricField& field : kMetricFields)
      EXPECT_NEAR(many.metrics[i].*field.member, expected.*field.member, kSampling * std::fabs(expected.*field.member))
          << field.name;
  }
}

TEST(SimulateMany, TakesTheRecordIntegrator) {
  const CrushModels models = test::random_family(3, 20);
  SimulateManyOptions options;
  options.integrator = ManyIntegrator::cvode;
  const CrushResponses cvode = simulate_many(models, options), taylor = simulate_many(models);
  for (std::size_t i = 0; i < models.count(); ++i) {
    EXPECT_EQ(cvode.outcome[i], taylor.outcome[i]) << i;
    if (cvode.outcome[i] == CrushOutcome::completed) {
      EXPECT_NEAR(cvode.metrics[i].max_crush_m, taylor.metrics[i].max_crush_m, kSolver) << i;
    }
  }
}

TEST(SimulateMany, VariesKnotsSpeedsAndRestitution) {
  CrushModels models;
  models.common = test::syn_b();
  models.common.unloading.kind = UnloadingKind::plastic;
  models.restitution = {0.1, 0.2};
  models.impact_speed_mps = {10.0, 15.0};
  models.spring_knots.resize(2, 7);
  models.spring_knots << 0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.0, 0.2, 0.3, 0.4, 0.5, 0.7, 0.9;
  const CrushResponses many = simulate_many(models);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(many.outcome[i], CrushOutcome::completed);
    EXPECT_NEAR(many.metrics[i].restitution, models.restitution[i], kSolver);
    EXPECT_NEAR(many.metrics[i].max_crush_m, simulate(models.model(i)).max_crush_m, kSolver);
  }
}

TEST(SimulateMany, MarksTheRestOfAMotionThatBrokeOff) {
  CrushModels models = three_masses();
  models.common.extrapolation = Extrapolation::error;
  models.mass_kg = {2582.0, 9000.0, 2582.0};  // the second one crushes beyond the last knot
  const CrushResponses many = simulate_many(models);
  EXPECT_EQ(many.outcome[1], CrushOutcome::left_knot_range);
  EXPECT_EQ(many.completed(), 2u);
  EXPECT_EQ(many.displacement_m(1, 0), 0.0);
  EXPECT_TRUE(std::isnan(many.displacement_m(1, many.displacement_m.cols() - 1)));
  EXPECT_TRUE(std::isnan(many.metrics[1].max_crush_m));
  EXPECT_TRUE(many.displacement_m.row(2).allFinite());
}

TEST(SimulateMany, OneModelWithoutArrays) {
  CrushModels models;
  models.common = test::syn_a();
  EXPECT_EQ(models.count(), 1u);
  EXPECT_NEAR(simulate_many(models).metrics[0].t_m_s, 0.072105196, 1e-8);  // the oracle's
}

TEST(SimulateMany, UsesTheMemoryOfEarlierResponses) {
  const CrushModels models = three_masses();
  CrushResponses out;
  simulate_many(models, {}, out);
  const double* const memory = out.displacement_m.data();
  const RowMatrix first = out.displacement_m;
  simulate_many(models, {}, out);
  EXPECT_EQ(out.displacement_m.data(), memory);
  EXPECT_EQ(out.displacement_m, first);
}

TEST(SimulateMany, RefusesWhatDoesNotFit) {
  CrushModels models = three_masses();
  models.impact_speed_mps = {10.0, 15.0};
  EXPECT_EQ(refusal_of([&] { simulate_many(models); }),
            "CrushModels.impact_speed_mps has 2 entries, but mass_kg has 3: give every array one a model");
  models = three_masses();
  models.spring_ordinates = RowMatrix::Constant(3, 5, 1e5);
  EXPECT_EQ(refusal_of([&] { simulate_many(models); }),
            "CrushModels.spring_ordinates has 5 columns, but common.spring has 7 knots: give one a knot");
  models = three_masses();
  models.mass_kg[1] = -1.0;
  EXPECT_EQ(refusal_of([&] { simulate_many(models); }), "model 1 of 3: CrushModel.mass_kg = -1 kg: must be > 0");
  models = three_masses();
  models.common.impact_speed_mps = kUnset;
  EXPECT_THAT(refusal_of([&] { simulate_many(models); }), HasSubstr("give CrushModels.impact_speed_mps"));
  models = three_masses();
  models.restitution = {0.1, 0.1, 0.1};
  EXPECT_THAT(refusal_of([&] { simulate_many(models); }), HasSubstr("model 0 of 3: CrushModel.unloading.restitution"));
  EXPECT_THAT(refusal_of([] { return three_masses().model(3); }), HasSubstr("3 is not below 3"));
  SimulateManyOptions options;
  options.times_s = {0.0, 0.1, 0.1};
  EXPECT_THAT(refusal_of([&] { simulate_many(three_masses(), options); }),
              HasSubstr("SimulateManyOptions.times_s[2] = 0.1 s: times must be finite and increase"));
}

}  // namespace
}  // namespace crashsim
