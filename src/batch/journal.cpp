#include "batch/journal.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>

#include <fcntl.h>
#include <unistd.h>

#include <fmt/format.h>

#include <crashsim/error.hpp>

#include "sha256.hpp"

namespace crashsim::batch {
namespace {

constexpr const char* kJournal = "journal";
constexpr std::size_t kSumDigits = 16;
constexpr std::chrono::seconds kSyncInterval{2};  // lost at most when the machine itself stops

std::string checksum(std::string_view text) { return sha256_of(text).substr(0, kSumDigits); }

/// The text of a line "checksum text"; empty when it is not sound.
std::string_view sound_text(std::string_view line) {
  if (line.size() <= kSumDigits + 1 || line[kSumDigits] != ' ') return {};
  const std::string_view text = line.substr(kSumDigits + 1);
  return line.substr(0, kSumDigits) == checksum(text) ? text : std::string_view();
}

/// Reads lines of a descriptor, with memory for one.
class Lines {
 public:
  Lines(int fd, const std::string& path) {
    const int own = ::fcntl(fd, F_DUPFD_CLOEXEC, 0);
    file_ = own < 0 ? nullptr : ::fdopen(own, "rb");
    if (file_ != nullptr) return;
    const int error = errno;
    if (own >= 0) ::close(own);
    throw SystemFailure(fmt::format("{}: cannot be read: {}", path, std::strerror(error)));
  }
  ~Lines() {
    std::fclose(file_);
    std::free(line_);  // NOLINT(cppcoreguidelines-no-malloc): getline's own
  }
  Lines(const Lines&) = delete;
  Lines& operator=(const Lines&) = delete;

  /// The next line with its end; empty when there is none.
  std::string_view next() {
    const ssize_t length = ::getline(&line_, &capacity_, file_);
    return length > 0 ? std::string_view(line_, static_cast<std::size_t>(length)) : std::string_view();
  }

 private:
  std::FILE* file_ = nullptr;
  char* line_ = nullptr;
  std::size_t capacity_ = 0;
};

}  // namespace

Journal::Journal(const Folder& folder, const Visit& visit)
    : path_(folder.path_of(kJournal)), fd_(folder.open_file(kJournal, O_RDWR | O_CREAT)) {
  try {
    folder.sync();
    find_lines(visit);
  } catch (...) {
    ::close(fd_);
    throw;
  }
}

void Journal::find_lines(const Visit& visit) {
  Lines lines(fd_, path_);
  for (std::string_view line = lines.next(); line.ends_with('\n'); line = lines.next()) {
    if (const std::string_view text = sound_text(line.substr(0, line.size() - 1)); !text.empty()) visit(end_, text);
    end_ += line.size();
  }
  if (::ftruncate(fd_, static_cast<::off_t>(end_)) != 0)
    throw SystemFailure(fmt::format("{}: cannot be written: {}", path_, std::strerror(errno)));
}

Journal::~Journal() {
  ::fdatasync(fd_);
  ::close(fd_);
}

std::uint64_t Journal::append(std::string_view text) {
  const std::string line = fmt::format("{} {}\n", checksum(text), text);
  for (std::size_t written = 0; written < line.size();) {
    const ssize_t count =
        ::pwrite(fd_, line.data() + written, line.size() - written, static_cast<::off_t>(end_ + written));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      const int error = errno;
      if (::ftruncate(fd_, static_cast<::off_t>(end_)) != 0) errno = error;  // a torn end is dropped when it is read
      throw SystemFailure(fmt::format("{}: cannot be written: {}", path_, std::strerror(error)));
    }
    written += static_cast<std::size_t>(count);
  }
  const std::uint64_t offset = end_;
  end_ += line.size();
  if (const auto now = std::chrono::steady_clock::now(); now - synced_ > kSyncInterval) {
    ::fdatasync(fd_);
    synced_ = now;
  }
  return offset;
}

std::string Journal::at(std::uint64_t offset) const {
  constexpr std::size_t kBlock = 4096;
  std::string line;
  std::array<char, kBlock> block;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled by pread
  for (;;) {
    const ssize_t got = ::pread(fd_, block.data(), block.size(), static_cast<::off_t>(offset + line.size()));
    if (got <= 0) break;
    const std::string_view piece(block.data(), static_cast<std::size_t>(got));
    const std::size_t end = piece.find('\n');
    line += piece.substr(0, end);
    if (end != std::string_view::npos) break;
  }
  const std::string_view text = sound_text(line);
  if (text.empty()) throw SystemFailure(fmt::format("{}: has been damaged while it was in use", path_));
  return std::string(text);
}

}  // namespace crashsim::batch
