/// What happens to a batch must not cost results: killed, interrupted, full disks, links in the way, two at once.

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <sys/mount.h>

#include "support/background.hpp"
#include "support/batch_cases.hpp"
#include "support/random.hpp"

namespace crashsim {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using test::Background;
using test::BatchWorkspace;
using test::Finished;
using test::kDone;
using test::kInterrupted;
using test::kMachineFailed;
using test::kUserCanFix;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kKilled = 128 + SIGKILL;

/// `crashsim batch in/*.toml` beside the test.
class BackgroundBatch : public Background {
 public:
  BackgroundBatch(const BatchWorkspace& workspace, const std::string& folder, const std::vector<std::string>& more = {})
      : Background(CRASHSIM_EXECUTABLE, arguments(folder, more), workspace.path("")) {}

 private:
  static std::vector<std::string> arguments(const std::string& folder, const std::vector<std::string>& more) {
    std::vector<std::string> all = {"batch", "in/*.toml", "-o", folder};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

/// Whether a process does anything still: not one that only waits to be asked how it ended.
bool is_running(::pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  const std::string stat{std::istreambuf_iterator<char>(file), {}};
  return !stat.empty() && stat.find(") Z ") == std::string::npos;
}

bool are_gone_soon(const std::vector<::pid_t>& pids) {
  const auto any_left = [&] { return std::any_of(pids.begin(), pids.end(), is_running); };
  for (int i = 0; i < 100 && any_left(); ++i) std::this_thread::sleep_for(10ms);
  return !any_left();
}

TEST(BatchFaults, KilledAtRandomTimesItGoesOnToTheSameBytes) {
  constexpr int kKills = 6;
  const BatchWorkspace workspace(40);
  workspace.file("in/broken.toml", "nonsense\n");
  const std::vector<std::string> options = {"--resume", "--keep-going"};
  const auto begin = std::chrono::steady_clock::now();
  (void)workspace.batch("calm", options);
  const std::chrono::duration<double> calm_s = std::chrono::steady_clock::now() - begin;
  test::Random random(20);
  for (int i = 0; i < kKills; ++i) {
    BackgroundBatch batch(workspace, "out", options);
    std::this_thread::sleep_for(calm_s * random.between(0.0, 0.7));
    batch.signal(SIGKILL);
    batch.wait();
  }
  const Finished last = workspace.batch("out", options);
  EXPECT_THAT(last.err, HasSubstr("41 of 41 cases done")) << last.err;
  EXPECT_EQ(workspace.files_of("out"), workspace.files_of("calm"));
  EXPECT_THAT(workspace.names("out/.batch/tmp"), IsEmpty());
}

TEST(BatchFaults, KilledItTakesItsWorkersWithIt) {
  const BatchWorkspace workspace;
  workspace.endless("a");
  workspace.endless("b");
  BackgroundBatch batch(workspace, "out", {"--jobs", "2"});
  const auto workers = batch.children(2);
  ASSERT_EQ(workers.size(), 2u);
  batch.signal(SIGKILL);
  EXPECT_EQ(batch.wait(), kKilled);
  EXPECT_TRUE(are_gone_soon(workers));
}

TEST(BatchFaults, InterruptedItKeepsWhatIsFinished) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const BatchWorkspace workspace(3);
    workspace.endless("long");
    BackgroundBatch batch(workspace, "out");
    const auto workers = batch.children(2);
    while (!workspace.has("out/cases/c02")) std::this_thread::sleep_for(10ms);
    std::this_thread::sleep_for(50ms);
    const auto begin = std::chrono::steady_clock::now();
    batch.signal(signal);
    EXPECT_EQ(batch.wait(), kInterrupted);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 1s);
    EXPECT_THAT(batch.said(), AllOf(HasSubstr("3 of 4 cases done"), HasSubstr("go on with --resume")));
    EXPECT_TRUE(are_gone_soon(workers));
    EXPECT_FALSE(workspace.has("out/results.csv"));
    fs::remove(workspace.path("in/long.toml"));
    EXPECT_THAT(workspace.batch("out", {"--resume"}).err, HasSubstr("3 of 3 cases done, 3 of them before"));
  }
}

TEST(BatchFaults, AWorkerThatIsKilledOnceLosesNothing) {
  const BatchWorkspace workspace;
  workspace.file("in/trace.csv", test::half_sine_trace());
  workspace.file("in/fit.toml", "[pulse]\nfile = \"trace.csv\"\n[identify]\nstarts = 60\n");
  BackgroundBatch batch(workspace, "out", {"--jobs", "1"});
  const auto workers = batch.children(1);
  ASSERT_EQ(workers.size(), 1u);
  ::kill(workers.front(), SIGKILL);
  EXPECT_EQ(batch.wait(), kDone) << batch.said();
  EXPECT_THAT(batch.said(), AllOf(HasSubstr("1 of 1 cases done, 0 failed"), HasSubstr("1 cases were run again")));
  ASSERT_EQ(workspace.batch("calm").exit_code, kDone);
  EXPECT_EQ(workspace.files_of("out"), workspace.files_of("calm"));
}

TEST(BatchFaults, AWorkerThatIsKilledTwiceFailsItsCaseAlone) {
  const BatchWorkspace workspace(2);
  workspace.endless("a");
  BackgroundBatch batch(workspace, "out", {"--jobs", "1", "--keep-going"});
  for (int i = 0; i < 2; ++i) {
    std::vector<::pid_t> workers;
    const auto has_started = [&] {
      workers = batch.children(1);
      return !workers.empty() && (i == 1 ? workspace.has("out/cases/c01") : true);
    };
    for (int wait = 0; wait < 500 && !has_started(); ++wait) std::this_thread::sleep_for(10ms);
    std::this_thread::sleep_for(100ms);
    ASSERT_FALSE(workers.empty());
    ::kill(workers.front(), SIGKILL);
  }
  EXPECT_EQ(batch.wait(), test::kNumbersFailed);
  EXPECT_THAT(batch.said(), AllOf(HasSubstr("3 of 3 cases done, 1 failed"),
                                  HasSubstr("failed: a: crashed: its process was killed twice, by signal 9 (Killed)")));
}

TEST(BatchFaults, AWorkerThatCrashesFailsItsCaseAlone) {
  const BatchWorkspace workspace(1);
  workspace.endless("a");
  BackgroundBatch batch(workspace, "out", {"--jobs", "1", "--keep-going"});
  const auto workers = batch.children(1);
  ASSERT_EQ(workers.size(), 1u);
  std::this_thread::sleep_for(100ms);
  ::kill(workers.front(), SIGSEGV);
  EXPECT_EQ(batch.wait(), test::kNumbersFailed);
  EXPECT_THAT(batch.said(), AllOf(HasSubstr("2 of 2 cases done, 1 failed"),
                                  HasSubstr("failed: a: crashed: its process ended in the middle of it: signal 11")));
}

TEST(BatchFaults, ASecondBatchInTheFolderIsRefused) {
  const BatchWorkspace workspace;
  workspace.endless("a");
  const BackgroundBatch batch(workspace, "out");
  ASSERT_EQ(batch.children(1).size(), 1u);
  const Finished second = workspace.batch("out", {"--resume"});
  EXPECT_EQ(second.exit_code, kUserCanFix);
  EXPECT_THAT(second.err, HasSubstr("out: is in use by process " + std::to_string(batch.pid()) + " on "));
  EXPECT_EQ(workspace.run({"merge", "out", "-o", "joined"}).exit_code, kUserCanFix);
}

TEST(BatchFaults, AJournalTornOrDamagedCostsOnlyItsLines) {
  const BatchWorkspace workspace(4);
  ASSERT_EQ(workspace.batch("calm").exit_code, kDone);
  ASSERT_EQ(workspace.batch("out", {"--jobs", "1"}).exit_code, kDone);
  std::string journal = workspace.text_of("out/.batch/journal");
  journal[journal.find("10.25")] = '9';
  workspace.file("out/.batch/journal", journal.substr(0, journal.size() - 20));
  const Finished again = workspace.batch("out", {"--resume"});
  EXPECT_THAT(again.err, HasSubstr("4 of 4 cases done, 2 of them before"));
  EXPECT_EQ(workspace.files_of("out"), workspace.files_of("calm"));
}

/// A small file system of its own, where the test may mount one.
class SmallDisk : public testing::Test {
 protected:
  SmallDisk() : workspace(12) {
    fs::create_directory(workspace.path("disk"));
    is_mounted = ::mount("none", workspace.path("disk").c_str(), "tmpfs", 0, "size=200k") == 0;
  }
  ~SmallDisk() override {
    if (is_mounted) ::umount2(workspace.path("disk").c_str(), MNT_DETACH);
  }
  void SetUp() override {
    if (!is_mounted) GTEST_SKIP() << "may not mount a tmpfs here";
  }
  void remount(unsigned long flags, const char* options) const {
    ASSERT_EQ(::mount("none", workspace.path("disk").c_str(), "tmpfs", MS_REMOUNT | flags, options), 0);
  }

  BatchWorkspace workspace;
  bool is_mounted = false;
};

TEST_F(SmallDisk, ThatIsFullStopsTheBatchAndLosesNothing) {
  const Finished full = workspace.batch("disk/out", {"--keep-going"});
  EXPECT_EQ(full.exit_code, kMachineFailed);
  EXPECT_THAT(full.err, AllOf(HasSubstr("No space left on device"), HasSubstr("cases are done and kept: mend it")));
  EXPECT_EQ(workspace.batch("disk/out", {"--resume"}).exit_code, kMachineFailed);
  remount(0, "size=16m");
  EXPECT_EQ(workspace.batch("disk/out", {"--resume"}).exit_code, kDone);
  ASSERT_EQ(workspace.batch("calm").exit_code, kDone);
  EXPECT_EQ(workspace.files_of("disk/out"), workspace.files_of("calm"));
}

TEST_F(SmallDisk, ThatIsReadOnlyIsToldAtOnce) {
  remount(MS_RDONLY, "");
  const Finished finished = workspace.batch("disk/out");
  EXPECT_EQ(finished.exit_code, kMachineFailed);
  EXPECT_THAT(finished.err, HasSubstr("disk/out: cannot be made: Read-only file system"));
}

/// A batch that is done, beside a folder that nobody may touch.
class BatchLinks : public testing::Test {
 protected:
  BatchLinks() : workspace(2) {
    fs::create_directory(workspace.path("victim"));
    for (const char* name : {"summary.json", "case.lock.json", "response.csv"})
      workspace.file(std::string("victim/") + name, "precious");
    EXPECT_EQ(workspace.batch("calm").exit_code, kDone);
    EXPECT_EQ(workspace.batch("out").exit_code, kDone);
    untouched = workspace.files_of("victim");
  }

  /// Puts a link to the victim, or to a file in it, in the place of something.
  void put_link(const std::string& name, const std::string& target = "victim") const {
    fs::remove_all(workspace.path(name));
    fs::create_symlink(workspace.path(target), workspace.path(name));
  }
  [[nodiscard]] Finished resume() const {
    Finished finished = workspace.batch("out", {"--resume"});
    EXPECT_EQ(workspace.files_of("victim"), untouched);
    return finished;
  }

  BatchWorkspace workspace;
  std::map<std::string, std::string> untouched;
};

TEST_F(BatchLinks, InPlaceOfFoldersAreRefused) {
  put_link("out/cases");
  const Finished finished = resume();
  EXPECT_EQ(finished.exit_code, kMachineFailed);
  EXPECT_THAT(finished.err, HasSubstr("out/cases: is a link or a file where a folder of the batch must be"));
  put_link("out/.batch");
  EXPECT_EQ(resume().exit_code, kMachineFailed);
}

TEST_F(BatchLinks, InPlaceOfTheJournalAreRefused) {
  put_link("out/.batch/journal", "victim/summary.json");
  const Finished finished = resume();
  EXPECT_EQ(finished.exit_code, kMachineFailed);
  EXPECT_THAT(finished.err, HasSubstr("out/.batch/journal: cannot be opened: Too many levels of symbolic links"));
}

TEST_F(BatchLinks, InPlaceOfResultsAreReplaced) {
  put_link("out/cases/c00");
  put_link("out/results.csv", "victim/response.csv");
  put_link("out/.batch/tmp");
  EXPECT_EQ(resume().exit_code, kDone);
  EXPECT_FALSE(fs::is_symlink(workspace.path("out/cases/c00")));
  EXPECT_EQ(workspace.files_of("out"), workspace.files_of("calm"));
}

TEST_F(BatchLinks, InFoldersThatAreRemovedAreNotFollowed) {
  put_link("out/cases/c01/prediction_link.csv");
  workspace.simulated("c01", 17.0);
  EXPECT_EQ(resume().exit_code, kDone);
  EXPECT_FALSE(workspace.has("out/cases/c01/prediction_link.csv"));
}

}  // namespace
}  // namespace crashsim
