/// Pieces of a batch: rows as text, shards, the unit of work and the folder as other programs use them.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/batch.hpp>
#include <crashsim/batch_folder.hpp>
#include <crashsim/error.hpp>
#include <crashsim/files.hpp>

#include "batch/workers.hpp"
#include "support/source_dir.hpp"
#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

using testing::HasSubstr;
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

TEST_F(BatchFolders, StopAskingAWatcherThatSaysNo) {
  const BatchReport report =
      run_batch(plan, folder, {}, [](const BatchEvent& event) { return event.kind != BatchEvent::Kind::case_started; });
  EXPECT_TRUE(report.interrupted);
  EXPECT_EQ(report.exit_code, 130);
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
