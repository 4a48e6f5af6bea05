/// Where results go: whole or not at all, never over an input, and to the stream that was asked for.

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <crashsim/trace_io.hpp>

#include "support/nhtsa_files.hpp"
#include "support/workspace.hpp"

namespace crashsim {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::Finished;
using test::kDone;
using test::kMachineFailed;
using test::kUserCanFix;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class Outputs : public testing::Test {
 protected:
  Outputs() {
    workspace.file("trace.csv", trace);
    workspace.file("model.json", test::kModelText);
  }
  [[nodiscard]] Finished run(const std::vector<std::string>& arguments) const { return workspace.run(arguments); }

  const std::string trace = test::half_sine_trace();
  test::Workspace workspace;
};

TEST_F(Outputs, AnExistingFileIsReplacedOnlyWithForce) {
  workspace.file("out.csv", "mine");
  const Finished refused = run({"pulse", "trace.csv", "-o", "out.csv"});
  EXPECT_EQ(refused.exit_code, kUserCanFix);
  EXPECT_THAT(refused.err, HasSubstr("out.csv: exists already; choose another name, or --force to replace it"));
  EXPECT_EQ(workspace.text_of("out.csv"), "mine");
  EXPECT_EQ(run({"pulse", "trace.csv", "-o", "out.csv", "--force"}).exit_code, kDone);
  EXPECT_THAT(workspace.text_of("out.csv"), StartsWith("# crashsim = "));
  EXPECT_THAT(workspace.names(), ElementsAre("model.json", "out.csv", "trace.csv"));
}

TEST_F(Outputs, DashIsStandardOutputAndTheSummaryGoesToStandardError) {
  const Finished finished = run({"pulse", "trace.csv", "-o", "-"});
  EXPECT_EQ(finished.exit_code, kDone);
  EXPECT_THAT(finished.out, AllOf(StartsWith("# crashsim = "), HasSubstr("time_s,accel_mps2,velocity_mps")));
  EXPECT_THAT(finished.err, AllOf(HasSubstr("pulse of trace.csv"), HasSubstr("maximum dynamic crush")));
  EXPECT_EQ(run({"pulse", "trace.csv", "-o", "pulse.csv"}).exit_code, kDone);
  EXPECT_EQ(workspace.text_of("pulse.csv"), finished.out);
  EXPECT_THAT(workspace.names(), ElementsAre("model.json", "pulse.csv", "trace.csv"));
}

TEST_F(Outputs, EveryCommandWritesToStandardOutput) {
  EXPECT_THAT(run({"simulate", "model.json", "-o", "-"}).out, HasSubstr("energy_residual_j"));
  EXPECT_EQ(json::parse(run({"identify", "trace.csv", "--method", "equation-error", "-o", "-"}).out)["format"],
            "crashsim.crush_model");
  EXPECT_TRUE(json::parse(run({"compare", "trace.csv", "trace.csv", "-o", "-"}).out).contains("channels"));
}

TEST_F(Outputs, JsonIsAllThatGoesToStandardOutput) {
  const Finished finished = run({"simulate", "model.json", "--json", "-o", "r.csv"});
  EXPECT_EQ(finished.exit_code, kDone);
  EXPECT_TRUE(json::parse(finished.out).is_object());
  EXPECT_TRUE(workspace.has("r.csv"));
}

TEST_F(Outputs, QuietSilencesTheSummary) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"pulse", "trace.csv", "-o", "p.csv", "--quiet"},
        {"identify", "trace.csv", "--method", "equation-error", "--quiet", "-o", "m.json"},
        {"simulate", "model.json", "--quiet", "-o", "r.csv"},
        {"compare", "trace.csv", "trace.csv", "--quiet"}}) {
    const Finished finished = run(arguments);
    EXPECT_EQ(finished.exit_code, kDone);
    EXPECT_THAT(finished.err + finished.out, IsEmpty()) << arguments.front();
  }
  EXPECT_THAT(run({"pulse", "none.csv", "-o", "q.csv", "--quiet"}).err, HasSubstr("none.csv: no such file"));
}

TEST_F(Outputs, WhatDoesNotExistIsNull) {
  workspace.file("weak.csv", test::half_sine_trace(10.0));
  const json summary = json::parse(run({"pulse", "weak.csv", "--json"}).out);
  EXPECT_EQ(summary["outcome"], "no_max_crush");
  for (const char* key : {"t_m_s", "max_crush_m", "static_crush_m", "mean_decel_g", "rebound_velocity_mps",
                          "restitution", "centroid_s", "energy_j"})
    EXPECT_TRUE(summary[key].is_null()) << key;
  for (const char* key : {"peak_decel_g", "delta_v_mps", "sm25_g", "asi"}) EXPECT_TRUE(summary[key].is_number()) << key;
}

TEST_F(Outputs, ErrorsLeaveNothingBehind) {
  EXPECT_EQ(run({"pulse", "trace.csv", "--cfc", "1e6", "-o", "p.csv"}).exit_code, kUserCanFix);
  EXPECT_EQ(run({"identify", "trace.csv", "--knots", "0,2,1", "-o", "m.json"}).exit_code, kUserCanFix);
  EXPECT_EQ(run({"simulate", "model.json", "--dt", "1e-12", "-o", "r.csv"}).exit_code, kUserCanFix);
  EXPECT_THAT(workspace.names(), ElementsAre("model.json", "trace.csv"));
}

TEST_F(Outputs, AFullDeviceIsTheMachinesFailure) {
  test::Launch full;
  full.stdout_file = "/dev/full";
  const Finished file = run({"simulate", "model.json", "-o", "/dev/full"});
  EXPECT_EQ(file.exit_code, kMachineFailed);
  EXPECT_THAT(file.err, HasSubstr("/dev/full: cannot be written: No space left on device"));
  const Finished stream = workspace.run({"simulate", "model.json", "-o", "-"}, full);
  EXPECT_EQ(stream.exit_code, kMachineFailed);
  EXPECT_THAT(stream.err, HasSubstr("standard output: cannot be written: No space left on device"));
  EXPECT_EQ(workspace.run({"simulate", "model.json", "--json"}, full).exit_code, kMachineFailed);
}

TEST_F(Outputs, APlaceThatCannotHoldFilesIsToldBeforeTheWork) {
  for (const char* output : {"trace.csv/out.csv", "no/such/out.csv"}) {
    const Finished finished = run({"pulse", "trace.csv", "-o", output});
    EXPECT_EQ(finished.exit_code, kUserCanFix);
    EXPECT_THAT(finished.err, AllOf(HasSubstr(": there is no folder "), HasSubstr(": make it first")));
  }
  const Finished folder = run({"identify", "trace.csv", "--starts", "1000000", "-o", "data"});
  EXPECT_EQ(folder.exit_code, kUserCanFix);
  EXPECT_THAT(folder.err, HasSubstr("data: is a folder: name a file to write"));
  EXPECT_EQ(workspace.text_of("trace.csv"), trace);
}

TEST_F(Outputs, ACaseUnderAFileIsTheMachinesFailure) {
  workspace.file("case.toml", "[crush]\nmodel = \"model.json\"\n");
  const Finished finished = run({"run", "case.toml", "-o", "trace.csv/out"});
  EXPECT_EQ(finished.exit_code, kMachineFailed);
  EXPECT_THAT(finished.err, HasSubstr("trace.csv/out: cannot be made: Not a directory"));
}

struct Spelling {
  const char* what;
  const char* output;
};
void PrintTo(const Spelling& s, std::ostream* out) { *out << s.what; }

/// An input however it is spelled.
class OverAnInput : public Outputs, public testing::WithParamInterface<Spelling> {
 protected:
  OverAnInput() {
    fs::create_symlink("trace.csv", workspace.path("link.csv"));
    fs::create_hard_link(workspace.path("trace.csv"), workspace.path("hard.csv"));
    fs::create_directory(workspace.path("sub"));
  }
};

TEST_P(OverAnInput, IsRefusedEvenWithForce) {
  const std::string output = GetParam().output[0] == '/' ? workspace.path("trace.csv") : GetParam().output;
  for (const std::vector<std::string>& command : {std::vector<std::string>{"pulse", "trace.csv"},
                                                  {"identify", "trace.csv"},
                                                  {"compare", "trace.csv", "trace.csv"}}) {
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), {"--force", "-o", output});
    const Finished finished = run(arguments);
    EXPECT_EQ(finished.exit_code, kUserCanFix);
    EXPECT_THAT(finished.err, HasSubstr(output + ": is an input: choose another name for the output"));
  }
  EXPECT_EQ(workspace.text_of("trace.csv"), trace);
}

INSTANTIATE_TEST_SUITE_P(Spellings, OverAnInput,
                         testing::Values(Spelling{"plain", "trace.csv"}, Spelling{"dot", "./trace.csv"},
                                         Spelling{"through_a_folder", "sub/../trace.csv"},
                                         Spelling{"symlink", "link.csv"}, Spelling{"hard_link", "hard.csv"},
                                         Spelling{"absolute", "/"}));

TEST_F(Outputs, TheConfigurationIsAnInputToo) {
  const std::string options = "cfc = 180\n";
  workspace.file("options.toml", options);
  const Finished finished = run({"pulse", "trace.csv", "--config", "options.toml", "--force", "-o", "options.toml"});
  EXPECT_EQ(finished.exit_code, kUserCanFix);
  EXPECT_THAT(finished.err, HasSubstr("options.toml: is an input"));
  EXPECT_EQ(workspace.text_of("options.toml"), options);
}

TEST_F(Outputs, SoAreTheChannelFilesThatAHeaderNames) {
  std::string samples;
  for (int i = -20; i <= 1000; ++i) samples += fmt::format("{:.6f}\t{:.4f}\n", i * 1e-4, i > 0 ? -30.0 : 0.0);
  test::NhtsaRecord record;
  record.first = "-20";
  record.last = "1000";
  workspace.file("v1.EV5", test::header_text({record}));
  workspace.file("v1.001", samples);
  EXPECT_EQ(run({"pulse", "v1.EV5", "--channel", "1", "-o", "pulse.csv"}).exit_code, kDone);
  const std::vector<std::string> refused[] = {
      {"pulse", "v1.EV5", "--channel", "1", "--force", "-o", "v1.001"},
      {"identify", "v1.EV5", "--method", "equation-error", "--force", "-o", "v1.001"},
      {"compare", "v1.EV5", "v1.EV5", "--force", "-o", "v1.001"},
  };
  for (const std::vector<std::string>& arguments : refused) {
    const Finished finished = run(arguments);
    EXPECT_EQ(finished.exit_code, kUserCanFix) << finished.err;
    EXPECT_THAT(finished.err, HasSubstr("v1.001: is an input"));
  }
  EXPECT_EQ(workspace.text_of("v1.001"), samples);
}

TEST_F(Outputs, SoAreTheFilesThatACaseNames) {
  fs::rename(workspace.path("trace.csv"), workspace.path("pulse.csv"));
  workspace.file("identify.toml", "[pulse]\nfile = \"pulse.csv\"\n[identify]\nmethod = \"equation-error\"\n");
  workspace.file("simulate.toml", "[crush]\nmodel = \"./model.json\"\n");
  const Finished pulse = run({"run", "identify.toml", "-o", ".", "--force"});
  EXPECT_EQ(pulse.exit_code, kUserCanFix);
  EXPECT_THAT(pulse.err, HasSubstr("pulse.csv: is an input"));
  EXPECT_EQ(workspace.text_of("pulse.csv"), trace);
  const Finished model = run({"run", "simulate.toml", "-o", ".", "--force"});
  EXPECT_EQ(model.exit_code, kUserCanFix);
  EXPECT_THAT(model.err, HasSubstr("model.json: is an input"));
  EXPECT_EQ(workspace.text_of("model.json"), test::kModelText);
}

TEST_F(Outputs, ACaseDirectoryIsWrittenAgainOnlyWithForce) {
  workspace.file("case.toml", "[crush]\nmodel = \"model.json\"\n");
  EXPECT_EQ(run({"run", "case.toml", "-o", "out"}).exit_code, kDone);
  const Finished refused = run({"run", "case.toml", "-o", "out"});
  EXPECT_EQ(refused.exit_code, kUserCanFix);
  EXPECT_THAT(refused.err, HasSubstr("exists already"));
  EXPECT_EQ(run({"run", "case.toml", "-o", "out", "--force"}).exit_code, kDone);
  EXPECT_THAT(workspace.names("out"), ElementsAre("case.lock.json", "model.json", "response.csv", "summary.json"));
}

}  // namespace
}  // namespace crashsim
