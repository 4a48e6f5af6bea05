#include "parallel.hpp"

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

namespace crashsim {
namespace {

using std::chrono::milliseconds;

class ParallelFor : public testing::TestWithParam<int> {};

TEST_P(ParallelFor, CallsEveryIndexOnceOnItsWorkers) {
  constexpr int kJobs = 500;
  std::vector<std::atomic<int>> calls(kJobs);
  std::atomic<bool> known_worker = true;
  const int done = parallel_for(kJobs, GetParam(),
                                [&](int worker, int index) {
                                  if (worker < 0 || worker >= GetParam()) known_worker = false;
                                  ++calls[static_cast<std::size_t>(index)];
                                },
                                {});
  EXPECT_EQ(done, kJobs);
  EXPECT_TRUE(known_worker);
  for (const auto& count : calls) EXPECT_EQ(count, 1);
}

TEST_P(ParallelFor, ThrowsTheFirstExceptionAndStartsNoFurtherJob) {
  constexpr int kJobs = 100'000, kBad = 10;
  std::atomic<int> started = 0;
  const auto work = [&](int, int index) {
    ++started;
    if (index == kBad) throw std::runtime_error("job 10");
    std::this_thread::sleep_for(std::chrono::microseconds(50));
  };
  try {
    parallel_for(kJobs, GetParam(), work, {});
    FAIL() << "nothing thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "job 10");
  }
  EXPECT_LT(started, kJobs);
}

TEST_P(ParallelFor, StopsWhenTheProgressSaysSo) {
  constexpr int kJobs = 100'000;
  const auto caller = std::this_thread::get_id();
  std::atomic<int> started = 0;
  int last_done = -1;
  const int done = parallel_for(
      kJobs, GetParam(),
      [&](int, int) {
        ++started;
        std::this_thread::sleep_for(milliseconds(1));
      },
      [&](int so_far, int count) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        EXPECT_EQ(count, kJobs);
        EXPECT_GE(so_far, last_done);
        last_done = so_far;
        return so_far == 0;
      });
  EXPECT_GT(done, 0);
  EXPECT_LT(done, kJobs);
  EXPECT_EQ(done, started);  // what was begun was finished
}

TEST_P(ParallelFor, PassesOnWhatTheProgressThrows) {
  std::atomic<int> started = 0;
  const auto work = [&](int, int) {
    ++started;
    std::this_thread::sleep_for(milliseconds(1));
  };
  EXPECT_THROW(parallel_for(100'000, GetParam(), work, [](int, int) -> bool { throw std::logic_error("stop"); }),
               std::logic_error);
  const int at_return = started;
  std::this_thread::sleep_for(milliseconds(5));
  EXPECT_EQ(started, at_return);  // no worker outlives the call
}

INSTANTIATE_TEST_SUITE_P(Threads, ParallelFor, testing::Values(1, 2, 7));

TEST(ParallelForWithoutJobs, ReturnsAtOnce) {
  EXPECT_EQ(parallel_for(0, 4, [](int, int) { FAIL(); }, {}), 0);
}

TEST(ThreadCount, IsTheNumberAskedForOrAllCores) {
  EXPECT_EQ(thread_count(3), 3);
  EXPECT_GE(thread_count(0), 1);
}

}  // namespace
}  // namespace crashsim
