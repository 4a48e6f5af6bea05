#pragma once
/// One line on stderr that says how far a long job is, when someone watches.

#include <chrono>
#include <cstddef>
#include <string>

#include "interrupt.hpp"

namespace crashsim::cli {

class ProgressLine {
 public:
  /// @param what is counted: "starts". Silent unless stderr is a terminal.
  ProgressLine(std::string what, bool quiet);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// @param failed of those done; told when there are any.
  void show(std::size_t done, std::size_t total, std::size_t failed = 0);
  /// Leaves these out when the rate is told: they were done before.
  void begin_after(std::size_t done) { before_ = done; }

 private:
  std::string what_;
  bool visible_;
  bool shown_ = false;
  std::size_t before_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Runs `work(progress)` with a line that counts; the first Ctrl-C stops it and keeps what is finished.
template <class Work>
auto watch(const char* counted, bool quiet, const Work& work) {
  const CooperativeInterrupt keep_what_is_finished;
  ProgressLine line(counted, quiet);
  return work([&line](int done, int total) {
    line.show(static_cast<std::size_t>(done), static_cast<std::size_t>(total));
    return !interrupted();
  });
}

template <class Work>
auto watch_starts(bool quiet, const Work& work) {
  return watch("starts", quiet, work);
}

}  // namespace crashsim::cli
