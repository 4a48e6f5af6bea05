/// Choice between crush models.

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/select_model.hpp>
#include <crashsim/simulate.hpp>

#include "select_candidates.hpp"
#include "support/fit_cases.hpp"

namespace crashsim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kRounding = 1e-12;  // relative, of a few operations on doubles
constexpr double kEngines = 1e-6;    // solver: between CVODE at its default tolerance and the Taylor kernel

/// A front whose force and damping both grow with crush: law `crush_damping`, exactly.
CrushModel crush_damped_car() {
  CrushModel car;
  car.mass_kg = 1400.0;
  car.law = CrushLaw::crush_damping;
  car.spring = {{0.0, 1.2}, {80e3, 420e3}};
  car.damper = {{0.0, 1.2}, {1e3, 25e3}};
  return car;
}

std::vector<Pulse> pulses_of(const CrushModel& car, const std::vector<double>& speeds_mps) {
  std::vector<Pulse> pulses;
  for (const double speed : speeds_mps) pulses.push_back(test::pulse_of(car, speed).value());
  return pulses;
}

std::vector<Pulse> three_tests() { return pulses_of(crush_damped_car(), {9.0, 12.0, 15.0}); }

SelectOptions quick() {
  SelectOptions options;
  options.method = IdentifyMethod::equation_error;
  options.spring_knots = {5};
  options.damper_knots = {0, 5};
  return options;
}

const SelectionRow& row_named(const Selection& selection, const std::string& name) {
  for (const SelectionRow& row : selection.rows)
    if (row.name == name) return row;
  throw std::out_of_range(name);
}

void expect_refused(const std::function<void()>& call, const char* reason) {
  try {
    call();
    ADD_FAILURE() << "not refused: " << reason;
  } catch (const InvalidInput& refusal) {
    EXPECT_THAT(refusal.what(), HasSubstr(reason));
  }
}

std::vector<std::string> names_of(const std::vector<SelectionRow>& rows) {
  std::vector<std::string> names;
  for (const SelectionRow& row : rows) names.push_back(row.name);
  return names;
}

TEST(Candidates, AreEveryCombinationOnce) {
  SelectOptions options;
  options.spring_knots = {0, 5};
  options.damper_knots = {0, 1, 4};
  EXPECT_THAT(names_of(candidates_of(options)),
              ElementsAre("stiffness 0+1", "stiffness 0+4", "stiffness 5+0", "stiffness 5+1", "stiffness 5+4",
                          "force 5+0", "force 5+1", "force 5+4", "crush_damping 0+4", "crush_damping 5+4", "rate 5+0"));
}

TEST(Candidates, NameTheirPlacementAndCurve) {
  SelectOptions options;
  options.laws = {"force"};
  options.spring_knots = {2, 5};
  options.damper_knots = {0};
  options.placements = {"uniform", "quantile"};
  options.curves = {"linear", "pchip"};
  EXPECT_THAT(names_of(candidates_of(options)), ElementsAre("force 2+0", "force 5+0", "force 5+0 pchip",
                                                            "force 5+0 quantile", "force 5+0 quantile pchip"));
}

TEST(Candidates, AreRefusedWithAReason) {
  const auto refuse = [](auto change, const char* reason) {
    SelectOptions options;
    change(options);
    expect_refused([&] { select_model(three_tests(), options); }, reason);
  };
  refuse([](SelectOptions& o) { o.laws = {"stiffnes"}; }, "SelectOptions.laws");
  refuse([](SelectOptions& o) { o.laws = {}; },
         "SelectOptions.laws: none given: name at least one of stiffness, force");
  refuse([](SelectOptions& o) { o.damper_knots = {2.5}; },
         "SelectOptions.damper_knots = 2.5: must be whole numbers of 0..100");
  refuse([](SelectOptions& o) { o.placements = {"given"}; }, "use uniform, quantile or free");
  refuse([](SelectOptions& o) { o.spring_knots = o.damper_knots = {0}; }, "no candidate has a force");
  expect_refused([] { select_model({}); }, "no pulse given");
}

TEST(Selection, OfSeveralTestsFindsTheLawThatMadeThem) {
  constexpr double kPredicted = 0.01;  // solver: the fit's knots end at the crush of the tests it was given
  const Selection selection = select_model(three_tests(), quick());
  ASSERT_TRUE(selection.usable()) << selection.brief_report();
  EXPECT_EQ(selection.rows.front().law, CrushLaw::crush_damping);
  ASSERT_NE(selection.recommended(), nullptr);
  EXPECT_EQ(selection.recommended()->name, "crush_damping 5+5");
  const LeftOutTest& middle = selection.recommended()->left_out[1];
  EXPECT_LT(std::fabs(middle.max_crush_error), kPredicted);
  EXPECT_LT(std::fabs(middle.t_m_error), kPredicted);
  EXPECT_THAT(selection.brief_report(), HasSubstr("crush_damping 5+5: tests left out are predicted"));
}

/// What a row says of a test is what one finds who leaves it out by hand.
TEST(Selection, PredictsFromTheOtherTestsAlone) {
  const std::vector<Pulse> all = three_tests();
  const SelectOptions options = quick();
  const Selection selection = select_model(all, options);
  const SelectionRow& row = row_named(selection, "force 5+5");
  const std::vector<Pulse> others = {all[0], all[2]};
  CrushModel model = identify(others, identify_options_of(row, options)).model;
  SimulateOptions how;
  how.impact_speed_mps = all[1].impact_speed_mps;
  how.to_max_crush = true;
  const CrushResponse run = simulate(model, how);
  EXPECT_NEAR(row.left_out[1].max_crush_error, run.max_crush_m / all[1].max_crush_m - 1.0, kEngines);
  EXPECT_NEAR(row.left_out[1].t_m_error, run.t_m_s / all[1].t_m_s - 1.0, kEngines);
  EXPECT_NEAR(row.left_out[1].error, fit_error(model, all[1]).total, kRounding);
}

TEST(Selection, OfOneTestIsByAicc) {
  const std::vector<Pulse> one = {test::noisy_pulse(crush_damped_car(), 14.0, 0.05, 3)};
  const Selection selection = select_model(one, quick());
  ASSERT_TRUE(selection.usable()) << selection.brief_report();
  EXPECT_THAT(selection.recommendation, HasSubstr("prediction was not tested"));
  EXPECT_TRUE(selection.rows.front().recommended);
  const double n = selection.observations;
  EXPECT_GT(n, 10.0);
  EXPECT_LT(n, static_cast<double>(one.front().time_s.size()));
  double weights = 0.0;
  for (const SelectionRow& row : selection.rows) {
    EXPECT_THAT(row.left_out, IsEmpty());
    const double k = row.parameters + 1.0;
    EXPECT_NEAR(row.aicc, 2.0 * n * std::log(row.error.total) + 2.0 * k + 2.0 * k * (k + 1.0) / (n - k - 1.0),
                kRounding * n);
    EXPECT_GE(row.aicc_difference, 0.0);
    weights += row.aicc_weight;
  }
  EXPECT_NEAR(weights, 1.0, kRounding);
}

TEST(Selection, CountsAModelThatNeverStopsAsAFailure) {
  SelectOptions options = quick();
  options.laws = {"stiffness"};
  options.spring_knots = {0, 5};
  options.damper_knots = {5};
  const Selection selection = select_model(three_tests(), options);
  ASSERT_TRUE(selection.usable()) << selection.brief_report();
  const SelectionRow& dampers = selection.rows.back();
  EXPECT_EQ(dampers.name, "stiffness 0+5");
  EXPECT_EQ(dampers.failures, 3);
  EXPECT_EQ(dampers.left_out[0].t_m_error, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(dampers.left_out[0].max_crush_error));
  EXPECT_TRUE(std::isinf(dampers.prediction_error));
  EXPECT_FALSE(dampers.as_good_as_best);

  options.spring_knots = {0};
  const Selection hopeless = select_model(three_tests(), options);
  EXPECT_EQ(hopeless.outcome, SelectOutcome::nothing_usable);
  EXPECT_EQ(hopeless.recommended(), nullptr);
  EXPECT_THAT(hopeless.brief_report(), HasSubstr("no candidate reaches maximum crush in every test that was left out"));
}

TEST(Selection, KeepsACandidateThatCannotBeFittedWithItsReason) {
  Pulse coarse = test::pulse_of(crush_damped_car(), 12.0, 4e-3).value();
  SelectOptions options = quick();
  options.laws = {"force"};
  options.spring_knots = {3, 90};
  options.damper_knots = {0};
  const Selection selection = select_model({&coarse, 1}, options);
  ASSERT_TRUE(selection.usable()) << selection.brief_report();
  EXPECT_EQ(selection.rows.back().name, "force 90+0");
  EXPECT_EQ(selection.rows.back().outcome, IdentifyOutcome::every_start_failed);
  EXPECT_THAT(selection.rows.back().message, HasSubstr("use fewer knots"));
}

TEST(Selection, WithoutMaximumCrushSaysSo) {
  std::vector<Pulse> tests = three_tests();
  tests[1].t_m_s = kUnset;
  const Selection selection = select_model(tests, quick());
  EXPECT_EQ(selection.outcome, SelectOutcome::no_max_crush);
  EXPECT_THAT(selection.brief_report(), HasSubstr("never reaches zero"));
}

TEST(Selection, StoppedRecommendsNothing) {
  const Selection selection = select_model(three_tests(), quick(), [](int, int) { return false; });
  EXPECT_EQ(selection.outcome, SelectOutcome::interrupted);
  EXPECT_EQ(selection.recommended(), nullptr);
  EXPECT_THAT(selection.recommendation, IsEmpty());
}

TEST(Selection, IsTheSameOnAnyNumberOfThreads) {
  SelectOptions options = quick();
  options.method = IdentifyMethod::multistart;
  options.starts = 2;
  options.laws = {"stiffness", "force"};
  options.jobs = 1;
  const Record none;
  const std::string one = format_selection_json(select_model(three_tests(), options), none);
  options.jobs = 3;
  EXPECT_EQ(format_selection_json(select_model(three_tests(), options), none), one);
}

SelectionRow scored(const char* name, int parameters, const std::vector<double>& scores) {
  SelectionRow row;
  row.name = name;
  row.outcome = IdentifyOutcome::completed;
  row.model = crush_damped_car();
  row.error.total = 0.1;
  row.parameters = parameters;
  for (const double score : scores) {
    LeftOutTest test;
    test.predicted = true;
    test.error = score;
    test.max_crush_error = test.t_m_error = 0.0;
    row.left_out.push_back(test);
  }
  return row;
}

/// Differences to the best: (0.03, -0.01, 0.01), mean 0.01, standard error 0.02 / sqrt 3; and (0.1, 0.1, 0.11).
TEST(Selection, PrefersFewerParametersWithinOneStandardError) {
  Selection selection;
  selection.tests = 3;
  selection.rows = {scored("best", 9, {0.10, 0.14, 0.12}), scored("simple", 4, {0.13, 0.13, 0.13}),
                    scored("simplest", 2, {0.20, 0.24, 0.23})};
  judge_candidates(three_tests(), quick(), selection);
  EXPECT_THAT(names_of(selection.rows), ElementsAre("best", "simple", "simplest"));
  EXPECT_NEAR(selection.rows[1].difference_to_best, 0.01, kRounding);
  EXPECT_NEAR(selection.rows[1].difference_deviation, 0.02 / std::sqrt(3.0), kRounding);
  EXPECT_TRUE(selection.rows[1].as_good_as_best);
  EXPECT_FALSE(selection.rows[2].as_good_as_best);
  ASSERT_NE(selection.recommended(), nullptr);
  EXPECT_EQ(selection.recommended()->name, "simple");
  EXPECT_THAT(selection.recommendation, HasSubstr("fewer parameters (4) than the best, best (9, score 0.120)"));
}

TEST(Selection, InFilesHasEveryRowAndTestLeftOut) {
  const Selection selection = select_model(three_tests(), quick());
  const Record none;
  const std::string csv = format_selection_csv(selection, none);
  EXPECT_THAT(csv, HasSubstr("# recommendation = crush_damping 5+5: "));
  EXPECT_THAT(csv, HasSubstr(",test3_speed_mps,test3_error,test3_max_crush_error,test3_t_m_error\n"));
  EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), selection.rows.size() + 6);
  EXPECT_THAT(format_selection_json(selection, none), HasSubstr("\"recommended\": true"));
}

}  // namespace
}  // namespace crashsim
