#pragma once
/// A file opened for reading: its bytes in one piece, mapped where the system can.

#include <string>
#include <string_view>

namespace crashsim::io {

/// Owns the bytes of one file while it is read. A folder has no bytes.
class InputFile {
 public:
  /// @throws InvalidInput with path and reason when there is no such file or it cannot be read.
  explicit InputFile(std::string path);
  /// Bytes that are not in a file, as if they were. @param path what messages call them.
  InputFile(std::string path, std::string bytes);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] bool is_folder() const { return is_folder_; }
  [[nodiscard]] std::string_view bytes() const { return bytes_; }

 private:
  std::string path_;
  bool is_folder_ = false;
  void* mapping_ = nullptr;
  std::string buffer_;  // for what cannot be mapped: pipes, empty files
  std::string_view bytes_;
};

}  // namespace crashsim::io
