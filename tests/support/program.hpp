#pragma once
/// The crashsim executable run as a user runs it, without a shell in between.

#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace crashsim::test {

/// How a run of the program ended.
struct Finished {
  int exit_code = -1;  ///< 128 + the signal's number when a signal ended it.
  std::string out, err;
  std::chrono::duration<double> after_interrupt{0};  ///< From SIGINT to the end.
};

/// Where and how to run it.
struct Launch {
  std::string folder = ".";
  std::string stdout_file;                                   ///< Instead of catching standard output.
  std::optional<std::chrono::milliseconds> interrupt_after;  ///< Sends SIGINT.
  std::chrono::seconds time_limit{60};                       ///< Killed when it takes longer.
};

namespace detail {

class Pipe {
 public:
  Pipe() {
    if (::pipe2(ends_, O_CLOEXEC) != 0) throw std::runtime_error(std::strerror(errno));
  }
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  [[nodiscard]] int read_end() const { return ends_[0]; }
  [[nodiscard]] int write_end() const { return ends_[1]; }
  void close_end(int which) {
    if (ends_[which] >= 0) ::close(ends_[which]);
    ends_[which] = -1;
  }

 private:
  int ends_[2] = {-1, -1};
};

[[noreturn]] inline void become_program(std::vector<char*> arguments, const Launch& launch, int out, int err) {
  if (!launch.stdout_file.empty()) out = ::open(launch.stdout_file.c_str(), O_WRONLY);
  const int none = ::open("/dev/null", O_RDONLY);
  if (::chdir(launch.folder.c_str()) == 0 && ::dup2(none, 0) == 0 && ::dup2(out, 1) == 1 && ::dup2(err, 2) == 2)
    ::execv(arguments.front(), arguments.data());
  ::_exit(127);
}

/// Appends what there is to read. False at the end of the stream.
inline bool drain(int descriptor, std::string& text) {
  char buffer[4096];
  const ssize_t got = ::read(descriptor, buffer, sizeof buffer);
  if (got > 0) text.append(buffer, static_cast<std::size_t>(got));
  return got > 0 || (got < 0 && errno == EINTR);
}

/// Reads both streams to their ends, interrupting and killing the program when it is time to.
inline void watch(::pid_t pid, const Launch& launch, Pipe& out, Pipe& err, Finished& finished,
                  std::optional<std::chrono::steady_clock::time_point>& interrupted) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  std::string* texts[] = {&finished.out, &finished.err};
  pollfd streams[] = {{out.read_end(), POLLIN, 0}, {err.read_end(), POLLIN, 0}};
  constexpr int kPollInterval_ms = 10;
  bool killed = false;
  while (streams[0].fd >= 0 || streams[1].fd >= 0) {
    ::poll(streams, 2, kPollInterval_ms);
    for (int i = 0; i < 2; ++i)
      if (streams[i].fd >= 0 && streams[i].revents != 0 && !drain(streams[i].fd, *texts[i])) streams[i].fd = -1;
    const Clock::duration elapsed = Clock::now() - begin;
    if (launch.interrupt_after && !interrupted && elapsed > *launch.interrupt_after) {
      ::kill(pid, SIGINT);
      interrupted = Clock::now();
    }
    if (!killed && elapsed > launch.time_limit) killed = ::kill(pid, SIGKILL) == 0;
  }
}

}  // namespace detail

/// Runs an executable to its end.
inline Finished run(const std::string& executable, const std::vector<std::string>& arguments,
                    const Launch& launch = {}) {
  std::vector<std::string> words = {executable};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  detail::Pipe out, err;
  const ::pid_t pid = ::fork();
  if (pid < 0) throw std::runtime_error(std::strerror(errno));
  if (pid == 0) detail::become_program(argv, launch, out.write_end(), err.write_end());
  out.close_end(1);
  err.close_end(1);
  Finished finished;
  std::optional<std::chrono::steady_clock::time_point> interrupted;
  detail::watch(pid, launch, out, err, finished, interrupted);
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  if (interrupted) finished.after_interrupt = std::chrono::steady_clock::now() - *interrupted;
  finished.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return finished;
}

}  // namespace crashsim::test
