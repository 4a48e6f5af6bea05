#pragma once
/// A folder of its own for one test, gone afterwards.

#include <filesystem>
#include <string>
#include <string_view>

#include <stdlib.h>

#include <crashsim/files.hpp>

namespace crashsim::test {

class TempDir {
 public:
  TempDir() {
    std::string pattern = (std::filesystem::temp_directory_path() / "crashsim-test-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~TempDir() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TempDir(const TempDir&) = delete;
  TempDir& operator=(const TempDir&) = delete;

  [[nodiscard]] std::string path(std::string_view name) const { return (path_ / name).string(); }
  /// Writes a file into the folder and returns its path.
  std::string file(std::string_view name, std::string_view text) const {
    write_file_atomically(path(name), text, true);
    return path(name);
  }

 private:
  std::filesystem::path path_;
};

}  // namespace crashsim::test
