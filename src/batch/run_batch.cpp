/// A batch from its plan to its tables.

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <deque>
#include <map>
#include <new>
#include <set>

#include <fmt/format.h>

#include <crashsim/batch.hpp>
#include <crashsim/batch_folder.hpp>
#include <crashsim/error.hpp>
#include <crashsim/option_values.hpp>

#include "batch/workers.hpp"
#include "parallel.hpp"
#include "stage_clock.hpp"

namespace crashsim {
namespace {

using Kind = BatchEvent::Kind;
using batch::WorkerEnd;

constexpr int kNumbersFailed = 3, kMachineFailed = 4, kInterrupted = 130;  // exit codes of the program

// What a worker says instead of a row.
constexpr char kUnchanged = '=', kUserMustFix = '?', kCannotGoOn = '!';

BatchRow failed_row(const std::string& name, std::string_view outcome, int exit_code, std::string message) {
  BatchRow row;
  row.name = name;
  row.outcome = outcome;
  row.exit_code = exit_code;
  row.message = std::move(message);
  return row;
}

/// Runs a case in a worker. @returns its row or what stands for it
std::string work_on(const BatchFolder& folder, std::size_t index) {
  const BatchCase& one = folder.cases()[index];
  try {
    const std::optional<BatchRow> before = folder.row_of(index);
    if (before && is_batch_case_done(one, folder.path(), *before)) return {kUnchanged};
    return to_json(run_batch_case(one, folder.path()));
  } catch (const std::bad_alloc&) {
    return to_json(failed_row(one.name, kOutOfMemory, kMachineFailed, "out of memory: give it more, or ask for less"));
  } catch (const InvalidInput& error) {
    return kUserMustFix + std::string(error.what());
  } catch (const std::exception& error) {
    return kCannotGoOn + std::string(error.what());
  }
}

/// Whether a signal comes from elsewhere, not from what the process did itself.
bool is_from_outside(int signal) {
  constexpr int kOwn[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGTRAP};
  return signal != 0 && std::find(std::begin(kOwn), std::end(kOwn), signal) == std::end(kOwn);
}

std::string text_of(const WorkerEnd& end) {
  return end.signal != 0 ? fmt::format("signal {} ({})", end.signal, ::strsignal(end.signal))
                         : fmt::format("exit code {}", end.exit_code);
}

class BatchRun {
 public:
  BatchRun(const std::vector<BatchCase>& plan, const std::string& path, const BatchOptions& options,
           const BatchWatcher& watcher)
      : folder_(path, plan, options), options_(options), watcher_(watcher) {
    report_.total = folder_.cases().size();
    counted_.resize(report_.total);
    report_.left_over = folder_.left_over();
  }

  BatchReport run() {
    tell({.kind = Kind::started});
    batch::WorkerLimits limits;
    limits.count = static_cast<int>(std::min(static_cast<std::size_t>(thread_count(options_.jobs)), report_.total));
    if (!std::isnan(options_.time_limit_s)) limits.time_s = options_.time_limit_s;
    if (!std::isnan(options_.memory_limit_mb)) limits.memory_b = 1e6 * options_.memory_limit_mb;
    batch::run_on_workers(limits,
                          {[this](std::size_t index) { return work_on(folder_, index); }, [this] { return next(); },
                           [this](std::size_t index, const std::string& text) { finish(index, text); },
                           [this](std::size_t index, const WorkerEnd& end) { mourn(index, end); },
                           [this] { return !stops_ && tell({}); }});
    if (!report_.interrupted) folder_.write_tables(counted_);
    for (auto& [index, row] : failures_) report_.failures.push_back(std::move(row));
    report_.seconds = clock_.lap();
    if (report_.failed > 0 && report_.exit_code == 0) report_.exit_code = kNumbersFailed;
    if (report_.interrupted) report_.exit_code = kInterrupted;
    tell({.kind = Kind::finished});
    return std::move(report_);
  }

 private:
  /// Tells the watcher. False when the batch is to stop.
  bool tell(BatchEvent event) {
    event.total = report_.total;
    event.done = report_.done;
    event.failed = report_.failed;
    if (watcher_ && !watcher_(event) && event.kind != Kind::finished) report_.interrupted = stops_ = true;
    return !stops_;
  }

  std::optional<std::size_t> next() {
    if (stops_) return std::nullopt;
    std::size_t index = next_;
    if (!again_.empty()) {
      index = again_.front();
      again_.pop_front();
    } else if (next_ < report_.total) {
      ++next_;
    } else {
      return std::nullopt;
    }
    tell({.kind = Kind::case_started, .name = folder_.cases()[index].name});
    return index;
  }

  void finish(std::size_t index, const std::string& text) {
    if (text.front() == kUserMustFix) throw InvalidInput(text.substr(1));
    if (text.front() == kCannotGoOn) throw SystemFailure(text.substr(1) + how_to_go_on());
    if (text.front() != kUnchanged) return keep(index, batch_row_from_json(text));
    ++report_.unchanged;
    const BatchRow row = *folder_.row_of(index);
    count(index, row);
    tell({.kind = Kind::case_unchanged, .name = row.name, .row = &row});
  }

  /// A worker ended with a case in its hands.
  void mourn(std::size_t index, const WorkerEnd& end) {
    const std::string& name = folder_.cases()[index].name;
    if (end.timed_out)
      return keep(index,
                  failed_row(name, kTimeLimit, kNumbersFailed,
                             fmt::format("took longer than the time limit of {} s: give it more, or ask for less",
                                         format_number(options_.time_limit_s))));
    const bool is_outside = is_from_outside(end.signal);
    if (is_outside && retried_.insert(index).second) {
      ++report_.retried;
      again_.push_back(index);
      tell({.kind = Kind::case_retried, .name = name, .message = text_of(end)});
      return;
    }
    keep(index, failed_row(name, kCrashed, kMachineFailed,
                           is_outside ? fmt::format("its process was killed twice, by {}: is there memory enough?",
                                                    text_of(end))
                                      : fmt::format("its process ended in the middle of it: {}", text_of(end))));
  }

  void keep(std::size_t index, const BatchRow& row) {
    folder_.record(index, row);
    count(index, row);
    for (const auto& stage : kStageTimes) report_.stages.*stage.member += row.stages.*stage.member;
    note_time(row);
    if (row.failed() && !options_.keep_going) {
      report_.exit_code = row.exit_code;
      stops_ = true;
    }
    tell({.kind = Kind::case_finished, .name = row.name, .row = &row});
  }

  void count(std::size_t index, const BatchRow& row) {
    ++report_.done;
    counted_[index] = true;
    if (!row.failed()) return;
    ++report_.failed;
    failures_.emplace(index, row);
    if (failures_.size() > BatchReport::kListed) failures_.erase(std::prev(failures_.end()));
  }

  void note_time(const BatchRow& row) {
    auto& slowest = report_.slowest;
    const auto place =
        std::find_if(slowest.begin(), slowest.end(), [&](const auto& other) { return other.second < row.seconds; });
    slowest.insert(place, {row.name, row.seconds});
    if (slowest.size() > BatchReport::kListed) slowest.pop_back();
  }

  [[nodiscard]] std::string how_to_go_on() const {
    return fmt::format("; {} of {} cases are done and kept: mend it, then go on with --resume", report_.done,
                       report_.total);
  }

  BatchFolder folder_;
  const BatchOptions& options_;
  const BatchWatcher& watcher_;
  BatchReport report_;
  StageClock clock_;
  std::map<std::size_t, BatchRow> failures_;  ///< The first few.
  std::deque<std::size_t> again_;
  std::set<std::size_t> retried_;
  std::vector<bool> counted_;  ///< Of each case: done, or found to be.
  std::size_t next_ = 0;
  bool stops_ = false;
};

}  // namespace

BatchReport run_batch(const std::vector<BatchCase>& plan, const std::string& folder, const BatchOptions& options,
                      const BatchWatcher& watcher) {
  validate_options(options, "BatchOptions");
  return BatchRun(plan, folder, options, watcher).run();
}

}  // namespace crashsim
