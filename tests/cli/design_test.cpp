/// crashsim design: its files, its exit codes, and its record run again.

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <crashsim/crashsim.hpp>

#include "support/refusal.hpp"
#include "support/workspace.hpp"

namespace crashsim {
namespace {

using nlohmann::json;
using test::Finished;
using test::kDone;
using test::kNumbersFailed;
using test::Refusal;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kVehicle =
    "[vehicle]\npitch_inertia = 2000\nfront_axle = 1.1\nrear_axle = 1.5\nfront_stiffness = 4e4\nrear_stiffness = 4e4\n"
    "front_damping = 3e3\nrear_damping = 3e3\ncg_height = 0.54\nforce_height = 0.48\n[crush]\nmodel = \"model.json\"\n";
const std::string kCase = std::string(kVehicle) +
                          "[design]\nparameters = [\"force_height\", \"k2\"]\nlower = [\"450 mm\", \"500 kN/m\"]\n"
                          "upper = [0.6, 2e6]\nminimise = \"pitch\"\nmax_crush = \"0.6 m\"\nstarts = 1\n"
                          "trade_off = \"max_crush\"\ntrade_off_limits = [\"0.55 m\", \"0.65 m\"]\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

class DesignCli : public testing::Test {
 protected:
  DesignCli() {
    workspace.file("model.json", test::kModelText);
    workspace.file("case.toml", kCase);
  }
  test::Workspace workspace;
};

TEST_F(DesignCli, WritesSensitivitiesOptimumCurveAndMotion) {
  const Finished finished = workspace.run({"design", "case.toml", "-o", "out", "--json"});
  ASSERT_EQ(finished.exit_code, kDone) << finished.err;
  EXPECT_THAT(workspace.names("out"), ElementsAre("case.lock.json", "coupled.csv", "design.json", "model.json",
                                                  "sensitivities.csv", "trade_off.csv"));
  EXPECT_EQ(finished.out, workspace.text_of("out/design.json"));
  const json result = json::parse(finished.out);
  EXPECT_EQ(result["outcome"], "completed");
  EXPECT_EQ(result["parameters"][1]["name"], "k2_n_per_m");
  EXPECT_LE(result["after"]["max_crush_m"], 0.6);
  EXPECT_LT(result["after"]["pitch_max_rad"], result["before"]["pitch_max_rad"]);
  EXPECT_THAT(finished.err, AllOf(HasSubstr("sensitivities of the given model, % per %"), HasSubstr("trade-off"),
                                  HasSubstr("force_height_m")));
  const CrushModel model = read_model(workspace.path("out/model.json"));
  EXPECT_EQ(model.spring.ordinates.at(1), result["parameters"][1]["after"].get<double>());
  const TraceSet motion = read_traces(workspace.path("out/coupled.csv"));
  EXPECT_EQ(motion.traces.size() + 1, kCoupledColumns.size());
  EXPECT_EQ(read_traces(workspace.path("out/trade_off.csv")).traces.front().values.size(), 2U);
}

TEST_F(DesignCli, ARecordRunAgainGivesTheSameFiles) {
  ASSERT_EQ(workspace.run({"design", "case.toml", "-o", "first", "--jobs", "2"}).exit_code, kDone);
  workspace.file("case.toml", "[design]\n");  // the record holds all that is needed
  ASSERT_EQ(workspace.run({"run", "first/case.lock.json", "-o", "second"}).exit_code, kDone);
  ASSERT_EQ(workspace.run({"run", "first/trade_off.csv", "-o", "third", "--jobs", "1"}).exit_code, kDone);
  ASSERT_EQ(workspace.run({"design", "first/design.json", "-o", "fourth"}).exit_code, kDone);
  const std::vector<std::string> names = workspace.names("first");
  for (const std::string other : {"second", "third", "fourth"}) {
    EXPECT_EQ(workspace.names(other), names);
    for (const std::string& name : names)
      EXPECT_EQ(workspace.text_of(other + "/" + name), workspace.text_of("first/" + name)) << name;
  }
}

TEST_F(DesignCli, WithoutAFeasibleDesignTheNumbersFailed) {
  workspace.file("case.toml", replaced(kCase, "\"0.6 m\"", "\"0.3 m\""));
  const Finished finished = workspace.run({"design", "case.toml", "-o", "out"});
  EXPECT_EQ(finished.exit_code, kNumbersFailed);
  EXPECT_THAT(finished.err, HasSubstr("optimum: infeasible: no design in the ranges keeps all limits"));
  EXPECT_THAT(workspace.names("out"),
              ElementsAre("case.lock.json", "design.json", "sensitivities.csv", "trade_off.csv"));
}

class BadDesignCase : public testing::TestWithParam<Refusal> {};

TEST_P(BadDesignCase, IsRefused) { test::expect_refused(GetParam()); }

Refusal bad(const char* what, const std::string& from, const std::string& to, std::vector<std::string> message) {
  return {what,
          {{"model.json", test::kModelText}, {"case.toml", replaced(kCase, from, to)}},
          {"design", "case.toml", "-o", "out"},
          std::move(message)};
}

INSTANTIATE_TEST_SUITE_P(
    Cases, BadDesignCase,
    testing::Values(
        bad("no_design", kCase.substr(kCase.find("[design]")), "", {"case.toml: has no [design] parameters"}),
        bad("unknown_parameter", "\"k2\"", "\"k9\"", {"case.toml: [design] parameters[1]: unknown name 'k9'"}),
        bad("unit_of_something_else", "450 mm", "450 ms",
            {"case.toml: [design] lower[0] (force_height_m) = '450 ms': 'ms' measures time, not length"}),
        bad("unknown_quantity", "\"pitch\"", "\"pich\"", {"case.toml:", "minimise", "did you mean 'pitch'?"}),
        bad("unknown_key", "minimise", "minimize", {"[design]", "'minimize', did you mean 'minimise'?"}),
        bad("no_height", "cg_height = 0.54\n", "", {"cg_height_m is not set but"})));

}  // namespace
}  // namespace crashsim
