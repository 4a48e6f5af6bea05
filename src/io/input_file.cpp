#include "io/input_file.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include <crashsim/error.hpp>

namespace crashsim::io {
namespace {

class Descriptor {
 public:
  explicit Descriptor(const char* path) : fd_(::open(path, O_RDONLY | O_CLOEXEC)) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

[[noreturn]] void refuse(const std::string& path, int error) {
  throw InvalidInput(error == ENOENT ? fmt::format("{}: no such file", path)
                                     : fmt::format("{}: cannot be read: {}", path, std::strerror(error)));
}

std::string read_to_end(int fd, const std::string& path) {
  constexpr std::size_t kBlock = std::size_t{1} << 16, kMost = std::size_t{1} << 30;
  std::string text;
  for (std::size_t used = 0;;) {
    text.resize(used + kBlock);
    const ssize_t got = ::read(fd, text.data() + used, kBlock);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) refuse(path, errno);
    used += static_cast<std::size_t>(got);
    if (used > kMost)
      throw InvalidInput(fmt::format("{}: gives more than {} bytes and is no file: name a file", path, kMost));
    if (got > 0) continue;
    text.resize(used);
    return text;
  }
}

}  // namespace

InputFile::InputFile(std::string path) : path_(std::move(path)) {
  const Descriptor file(path_.c_str());
  struct stat status {};
  if (file.get() < 0 || ::fstat(file.get(), &status) != 0) refuse(path_, errno);
  is_folder_ = S_ISDIR(status.st_mode);
  if (is_folder_) return;
  const auto size = static_cast<std::size_t>(status.st_size);
  if (S_ISREG(status.st_mode) && size > 0) {
    void* mapping = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.get(), 0);
    if (mapping != MAP_FAILED) {
      mapping_ = mapping;
      bytes_ = {static_cast<const char*>(mapping), size};
      return;
    }
  }
  buffer_ = read_to_end(file.get(), path_);
  bytes_ = buffer_;
}

InputFile::InputFile(std::string path, std::string bytes)
    : path_(std::move(path)), buffer_(std::move(bytes)), bytes_(buffer_) {}

InputFile::~InputFile() {
  if (mapping_ != nullptr) ::munmap(mapping_, bytes_.size());
}

}  // namespace crashsim::io
