/// crashsim export, of traces; tests/unit/export_test.cpp judges what models become.
#include <filesystem>

#include <nlohmann/json.hpp>

#include <gmock/gmock.h>

#include <crashsim/pulse.hpp>
#include <crashsim/trace_io.hpp>

#include "support/program.hpp"
#include "support/workspace.hpp"

namespace crashsim {
namespace {

using test::Finished;
using test::kDone;
using test::kUserCanFix;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class ExportTraces : public testing::Test {
 protected:
  ExportTraces() {
    workspace.file("trace.csv", test::half_sine_trace());
    EXPECT_EQ(workspace.run({"pulse", "trace.csv", "-o", "pulse.csv"}).exit_code, kDone);
  }
  [[nodiscard]] Finished to_iso_mme(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"export", "pulse.csv", "--to", "iso-mme"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return workspace.run(arguments);
  }

  test::Workspace workspace;
};

TEST_F(ExportTraces, APulseBecomesAnIsoMmeTestThatReadsBackAsThePulse) {
  const Finished finished = to_iso_mme({"--test", "T1", "-o", "T1"});
  ASSERT_EQ(finished.exit_code, kDone) << finished.err;
  EXPECT_THAT(workspace.names("T1"), ElementsAre("Channel", "T1.mme", "T1.txt"));
  const TraceSet test = read_traces(workspace.path("T1")), pulse = read_traces(workspace.path("pulse.csv"));
  EXPECT_EQ(test.format, "iso_mme");
  EXPECT_EQ(test.mass_kg, 1500.0);
  EXPECT_EQ(test.impact_speed_mps, test::kTraceSpeed_mps);
  ASSERT_EQ(test.traces.size(), pulse.traces.size());
  for (std::size_t i = 0; i < pulse.traces.size(); ++i) {
    EXPECT_EQ(test.traces[i].values, pulse.traces[i].values) << pulse.traces[i].name;
    EXPECT_EQ(test.traces[i].dimension, pulse.traces[i].dimension);
  }
  EXPECT_THAT(test.compartment_x, ElementsAre(test.traces[0].id));
}

TEST_F(ExportTraces, TheRecordOfAnIsoMmeTestMakesTheSameTestAgain) {
  ASSERT_EQ(to_iso_mme({"-o", "first"}).exit_code, kDone);
  const Finished again = workspace.run({"run", "first/pulse.txt", "-o", "second"});
  ASSERT_EQ(again.exit_code, kDone) << again.err;
  for (const char* file : {"pulse.mme", "pulse.txt", "Channel/pulse.chn", "Channel/pulse.001", "Channel/pulse.003"})
    EXPECT_EQ(workspace.text_of(std::string("first/") + file), workspace.text_of(std::string("second/") + file))
        << file;
}

TEST_F(ExportTraces, AFolderThatHoldsOtherFilesIsLeftAlone) {
  ASSERT_EQ(to_iso_mme({"-o", "T1"}).exit_code, kDone);
  const Finished second = to_iso_mme({"-o", "T1"});
  EXPECT_EQ(second.exit_code, kUserCanFix);
  EXPECT_THAT(second.err, HasSubstr("T1"));
  EXPECT_EQ(to_iso_mme({"-o", "T1", "--overwrite"}).exit_code, kDone);
  workspace.file("T1/notes.txt", "mine");
  EXPECT_EQ(to_iso_mme({"-o", "T1", "--overwrite"}).exit_code, kUserCanFix);
  EXPECT_EQ(workspace.text_of("T1/notes.txt"), "mine");
  std::filesystem::remove(workspace.path("T1/notes.txt"));
  workspace.file("T1/Channel/notes.txt", "mine too");
  const Finished within = to_iso_mme({"-o", "T1", "--overwrite"});
  EXPECT_EQ(within.exit_code, kUserCanFix);
  EXPECT_THAT(within.err, HasSubstr("holds Channel/notes.txt too, which would be lost"));
  EXPECT_EQ(workspace.text_of("T1/Channel/notes.txt"), "mine too");
}

TEST_F(ExportTraces, AFolderGivesTheTestItsName) {
  ASSERT_EQ(to_iso_mme({"-o", "T1"}).exit_code, kDone);
  for (const char* folder : {"T1", "T1/"}) {
    const Finished finished = workspace.run({"export", folder, "--to", "iso-mme", "-o", "again", "--overwrite"});
    ASSERT_EQ(finished.exit_code, kDone) << finished.err;
    EXPECT_THAT(workspace.names("again"), ElementsAre("Channel", "T1.mme", "T1.txt")) << folder;
  }
}

TEST_F(ExportTraces, OnlyChosenChannelsAreWritten) {
  const Finished finished = to_iso_mme({"--channel", "velocity*", "-o", "T1"});
  ASSERT_EQ(finished.exit_code, kDone) << finished.err;
  EXPECT_THAT(finished.err, testing::Not(HasSubstr("left out")));
  const TraceSet test = read_traces(workspace.path("T1"));
  ASSERT_EQ(test.traces.size(), 1u);
  EXPECT_EQ(test.traces[0].name, "velocity_mps");
}

TEST_F(ExportTraces, ChannelsWithoutACodeAreLeftOutWithANote) {
  workspace.file("k.csv", "time_s,accel_mps2,k_n_per_m\n0,1,2\n1,2,3\n");
  const Finished finished = workspace.run({"export", "k.csv", "--to", "iso-mme", "-o", "T1"});
  ASSERT_EQ(finished.exit_code, kDone) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("note: left out: channel 3 k_n_per_m: ISO-MME has no code for stiffness"));
  EXPECT_EQ(read_traces(workspace.path("T1")).traces.size(), 1u);
}

TEST_F(ExportTraces, StandardOutputAndModelsAreRefused) {
  EXPECT_THAT(to_iso_mme({"-o", "-"}).err, HasSubstr("several files: name a folder"));
  workspace.file("m.json", test::kModelText);
  const Finished model = workspace.run({"export", "m.json", "--to", "iso-mme", "-o", "T1"});
  EXPECT_EQ(model.exit_code, kUserCanFix);
  EXPECT_THAT(model.err, AllOf(HasSubstr("m.json"), HasSubstr("not a trace file")));
}

}  // namespace
}  // namespace crashsim
