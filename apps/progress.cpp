#include "progress.hpp"

#include <algorithm>
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

void ProgressLine::show(std::size_t done, std::size_t total, std::size_t failed) {
  if (!visible_) return;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
  const double rate = static_cast<double>(done - std::min(done, before_)) / elapsed.count();
  const std::string lost = failed > 0 ? fmt::format(", {} failed", failed) : "";
  const std::string left =
      rate > 0.0 ? fmt::format(", {:.3g}/s, {:.1f} s left", rate, static_cast<double>(total - done) / rate) : "";
  fmt::print(stderr, "\r\x1b[K  {}/{} {}{}{}", done, total, what_, lost, left);
  std::fflush(stderr);
  shown_ = true;
}

}  // namespace crashsim::cli
