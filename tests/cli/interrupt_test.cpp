/// Ctrl-C: within a second, exit code 130, and what is finished is kept.

#include <chrono>
#include <string>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <crashsim/model_io.hpp>

#include "support/workspace.hpp"

namespace crashsim {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;
using test::Finished;
using test::kInterrupted;
using testing::HasSubstr;

constexpr std::chrono::duration<double> kAtOnce = 1s;
constexpr const char* kManyStarts = "1000000";

/// Ctrl-C some time after the start.
test::Launch interrupted_after(std::chrono::milliseconds delay) {
  test::Launch launch;
  launch.interrupt_after = delay;
  return launch;
}

class Interrupt : public testing::Test {
 protected:
  Interrupt() { workspace.file("trace.csv", test::half_sine_trace()); }
  test::Workspace workspace;
};

TEST_F(Interrupt, OfAnIdentificationKeepsWhatIsFinished) {
  const Finished finished = workspace.run(
      {"identify", "trace.csv", "--starts", kManyStarts, "-o", "model.json", "--json"}, interrupted_after(1s));
  EXPECT_EQ(finished.exit_code, kInterrupted) << finished.err;
  EXPECT_LT(finished.after_interrupt, kAtOnce);
  const json summary = json::parse(finished.out);
  EXPECT_EQ(summary["outcome"], "interrupted");
  EXPECT_GT(summary["starts"], 0);
  EXPECT_THAT(finished.err, HasSubstr(std::string(" of ") + kManyStarts + " starts"));
  EXPECT_EQ(read_model(workspace.path("model.json")).spring.knots.size(), 7u);
  EXPECT_THAT(workspace.names(), testing::ElementsAre("model.json", "trace.csv"));
}

TEST_F(Interrupt, OfACaseKeepsWhatIsFinished) {
  workspace.file("case.toml", std::string("[pulse]\nfile = \"trace.csv\"\n[identify]\nstarts = ") + kManyStarts + "\n");
  const Finished finished = workspace.run({"run", "case.toml", "-o", "out", "--json"}, interrupted_after(1s));
  EXPECT_EQ(finished.exit_code, kInterrupted) << finished.err;
  EXPECT_LT(finished.after_interrupt, kAtOnce);
  EXPECT_EQ(json::parse(finished.out)["identification"]["outcome"], "interrupted");
  EXPECT_EQ(read_model(workspace.path("out/model.json")).spring.knots.size(), 7u);
}

TEST_F(Interrupt, OfIdentificationsOfNumbersKeepsWhatIsFinished) {
  const std::vector<std::string> pitch = {"identify-pitch",
                                          "data/paper/table1.json",
                                          "--cg-height",
                                          "504mm",
                                          "--force",
                                          "data/fe-car/C56.csv",
                                          "--longitudinal",
                                          "barrier_impulse_FNX",
                                          "--start",
                                          "impact",
                                          "--motion",
                                          "data/fe-car/C56.csv",
                                          "--front",
                                          "LEFT_MID_DZ",
                                          "--rear",
                                          "LEFT_REAR_DZ",
                                          "--front-position=1",
                                          "--rear-position=0",
                                          "--cg-position=0.65",
                                          "--free",
                                          "force-height",
                                          "--starts",
                                          kManyStarts,
                                          "-o",
                                          "vehicle.json",
                                          "--json"};
  const std::vector<std::string> law = {"identify-vertical",
                                        "data/fe-car/C56.csv",
                                        "--channel",
                                        "barrier_impulse_FTZ",
                                        "--longitudinal",
                                        "barrier_impulse_FNX",
                                        "--crush",
                                        "LEFT_REAR_DX",
                                        "--starts",
                                        kManyStarts,
                                        "-o",
                                        "law.json",
                                        "--json"};
  for (const auto& command : {pitch, law}) {
    const Finished finished = workspace.run(command, interrupted_after(1s));
    EXPECT_EQ(finished.exit_code, kInterrupted) << finished.err;
    EXPECT_LT(finished.after_interrupt, kAtOnce);
    const json summary = json::parse(finished.out);
    EXPECT_EQ(summary["outcome"], "interrupted");
    EXPECT_GT(summary["starts"], 0);
  }
  EXPECT_THAT(workspace.names(), testing::ElementsAre("law.json", "trace.csv", "vehicle.json"));
}

TEST_F(Interrupt, BeforeAnythingIsFinishedLeavesNothing) {
  const Finished finished =
      workspace.run({"identify", "trace.csv", "--starts", kManyStarts, "-o", "model.json"}, interrupted_after(0ms));
  EXPECT_THAT(finished.exit_code, testing::AnyOf(kInterrupted, 128 + SIGINT));
  EXPECT_LT(finished.after_interrupt, kAtOnce);
  if (workspace.has("model.json")) {
    EXPECT_EQ(read_model(workspace.path("model.json")).mass_kg, 1500.0);
  }
  EXPECT_THAT(workspace.names(), testing::Each(testing::AnyOf("trace.csv", "model.json")));
}

}  // namespace
}  // namespace crashsim
