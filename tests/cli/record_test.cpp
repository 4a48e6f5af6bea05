/// The record in every output: run again it gives the same bytes, on any number of threads; a changed input is refused.

#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <crashsim/crashsim.hpp>
#include <crashsim/files.hpp>

#include "support/source_dir.hpp"
#include "support/workspace.hpp"

namespace crashsim {
namespace {

using nlohmann::json;
using test::Finished;
using test::kDone;
using test::kUserCanFix;
using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kCase =
    "title = \"a half sine\"\n[pulse]\nfile = \"trace.csv\"\ncfc = 180\n[crush]\nspring_knots = 3\ndamper_knots = 3\n"
    "[identify]\nstarts = 4\nseed = 9007199254740993\n[predict]\nspeeds = [\"40 km/h\"]\n";

class Recorded : public testing::Test {
 protected:
  Recorded() {
    workspace.file("trace.csv", test::half_sine_trace());
    workspace.file("-x.csv", test::half_sine_trace(17.0));
    workspace.file("case.toml", kCase);
    workspace.file("options.toml", "seed = 9007199254740993\nsmooth = 0.1\n");
  }
  void expect_done(const std::vector<std::string>& arguments) const {
    const Finished finished = workspace.run(arguments);
    EXPECT_EQ(finished.exit_code, kDone) << finished.err;
  }

  test::Workspace workspace;
};

struct Made {
  const char* what;
  std::string output;
  std::vector<std::string> arguments;
};
void PrintTo(const Made& m, std::ostream* out) { *out << m.what; }

class RunAgain : public Recorded, public testing::WithParamInterface<Made> {};

TEST_P(RunAgain, GivesTheSameBytes) {
  std::vector<std::string> arguments = GetParam().arguments;
  arguments.insert(arguments.begin() + 1, {"-o", GetParam().output});
  expect_done(arguments);
  const std::string again = "again_" + GetParam().output;
  expect_done({"run", GetParam().output, "-o", again});
  EXPECT_EQ(workspace.text_of(again), workspace.text_of(GetParam().output));
}

INSTANTIATE_TEST_SUITE_P(
    Outputs, RunAgain,
    testing::Values(
        Made{"pulse", "pulse.csv", {"pulse", "trace.csv"}},
        Made{"pulse_with_options",
             "pulse.csv",
             {"pulse", "trace.csv", "--channel", "accel_g", "--cfc", "180", "--t0=-5ms", "--bias=-8ms,-6ms", "--mass",
              "1.3t", "--speed", "50km/h", "--cfc-standard", "iso6487"}},
        Made{"pulse_of_a_file_like_an_option", "pulse.csv", {"pulse", "--", "-x.csv"}},
        Made{"pulse_of_named_columns", "pulse.csv", {"pulse", "trace.csv", "--columns", "time:s,accel:g"}},
        Made{"model", "model.json", {"identify", "trace.csv", "--starts", "4", "--jobs", "2"}},
        Made{"model_of_two_pulses", "model.json", {"identify", "--starts", "2", "--", "trace.csv", "-x.csv"}},
        Made{"model_with_numbers",
             "model.json",
             {"identify", "trace.csv", "--knots", "0,0.3,0.9", "--weights", "1,2,0.1", "--starts", "2", "--law",
              "force", "--loss", "huber", "--mass", "0.1t"}},
        Made{"model_of_a_configuration",
             "model.json",
             {"identify", "trace.csv", "--config", "options.toml", "--starts", "2"}},
        Made{"response", "response.csv", {"simulate", "data/syn-a/model.json", "--speed", "12.3m/s", "--dt", "0.3ms"}},
        Made{"response_to_max_crush", "response.csv", {"simulate", "data/syn-a/model.json", "--to-max-crush"}},
        Made{"cards_of_lsdyna",
             "model.k",
             {"export", "data/syn-a/model.json", "--to", "lsdyna", "--units", "t-mm-s", "--id", "100"}},
        Made{"cards_of_radioss", "model.rad", {"export", "data/syn-a/model.json", "--to", "radioss"}},
        Made{"tables", "model.csv", {"export", "data/syn-a/model.json", "--to", "csv"}},
        Made{"pitch", "pitch.csv", {"pitch",          "data/paper/table1.json",
                                    "--force",        "data/fe-car/C56.csv",
                                    "--channel",      "barrier_impulse_FTZ",
                                    "--longitudinal", "barrier_impulse_FNX",
                                    "--cg-height",    "504mm",
                                    "--force-height", "0.4",
                                    "--force-arm",    "1.7",
                                    "--start",        "20ms",
                                    "--cfc",          "100",
                                    "--mass",         "1.19t"}},
        Made{"vehicle",
             "vehicle.json",
             {"identify-pitch",
              "data/paper/table1.json",
              "--mass",
              "1190kg",
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
              "*_MID_DZ",
              "--front",
              "*_MID_VZ",
              "--rear",
              "*_REAR_DZ",
              "--rear",
              "*_REAR_VZ",
              "--cg-position",
              "-1.6m",
              "--free",
              "force-height,rear_damping",
              "--lower",
              "0.1,10",
              "--upper",
              "0.9,1e5",
              "--jobs",
              "2",
              "--starts",
              "3",
              "--loss",
              "l2",
              "--front-position=-2.286",
              "--rear-position=-3.1327",
              "--cg-position=-2.486"}},
        Made{"law",
             "law.json",
             {"identify-vertical",
              "data/fe-car/C56.csv",
              "--channel",
              "barrier_impulse_FTZ",
              "--longitudinal",
              "barrier_impulse_FNX",
              "--crush",
              "*_REAR_DX",
              "--free",
              "angle",
              "--free",
              "angle-rate",
              "--friction",
              "0.3",
              "--to",
              "90ms",
              "--starts",
              "3",
              "--cfc",
              "180"}},
        Made{"rating",
             "rating.json",
             {"compare", "trace.csv", "./-x.csv", "--start=-1ms", "--end", "90ms", "--channel", "accel*"}}));

TEST_F(Recorded, ACaseRunAgainGivesTheSameFiles) {
  expect_done({"run", "case.toml", "-o", "first"});
  expect_done({"run", "first/case.lock.json", "-o", "second"});
  expect_done({"run", "first/model.json", "-o", "third", "--jobs", "1"});
  const std::vector<std::string> names = workspace.names("first");
  for (const std::string other : {"second", "third"}) {
    EXPECT_EQ(workspace.names(other), names);
    for (const std::string& name : names)
      EXPECT_EQ(workspace.text_of(other + "/" + name), workspace.text_of("first/" + name)) << name;
  }
}

TEST_F(Recorded, ThePapersCaseRunAgainGivesTheSameFiles) {
  expect_done({"run", "data/paper/case.toml", "-o", "first"});
  expect_done({"run", "first/case.lock.json", "-o", "second"});
  const std::vector<std::string> names = workspace.names("first");
  EXPECT_THAT(names, testing::IsSupersetOf({"pitch.csv", "coupled.csv", "comparison.json"}));
  EXPECT_EQ(workspace.names("second"), names);
  for (const std::string& name : names)
    EXPECT_EQ(workspace.text_of("second/" + name), workspace.text_of("first/" + name)) << name;
}

TEST_F(Recorded, TheLibraryMakesTheProgramsFiles) {
  const std::string file = std::string(test::source_dir()) + "/data/fe-car/case.toml";
  expect_done({"run", file, "-o", "program"});
  const Case study = read_case(file);
  const std::vector<FileText> files = case_files(study, run_case(study));
  EXPECT_EQ(workspace.names("program").size(), files.size());
  for (const FileText& made : files) EXPECT_EQ(workspace.text_of("program/" + made.name), made.text) << made.name;
}

TEST_F(Recorded, TheNumberOfThreadsDoesNotShow) {
  std::string first;
  for (const char* jobs : {"1", "2", "7"}) {
    const std::string output = std::string("model_") + jobs + ".json";
    expect_done({"identify", "trace.csv", "--starts", "7", "--jobs", jobs, "-o", output});
    if (first.empty()) first = workspace.text_of(output);
    EXPECT_EQ(workspace.text_of(output), first) << jobs << " threads";
  }
  expect_done({"run", "model_7.json", "--jobs", "1", "-o", "again.json"});
  EXPECT_EQ(workspace.text_of("again.json"), first);
}

TEST_F(Recorded, EveryOutputTellsVersionOptionsAndInputs) {
  expect_done({"pulse", "trace.csv", "-o", "pulse.csv"});
  expect_done({"identify", "pulse.csv", "--method", "equation-error", "-o", "model.json"});
  const json record = json::parse(workspace.text_of("model.json"))["record"];
  EXPECT_EQ(record["version"], kVersion);
  EXPECT_EQ(record["command"], "identify");
  EXPECT_EQ(record["arguments"], json({"pulse.csv"}));
  EXPECT_EQ(record["options"]["starts"], 100);
  EXPECT_TRUE(record["options"]["mass"].is_null());
  EXPECT_FALSE(record["options"].contains("jobs"));
  EXPECT_EQ(record["inputs"], json({{{"path", "pulse.csv"}, {"sha256", sha256_of_file(workspace.path("pulse.csv"))}}}));
}

TEST_F(Recorded, AChangedInputIsRefused) {
  expect_done({"pulse", "trace.csv", "-o", "pulse.csv"});
  expect_done({"run", "case.toml", "-o", "first"});
  workspace.file("trace.csv", test::half_sine_trace(16.6));
  for (const char* record : {"pulse.csv", "first/case.lock.json", "first/response.csv"}) {
    const Finished finished = workspace.run({"run", record, "-o", "again"});
    EXPECT_EQ(finished.exit_code, kUserCanFix);
    EXPECT_THAT(finished.err, AllOf(HasSubstr("trace.csv: has changed since the record was made (SHA-256 "),
                                    HasSubstr("run the command itself instead")));
  }
  EXPECT_FALSE(workspace.has("again"));
}

TEST_F(Recorded, ARecordOfAnotherVersionIsRunWithAWarning) {
  expect_done({"pulse", "trace.csv", "-o", "pulse.csv"});
  std::string text = workspace.text_of("pulse.csv");
  const std::string now = "\"version\":\"" + std::string(kVersion) + "\"";
  text.replace(text.find(now), now.size(), "\"version\":\"0.0.1\"");
  workspace.file("old.csv", text);
  const Finished finished = workspace.run({"run", "old.csv", "-o", "new.csv"});
  EXPECT_EQ(finished.exit_code, kDone);
  EXPECT_THAT(finished.err, HasSubstr("warning: old.csv was made by crashsim 0.0.1, this is " + std::string(kVersion)));
}

struct Damaged {
  const char* what;
  std::string text;
  const char* message;
};
void PrintTo(const Damaged& d, std::ostream* out) { *out << d.what; }

class DamagedRecord : public testing::TestWithParam<Damaged> {};

TEST_P(DamagedRecord, IsRefused) {
  const test::Workspace workspace;
  workspace.file("r.json", GetParam().text);
  const Finished finished = workspace.run({"run", "r.json", "-o", "again"});
  EXPECT_EQ(finished.exit_code, kUserCanFix);
  EXPECT_THAT(finished.err, HasSubstr(GetParam().message));
  EXPECT_FALSE(workspace.has("again"));
}

constexpr const char* kStart = R"({"format": "crashsim.record", "version": "0.1.0", )";
INSTANTIATE_TEST_SUITE_P(
    Records, DamagedRecord,
    testing::Values(
        Damaged{"cut", std::string(kStart), "r.json:1: is not JSON"},
        Damaged{"no_command", std::string(kStart) + "\"options\": {}}", "r.json: its record has no proper 'command'"},
        Damaged{"argument_is_a_number",
                std::string(kStart) + R"("command": "pulse", "arguments": [1], "options": {}, "inputs": []})",
                "r.json: its record has no proper 'arguments'"},
        Damaged{"input_without_fingerprint",
                std::string(kStart) +
                    R"("command": "pulse", "arguments": ["a"], "options": {}, "inputs": [{"path": "a"}]})",
                "r.json: its record has no proper 'sha256'"},
        Damaged{"unknown_command",
                std::string(kStart) + R"("command": "fly", "arguments": [], "options": {}, "inputs": []})",
                "unknown subcommand 'fly'"},
        Damaged{"unknown_option",
                std::string(kStart) + R"("command": "pulse", "arguments": ["a"], "options": {"cfx": 1}, "inputs": []})",
                "unknown option '--cfx', did you mean '--cfc'?"},
        Damaged{"case_without_arguments",
                std::string(kStart) + R"("command": "run", "arguments": [], "options": {}, "inputs": []})",
                "r.json: is the record of 'crashsim run', not of a case"},
        Damaged{
            "lost_input",
            std::string(kStart) +
                R"("command": "pulse", "arguments": ["a"], "options": {}, "inputs": [{"path": "a", "sha256": "0"}]})",
            "a: no such file"},
        Damaged{"json_without_a_record", R"({"format": "crashsim.crush_model"})",
                "r.json: holds no record of what made it"}));

}  // namespace
}  // namespace crashsim
