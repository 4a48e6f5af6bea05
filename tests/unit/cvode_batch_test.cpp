/// CVODE with many models as one problem, against CVODE one by one.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/simulate_many.hpp>

#include "solver/cvode_batch.hpp"
#include "support/crush_cases.hpp"
#include "support/many_models.hpp"

namespace crashsim {
namespace {

constexpr double kUsual = 1e-6;  // of each channel's maximum at rtol 1e-8, for 90 % of models
constexpr double kWorst = 1e-4;  // for all of them
constexpr double kEvents = 3e-6;
constexpr double kSteep =
    3e-5;  // where acceleration changes within a millisecond: by the error of t_m, which is larger

SimulateManyOptions options_of(ManyIntegrator integrator, double rtol = 1e-8) {
  SimulateManyOptions options;
  options.integrator = integrator;
  options.end_time_s = 0.12;
  options.rtol = rtol;
  return options;
}

CrushResponses run(const CrushModels& models, ManyIntegrator integrator, double rtol = 1e-8) {
  return simulate_many(models, options_of(integrator, rtol));
}

/// Largest difference in a row, by the reference's largest value or by `least`; infinite where only one is a number.
double difference(const RowMatrix& rows, const RowMatrix& reference, Eigen::Index row, double least) {
  double size = least, worst = 0.0;
  for (Eigen::Index i = 0; i < reference.cols(); ++i) {
    const double expected = reference(row, i), is = rows(row, i);
    if (std::isnan(expected) != std::isnan(is)) return std::numeric_limits<double>::infinity();
    if (std::isnan(expected)) continue;
    size = std::max(size, std::fabs(expected));
    worst = std::max(worst, std::fabs(is - expected));
  }
  return worst / size;
}

std::vector<double> differences(const CrushResponses& is, const CrushResponses& expected) {
  std::vector<double> all;
  for (Eigen::Index i = 0; i < expected.displacement_m.rows(); ++i)
    all.push_back(std::max({difference(is.displacement_m, expected.displacement_m, i, 0.1),
                            difference(is.velocity_mps, expected.velocity_mps, i, 1.0),
                            difference(is.accel_mps2, expected.accel_mps2, i, 1.0)}));
  return all;
}

double ninetieth_percentile(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() * 9 / 10];
}

void expect_near_or_unset(double is, double expected, double tolerance, const std::string& what) {
  EXPECT_EQ(std::isnan(is), std::isnan(expected)) << what;
  if (!std::isnan(expected)) {
    EXPECT_NEAR(is, expected, tolerance) << what;
  }
}

TEST(CvodeBatch, AgreesWithCvodeOneByOne) {
  std::vector<double> all;
  bool has_plastic = false, has_bilateral = false, has_force_law = false, has_linear = false;
  for (std::uint64_t family = 1; family <= 8; ++family) {
    const CrushModels models = test::random_family(family, 70);
    const CrushModel& common = models.common;
    has_plastic |= common.unloading.kind == UnloadingKind::plastic;
    has_bilateral |= common.unloading.bilateral;
    has_force_law |= common.law == CrushLaw::force;
    has_linear |= common.extrapolation == Extrapolation::linear;
    const CrushResponses batch = run(models, ManyIntegrator::cvode_batch);
    const CrushResponses record = run(models, ManyIntegrator::cvode);
    EXPECT_EQ(batch.outcome, record.outcome) << "family " << family;
    const std::vector<double> here = differences(batch, record);
    all.insert(all.end(), here.begin(), here.end());
    for (std::size_t i = 0; i < models.count(); ++i) {
      const std::string which = "family " + std::to_string(family) + ", model " + std::to_string(i);
      const Metrics &is = batch.metrics[i], &expected = record.metrics[i];
      expect_near_or_unset(is.t_m_s, expected.t_m_s, kWorst * 0.12, "t_m of " + which);
      expect_near_or_unset(is.max_crush_m, expected.max_crush_m, kWorst, "maximum crush of " + which);
      expect_near_or_unset(is.static_crush_m, expected.static_crush_m, kWorst, "static crush of " + which);
      expect_near_or_unset(is.rebound_velocity_mps, expected.rebound_velocity_mps, kWorst * 15.0,
                           "rebound velocity of " + which);
    }
  }
  EXPECT_TRUE(has_plastic && has_bilateral && has_force_law && has_linear) << "too few kinds of families";
  EXPECT_LE(ninetieth_percentile(all), kUsual);
  EXPECT_LE(*std::max_element(all.begin(), all.end()), kWorst);
}

TEST(CvodeBatch, AgreesWithCvodeOneByOneWhereDampingFollowsTheCrush) {
  std::vector<double> all;
  for (std::uint64_t family = 1; family <= 6; ++family) {
    const CrushModels models = test::random_family_of(CrushLaw::crush_damping, family, 70);
    const CrushResponses batch = run(models, ManyIntegrator::cvode_batch);
    const CrushResponses record = run(models, ManyIntegrator::cvode);
    EXPECT_EQ(batch.outcome, record.outcome) << "family " << family;
    const std::vector<double> here = differences(batch, record);
    all.insert(all.end(), here.begin(), here.end());
  }
  EXPECT_LE(ninetieth_percentile(all), kUsual);
  EXPECT_LE(*std::max_element(all.begin(), all.end()), kWorst);
}

TEST(CvodeBatch, LeavesTheLawRateToCvodeAlone) {
  const CrushModels models = test::random_family_of(CrushLaw::rate, 3, 5);
  for (const double error : differences(run(models, ManyIntegrator::cvode_batch), run(models, ManyIntegrator::cvode)))
    EXPECT_EQ(error, 0.0);
}

TEST(CvodeBatch, FollowsItsTolerance) {
  CrushModels models = test::random_family(12, 64);
  const CrushResponses record = run(models, ManyIntegrator::cvode, 1e-10);
  const double coarse = ninetieth_percentile(differences(run(models, ManyIntegrator::cvode_batch, 1e-6), record));
  const double fine = ninetieth_percentile(differences(run(models, ManyIntegrator::cvode_batch, 1e-10), record));
  EXPECT_LE(coarse, 1e-4);
  EXPECT_LE(fine, 1e-7);
}

/// Plastic SYN_B at several restitutions and stiffnesses.
CrushModels plastic_models() {
  CrushModels models;
  models.common = test::syn_b();
  models.common.unloading.kind = UnloadingKind::plastic;
  models.restitution = {0.0, 0.01, 0.1, 0.2, 0.3};
  return models;
}

TEST(CvodeBatch, UnloadsPlasticallyInClosedForm) {
  const CrushModels models = plastic_models();
  const CrushResponses batch = run(models, ManyIntegrator::cvode_batch);
  const CrushResponses record = run(models, ManyIntegrator::cvode);
  const double speed = models.common.impact_speed_mps;
  for (std::size_t i = 0; i < models.count(); ++i) {
    const Metrics& metrics = batch.metrics[i];
    EXPECT_EQ(batch.outcome[i], CrushOutcome::completed);
    EXPECT_NEAR(metrics.restitution, models.restitution[i], 1e-12);
    const double returned = models.restitution[i] * speed;
    const double force = spring_force(models.common, metrics.max_crush_m);
    EXPECT_NEAR(metrics.static_crush_m, metrics.max_crush_m - returned * returned * models.common.mass_kg / force,
                1e-12);
    EXPECT_NEAR(metrics.t_m_s, record.metrics[i].t_m_s, kEvents * record.metrics[i].t_m_s);
  }
  for (const double error : differences(batch, record)) EXPECT_LE(error, kSteep);
}

TEST(CvodeBatch, SwingsOnTheReturnLineWhereTheBarrierPulls) {
  CrushModels models = plastic_models();
  models.common.unloading.bilateral = true;
  const CrushResponses batch = run(models, ManyIntegrator::cvode_batch);
  const CrushResponses record = run(models, ManyIntegrator::cvode);
  for (const double error : differences(batch, record)) EXPECT_LE(error, kSteep);
  EXPECT_TRUE(std::isnan(batch.metrics[2].static_crush_m)) << "never out of contact";
}

TEST(CvodeBatch, AMotionThatBreaksOffLeavesTheOthersAlone) {
  CrushModels models;
  models.common = test::syn_a();
  models.common.extrapolation = Extrapolation::error;
  models.mass_kg = {2582.0, 9000.0, 2400.0};  // the second one crushes beyond the last knot
  const CrushResponses batch = run(models, ManyIntegrator::cvode_batch);
  const CrushResponses record = run(models, ManyIntegrator::cvode);
  EXPECT_EQ(batch.outcome, record.outcome);
  EXPECT_EQ(batch.outcome[1], CrushOutcome::left_knot_range);
  for (const double error : differences(batch, record)) EXPECT_LE(error, kEvents);
  EXPECT_TRUE(std::isnan(batch.displacement_m(1, batch.displacement_m.cols() - 1)));
}

TEST(CvodeBatch, EndsWhereTheReturnLineIsTooSoft) {
  CrushModels models = plastic_models();
  models.common.law = CrushLaw::force;
  models.common.spring = {{0.0}, {5e5}};
  models.restitution = {0.1, 1.0};
  const CrushResponses batch = run(models, ManyIntegrator::cvode_batch);
  EXPECT_EQ(batch.outcome[0], CrushOutcome::completed);
  EXPECT_EQ(batch.outcome[1], CrushOutcome::unloading_too_soft);
  EXPECT_TRUE(std::isnan(batch.velocity_mps(1, batch.velocity_mps.cols() - 1)));
}

TEST(CvodeBatch, LeavesMotionsWithoutBoundToCvodeAlone) {
  CrushModels models;
  models.common = test::syn_b();
  models.common.extrapolation = Extrapolation::linear;
  models.common.unloading.bilateral = true;
  models.common.spring = {{0.0, 0.3, 0.31}, {1e6, 1e6, 0.0}};  // then a spring that pushes on
  models.mass_kg = {300.0, 2582.0, 350.0};
  const CrushResponses batch = run(models, ManyIntegrator::cvode_batch);
  const CrushResponses record = run(models, ManyIntegrator::cvode);
  EXPECT_EQ(batch.outcome, record.outcome);
  EXPECT_EQ(batch.outcome[0], CrushOutcome::completed);
  EXPECT_NE(batch.outcome[1], CrushOutcome::completed);
  const std::vector<double> errors = differences(batch, record);
  EXPECT_LE(errors[0], kEvents);
  EXPECT_EQ(errors[1], 0.0) << "the record's own numbers";
}

TEST(CvodeBatch, LeavesForcesThatJumpInContactToCvodeAlone) {
  CrushModels models;
  models.common = test::kelvin_model(1500.0, 4e5, 2e3, 12.0);
  models.common.law = CrushLaw::force;
  models.common.unloading.bilateral = true;
  models.mass_kg = {1400.0, 1500.0};
  for (const double error : differences(run(models, ManyIntegrator::cvode_batch), run(models, ManyIntegrator::cvode)))
    EXPECT_EQ(error, 0.0);
}

TEST(CvodeBatch, GivesMetricsWithoutKeepingTheMotions) {
  const CrushModels models = test::random_family(2, 70);
  SimulateManyOptions options = options_of(ManyIntegrator::cvode_batch);
  const CrushResponses kept = simulate_many(models, options);
  options.samples = false;
  const CrushResponses events = simulate_many(models, options);
  options.metrics = ManyMetrics::all;
  const CrushResponses all = simulate_many(models, options);
  EXPECT_EQ(events.displacement_m.size(), 0);
  for (std::size_t i = 0; i < models.count(); ++i) {
    expect_near_or_unset(events.metrics[i].max_crush_m, kept.metrics[i].max_crush_m, 0.0, std::to_string(i));
    expect_near_or_unset(all.metrics[i].max_crush_m, kept.metrics[i].max_crush_m, 0.0, std::to_string(i));
  }
  EXPECT_FALSE(std::isnan(all.metrics[0].olc_g));
}

TEST(CvodeBatch, TakesAnyOutputTimes) {
  const CrushModels models = test::random_family(8, 5);
  SimulateManyOptions options = options_of(ManyIntegrator::cvode_batch);
  for (const std::vector<double>& times : {std::vector<double>{0.01, 0.013, 0.08}, {0.0, 0.09}, {0.05}}) {
    options.times_s = times;
    const CrushResponses batch = simulate_many(models, options);
    options.integrator = ManyIntegrator::taylor;
    const CrushResponses taylor = simulate_many(models, options);
    options.integrator = ManyIntegrator::cvode_batch;
    EXPECT_EQ(batch.outcome, taylor.outcome);
    for (const double error : differences(batch, taylor)) EXPECT_LE(error, kWorst);
  }
}

/// Accelerations of a block of models.
std::vector<double> accelerations(const CrushModels& models, InstructionSet set) {
  std::vector<double> times;
  for (int i = 0; i <= 120; ++i) times.push_back(1e-3 * i);
  const std::size_t n = times.size(), count = models.count();
  std::vector<double> accel(count * n), velocity(count * n), displacement(count * n);
  CvodeBatch batch(times, 1e-8, set);
  std::vector<std::size_t> alone;
  batch.run({count,
             [&](std::size_t i, LaneModel& lane) {
               const CrushModel model = models.model(i);
               lane = {make_force(model), model.mass_kg, model.impact_speed_mps, model.unloading};
             },
             [&](std::size_t i) {
               return LaneRow{&accel[i * n], &velocity[i * n], &displacement[i * n]};
             },
             [](std::size_t, const MotionSummary&) {}},
            alone);
  EXPECT_TRUE(alone.empty());
  return accel;
}

class CvodeBatchOn : public testing::TestWithParam<InstructionSet> {};
INSTANTIATE_TEST_SUITE_P(InstructionSets, CvodeBatchOn, testing::Values(InstructionSet::avx2, InstructionSet::avx512),
                         [](const auto& set) { return set.param == InstructionSet::avx2 ? "Avx2" : "Avx512"; });

TEST_P(CvodeBatchOn, GivesTheBitsOfTheBaseline) {
  if (!is_available(GetParam())) GTEST_SKIP() << "this processor does not have it";
  std::vector<CrushModels> families = {test::random_family(1, kBatch - 3), test::random_family(8, kBatch - 3)};
  families.push_back(test::random_family_of(CrushLaw::crush_damping, 2, kBatch - 3));
  for (const CrushModels& models : families) {
    const std::vector<double> baseline = accelerations(models, InstructionSet::baseline);
    const std::vector<double> wide = accelerations(models, GetParam());
    EXPECT_EQ(std::memcmp(baseline.data(), wide.data(), baseline.size() * sizeof(double)), 0)
        << "law " << name_of(models.common.law);
  }
}

}  // namespace
}  // namespace crashsim
