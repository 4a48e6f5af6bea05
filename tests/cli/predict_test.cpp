/// crashsim predict, and what identify leaves for it.

#include <string>

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
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class PredictCli : public testing::Test {
 protected:
  test::Workspace workspace;

  /// Identifies 40 and 56 km/h into model.json, quickly.
  void identify(const std::vector<std::string>& further = {}) {
    for (const char* speed : {"40", "56"}) {
      const std::string pulse = std::string("p") + speed + ".csv";
      const Finished made = workspace.run({"pulse", std::string("data/fe-car/C") + speed + ".csv", "--channel",
                                           "LEFT_REAR_VX", "--channel", "RIGHT_REAR_VX", "-o", pulse});
      ASSERT_EQ(made.exit_code, kDone) << made.err;
    }
    std::vector<std::string> arguments = {"identify", "p40.csv", "p56.csv", "--starts", "1", "-o", "model.json"};
    arguments.insert(arguments.end(), further.begin(), further.end());
    const Finished fitted = workspace.run(arguments);
    ASSERT_EQ(fitted.exit_code, kDone) << fitted.err;
  }
};

TEST_F(PredictCli, PredictsInALaterProcessWithBands) {
  identify();
  const Finished finished = workspace.run({"predict", "model.json", "--speed", "40km/h..56km/h:3", "-o", "p.csv"});
  EXPECT_EQ(finished.exit_code, kDone) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("prediction of model.json: 3 speeds"));
  EXPECT_THAT(finished.err, HasSubstr("bands hold 95 % of 200 replicates"));
  EXPECT_THAT(finished.err, Not(HasSubstr("extrapolated")));
  EXPECT_THAT(workspace.text_of("p.csv"),
              HasSubstr("\nimpact_speed_mps,outcome,extrapolated,without_max_crush,t_m_s,"));
  const Finished told = workspace.run({"predict", "model.json", "--speed", "48km/h", "--json", "--quiet"});
  EXPECT_THAT(told.err, IsEmpty());
  const json row = json::parse(told.out)["speeds"][0];
  EXPECT_LT(row["max_crush_m_low"].get<double>(), row["max_crush_m"].get<double>());
  EXPECT_GT(row["max_crush_m_high"].get<double>(), row["max_crush_m"].get<double>());
}

TEST_F(PredictCli, FlagsWhatIsBeyondTheTests) {
  identify({"--replicates", "20", "--level", "0.9"});
  const Finished finished = workspace.run({"predict", "model.json", "--speed", "64km/h", "--json"});
  EXPECT_THAT(finished.err, HasSubstr("  extrapolated\n"));
  EXPECT_THAT(finished.err, HasSubstr("faster than the speeds identified, "));
  const json told = json::parse(finished.out);
  EXPECT_EQ(told["replicates"], 20);
  EXPECT_EQ(told["level"], 0.9);
  EXPECT_TRUE(told["speeds"][0]["extrapolated"].get<bool>());
}

TEST_F(PredictCli, SaysThatAModelOfHandHasNoBands) {
  const Finished finished = workspace.run({"predict", "data/neon-kw400/model.json", "--speed", "56km/h", "--json"});
  EXPECT_EQ(finished.exit_code, kDone);
  EXPECT_THAT(finished.err, HasSubstr("no bands: the model carries no ensemble"));
  EXPECT_TRUE(json::parse(finished.out)["speeds"][0]["t_m_s_low"].is_null());
}

TEST_F(PredictCli, FailsWhereTheModelDoesNotComeToRest) {
  const Finished finished =
      workspace.run({"predict", "data/neon-kw400/model.json", "--speed", "56km/h", "--end", "10ms", "--json"});
  EXPECT_EQ(finished.exit_code, kNumbersFailed);
  EXPECT_THAT(finished.err, HasSubstr("the model does not come to rest by 0.01 s"));
}

TEST_F(PredictCli, RunsAgainFromItsRecord) {
  identify({"--resample", "block", "--replicates", "5", "--seed", "7"});
  const Finished again = workspace.run({"run", "model.json", "-o", "again"});
  EXPECT_EQ(again.exit_code, kDone) << again.err;
}

TEST(PredictRefusal, NamesWhatIsWrong) {
  test::expect_refused({"speed",
                        {{"model.json", test::kModelText}},
                        {"predict", "model.json", "--speed", "40kg", "-o", "out"},
                        {"PredictOptions.speeds[0]", "40kg"}});
  test::expect_refused({"kind",
                        {{"p.csv", "time_s,accel_mps2\n"}},
                        {"identify", "p.csv", "--resample", "jackknife", "-o", "out"},
                        {"--resample", "jackknife", "linearised, parametric, block"}});
}

}  // namespace
}  // namespace crashsim
