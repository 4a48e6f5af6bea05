/// Pieces of a batch: rows as text, shards, the unit of work and the folder as other programs use them.

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/batch.hpp>
#include <crashsim/batch_folder.hpp>
#include <crashsim/error.hpp>
#include <crashsim/files.hpp>

#include "batch/batch_file.hpp"
#include "batch/workers.hpp"
#include "support/source_dir.hpp"
#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;
using testing::ThrowsMessage;

BatchRow some_row() {
  BatchRow row;
  row.name = "a \"quoted\", näme";
  row.outcome = "completed";
  row.message = "line\nline";
  row.exit_code = 3;
  row.values = {
      {"t_m_s", 0.1, ""}, {"whole", 2.0, ""}, {"count", std::int64_t{7}, ""}, {"is", true, ""}, {"who", "x", ""}};
  row.parts = {{"pulse", {{"none", kUnset, ""}}}};
  row.identity = "abc";
  row.bytes = 12345678901;
  row.stages.write_s = 0.25;
  row.seconds = 1.0 / 3.0;
  return row;
}

TEST(BatchRow, ComesBackFromText) {
  const BatchRow row = some_row(), back = batch_row_from_json(to_json(row));
  EXPECT_EQ(to_json(back), to_json(row));
  EXPECT_EQ(back.name, row.name);
  EXPECT_EQ(back.message, row.message);
  EXPECT_EQ(back.bytes, row.bytes);
  EXPECT_EQ(back.stages, row.stages);
  EXPECT_EQ(back.seconds, row.seconds);
  EXPECT_EQ(std::get<double>(back.values[1].value), 2.0);
  EXPECT_EQ(std::get<std::int64_t>(back.values[2].value), 7);
  EXPECT_TRUE(std::isnan(std::get<double>(back.parts[0].second[0].value)));
}

TEST(BatchRow, OfOtherTextIsRefused) {
  for (const char* text : {"", "nonsense", "{}", "[1]", R"({"case": 1})"})
    EXPECT_THROW((void)batch_row_from_json(text), InvalidInput) << text;
}

TEST(BatchShard, IsReadFromText) {
  EXPECT_EQ(parse_shard("2/8"), (BatchShard{2, 8}));
  EXPECT_THAT([] { (void)parse_shard("9/8"); }, ThrowsMessage<InvalidInput>(HasSubstr("shard '9/8': must be I/N")));
}

TEST(BatchPlan, NamesCasesByTheirFilesOrFolders) {
  const std::string data = std::string(test::source_dir()) + "/data/";
  const auto plan = plan_batch({data + "*/case.toml", data + "paper/free.toml"});
  ASSERT_THAT(plan, SizeIs(7));  // design, fe-car, neon-kw400, paper, scatter, silverado-kw400, free
  EXPECT_EQ(plan[0], (BatchCase{"design", data + "design/case.toml"}));
  EXPECT_EQ(plan[6], (BatchCase{"free", data + "paper/free.toml"}));
}

class BatchFolders : public testing::Test {
 protected:
  std::string data = std::string(test::source_dir()) + "/data/";
  std::vector<BatchCase> plan = {{"a", data + "neon-kw400/case.toml"}, {"b", data + "gone.toml"}};
  test::TempDir dir;
  std::string folder = dir.path("out");
};

TEST_F(BatchFolders, KeepRowsOfCasesThatAreRunAnywhere) {
  {
    BatchFolder batch(folder, plan, {});
    for (const std::size_t i : {1U, 0U}) batch.record(i, run_batch_case(plan[i], folder));
    EXPECT_THROW(batch.record(0, some_row()), InvalidInput);
  }
  BatchOptions options;
  options.resume = true;
  const BatchFolder batch(folder, plan, options);
  const BatchRow a = batch.row_of(0).value(), b = batch.row_of(1).value();
  EXPECT_EQ(a.outcome, "completed");
  EXPECT_TRUE(is_batch_case_done(plan[0], folder, a));
  EXPECT_EQ(b.outcome, kInvalidInput);
  EXPECT_THAT(b.message, HasSubstr("gone.toml: no such file"));
  EXPECT_FALSE(is_batch_case_done(plan[1], folder, b));
  EXPECT_GT(a.stages.simulate_s, 0.0);
  EXPECT_LE(a.stages.simulate_s + a.stages.write_s, a.seconds);
  batch.write_tables();
  EXPECT_THAT(read_file(folder + "/results.csv"), HasSubstr("\na,completed,,1354,15.646"));
}

TEST_F(BatchFolders, BelongToOneAtATime) {
  const BatchFolder batch(folder, plan, {});
  EXPECT_THAT([&] { const BatchFolder second(folder, plan, {}); },
              ThrowsMessage<InvalidInput>(HasSubstr("is in use by")));
}

TEST_F(BatchFolders, KnowSampledCasesAgain) {
  write_file_atomically(dir.path("s.toml"),
                        "[crush]\nmodel = \"" + data +
                            "neon-kw400/model.json\"\n[sweep]\n"
                            "impact.speed = [\"40 km/h\", \"48 km/h\"]\n",
                        false);
  plan = {{"s", dir.path("s.toml")}};
  ASSERT_EQ(run_batch(plan, folder).exit_code, 0);
  ASSERT_THAT(read_file(folder + "/cases/s/sweep.json"), HasSubstr("outcomes"));
  BatchOptions options;
  options.resume = true;
  EXPECT_EQ(run_batch(plan, folder, options).unchanged, 1u);
  write_file_atomically(dir.path("s.toml"), "nonsense", true);  // whose files are removed
  EXPECT_EQ(run_batch(plan, folder, options).exit_code, 2);
  EXPECT_THROW((void)read_file(folder + "/cases/s/sweep.json"), InvalidInput);
}

TEST_F(BatchFolders, TellWhenNoSampleCompletes) {
  write_file_atomically(dir.path("s.toml"),
                        "[crush]\nmodel = \"" + data +
                            "neon-kw400/model.json\"\n[sweep]\n"
                            "crush.k2 = [\"-1 N\"]\n",
                        false);
  const BatchFolder batch(folder, {{"s", dir.path("s.toml")}}, {});
  const BatchRow row = run_batch_case(batch.cases()[0], folder);
  EXPECT_EQ(row.outcome, "invalid_input");
  EXPECT_EQ(row.exit_code, 3);
  EXPECT_THAT(row.message, HasSubstr("none of the 1 samples completed: the first ended as invalid_input"));
}

TEST_F(BatchFolders, HoldNoCaseWhoseNameLeadsOut) {
  const auto refused = [](const char* what) { return ThrowsMessage<InvalidInput>(HasSubstr(what)); };
  for (const char* name : {"../../x", "..", ".", "a/b", ""}) {
    const BatchCase bad{name, plan[0].path};
    EXPECT_THAT([&] { const BatchFolder batch(folder, {bad}, {}); }, refused("': is no name for the folder of a case"));
    EXPECT_THAT([&] { (void)run_batch_case(bad, folder); }, refused("': is no name for the folder of a case"));
    EXPECT_THAT([&] { (void)batch::parse_plan(batch::format_plan({bad}), "s/plan"); }, refused("s/plan: '"));
  }
  EXPECT_THAT([&] { const BatchFolder batch(folder, {{"caf\xe9", "x.toml"}}, {}); }, refused("is not UTF-8"));
  EXPECT_THAT(
      [&] {
        const BatchFolder batch(folder, {plan[0], plan[0]}, {});
      },
      refused("'a': is the name of two cases"));
}

TEST_F(BatchFolders, TellNothingOfAnEarlierRunWhenTheyAreStopped) {
  plan = {{"b", dir.path("b.toml")}, {"a", data + "neon-kw400/case.toml"}};
  write_file_atomically(plan[0].path, "[crush]\nmodel = \"" + data + "neon-kw400/model.json\"\n", false);
  BatchOptions options;
  options.resume = true;
  options.jobs = 1;
  ASSERT_EQ(run_batch(plan, folder, options).exit_code, 0);
  write_file_atomically(plan[0].path, "nonsense", true);
  const BatchReport stopped = run_batch(plan, folder, options);
  EXPECT_EQ(stopped.done, 1u);
  EXPECT_THAT(read_file(folder + "/results.csv"), AllOf(HasSubstr("\nb,invalid_input,"), Not(HasSubstr("\na,"))));
}

TEST_F(BatchFolders, AreNotJoinedWhenFilesHaveChanged) {
  plan.resize(1);
  ASSERT_EQ(run_batch(plan, folder).exit_code, 0);
  write_file_atomically(folder + "/cases/a/summary.json", "{}", true);
  EXPECT_THAT([&] { (void)merge_batches({folder}, dir.path("joined")); },
              ThrowsMessage<InvalidInput>(HasSubstr("the files of case 'a' have ")));
}

TEST_F(BatchFolders, StopAskingAWatcherThatSaysNo) {
  const BatchReport report =
      run_batch(plan, folder, {}, [](const BatchEvent& event) { return event.kind != BatchEvent::Kind::case_started; });
  EXPECT_TRUE(report.interrupted);
  EXPECT_EQ(report.exit_code, 130);
}

TEST_F(BatchFolders, AreNotJoinedTwice) {
  plan.resize(1);
  ASSERT_EQ(run_batch(plan, folder).exit_code, 0);
  EXPECT_THAT(
      [&] {
        (void)merge_batches({folder, dir.path("./out")}, dir.path("joined"));
      },
      ThrowsMessage<InvalidInput>(HasSubstr("are the same folder: leave one out")));
}

TEST(Workers, TellInOneLineAndTakeAnyLimitOfMemory) {
  bool is_given = false;
  std::string told;
  batch::WorkerLimits limits;
  limits.memory_b = 1e300;
  batch::run_on_workers(limits,
                        {[](std::size_t) { return std::string("a\nb\n"); },
                         [&]() -> std::optional<std::size_t> {
                           if (std::exchange(is_given, true)) return std::nullopt;
                           return 0;
                         },
                         [&](std::size_t, const std::string& text) { told = text; },
                         [](std::size_t task, const batch::WorkerEnd&) { FAIL() << task; }, [] { return true; }});
  EXPECT_EQ(told, "a b ");
}

TEST(Workers, DoEveryTaskOnceAndEndWithTheCaller) {
  std::size_t next = 0;
  std::vector<std::size_t> done;
  batch::WorkerLimits limits;
  limits.count = 3;
  batch::run_on_workers(limits,
                        {[](std::size_t task) { return std::string(10'000 * task, 'x'); },
                         [&]() -> std::optional<std::size_t> {
                           if (next == 20) return std::nullopt;
                           return next++;
                         },
                         [&](std::size_t task, const std::string& text) {
                           EXPECT_EQ(text.size(), 10'000 * task);
                           done.push_back(task);
                         },
                         [](std::size_t task, const batch::WorkerEnd&) { FAIL() << task; }, [] { return true; }});
  std::sort(done.begin(), done.end());
  ASSERT_THAT(done, SizeIs(20));
  EXPECT_EQ(done.back(), 19u);
}

}  // namespace
}  // namespace crashsim
