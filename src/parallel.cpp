#include "parallel.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace crashsim {

int thread_count(int jobs) {
  if (jobs > 0) return jobs;
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

int parallel_for(int count, int threads, const std::function<void(int worker, int index)>& work,
                 const std::function<bool(int done, int count)>& progress) {
  std::atomic<int> next{0};
  std::atomic<bool> stop{false};
  std::mutex mutex;
  std::condition_variable changed;
  int done = 0, running = std::min(threads, count);
  std::exception_ptr failure;

  const auto run_worker = [&](int worker) {
    for (int index = next++; index < count && !stop; index = next++) {
      std::exception_ptr thrown;
      try {
        work(worker, index);
      } catch (...) {
        thrown = std::current_exception();
        stop = true;
      }
      const std::scoped_lock lock(mutex);
      if (thrown && !failure) failure = thrown;
      if (!thrown) ++done;
    }
    const std::scoped_lock lock(mutex);
    --running;
    changed.notify_one();
  };

  {
    std::vector<std::jthread> pool;
    // NOLINTNEXTLINE(cppcoreguidelines-special-member-functions): one local object, never copied
    struct StopOnExit {  // also when progress throws
      std::atomic<bool>& stop;
      ~StopOnExit() { stop = true; }
    } const stop_on_exit{stop};
    for (int worker = 0; worker < std::min(threads, count); ++worker) pool.emplace_back(run_worker, worker);
    std::unique_lock lock(mutex);
    while (running > 0) {
      changed.wait_for(lock, std::chrono::milliseconds(100));
      const int so_far = done;
      lock.unlock();
      if (progress && !progress(so_far, count)) stop = true;
      lock.lock();
    }
  }
  if (failure) std::rethrow_exception(failure);
  return done;
}

}  // namespace crashsim
