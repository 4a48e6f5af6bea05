#pragma once
/// One line on stderr that says how far a long job is, when someone watches.

#include <chrono>
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

  void show(int done, int total);

 private:
  std::string what_;
  bool visible_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Runs `work(progress)` with a line that counts starts; the first Ctrl-C stops it and keeps what is finished.
template <class Work>
auto watch_starts(bool quiet, const Work& work) {
  const CooperativeInterrupt keep_what_is_finished;
  ProgressLine line("starts", quiet);
  return work([&line](int done, int total) {
    line.show(done, total);
    return !interrupted();
  });
}

}  // namespace crashsim::cli
