#pragma once
/// What is told of a batch.

#include <cstdio>
#include <string>
#include <vector>

#include <crashsim/batch.hpp>

namespace crashsim::cli {

/// How a batch went, line by line.
std::vector<std::string> lines_of(const BatchReport& report);

/// The same as JSON.
std::string json_of(const BatchReport& report);

/// Events as JSON, one object a line, in a file or on standard error.
class EventLog {
 public:
  /// @param path "" for none, "-" for standard error. @throws SystemFailure when it cannot be written.
  explicit EventLog(const std::string& path);
  ~EventLog();
  EventLog(const EventLog&) = delete;
  EventLog& operator=(const EventLog&) = delete;

  void write(const BatchEvent& event);
  /// The report at the end.
  void write(const BatchReport& report);

 private:
  void write_line(const std::string& line);

  std::string path_;
  std::FILE* file_ = nullptr;
};

}  // namespace crashsim::cli
