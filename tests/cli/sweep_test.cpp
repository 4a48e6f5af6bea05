/// crashsim run on cases with [sweep] and [monte_carlo]: files, records, exit codes, Ctrl-C.

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <crashsim/crashsim.hpp>

#include "support/workspace.hpp"

namespace crashsim {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;
using test::Finished;
using test::kDone;
using test::kInterrupted;
using test::kNumbersFailed;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string kCase =
    "[impact]\nspeed = \"50 km/h\"\n[crush]\nmodel = \"model.json\"\n[monte_carlo]\nsamples = 100\n"
    "vehicle.mass = {normal = [\"1.5 t\", \"50 kg\"]}\nimpact.speed = {uniform = [\"48 km/h\", \"52 km/h\"]}\n";

class SweepCli : public testing::Test {
 protected:
  SweepCli() {
    workspace.file("model.json", test::kModelText);
    workspace.file("case.toml", kCase);
  }
  [[nodiscard]] std::size_t rows_of(const std::string& name) const {
    const std::string text = workspace.text_of(name);
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) - 5;  // comments and header
  }
  test::Workspace workspace;
};

TEST_F(SweepCli, WritesSamplesAndWhatTheySayBesideTheCase) {
  const Finished finished = workspace.run({"run", "case.toml", "-o", "out"});
  ASSERT_EQ(finished.exit_code, kDone) << finished.err;
  EXPECT_THAT(workspace.names("out"),
              ElementsAre("case.lock.json", "model.json", "response.csv", "samples.csv", "summary.json", "sweep.json"));
  EXPECT_EQ(rows_of("out/samples.csv"), 100U);
  EXPECT_THAT(workspace.text_of("out/samples.csv"),
              HasSubstr("\nsample,vehicle.mass_kg,impact.speed_mps,outcome,t_m_s,max_crush_m,"));
  const json sweep = json::parse(workspace.text_of("out/sweep.json"));
  EXPECT_EQ(sweep["outcome"], "completed");
  EXPECT_EQ(sweep["outcomes"]["completed"], 100);
  EXPECT_EQ(sweep["statistics"]["max_crush_m"]["count"], 100);
  EXPECT_GT(sweep["pearson"]["max_crush_m"]["impact.speed_mps"], 0.5);
  EXPECT_GT(sweep["sobol"]["first_order"]["delta_v_mps"]["impact.speed_mps"]["value"], 0.9);
  EXPECT_THAT(finished.err, AllOf(HasSubstr("samples: 100 of 100, sobol, 100 completed"),
                                  HasSubstr("driven by (first-order index)"), HasSubstr("impact.speed_mps (")));
}

TEST_F(SweepCli, IsTheSameOnAnyNumberOfJobsAndFromItsRecord) {
  ASSERT_EQ(workspace.run({"run", "case.toml", "-o", "first", "--jobs", "1"}).exit_code, kDone);
  ASSERT_EQ(workspace.run({"run", "case.toml", "-o", "second", "--jobs", "3"}).exit_code, kDone);
  workspace.file("case.toml", "");  // the record holds all that is needed
  ASSERT_EQ(workspace.run({"run", "first/case.lock.json", "-o", "third"}).exit_code, kDone);
  ASSERT_EQ(workspace.run({"run", "first/samples.csv", "-o", "fourth"}).exit_code, kDone);
  for (const std::string other : {"second", "third", "fourth"})
    for (const std::string& name : workspace.names("first"))
      EXPECT_EQ(workspace.text_of(other + "/" + name), workspace.text_of("first/" + name)) << other << "/" << name;
}

TEST_F(SweepCli, FailsOnlyWhereNoSampleCompletes) {
  const std::string late = kCase.substr(0, kCase.find("[monte_carlo]")) + "[simulate]\nend = ";
  workspace.file("some.toml", late + "0.07\n[sweep]\nmass = [\"1 t\", \"5 t\"]\n");
  EXPECT_EQ(workspace.run({"run", "some.toml", "-o", "some"}).exit_code, kDone);
  EXPECT_THAT(workspace.text_of("some/samples.csv"), AllOf(HasSubstr(",completed,"), HasSubstr(",no_max_crush,,")));
  workspace.file("none.toml", late + "0.2\n[sweep]\nmass = [\"500 t\"]\n");
  const Finished none = workspace.run({"run", "none.toml", "-o", "none", "--json"});
  EXPECT_EQ(json::parse(none.out)["outcome"], "completed");  // the case itself
  EXPECT_EQ(none.exit_code, kNumbersFailed) << none.err;
  EXPECT_EQ(json::parse(workspace.text_of("none/sweep.json"))["outcome"], "every_sample_failed");
}

TEST_F(SweepCli, InterruptedItKeepsTheSamplesThatAreDone) {
  workspace.file("many.toml",
                 "[pulse]\nfile = \"data/fe-car/C56.csv\"\nchannels = [\"LEFT_REAR_VX\"]\n[identify]\nstarts = 1\n"
                 "[sweep]\npulse.cfc = \"50..180:1000\"\n");
  test::Launch launch;
  launch.interrupt_after = 2s;
  const Finished finished = workspace.run({"run", "many.toml", "-o", "out"}, launch);
  EXPECT_EQ(finished.exit_code, kInterrupted) << finished.err;
  EXPECT_LT(finished.after_interrupt, 1s);
  const json sweep = json::parse(workspace.text_of("out/sweep.json"));
  EXPECT_EQ(sweep["outcome"], "interrupted");
  EXPECT_GT(sweep["samples"], 0);
  EXPECT_EQ(rows_of("out/samples.csv"), sweep["samples"]);
}

TEST_F(SweepCli, TheSchemaTellsOfIt) {
  const std::string schema = workspace.run({"schema", "case"}).out;
  EXPECT_THAT(schema, AllOf(HasSubstr("\n[sweep]\n<section>.<key>"), HasSubstr("\n[monte_carlo]\nsamples"),
                            HasSubstr("{triangular = [least, likely, largest]}")));
}

}  // namespace
}  // namespace crashsim
