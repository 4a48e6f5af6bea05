#include "batch/folder_lock.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <fmt/format.h>

#include <crashsim/error.hpp>

#include "text.hpp"

namespace crashsim::batch {
namespace {

constexpr const char* kLock = "lock";
constexpr std::size_t kLongest = 512;  // what a lock says

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "?";
}

/// "123 host", as the holder wrote it.
std::string holder_of(int fd) {
  std::array<char, kLongest> text{};
  const ssize_t got = ::pread(fd, text.data(), text.size(), 0);
  return std::string(trimmed({text.data(), got > 0 ? static_cast<std::size_t>(got) : 0}));
}

/// Whether the holder ran here and is gone: then only its workers are left, which end with it.
bool is_dying(const std::string& holder) {
  const std::size_t blank = holder.find(' ');
  if (blank == std::string::npos || holder.substr(blank + 1) != host_name()) return false;
  const auto pid = static_cast<::pid_t>(std::strtol(holder.c_str(), nullptr, 10));
  return pid > 0 && ::kill(pid, 0) != 0 && errno == ESRCH;
}

[[noreturn]] void refuse(const std::string& what, const std::string& holder) {
  const std::size_t blank = std::min(holder.find(' '), holder.size());
  throw InvalidInput(
      fmt::format("{}: is in use by process {} on {}: wait until it has finished, or choose another folder", what,
                  holder.substr(0, blank), holder.substr(std::min(blank + 1, holder.size()))));
}

}  // namespace

FolderLock::FolderLock(const Folder& folder, const std::string& what) : fd_(folder.open_file(kLock, O_RDWR | O_CREAT)) {
  using namespace std::chrono_literals;
  const auto begin = std::chrono::steady_clock::now();
  while (::flock(fd_, LOCK_EX | LOCK_NB) != 0) {
    const int error = errno;
    const std::string holder = holder_of(fd_);
    const auto patience = is_dying(holder) ? 5s : 500ms;  // the latter: killed, but its parent has not noticed
    if (error == EWOULDBLOCK && std::chrono::steady_clock::now() < begin + patience) {
      std::this_thread::sleep_for(10ms);
      continue;
    }
    ::close(fd_);
    if (error == EWOULDBLOCK) refuse(what, holder);
    throw SystemFailure(fmt::format("{}: cannot be locked: {}", what, std::strerror(error)));
  }
  const std::string me = fmt::format("{} {}\n", ::getpid(), host_name());
  if (::ftruncate(fd_, 0) != 0 || ::pwrite(fd_, me.data(), me.size(), 0) != std::ssize(me)) {
    const int error = errno;
    ::close(fd_);
    throw SystemFailure(fmt::format("{}: cannot be written: {}", folder.path_of(kLock), std::strerror(error)));
  }
}

FolderLock::~FolderLock() {
  ::flock(fd_, LOCK_UN);  // a child that was forked meanwhile may hold the descriptor a little longer
  ::close(fd_);
}

}  // namespace crashsim::batch
