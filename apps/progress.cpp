#include "progress.hpp"

#include <cstdio>
#include <utility>

#include <unistd.h>

#include <fmt/format.h>

namespace crashsim::cli {

ProgressLine::ProgressLine(std::string what, bool quiet)
    : what_(std::move(what)), visible_(!quiet && ::isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (shown_) fmt::print(stderr, "\r\x1b[K");
}

void ProgressLine::show(int done, int total) {
  if (!visible_) return;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
  const double rate = done / elapsed.count();
  std::string left = done > 0 ? fmt::format(", {:.3g}/s, {:.1f} s left", rate, (total - done) / rate) : "";
  fmt::print(stderr, "\r\x1b[K  {}/{} {}{}", done, total, what_, left);
  std::fflush(stderr);
  shown_ = true;
}

}  // namespace crashsim::cli
