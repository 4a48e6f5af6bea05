#include <crashsim/summary.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <crashsim/units.hpp>

namespace crashsim {
namespace {

using testing::ElementsAre;
using testing::IsNan;

CrushModel spring_of(double stiffness_n_per_m) {
  CrushModel model;
  model.mass_kg = 1500.0;
  model.impact_speed_mps = 15.0;
  model.spring = {{0.0}, {stiffness_n_per_m}};
  return model;
}

std::vector<std::string> names_of(const Summary& summary) {
  std::vector<std::string> names;
  for (const SummaryItem& item : summary) names.push_back(item.name);
  return names;
}

/// The numbers that scripts rely on, word for word.
const std::vector<std::string> kContract = {"t_m_s",
                                            "max_crush_m",
                                            "static_crush_m",
                                            "peak_decel_g",
                                            "mean_decel_g",
                                            "delta_v_mps",
                                            "rebound_velocity_mps",
                                            "restitution",
                                            "centroid_s",
                                            "olc_g",
                                            "sm10_g",
                                            "sm25_g",
                                            "sm38_g",
                                            "sm50_g",
                                            "asi",
                                            "vpi_g",
                                            "kw400_n_per_m",
                                            "energy_j"};

TEST(Summarize, NamesAreThoseThatScriptsRelyOn) {
  std::vector<std::string> expected = {"outcome", "mass_kg", "impact_speed_mps"};
  expected.insert(expected.end(), kContract.begin(), kContract.end());
  EXPECT_EQ(names_of(summarize(simulate(spring_of(1e6)), 1500.0)), expected);
  std::vector<double> times, accel;
  for (int i = 0; i < 20; ++i) times.push_back(0.01 * i), accel.push_back(-100.0);
  EXPECT_EQ(names_of(summarize(make_pulse(times, accel, 15.0))), expected);
}

TEST(Summarize, NumbersOfASimulationAreThoseOfItsEvents) {
  const CrushResponse response = simulate(spring_of(1e6));
  const Metrics m = metrics_of(response, 1500.0);
  EXPECT_EQ(m.t_m_s, response.t_m_s);
  EXPECT_EQ(m.max_crush_m, response.max_crush_m);
  EXPECT_EQ(m.static_crush_m, response.static_crush_m);
  EXPECT_EQ(m.rebound_velocity_mps, response.rebound_velocity_mps);
  EXPECT_EQ(m.restitution, -response.rebound_velocity_mps / 15.0);
  EXPECT_EQ(m.centroid_s, response.max_crush_m / 15.0);
  EXPECT_EQ(m.mean_decel_g, 15.0 / response.t_m_s / kStandardGravity);
  EXPECT_EQ(m.energy_j, 0.5 * 1500.0 * 15.0 * 15.0);
}

TEST(Summarize, AReboundOfNothingHasRestitution0) {
  CrushModel model = spring_of(1e6);
  model.unloading.kind = UnloadingKind::plastic;
  model.unloading.restitution = 0.0;
  const Metrics m = metrics_of(simulate(model), 1500.0);
  EXPECT_EQ(m.restitution, 0.0);
  EXPECT_FALSE(std::signbit(m.restitution));
  EXPECT_EQ(m.static_crush_m, m.max_crush_m);
}

/// The last sample is the maximum crush itself, where sampled velocity may not quite have reached zero.
TEST(Summarize, ASimulationToMaximumCrushHasAllNumbersOfIt) {
  SimulateOptions options;
  options.to_max_crush = true;
  const Metrics m = metrics_of(simulate(spring_of(1e6), options), 1500.0);
  for (const double number : {m.t_m_s, m.max_crush_m, m.mean_decel_g, m.centroid_s, m.energy_j})
    EXPECT_THAT(number, testing::Not(IsNan()));
  EXPECT_THAT(m.restitution, IsNan());
}

TEST(Summarize, FewSamplesLeaveTheEventsNumbers) {
  SimulateOptions options;
  options.dt_s = 1.0;
  const Metrics m = metrics_of(simulate(spring_of(1e6), options), 1500.0);
  EXPECT_THAT(m.max_crush_m, testing::Not(IsNan()));
  EXPECT_THAT(m.peak_decel_g, IsNan());
}

TEST(Summarize, ASimulationThatBrokeOffHasNoNumbers) {
  CrushModel model = spring_of(1e6);
  model.spring = {{0.0, 0.1}, {1e6, 1e6}};
  model.extrapolation = Extrapolation::error;
  const CrushResponse response = simulate(model);
  ASSERT_EQ(response.outcome, CrushOutcome::left_knot_range);
  const Metrics m = metrics_of(response, 1500.0);
  for (const MetricField& field : kMetricFields) EXPECT_THAT(m.*field.member, IsNan()) << field.name;
  EXPECT_EQ(std::get<std::string>(summarize(response, 1500.0)[0].value), "left_knot_range");
}

TEST(Summarize, ARunThatWasNotRunHasNoNumbers) {
  const Metrics m = metrics_of(CrushResponse(), 1500.0);
  for (const MetricField& field : kMetricFields) EXPECT_THAT(m.*field.member, IsNan()) << field.name;
}

TEST(Summarize, TellsOfAnIdentification) {
  Identification fit;
  fit.outcome = IdentifyOutcome::interrupted;
  fit.starts.resize(3);
  fit.starts_at_best = 2;
  const auto json = nlohmann::json::parse(format_summary(summarize(fit)));
  EXPECT_EQ(json["outcome"], "interrupted");
  EXPECT_EQ(json["starts"], 3);
  EXPECT_EQ(json["starts_at_best"], 2);
  EXPECT_EQ(json["identifiable"], false);
  EXPECT_TRUE(json["error"].is_null());
  EXPECT_TRUE(json["seconds"].is_null());
}

TEST(FormatSummary, WritesEveryKindAndParts) {
  const Summary summary = {{"a", 0.1, ""},
                           {"b", kUnset, ""},
                           {"c", std::int64_t{3}, ""},
                           {"d", true, ""},
                           {"e", std::string("caf\xe9"), ""}};
  const auto json = nlohmann::ordered_json::parse(format_summary(summary, {{"part", {{"x", 1.0, ""}}}}));
  EXPECT_EQ(json["a"], 0.1);
  EXPECT_TRUE(json["b"].is_null());
  EXPECT_EQ(json["c"], 3);
  EXPECT_EQ(json["d"], true);
  EXPECT_EQ(json["e"], "caf\xef\xbf\xbd");
  EXPECT_EQ(json["part"]["x"], 1.0);
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  EXPECT_THAT(keys, ElementsAre("a", "b", "c", "d", "e", "part"));
}

}  // namespace
}  // namespace crashsim
