#pragma once
/// A folder held open: what is written through it lands in it, even when somebody puts links in its way.

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace crashsim::batch {

/// An open folder. Names are single: no '/', not '.' nor '..'. Links inside are never followed.
/// Every function throws SystemFailure with path and reason when the system refuses.
class Folder {
 public:
  /// Opens a folder that is there. @throws SystemFailure
  explicit Folder(const std::string& path);
  ~Folder();
  Folder(Folder&& other) noexcept;
  Folder& operator=(Folder&&) = delete;
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] int descriptor() const { return fd_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string path_of(std::string_view name) const;

  /// A folder in this one, made unless it is there. @throws SystemFailure also when a link has its name.
  [[nodiscard]] Folder inside(const std::string& name) const;
  /// The same, none when it is not there or no folder.
  [[nodiscard]] std::optional<Folder> find(const std::string& name) const;

  [[nodiscard]] std::vector<std::string> names() const;  ///< Sorted.
  [[nodiscard]] bool has(const std::string& name) const;
  /// Size of a regular file, none when there is none.
  [[nodiscard]] std::optional<std::uint64_t> size_of(const std::string& name) const;

  /// Opens a file as open(2) does with these flags. @returns its descriptor
  [[nodiscard]] int open_file(const std::string& name, int flags) const;
  [[nodiscard]] std::string read(const std::string& name) const;
  /// Writes a file that is not there yet.
  void write(const std::string& name, std::string_view text) const;
  /// Makes a file, or which names this folder has, last through a power cut.
  void sync(const std::string& name) const;
  void sync() const;
  /// Moves a file or folder; a file of that name is replaced.
  void move(const std::string& name, const Folder& to, const std::string& new_name) const;
  /// Removes a file, link or folder with all that is in it; nothing when it is not there.
  void remove(const std::string& name) const;

 private:
  Folder(int fd, std::string path) : fd_(fd), path_(std::move(path)) {}
  [[noreturn]] void fail(const std::string& name, const char* what, int error) const;

  int fd_;
  std::string path_;
};

/// A file written piece by piece. @throws SystemFailure when it cannot be.
class FileWriter {
 public:
  FileWriter(const Folder& folder, const std::string& name);
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  void append(std::string_view text);
  void close();

 private:
  [[noreturn]] void fail(int error) const;

  std::string path_;
  std::FILE* file_ = nullptr;
};

}  // namespace crashsim::batch
