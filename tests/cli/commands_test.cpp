/// Every subcommand as a user first meets it: on the project's data, with quantities that carry units.

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <crashsim/metrics.hpp>
#include <crashsim/model_io.hpp>
#include <crashsim/simulate_pitch.hpp>
#include <crashsim/trace_io.hpp>
#include <crashsim/vehicle_io.hpp>

#include "support/source_dir.hpp"
#include "support/workspace.hpp"

namespace crashsim {
namespace {

using nlohmann::json;
using test::Finished;
using test::kDone;
using test::kNumbersFailed;
using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

constexpr double kRounding = 1e-12;        // rounding: relative, of one unit conversion
constexpr double kStepsOfResponse = 1e-9;  // rounding: of a time step [s]

/// What every summary has beside its metrics.
std::vector<std::string> summary_keys() {
  std::vector<std::string> keys = {"outcome", "mass_kg", "impact_speed_mps"};
  for (const MetricField& field : kMetricFields) keys.emplace_back(field.name);
  std::sort(keys.begin(), keys.end());
  return keys;
}

std::vector<std::string> keys_of(const json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

const std::vector<std::string> kFePulse = {"pulse",        "data/fe-car/C56.csv", "--channel",
                                           "LEFT_REAR_VX", "--channel",           "RIGHT_REAR_VX"};

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

class Commands : public testing::Test {
 protected:
  /// Runs a command that must succeed.
  [[nodiscard]] Finished run(const std::vector<std::string>& arguments) const {
    Finished finished = workspace.run(arguments);
    EXPECT_EQ(finished.exit_code, kDone) << finished.err;
    return finished;
  }
  [[nodiscard]] json summary_of(const std::vector<std::string>& arguments) const {
    return json::parse(run(with(arguments, {"--json"})).out);
  }

  test::Workspace workspace;
};

TEST_F(Commands, InfoListsChannels) {
  const Finished table = run({"info", "data/fe-car/C56.csv", "data/fe-car/C40.csv", "--filter", "*REAR_VX"});
  EXPECT_THAT(table.out, AllOf(HasSubstr("data/fe-car/C56.csv: csv"), HasSubstr("data/fe-car/C40.csv: csv"),
                               HasSubstr("mass 1190.02 kg"), HasSubstr("LEFT_REAR_VX"), HasSubstr("m/s")));
  EXPECT_THAT(table.out, testing::Not(HasSubstr("LEFT_REAR_VZ")));
  const json one = json::parse(run({"info", "data/fe-car/C56.csv", "--json"}).out);
  EXPECT_EQ(one["mass_kg"], 1190.017);
  EXPECT_EQ(one["impact_speed_mps"], 15.64);
  EXPECT_THAT(keys_of(one["channels"][0]), testing::IsSupersetOf({"id", "name", "unit", "samples", "rate_hz", "first_s",
                                                                  "last_s", "min", "max", "status"}));
  EXPECT_THAT(json::parse(run({"info", "--json", "data/fe-car/C56.csv", "data/fe-car/C40.csv"}).out), SizeIs(2));
}

TEST_F(Commands, InfoOfTextThatIsNotUtf8IsJsonAllTheSame) {
  workspace.file("a.csv", "# title = caf\xe9\ntime_s,accel_g\n0,1\n1,2\n");
  EXPECT_EQ(json::parse(run({"info", "a.csv", "--json"}).out)["title"], "caf\xef\xbf\xbd");
}

TEST_F(Commands, PulseWritesMotionAndSummary) {
  const json summary = summary_of(with(kFePulse, {"-o", "pulse.csv"}));
  EXPECT_EQ(keys_of(summary), summary_keys());
  EXPECT_EQ(summary["outcome"], "completed");
  const TraceSet pulse = read_traces(workspace.path("pulse.csv"));
  ASSERT_THAT(pulse.traces, SizeIs(3));
  EXPECT_EQ(pulse.traces[0].name, "accel_mps2");
  EXPECT_EQ(pulse.traces[1].name, "velocity_mps");
  EXPECT_EQ(pulse.traces[2].name, "displacement_m");
  EXPECT_EQ(pulse.traces[0].times().front(), 0.0);
  EXPECT_EQ(pulse.traces[1].values.front(), 15.64);
  EXPECT_EQ(pulse.traces[2].values.front(), 0.0);
  EXPECT_EQ(pulse.mass_kg, 1190.017);
  EXPECT_THAT(workspace.names(), ElementsAre("pulse.csv"));
}

TEST_F(Commands, IdentifyWritesAModelThatSimulates) {
  workspace.file("trace.csv", test::half_sine_trace());
  static_cast<void>(run({"pulse", "trace.csv", "-o", "pulse.csv"}));
  const json summary = summary_of({"identify", "pulse.csv", "--starts", "3", "--spring-knots", "4", "--damper-knots",
                                   "2", "--seed", "7", "-o", "model.json"});
  EXPECT_EQ(summary["outcome"], "completed");
  EXPECT_EQ(summary["starts"], 3);
  const json model = json::parse(workspace.text_of("model.json"));
  EXPECT_EQ(model["mass_kg"], 1500.0);
  EXPECT_THAT(model["spring"]["knots_m"], SizeIs(4));
  EXPECT_THAT(model["damper"]["knots_mps"], SizeIs(2));
  EXPECT_EQ(model["identification"]["seed"], 7);
  EXPECT_EQ(model["identification"]["error"], summary["error"]);
  EXPECT_THAT(keys_of(model["identification"]),
              testing::IsSupersetOf({"error", "error_accel", "error_velocity", "error_displacement", "starts",
                                     "starts_at_best", "verdict", "standard_error", "evaluations", "seed"}));
  EXPECT_EQ(summary_of({"simulate", "model.json"})["outcome"], "completed");
}

TEST_F(Commands, SelectWritesATableAndRecommends) {
  workspace.file("a.csv", test::half_sine_trace());
  workspace.file("b.csv", test::half_sine_trace(17.0));
  const Finished finished =
      run({"select", "a.csv", "b.csv", "--method", "equation-error", "--law", "force", "--law", "stiffness",
           "--spring-knots", "5", "--damper-knots", "0,1", "-o", "selection.csv", "--json"});
  ASSERT_EQ(finished.exit_code, kDone) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("recommended: "));
  const json selection = json::parse(finished.out);
  EXPECT_EQ(selection["outcome"], "completed");
  EXPECT_THAT(selection["rows"], SizeIs(4));
  EXPECT_THAT(selection["rows"][0]["left_out"], SizeIs(2));
  const std::string csv = workspace.text_of("selection.csv");
  EXPECT_THAT(csv, HasSubstr("\nlaw,spring_knots,damper_knots,"));
  EXPECT_THAT(csv, HasSubstr(selection["recommendation"].get<std::string>()));
}

TEST_F(Commands, AnOptionTakesOneValueAndFilesMayFollow) {
  workspace.file("a.csv", test::half_sine_trace());
  workspace.file("b.csv", test::half_sine_trace(17.0));
  const Finished finished = run({"identify", "-o", "model.json", "--method", "equation-error", "a.csv", "b.csv"});
  EXPECT_THAT(finished.err, HasSubstr("identification from a.csv, b.csv: completed"));
}

TEST_F(Commands, SimulateWritesUniformSamplesToTheEnd) {
  const json summary =
      summary_of({"simulate", "data/neon-kw400/model.json", "--speed", "56km/h", "--end", "150.05ms", "-o", "r.csv"});
  EXPECT_EQ(keys_of(summary), summary_keys());
  const TraceSet response = read_traces(workspace.path("r.csv"));
  std::vector<std::string> names;
  for (const Trace& trace : response.traces) names.push_back(trace.name);
  EXPECT_THAT(names, ElementsAre("accel_mps2", "velocity_mps", "displacement_m", "spring_force_n", "damper_force_n",
                                 "energy_residual_j"));
  const auto times = response.traces[0].times();
  constexpr double kStep_s = 1e-4, kEnd_s = 0.15005;
  constexpr std::size_t kSamples = 1502;
  ASSERT_THAT(times, SizeIs(kSamples));
  EXPECT_EQ(times.front(), 0.0);
  EXPECT_NEAR(times[1], kStep_s, kStepsOfResponse);
  EXPECT_NEAR(times.back(), kEnd_s, kStepsOfResponse);
}

TEST_F(Commands, ToMaximumCrushEndsThereWithEveryNumberOfIt) {
  const json to_the_end = summary_of({"simulate", "data/syn-a/model.json", "--end", "0.2"});
  const json summary = summary_of({"simulate", "data/syn-a/model.json", "--to-max-crush", "-o", "r.csv"});
  for (const char* key : {"t_m_s", "max_crush_m", "mean_decel_g", "centroid_s", "energy_j"})
    EXPECT_EQ(summary[key], to_the_end[key]) << key;
  for (const char* key : {"static_crush_m", "rebound_velocity_mps", "restitution"})
    EXPECT_TRUE(summary[key].is_null()) << key;
  EXPECT_EQ(read_traces(workspace.path("r.csv")).traces[0].times().back(), summary["t_m_s"]);
}

TEST_F(Commands, AVeryShortSimulationIsWrittenAndIsNoSuccess) {
  const Finished finished = workspace.run({"simulate", "data/syn-a/model.json", "--end", "0.1ms", "-o", "r.csv"});
  EXPECT_EQ(finished.exit_code, kNumbersFailed) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("no_max_crush: no maximum crush: v did not reach zero within 0..0.0001 s"));
  EXPECT_THAT(read_traces(workspace.path("r.csv")).traces[0].values, SizeIs(2));
}

TEST_F(Commands, CompareTellsErrorsAndRatings) {
  workspace.file("a.csv", test::half_sine_trace());
  const Finished finished = run({"compare", "a.csv", "a.csv", "--end", "120ms", "-o", "rating.json"});
  EXPECT_THAT(finished.err, AllOf(HasSubstr("accel_g"), HasSubstr("excellent")));
  const json rating = json::parse(workspace.text_of("rating.json"));
  ASSERT_THAT(rating["channels"], SizeIs(1));
  EXPECT_EQ(rating["channels"][0]["iso18571"]["overall"], 1.0);
  EXPECT_EQ(rating["channels"][0]["errors"]["max_abs"], 0.0);
  EXPECT_EQ(json::parse(run({"compare", "a.csv", "a.csv", "--json"}).out)["channels"], rating["channels"]);
}

TEST_F(Commands, CompareNeedsNoOutput) {
  workspace.file("a.csv", test::half_sine_trace());
  EXPECT_THAT(run({"compare", "a.csv", "a.csv"}).err, HasSubstr("accel_g"));
}

TEST_F(Commands, RunWritesTheCaseDirectory) {
  workspace.file("case.toml",
                 "[pulse]\nfile = \"data/fe-car/C56.csv\"\nchannels = [\"LEFT_REAR_VX\", \"RIGHT_REAR_VX\"]\n"
                 "[identify]\nstarts = 2\n[predict]\nspeeds = [\"60 km/h\", 16]\n");
  const Finished finished = run({"run", "case.toml", "-o", "out/deep", "--json"});
  EXPECT_THAT(workspace.names("out/deep"),
              ElementsAre("case.lock.json", "comparison.json", "model.json", "prediction_57.6kmh.csv",
                          "prediction_60kmh.csv", "pulse.csv", "response.csv", "summary.json"));
  EXPECT_EQ(finished.out, workspace.text_of("out/deep/summary.json"));
  const json summary = json::parse(finished.out);
  std::vector<std::string> keys = summary_keys();
  const std::vector<std::string> parts = {"pulse",
                                          "identification",
                                          "rating_to_max_crush",
                                          "rating_whole_record",
                                          "prediction_60kmh",
                                          "prediction_57.6kmh"};
  keys.insert(keys.end(), parts.begin(), parts.end());
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(keys_of(summary), keys);
  EXPECT_EQ(summary["outcome"], "completed");
  for (const char* part : {"pulse", "prediction_60kmh"}) EXPECT_EQ(keys_of(summary[part]), summary_keys()) << part;
}

TEST_F(Commands, PitchWritesHeaveAndPitch) {
  const std::vector<std::string> command = {
      "pitch",     "data/paper/table1.json", "--mass",      "2582kg", "--force", "data/fe-car/C56.csv",
      "--channel", "barrier_impulse_FTZ",    "--force-arm", "1.7m"};
  const json summary = summary_of(with(command, {"--start", "impact", "-o", "pitch.csv"}));
  EXPECT_THAT(keys_of(summary),
              ElementsAre("heave_min_m", "heave_velocity_min_mps", "outcome", "pitch_max_rad", "pitch_max_time_s"));
  const TraceSet pitch = read_traces(workspace.path("pitch.csv"));
  EXPECT_EQ(pitch.traces.size() + 1, kPitchColumns.size());
  const Finished report = run(with(command, {"--velocity", "*_REAR_VX", "-o", "-", "--end", "200ms"}));
  EXPECT_THAT(report.out, StartsWith("# crashsim = "));
  EXPECT_THAT(report.err, AllOf(HasSubstr("where the velocity ends"), HasSubstr("free motion: ")));
}

TEST_F(Commands, PitchTakesTheForceOfASimulatedCrush) {
  static_cast<void>(run({"simulate", "data/syn-a/model.json", "-o", "response.csv"}));
  const json summary = summary_of({"pitch", "data/paper/table1.json", "--force", "response.csv", "--cg-height", "0.6m",
                                   "--force-height", "0.5m", "--formulation", "derived"});
  EXPECT_GT(summary["pitch_max_rad"].get<double>(), 0.0);
}

TEST_F(Commands, AVehicleIsIdentifiedFromItsOwnMotion) {
  constexpr double kFound = 0.061;  // regression: N/m, of 61000
  const std::vector<std::string> force = {
      "--force", "data/fe-car/C56.csv", "--channel", "barrier_impulse_FTZ", "--force-arm", "1.7m", "--start", "impact"};
  std::vector<std::string> simulate = {"pitch", "data/paper/table1.json", "--rear-stiffness", "61000", "-o", "own.csv"};
  simulate.insert(simulate.end(), force.begin(), force.end());
  ASSERT_EQ(run(simulate).exit_code, kDone);
  // The deflections are those of the body over its axles.
  const HeavePitchModel table = read_vehicle(std::string(test::source_dir()) + "/data/paper/table1.json");
  std::vector<std::string> identify = {"identify-pitch",
                                       "data/paper/table1.json",
                                       "--motion",
                                       "own.csv",
                                       "--front",
                                       "front_deflection_m",
                                       "--rear",
                                       "rear_deflection_m",
                                       "--free",
                                       "rear-stiffness",
                                       "--starts",
                                       "4",
                                       "--front-position=" + std::to_string(table.front_axle_m),
                                       "--rear-position=" + std::to_string(-table.rear_axle_m),
                                       "--cg-position=0"};
  identify.insert(identify.end(), force.begin(), force.end());
  const json summary = summary_of(with(identify, {"-o", "vehicle.json"}));
  EXPECT_EQ(summary["outcome"], "completed");
  EXPECT_EQ(summary["identifiable"], true);
  EXPECT_NEAR(summary["rear_stiffness_n_per_m"].get<double>(), 61000.0, kFound);
  EXPECT_NEAR(read_vehicle(workspace.path("vehicle.json")).rear_stiffness_n_per_m, 61000.0, kFound);
  const Finished report = run(with(identify, {"-o", "-"}));
  EXPECT_THAT(report.err, AllOf(HasSubstr("std. error"), HasSubstr("rear_stiffness_n_per_m")));
}

TEST_F(Commands, SchemaListsKeysWithUnitsRangesAndDefaults) {
  EXPECT_THAT(run({"schema", "case"}).out, AllOf(HasSubstr("[pulse]"), HasSubstr("cfc"), HasSubstr("in Hz"),
                                                 HasSubstr(">= 0"), HasSubstr("default 60")));
  EXPECT_THAT(run({"schema", "model"}).out, AllOf(StartsWith("format"), HasSubstr("ordinates_n_per_m")));
  EXPECT_THAT(run({"schema", "vehicle"}).out, HasSubstr("pitch_inertia_kgm2"));
  for (const char* kind : {"case", "model", "vehicle"})
    for (const json& key : json::parse(run({"schema", kind, "--json"}).out))
      EXPECT_THAT(keys_of(key), ElementsAre("choices", "default", "doc", "key", "range", "section", "unit"));
}

struct Spelled {
  const char* what;
  const char* flag;
  const char* text;
  const char* key;
  double value;
};
void PrintTo(const Spelled& s, std::ostream* out) { *out << s.what; }

class SpelledQuantity : public testing::TestWithParam<Spelled> {};

TEST_P(SpelledQuantity, IsSi) {
  const test::Workspace workspace;
  workspace.file("trace.csv", test::half_sine_trace());
  const Spelled& spelled = GetParam();
  const Finished finished = workspace.run({"pulse", "trace.csv", spelled.flag, spelled.text, "--json", "--quiet"});
  ASSERT_THAT(finished.exit_code, testing::AnyOf(kDone, kNumbersFailed)) << finished.err;
  EXPECT_NEAR(json::parse(finished.out)[spelled.key].get<double>(), spelled.value, kRounding * spelled.value);
}

INSTANTIATE_TEST_SUITE_P(Units, SpelledQuantity,
                         testing::Values(Spelled{"kmh", "--speed", "56km/h", "impact_speed_mps", 56 / 3.6},
                                         Spelled{"kmh_blank", "--speed", "56 km/h", "impact_speed_mps", 56 / 3.6},
                                         Spelled{"mph", "--speed", "35mph", "impact_speed_mps", 35 * 0.44704},
                                         Spelled{"mps", "--speed", "15.5m/s", "impact_speed_mps", 15.5},
                                         Spelled{"bare_is_si", "--speed", "15.5", "impact_speed_mps", 15.5},
                                         Spelled{"exponent", "--speed", "1.55e1", "impact_speed_mps", 15.5},
                                         Spelled{"tonnes", "--mass", "1.719t", "mass_kg", 1719},
                                         Spelled{"kilograms", "--mass", "1719kg", "mass_kg", 1719},
                                         Spelled{"pounds", "--mass", "3000lb", "mass_kg", 3000 * 0.45359237}));

struct Moment {
  const char* what;
  std::vector<std::string> arguments;
};
void PrintTo(const Moment& m, std::ostream* out) { *out << m.what; }

class SpelledTime : public testing::TestWithParam<Moment> {};

/// The trace's own time zero moved to 5 ms before impact.
TEST_P(SpelledTime, IsSecondsOnTheTracesClock) {
  const test::Workspace workspace;
  workspace.file("trace.csv", test::half_sine_trace());
  const Finished own = workspace.run({"pulse", "trace.csv", "--json"});
  std::vector<std::string> arguments = {"pulse", "trace.csv", "--json"};
  const Finished moved = workspace.run(with(arguments, GetParam().arguments));
  ASSERT_EQ(moved.exit_code, kDone) << moved.err;
  constexpr double kMoved_s = 0.005, kFilterAtTheEdge_s = 1e-5;  // solver
  EXPECT_NEAR(json::parse(moved.out)["t_m_s"].get<double>() - json::parse(own.out)["t_m_s"].get<double>(), kMoved_s,
              kFilterAtTheEdge_s);
}

INSTANTIATE_TEST_SUITE_P(Units, SpelledTime,
                         testing::Values(Moment{"milliseconds", {"--t0", "-5ms"}},
                                         Moment{"seconds", {"--t0", "-0.005"}}, Moment{"equals", {"--t0=-5e-3s"}},
                                         Moment{"last_one_wins", {"--t0", "0", "--t0", "-5 ms"}}));

}  // namespace
}  // namespace crashsim
