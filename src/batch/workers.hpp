#pragma once
/// Processes that work for this one: what happens to one of them costs the task in its hands and nothing else.

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace crashsim::batch {

/// How a worker ended with a task in its hands.
struct WorkerEnd {
  int signal = 0;          ///< That killed it; 0: it ended by itself.
  int exit_code = 0;       ///< When it ended by itself.
  bool timed_out = false;  ///< Killed by us: the task took too long.
};

/// What workers do. All but `work` is called in this process.
struct WorkerTasks {
  std::function<std::string(std::size_t task)> work;             ///< In a worker: one line of text. Must not throw.
  std::function<std::optional<std::size_t>()> next;              ///< The next task; none: none now.
  std::function<void(std::size_t task, std::string)> finished;   ///< With what `work` gave.
  std::function<void(std::size_t task, const WorkerEnd&)> died;  ///< The task is not done; next() may give it again.
  std::function<bool()> goes_on;                                 ///< At least ten times a second; false: stop.
};

struct WorkerLimits {
  int count = 1;
  double time_s = 0.0;    ///< Of one task; 0: none.
  double memory_b = 0.0;  ///< Address space of a worker; 0: none.
};

/// Runs tasks on forked processes until there are none or `goes_on` says so; then, or when a call throws, the workers
/// are killed. They end with this process, however it ends. @throws SystemFailure when none can be made.
void run_on_workers(const WorkerLimits& limits, const WorkerTasks& tasks);

}  // namespace crashsim::batch
