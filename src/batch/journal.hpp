#pragma once
/// What is done, line by line: a line that was appended is found again after any end of the program.

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "batch/folder.hpp"

namespace crashsim::batch {

/// An open journal. Each line carries its checksum: a torn one, or one that the disk has damaged, does not count.
class Journal {
 public:
  using Visit = std::function<void(std::uint64_t offset, std::string_view text)>;

  /// Opens the journal of a folder, makes it when there is none, visits every sound line and drops a torn end.
  Journal(const Folder& folder, const Visit& visit);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// Appends a line, all or nothing. @returns its offset. @throws SystemFailure
  std::uint64_t append(std::string_view text);
  /// The line at an offset.
  [[nodiscard]] std::string at(std::uint64_t offset) const;

 private:
  void find_lines(const Visit& visit);

  std::string path_;
  int fd_;
  std::uint64_t end_ = 0;
  std::chrono::steady_clock::time_point synced_ = std::chrono::steady_clock::now();
};

}  // namespace crashsim::batch
