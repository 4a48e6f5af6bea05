/// crashsim batch and merge: what they write, go on with, refuse.

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "support/batch_cases.hpp"

namespace crashsim {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::BatchWorkspace;
using test::Finished;
using test::kDone;
using test::kNumbersFailed;
using test::kUserCanFix;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

TEST(Batch, WritesWhatRunWritesAndARowEach) {
  const BatchWorkspace workspace(3);
  const Finished finished = workspace.batch("out");
  EXPECT_EQ(finished.exit_code, kDone) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("3 of 3 cases done, 0 failed"));
  EXPECT_EQ(workspace.run({"run", "in/c01.toml", "-o", "alone", "--quiet"}).exit_code, kDone);
  EXPECT_EQ(workspace.files_of("out/cases/c01"), workspace.files_of("alone"));

  const auto rows = test::lines_of(workspace.text_of("out/results.csv"));
  ASSERT_THAT(rows, SizeIs(4));
  EXPECT_THAT(rows[0], StartsWith("case,outcome,message,mass_kg,impact_speed_mps,t_m_s,max_crush_m,"));
  EXPECT_THAT(rows[2], StartsWith("c01,completed,,2582,10.25,"));
  const json row = json::parse(test::lines_of(workspace.text_of("out/results.jsonl"))[1]);
  const json summary = json::parse(workspace.text_of("out/cases/c01/summary.json"));
  EXPECT_EQ(row["case"], "c01");
  EXPECT_EQ(row["max_crush_m"], summary["max_crush_m"]);
  EXPECT_EQ(row["rebound_velocity_mps"], nullptr);
  EXPECT_THAT(workspace.text_of("out/timings.csv"), StartsWith("case,seconds,read_s,pulse_s,identify_s,"));
  EXPECT_THAT(workspace.names("out/.batch/tmp"), IsEmpty());
}

TEST(Batch, TellsOfIdentifications) {
  const BatchWorkspace workspace;
  workspace.file("in/trace.csv", test::half_sine_trace());
  workspace.file("in/fit.toml", "[pulse]\nfile = \"trace.csv\"\n[identify]\nstarts = 2\n");
  ASSERT_EQ(workspace.batch("out").exit_code, kDone);
  EXPECT_THAT(workspace.text_of("out/results.csv"), HasSubstr("identification.error,identification.starts_at_best"));
  const json row = json::parse(workspace.text_of("out/results.jsonl"));
  EXPECT_EQ(row["identification"]["starts"], 2);
  EXPECT_GT(row["rating_whole_record"]["velocity_mps"], 0.5);
}

TEST(Batch, GivesTheSameBytesOnAnyNumberOfJobsAndShards) {
  const BatchWorkspace workspace(11);
  workspace.file("in/broken.toml", "nonsense\n");
  ASSERT_EQ(workspace.batch("one", {"--jobs", "1", "--keep-going"}).exit_code, kNumbersFailed);
  ASSERT_EQ(workspace.batch("two", {"--jobs", "2", "--keep-going"}).exit_code, kNumbersFailed);
  const auto whole = workspace.files_of("one");
  EXPECT_EQ(workspace.files_of("two"), whole);
  std::vector<std::string> merge = {"merge"};
  for (const std::string shard : {"3", "1", "4", "2"}) {
    (void)workspace.batch("shard" + shard, {"--shard", shard + "/4", "--keep-going"});
    merge.push_back("shard" + shard);
  }
  merge.insert(merge.end(), {"-o", "joined"});
  const Finished joined = workspace.run(merge);
  EXPECT_EQ(joined.exit_code, kDone) << joined.err;
  EXPECT_THAT(joined.err,
              AllOf(HasSubstr("12 of 12 cases done, 1 failed"), HasSubstr("failed: broken: invalid_input")));
  EXPECT_EQ(workspace.files_of("joined"), whole);
  EXPECT_EQ(workspace.batch("joined", {"--resume", "--keep-going"}).exit_code, kNumbersFailed);
  EXPECT_EQ(workspace.files_of("joined"), whole);
}

TEST(Batch, ResumesWithWhatIsNewChangedOrDamaged) {
  const BatchWorkspace workspace(6);
  ASSERT_EQ(workspace.batch("out").exit_code, kDone);
  EXPECT_THAT(workspace.batch("out", {"--resume"}).err, HasSubstr("6 of 6 cases done, 6 of them before"));
  workspace.simulated("c02", 14.0);
  workspace.simulated("new", 15.0);
  fs::resize_file(workspace.path("out/cases/c03/response.csv"), 100);
  fs::remove(workspace.path("out/cases/c04/summary.json"));
  fs::remove_all(workspace.path("out/cases/c05"));
  const Finished again = workspace.batch("out", {"--resume"});
  EXPECT_EQ(again.exit_code, kDone);
  EXPECT_THAT(again.err, HasSubstr("7 of 7 cases done, 2 of them before"));
  ASSERT_EQ(workspace.batch("fresh").exit_code, kDone);
  EXPECT_EQ(workspace.files_of("out"), workspace.files_of("fresh"));
}

TEST(Batch, RedoesAllWhoseInputHasChanged) {
  const BatchWorkspace workspace(2);
  ASSERT_EQ(workspace.batch("out").exit_code, kDone);
  std::string model = workspace.text_of("in/model.json");
  workspace.file("in/model.json", model.replace(model.find("3000000.0"), 9, "3100000.0"));
  EXPECT_THAT(workspace.batch("out", {"--resume"}).err, HasSubstr("2 of 2 cases done, 0 failed"));
  ASSERT_EQ(workspace.batch("fresh").exit_code, kDone);
  EXPECT_EQ(workspace.files_of("out"), workspace.files_of("fresh"));
}

TEST(Batch, LeavesOutOfTheTablesWhatIsNotAskedForAnyMore) {
  const BatchWorkspace workspace(3);
  ASSERT_EQ(workspace.batch("out").exit_code, kDone);
  fs::remove(workspace.path("in/c01.toml"));
  const Finished again = workspace.batch("out", {"--resume"});
  EXPECT_THAT(again.err, HasSubstr("1 cases in the folder were not asked for"));
  EXPECT_THAT(test::lines_of(workspace.text_of("out/results.csv")), SizeIs(3));
  EXPECT_TRUE(workspace.has("out/cases/c01/summary.json"));
}

TEST(Batch, StopsAtTheFirstFailureOrKeepsGoing) {
  const BatchWorkspace workspace(3);
  workspace.file("in/c00a.toml", "[crush]\nmodel = \"gone.json\"\n");
  workspace.simulated("c00b", 12.0, "end = 0.001\n");  // no maximum crush: the numbers fail
  const Finished stopped = workspace.batch("stopped", {"--jobs", "1"});
  EXPECT_EQ(stopped.exit_code, kUserCanFix);
  EXPECT_THAT(stopped.err, AllOf(HasSubstr("2 of 5 cases done, 1 failed"), HasSubstr("--keep-going")));
  const Finished all = workspace.batch("out", {"--keep-going"});
  EXPECT_EQ(all.exit_code, kNumbersFailed);
  EXPECT_THAT(all.err, AllOf(HasSubstr("5 of 5 cases done, 2 failed"),
                             HasSubstr("failed: c00a: invalid_input: in/gone.json: no such file"),
                             HasSubstr("failed: c00b: no_max_crush: ")));
  EXPECT_THAT(workspace.text_of("out/results.csv"), HasSubstr("c00a,invalid_input,in/gone.json: no such file,,,"));
  EXPECT_FALSE(workspace.has("out/cases/c00a"));
  EXPECT_TRUE(workspace.has("out/cases/c00b/response.csv"));
  EXPECT_EQ(workspace.batch("stopped", {"--resume", "--keep-going"}).exit_code, kNumbersFailed);
  EXPECT_EQ(workspace.files_of("stopped"), workspace.files_of("out"));
}

TEST(Batch, RemovesResultsOfACaseThatFailsNow) {
  const BatchWorkspace workspace(2);
  ASSERT_EQ(workspace.batch("out").exit_code, kDone);
  workspace.file("in/c01.toml", "nonsense\n");
  EXPECT_EQ(workspace.batch("out", {"--resume", "--keep-going"}).exit_code, kNumbersFailed);
  EXPECT_THAT(workspace.names("out/cases"), ElementsAre("c00"));
}

TEST(Batch, LosesNoFileThatIsNotItsOwn) {
  const BatchWorkspace workspace(2);
  ASSERT_EQ(workspace.batch("out").exit_code, kDone);
  workspace.file("out/cases/c01/report.html", "mine");
  EXPECT_EQ(workspace.batch("out", {"--resume"}).exit_code, kDone);
  workspace.simulated("c01", 20.0);
  const Finished again = workspace.batch("out", {"--resume"});
  EXPECT_EQ(again.exit_code, kUserCanFix);
  EXPECT_THAT(again.err, HasSubstr("out/cases/c01/report.html: would be lost when the case is run again: move it"));
  EXPECT_EQ(workspace.text_of("out/cases/c01/report.html"), "mine");
}

TEST(Batch, LimitsTimeAndMemoryOfACase) {
  const BatchWorkspace workspace(2);
  workspace.endless("long");
  workspace.file("in/wide.toml", "[impact]\nspeed = 10\n[crush]\nmodel = \"model.json\"\n[simulate]\ndt = 3e-8\n");
  const Finished finished =
      workspace.batch("out", {"--time-limit", "0.4 s", "--memory-limit", "300", "--keep-going", "--json"});
  EXPECT_EQ(finished.exit_code, kNumbersFailed);
  EXPECT_THAT(finished.err, AllOf(HasSubstr("4 of 4 cases done, 2 failed"),
                                  HasSubstr("failed: long: time_limit: took longer than the time limit of 0.4 s"),
                                  HasSubstr("failed: wide: out_of_memory: out of memory")));
  EXPECT_THAT(workspace.names("out/cases"), ElementsAre("c00", "c01"));
  const json report = json::parse(finished.out);
  EXPECT_EQ(report["failures"][0]["case"], "long");
  EXPECT_EQ(report["done"], 4);
}

TEST(Batch, LogsEveryEventAsJson) {
  const BatchWorkspace workspace(2);
  ASSERT_EQ(workspace.batch("out", {"--jobs", "1", "--log-json", "log.jsonl"}).exit_code, kDone);
  std::vector<std::string> events;
  for (const std::string& line : test::lines_of(workspace.text_of("log.jsonl"))) {
    const json event = json::parse(line);
    events.push_back(event["event"].get<std::string>() + " " + event.value("case", "-"));
    EXPECT_THAT(event["time"].get<std::string>(), testing::ContainsRegex("^20..-..-..T..:..:..\\....Z$"));
  }
  EXPECT_THAT(events, ElementsAre("started -", "case_started c00", "case_finished c00", "case_started c01",
                                  "case_finished c01", "finished -", "report -"));
}

TEST(Batch, ReadsManifestsRelativeToThem) {
  const BatchWorkspace workspace(3);
  workspace.file("in/list.txt", "# three cases\nc0[01].toml\n\n  third = ../in/c02.toml  \n");
  const Finished finished = workspace.run({"batch", "in/list.txt", "data/neon-kw400/case.toml", "-o", "out"});
  EXPECT_EQ(finished.exit_code, kDone) << finished.err;
  EXPECT_THAT(workspace.names("out/cases"), ElementsAre("c00", "c01", "neon-kw400", "third"));
}

TEST(Batch, RunsRecordsOfCases) {
  const BatchWorkspace workspace(1);
  ASSERT_EQ(workspace.batch("first").exit_code, kDone);
  ASSERT_EQ(workspace.run({"batch", "first/cases/c00/case.lock.json", "-o", "second"}).exit_code, kDone);
  EXPECT_EQ(workspace.files_of("second/cases"), workspace.files_of("first/cases"));
}

class BatchRefusal : public testing::Test {
 protected:
  BatchRefusal() : workspace(2) {}

  /// What `crashsim batch` or `merge` says when it refuses.
  [[nodiscard]] std::string refusal(const std::vector<std::string>& arguments) const {
    const Finished finished = workspace.run(arguments);
    EXPECT_EQ(finished.exit_code, kUserCanFix) << finished.err;
    return finished.err;
  }
  BatchWorkspace workspace;
};

TEST_F(BatchRefusal, OfFoldersThatHoldSomething) {
  ASSERT_EQ(workspace.batch("out").exit_code, kDone);
  EXPECT_THAT(refusal({"batch", "in/*.toml", "-o", "out"}),
              HasSubstr("out: holds a batch already, 2 cases of it are done: go on with --resume"));
  EXPECT_THAT(refusal({"batch", "in/*.toml", "-o", "out", "--resume", "--shard", "1/2"}),
              HasSubstr("out: holds shard 1/1, not 1/2"));
  EXPECT_THAT(refusal({"batch", "in/*.toml", "-o", "in"}), HasSubstr("in: is not empty and holds no batch"));
  EXPECT_THAT(refusal({"batch", "in/*.toml", "-o", "in/c00.toml"}), HasSubstr("in/c00.toml: is a file"));
  EXPECT_THAT(refusal({"batch", "in/*.toml"}), HasSubstr("batch: where to?"));
}

TEST_F(BatchRefusal, OfPlansThatAreNone) {
  workspace.file("in/case.toml", "");
  workspace.file("twice.txt", "in/c00.toml\nin/c00.toml\n");
  workspace.file("same.txt", "in/c00.toml\nc00 = in/c01.toml\n");
  workspace.file("up.txt", "../up = in/c00.toml\n");
  workspace.file("hidden.txt", ".batch = in/c00.toml\n");
  workspace.file("nested.txt", "twice.txt\n");
  workspace.file("empty.txt", "# nothing\n");
  EXPECT_THAT(refusal({"batch", "twice.txt", "-o", "out"}), HasSubstr("twice.txt:2: in/c00.toml: is asked for twice"));
  EXPECT_THAT(refusal({"batch", "same.txt", "-o", "out"}),
              HasSubstr("same.txt:2: in/c00.toml and in/c01.toml: are both called 'c00'"));
  EXPECT_THAT(refusal({"batch", "up.txt", "-o", "out"}), HasSubstr("up.txt:1: '../up': is no name for the folder"));
  EXPECT_THAT(refusal({"batch", "hidden.txt", "-o", "out"}), HasSubstr("hidden.txt:1: '.batch': is no name"));
  EXPECT_THAT(refusal({"batch", "nested.txt", "-o", "out"}), HasSubstr("nested.txt:1: twice.txt: is no case"));
  EXPECT_THAT(refusal({"batch", "empty.txt", "-o", "out"}), HasSubstr("no case: name case files"));
  EXPECT_THAT(refusal({"batch", "no*.toml", "-o", "out"}), HasSubstr("no*.toml: matches no file"));
  EXPECT_THAT(refusal({"batch", "gone.txt", "-o", "out"}), HasSubstr("gone.txt: no such file"));
  EXPECT_THAT(refusal({"batch", "in", "-o", "out"}), HasSubstr("in: is a folder: name its cases, as in 'in/*.toml'"));
  for (const char* shard : {"0/2", "3/2", "x", "1/2/3", "1", "/", "1/1000001"})
    EXPECT_THAT(refusal({"batch", "in/c*.toml", "-o", "out", "--shard", shard}), HasSubstr("must be I/N"));
  EXPECT_FALSE(workspace.has("out"));
}

TEST_F(BatchRefusal, OfShardsThatDoNotBelongTogether) {
  const auto shard = [&](const std::string& which, const std::string& folder) {
    ASSERT_EQ(workspace.batch(folder, {"--shard", which}).exit_code, kDone);
  };
  shard("1/2", "a");
  shard("2/2", "b");
  shard("1/2", "a2");
  shard("1/3", "other");
  EXPECT_THAT(refusal({"merge", "a", "-o", "out"}), HasSubstr("shard 2/2: not given"));
  EXPECT_THAT(refusal({"merge", "a", "b", "a2", "-o", "out"}), HasSubstr("a and a2: are both shard 1/2"));
  EXPECT_THAT(refusal({"merge", "b", "other", "-o", "out"}), HasSubstr("b and other: are not shards of one batch"));
  EXPECT_THAT(refusal({"merge", "a", "in", "-o", "out"}), HasSubstr("in: holds no batch"));
  EXPECT_THAT(refusal({"merge", "a", "gone", "-o", "out"}), HasSubstr("gone: no such folder"));
  EXPECT_THAT(refusal({"merge", "a", "b", "-o", "in"}), HasSubstr("in: exists already"));
  fs::remove_all(workspace.path("b/cases/c01"));
  EXPECT_THAT(refusal({"merge", "a", "b", "-o", "out"}), HasSubstr("b: the files of case 'c01' are gone"));
  workspace.simulated("c02", 11.0);
  shard("2/2", "more");
  EXPECT_THAT(refusal({"merge", "a", "more", "-o", "out"}), HasSubstr("a and more: are not shards of one batch"));
  EXPECT_THAT(workspace.names(), Not(IsSupersetOf({"out"})));
}

}  // namespace
}  // namespace crashsim
