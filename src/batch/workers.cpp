#include "batch/workers.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <fmt/format.h>

#include <crashsim/error.hpp>

namespace crashsim::batch {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kNotLimited = 125;                       // exit code of a worker whose memory could not be limited
constexpr std::chrono::milliseconds kLookAround{100};  // how often the caller is asked whether to go on

/// Sends all of a text; false when nobody listens.
bool send_all(int socket, std::string_view text) {
  while (!text.empty()) {
    const ssize_t sent = ::send(socket, text.data(), text.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) return false;
    text.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

/// Appends what has come to `text`; false when the other end is gone.
bool receive(int socket, std::string& text) {
  std::array<char, 65536> block;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled by recv
  const ssize_t got = ::recv(socket, block.data(), block.size(), 0);
  if (got > 0) text.append(block.data(), static_cast<std::size_t>(got));
  return got > 0 || (got < 0 && (errno == EINTR || errno == EAGAIN));
}

/// Limits the address space of this process, below a limit that it has already. False when the system refuses.
bool limit_memory(double bytes) {
  if (bytes <= 0.0) return true;
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0) return false;
  if (bytes >= static_cast<double>(limit.rlim_max)) return true;  // also what no rlim_t holds
  limit.rlim_cur = limit.rlim_max = static_cast<rlim_t>(bytes);
  return ::setrlimit(RLIMIT_AS, &limit) == 0;
}

/// The life of a worker: tasks come as numbers, a line each; results go back as lines.
[[noreturn]] void live(int socket, const WorkerTasks& tasks) {
  std::string text;
  for (;;) {
    const std::size_t end = text.find('\n');
    if (end == std::string::npos) {
      if (!receive(socket, text)) ::_exit(0);
      continue;
    }
    std::size_t task = 0;
    std::from_chars(text.data(), text.data() + end, task);
    text.erase(0, end + 1);
    std::string result = tasks.work(task);
    std::replace(result.begin(), result.end(), '\n', ' ');  // a line it is, whatever a message says
    if (!send_all(socket, result + "\n")) ::_exit(0);
  }
}

/// A worker as seen from here.
struct Worker {
  ::pid_t pid = -1;
  int socket = -1;
  std::string received;
  std::optional<std::size_t> task;
  Clock::time_point deadline = Clock::time_point::max();
};

class Pool {
 public:
  Pool(const WorkerLimits& limits, const WorkerTasks& tasks)
      : limits_(limits), tasks_(tasks), workers_(static_cast<std::size_t>(std::max(1, limits.count))) {}
  ~Pool() {
    for (Worker& worker : workers_) end(worker);
  }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  void run() {
    while (tasks_.goes_on() && hand_out()) {
      wait();
      for (Worker& worker : workers_) look_after(worker);
    }
  }

 private:
  /// Gives every idle worker a task. False when there is nothing left to do.
  bool hand_out() {
    bool is_busy = false;
    for (Worker& worker : workers_) {
      if (!worker.task) give(worker);
      is_busy = is_busy || worker.task.has_value();
    }
    return is_busy;
  }

  void give(Worker& worker) {
    const std::optional<std::size_t> task = tasks_.next();
    if (!task) return;
    if (worker.pid < 0) start(worker);
    worker.task = task;
    if (limits_.time_s > 0.0)
      worker.deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                           std::chrono::duration<double>(std::min(limits_.time_s, kLongest_s)));
    send_all(worker.socket, fmt::format("{}\n", *task));  // when it is gone, the next look tells
  }

  void start(Worker& worker) {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
      throw SystemFailure(fmt::format("no worker process can be reached: {}", std::strerror(errno)));
    const ::pid_t parent = ::getpid();
    worker.pid = ::fork();
    if (worker.pid == 0) become_worker(parent, ends[0], ends[1]);
    const int error = errno;
    ::close(ends[1]);
    if (worker.pid < 0) {
      ::close(ends[0]);
      throw SystemFailure(fmt::format("no worker process can be made: {}", std::strerror(error)));
    }
    worker.socket = ends[0];
  }

  [[noreturn]] void become_worker(::pid_t parent, int others_end, int own_end) const {
#ifdef __linux__
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    if (::getppid() != parent) ::_exit(0);
    std::signal(SIGINT, SIG_IGN);  // Ctrl-C reaches all; the parent decides
    std::signal(SIGTERM, SIG_DFL);
    for (const Worker& other : workers_)
      if (other.socket >= 0) ::close(other.socket);
    ::close(others_end);
    if (!limit_memory(limits_.memory_b)) ::_exit(kNotLimited);
    live(own_end, tasks_);
  }

  /// Until something comes, a task takes too long, or it is time to look around.
  void wait() {
    std::vector<pollfd> sockets;
    Clock::duration patience = kLookAround;
    for (const Worker& worker : workers_) {
      if (!worker.task) continue;
      sockets.push_back({worker.socket, POLLIN, 0});
      patience = std::min(patience, std::max(Clock::duration::zero(), worker.deadline - Clock::now()));
    }
    const auto rounded_up =
        std::chrono::duration_cast<std::chrono::milliseconds>(patience) + std::chrono::milliseconds(1);
    ::poll(sockets.data(), sockets.size(), static_cast<int>(rounded_up.count()));
  }

  void look_after(Worker& worker) {
    if (!worker.task) return;
    pollfd socket{worker.socket, POLLIN, 0};
    const bool has_news = ::poll(&socket, 1, 0) > 0;
    const bool is_alive = !has_news || receive(worker.socket, worker.received);
    if (worker.received.ends_with('\n')) {
      finish(worker);
    } else if (!is_alive || Clock::now() >= worker.deadline) {
      bury(worker, is_alive);
    }
  }

  void finish(Worker& worker) {
    std::string result = std::exchange(worker.received, {});
    result.pop_back();
    const std::size_t task = *std::exchange(worker.task, std::nullopt);
    worker.deadline = Clock::time_point::max();
    tasks_.finished(task, std::move(result));
  }

  void bury(Worker& worker, bool timed_out) {
    const std::size_t task = *worker.task;
    WorkerEnd how;
    const int status = end(worker);
    how.timed_out = timed_out;
    if (WIFSIGNALED(status)) how.signal = WTERMSIG(status);
    if (WIFEXITED(status)) how.exit_code = WEXITSTATUS(status);
    if (how.exit_code == kNotLimited && !timed_out)
      throw SystemFailure("the memory limit cannot be set: the system refuses it: leave it out");
    tasks_.died(task, how);
  }

  /// Ends a worker: an idle one by itself, one with a task in its hands at once. @returns its wait status
  static int end(Worker& worker) {
    int status = 0;
    if (worker.pid > 0) {
      if (worker.task) ::kill(worker.pid, SIGKILL);
      ::close(worker.socket);
      while (::waitpid(worker.pid, &status, 0) < 0 && errno == EINTR) {
      }
    }
    worker = {};
    return status;
  }

  static constexpr double kLongest_s = 1e9;
  const WorkerLimits& limits_;
  const WorkerTasks& tasks_;
  std::vector<Worker> workers_;
};

}  // namespace

void run_on_workers(const WorkerLimits& limits, const WorkerTasks& tasks) { Pool(limits, tasks).run(); }

}  // namespace crashsim::batch
