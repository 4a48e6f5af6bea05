#pragma once
/// The program run beside the test, so that the test can do things to it.

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace crashsim::test {

using namespace std::chrono_literals;

/// A process of the program; killed when it is still there at the end of the test.
class Background {
 public:
  /// Runs it in `folder`; what it says on standard error goes to a file there.
  Background(std::string executable, const std::vector<std::string>& arguments, const std::string& folder)
      : said_(folder + "/background.err") {
    std::vector<std::string> words = {std::move(executable)};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ != 0) return;
    const int none = ::open("/dev/null", O_RDWR), said = ::open(said_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (::chdir(folder.c_str()) == 0 && ::dup2(none, 0) == 0 && ::dup2(none, 1) == 1 && ::dup2(said, 2) == 2)
      ::execv(argv.front(), argv.data());
    ::_exit(127);
  }
  ~Background() {
    signal(SIGKILL);
    wait();
  }
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  void signal(int number) const {
    if (pid_ > 0) ::kill(pid_, number);
  }
  [[nodiscard]] ::pid_t pid() const { return pid_; }

  /// Its processes of the moment; waits until there are as many, 10 s at most.
  [[nodiscard]] std::vector<::pid_t> children(std::size_t count) const {
    std::vector<::pid_t> pids;
    for (int i = 0; i < 1000 && pids.size() < count; ++i) {
      pids.clear();
      std::ifstream file("/proc/" + std::to_string(pid_) + "/task/" + std::to_string(pid_) + "/children");
      for (::pid_t pid = 0; file >> pid;) pids.push_back(pid);
      if (pids.size() < count) std::this_thread::sleep_for(10ms);
    }
    return pids;
  }

  /// Waits for its end. @returns the exit code, 128 + the signal's number when a signal ended it.
  int wait() {
    if (pid_ < 0) return exit_code_;
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return exit_code_;
  }

  [[nodiscard]] std::string said() const {
    std::ifstream file(said_);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  std::string said_;
  ::pid_t pid_ = -1;
  int exit_code_ = -1;
};

}  // namespace crashsim::test
