#include "batch/folder.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include <crashsim/error.hpp>

namespace crashsim::batch {
namespace {

constexpr int kFolderFlags = O_RDONLY | O_DIRECTORY | O_CLOEXEC;
constexpr ::mode_t kFolderMode = 0777, kFileMode = 0666;  // less what the umask takes

[[noreturn]] void fail_at(const std::string& path, const char* what, int error) {
  throw SystemFailure(fmt::format("{}: cannot be {}: {}", path, what, std::strerror(error)));
}

struct CloseDirectory {
  void operator()(DIR* directory) const { ::closedir(directory); }
};

}  // namespace

Folder::Folder(const std::string& path) : fd_(::open(path.c_str(), kFolderFlags)), path_(path) {
  if (fd_ < 0) fail_at(path, "opened", errno);
}

Folder::~Folder() {
  if (fd_ >= 0) ::close(fd_);
}

Folder::Folder(Folder&& other) noexcept : fd_(std::exchange(other.fd_, -1)), path_(std::move(other.path_)) {}

std::string Folder::path_of(std::string_view name) const { return (std::filesystem::path(path_) / name).string(); }

void Folder::fail(const std::string& name, const char* what, int error) const { fail_at(path_of(name), what, error); }

Folder Folder::inside(const std::string& name) const {
  if (::mkdirat(fd_, name.c_str(), kFolderMode) != 0 && errno != EEXIST) fail(name, "made", errno);
  const int fd = ::openat(fd_, name.c_str(), kFolderFlags | O_NOFOLLOW);
  if (fd >= 0) return {fd, path_of(name)};
  if (errno == ELOOP || errno == ENOTDIR)
    throw SystemFailure(
        fmt::format("{}: is a link or a file where a folder of the batch must be: remove it, and find "
                    "out who put it there",
                    path_of(name)));
  fail(name, "opened", errno);
}

std::optional<Folder> Folder::find(const std::string& name) const {
  const int fd = ::openat(fd_, name.c_str(), kFolderFlags | O_NOFOLLOW);
  if (fd < 0) return std::nullopt;
  return Folder(fd, path_of(name));
}

std::vector<std::string> Folder::names() const {
  const int fd = ::openat(fd_, ".", kFolderFlags);  // a position of its own
  if (fd < 0) fail_at(path_, "read", errno);
  const std::unique_ptr<DIR, CloseDirectory> directory(::fdopendir(fd));
  if (!directory) {
    const int error = errno;
    ::close(fd);
    fail_at(path_, "read", error);
  }
  std::vector<std::string> names;
  while (const dirent* entry = ::readdir(directory.get())) {
    const std::string name = entry->d_name;
    if (name != "." && name != "..") names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool Folder::has(const std::string& name) const {
  struct stat status {};
  return ::fstatat(fd_, name.c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0;
}

std::optional<std::uint64_t> Folder::size_of(const std::string& name) const {
  struct stat status {};
  if (::fstatat(fd_, name.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return static_cast<std::uint64_t>(status.st_size);
}

int Folder::open_file(const std::string& name, int flags) const {
  const int fd = ::openat(fd_, name.c_str(), flags | O_NOFOLLOW | O_CLOEXEC, kFileMode);
  if (fd < 0) fail(name, "opened", errno);
  return fd;
}

std::string Folder::read(const std::string& name) const {
  constexpr std::size_t kBlock = std::size_t{1} << 16;
  const int fd = open_file(name, O_RDONLY);
  std::string text;
  for (ssize_t got = 1; got != 0;) {
    const std::size_t used = text.size();
    text.resize(used + kBlock);
    got = ::read(fd, text.data() + used, kBlock);
    const int error = errno;
    text.resize(used + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got >= 0 || error == EINTR) continue;
    ::close(fd);
    fail(name, "read", error);
  }
  ::close(fd);
  return text;
}

void Folder::write(const std::string& name, std::string_view text) const {
  FileWriter file(*this, name);
  file.append(text);
  file.close();
}

void Folder::sync(const std::string& name) const {
  const int fd = open_file(name, O_RDONLY);
  const int error = ::fsync(fd) == 0 ? 0 : errno;
  ::close(fd);
  if (error != 0) fail(name, "written", error);
}

void Folder::sync() const {
  if (::fsync(fd_) != 0 && errno != EINVAL && errno != ENOTSUP)  // not every file system does it for folders
    fail_at(path_, "written", errno);
}

void Folder::move(const std::string& name, const Folder& to, const std::string& new_name) const {
  if (::renameat(fd_, name.c_str(), to.fd_, new_name.c_str()) != 0) to.fail(new_name, "put in place", errno);
}

void Folder::remove(const std::string& name) const {
  if (::unlinkat(fd_, name.c_str(), 0) == 0 || errno == ENOENT) return;
  if (errno != EISDIR && errno != EPERM) fail(name, "removed", errno);
  if (const auto inner = find(name))
    for (const std::string& entry : inner->names()) inner->remove(entry);
  if (::unlinkat(fd_, name.c_str(), AT_REMOVEDIR) != 0 && errno != ENOENT) fail(name, "removed", errno);
}

FileWriter::FileWriter(const Folder& folder, const std::string& name) : path_(folder.path_of(name)) {
  const int fd = folder.open_file(name, O_WRONLY | O_CREAT | O_EXCL);
  file_ = ::fdopen(fd, "wb");
  if (file_ != nullptr) return;
  const int error = errno;
  ::close(fd);
  fail(error);
}

FileWriter::~FileWriter() {
  if (file_ != nullptr) std::fclose(file_);
}

void FileWriter::append(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail(errno);
}

void FileWriter::close() {
  std::FILE* const file = std::exchange(file_, nullptr);
  if (std::fclose(file) != 0) fail(errno);
}

void FileWriter::fail(int error) const { fail_at(path_, "written", error); }

}  // namespace crashsim::batch
