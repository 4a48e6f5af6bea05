/// --config FILE.toml: any option, by flag or name; the command line wins.

#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "support/workspace.hpp"

namespace crashsim {
namespace {

using nlohmann::json;
using test::Finished;
using test::kDone;
using test::kUserCanFix;
using testing::HasSubstr;
using testing::IsEmpty;

class Config : public testing::Test {
 protected:
  Config() { workspace.file("trace.csv", test::half_sine_trace()); }
  /// The options that the record of a pulse holds.
  [[nodiscard]] json options_of(const std::string& config, std::vector<std::string> more = {}) const {
    workspace.file("options.toml", config);
    std::vector<std::string> arguments = {"pulse", "trace.csv", "--config", "options.toml"};
    if (config.find("output") == std::string::npos) more.insert(more.end(), {"-o", "pulse.csv"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Finished finished = workspace.run(arguments);
    EXPECT_EQ(finished.exit_code, kDone) << finished.err;
    const std::string text = workspace.text_of("pulse.csv"), mark = "# record = ";
    const std::size_t from = text.find(mark) + mark.size();
    return json::parse(text.substr(from, text.find('\n', from) - from))["options"];
  }

  test::Workspace workspace;
};

TEST_F(Config, GivesOptionsByFlagOrName) {
  const json options = options_of(
      "cfc = 180\nmass_kg = 1600\nspeed = \"50 km/h\"\nchannels = [2]\nbias = [-0.009, -0.001]\ncfc-standard = "
      "\"iso6487\"\n");
  EXPECT_EQ(options["cfc"], 180.0);
  EXPECT_EQ(options["mass"], 1600.0);
  EXPECT_EQ(options["speed"], 50.0 / 3.6);
  EXPECT_EQ(options["channel"], json({"2"}));
  EXPECT_EQ(options["bias"], json({-0.009, -0.001}));
  EXPECT_EQ(options["cfc-standard"], "iso6487");
}

TEST_F(Config, TheCommandLineWins) {
  const json options = options_of("cfc = 180\nmass = 1600\n", {"--cfc", "100"});
  EXPECT_EQ(options["cfc"], 100.0);
  EXPECT_EQ(options["mass"], 1600.0);
}

TEST_F(Config, ATableIsForTheSubcommandOfItsName) {
  const json options = options_of("mass = 1600\n[pulse]\ncfc = 180\n[identify]\nmass = 1\nnonsense = 2\n");
  EXPECT_EQ(options["cfc"], 180.0);
  EXPECT_EQ(options["mass"], 1600.0);
}

TEST_F(Config, GivesTheOutputAndHowToReport) {
  static_cast<void>(options_of("output = \"pulse.csv\"\nquiet = true\njson = true\n"));
  const Finished refused = workspace.run({"pulse", "trace.csv", "--config", "options.toml"});
  EXPECT_THAT(refused.err, HasSubstr("pulse.csv: exists already"));
  workspace.file("options.toml", "output = \"pulse.csv\"\nquiet = true\njson = true\nforce = true\n");
  const Finished finished = workspace.run({"pulse", "trace.csv", "--config", "options.toml"});
  EXPECT_EQ(finished.exit_code, kDone);
  EXPECT_THAT(finished.err, IsEmpty());
  EXPECT_TRUE(json::parse(finished.out).is_object());
}

TEST_F(Config, GivesRunItsThreads) {
  workspace.file("model.json", test::kModelText);
  workspace.file("case.toml", "[crush]\nmodel = \"model.json\"\n");
  workspace.file("options.toml", "[run]\njobs = 1\n");
  const Finished finished = workspace.run({"run", "case.toml", "--config", "options.toml", "-o", "out"});
  EXPECT_EQ(finished.exit_code, kDone) << finished.err;
}

TEST_F(Config, GivesInfoAndSchemaTheirs) {
  workspace.file("options.toml", "[info]\ncolumns = \"time:s,speed:km/h\"\n[schema]\njson = true\n");
  workspace.file("bare.csv", "0,36\n1,18\n");
  const Finished info = workspace.run({"info", "bare.csv", "--json", "--quiet", "--config", "options.toml"});
  EXPECT_EQ(json::parse(info.out)["channels"][0]["max"], 10.0) << info.err;
  EXPECT_TRUE(json::parse(workspace.run({"schema", "model", "--config", "options.toml"}).out).is_array());
}

struct Bad {
  const char* what;
  const char* text;
  const char* message;
};
void PrintTo(const Bad& b, std::ostream* out) { *out << b.what; }

class BadConfig : public testing::TestWithParam<Bad> {};

TEST_P(BadConfig, IsRefusedWithFileLineAndRule) {
  const test::Workspace workspace;
  workspace.file("trace.csv", test::half_sine_trace());
  workspace.file("o.toml", GetParam().text);
  const Finished finished = workspace.run({"pulse", "trace.csv", "--config", "o.toml", "-o", "pulse.csv"});
  EXPECT_EQ(finished.exit_code, kUserCanFix);
  EXPECT_THAT(finished.err, HasSubstr(GetParam().message));
  EXPECT_FALSE(workspace.has("pulse.csv"));
}

INSTANTIATE_TEST_SUITE_P(
    Files, BadConfig,
    testing::Values(Bad{"unknown_key", "\ncfx = 60\n",
                        "o.toml:2: unknown name 'cfx', did you mean 'cfc'? (known: output, overwrite"},
                    Bad{"unknown_key_of_the_subcommand", "[pulse]\nmas = 1\n",
                        "o.toml:2: unknown name 'mas', did you mean 'mass'?"},
                    Bad{"unknown_table", "[puls]\ncfc = 60\n",
                        "o.toml:2: [puls] is no subcommand: options of this one stand in [pulse] or before any table"},
                    Bad{"unit_of_another_quantity", "mass = \"5 m\"\n",
                        "o.toml:1: mass = '5 m': 'm' measures length, not mass"},
                    Bad{"out_of_range", "mass = -3\n", "o.toml:1: mass = -3 kg: must be > 0"},
                    Bad{"text_for_a_flag", "force = \"please\"\n", "o.toml:1: force: must be true or false, not text"},
                    Bad{"flag_for_a_number", "cfc = true\n",
                        "o.toml:1: cfc: must be a number in Hz or text with a unit, not true or false"},
                    Bad{"a_date", "cfc = 2020-01-01\n",
                        "o.toml:1: cfc: must be a number, a text, true or false, or a list of them"},
                    Bad{"a_list_of_lists", "bias = [[1]]\n", "o.toml:1: bias: a list must hold numbers or texts"},
                    Bad{"not_toml", "cfc = 60\nmass 3\n", "o.toml:2: is not TOML: "},
                    Bad{"a_key_twice", "cfc = 60\ncfc = 61\n", "o.toml:2: is not TOML: "}));

TEST_F(Config, AMissingFileIsNamed) {
  const Finished finished = workspace.run({"pulse", "trace.csv", "--config", "none.toml", "-o", "p.csv"});
  EXPECT_EQ(finished.exit_code, kUserCanFix);
  EXPECT_THAT(finished.err, HasSubstr("none.toml: no such file"));
}

}  // namespace
}  // namespace crashsim
