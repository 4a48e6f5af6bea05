#pragma once
/// Many cases: each in a worker process, one folder and one row each; none is lost, none done twice.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <crashsim/batch_options.hpp>
#include <crashsim/stage_times.hpp>
#include <crashsim/summary.hpp>

namespace crashsim {

/// One case of a batch.
struct BatchCase {
  std::string name;  ///< Of its folder and its row.
  std::string path;  ///< Case file, as seen from where the program runs.

  bool operator==(const BatchCase&) const = default;
};

/// The cases that arguments name, in their order: case files (.toml), records of cases (.json), globs, or manifests
/// (other files): one case file or glob a line, relative to the manifest, `name = file` to name it, `#` comments.
/// A case is called as its file, or as the folder of a file called case.toml or case.lock.json.
/// @throws InvalidInput when there is no such file, no case, a case twice, or two of one name.
std::vector<BatchCase> plan_batch(const std::vector<std::string>& arguments);

/// What became of a case that has no results; its row's outcome beside those of CrushOutcome, IdentifyOutcome, ..
inline constexpr std::string_view kInvalidInput = "invalid_input";          ///< The user can fix it.
inline constexpr std::string_view kNumericalFailure = "numerical_failure";  ///< No result could be formed.
inline constexpr std::string_view kSystemFailure = "system_failure";        ///< The machine failed.
inline constexpr std::string_view kOutOfMemory = "out_of_memory";           ///< Also by the memory limit.
inline constexpr std::string_view kTimeLimit = "time_limit";                ///< Took longer than allowed.
inline constexpr std::string_view kCrashed = "crashed";  ///< Its process ended by itself or was killed.

/// One case's row of the results table.
struct BatchRow {
  std::string name;
  std::string outcome = "not_run";  ///< Of its results, or why there are none.
  std::string message;              ///< What failed; "" when nothing did.
  int exit_code = 0;                ///< That of `crashsim run`: 0, 2 the user can fix it, 3 the numbers, 4 the machine.
  Summary values;                   ///< The summary without its outcome; docs are not kept.
  std::vector<std::pair<std::string, Summary>> parts;  ///< Of the summary: "pulse", "identification", ..
  std::string identity;     ///< SHA-256 of the record, which is of options, inputs and version; "" without results.
  std::uint64_t bytes = 0;  ///< Of the case's files.
  StageTimes stages;
  double seconds = 0.0;  ///< Wall time.

  [[nodiscard]] bool failed() const { return exit_code != 0; }
};

/// A row as one line of JSON, and back. @throws InvalidInput when the text is no row.
std::string to_json(const BatchRow& row);
BatchRow batch_row_from_json(std::string_view text);

/// The unit of work: runs one case with one thread and writes its files to `folder`/cases/NAME, whole or not at all, in
/// place of earlier ones. What fails in the case is told by the row; then there are no files, except where only the
/// numbers failed. Depends on nothing but the files: runs in any process that sees them.
/// @throws SystemFailure when the files cannot be written, InvalidInput when the name would lead out of the folder.
BatchRow run_batch_case(const BatchCase& what, const std::string& folder);

/// Whether `done` is what running the case would give: same options, inputs and version, and its files are all there.
bool is_batch_case_done(const BatchCase& what, const std::string& folder, const BatchRow& done);

/// What a batch tells while it runs.
struct BatchEvent {
  enum class Kind { started, case_started, case_finished, case_unchanged, case_retried, waiting, finished };
  Kind kind = Kind::waiting;
  std::string name = {};          ///< Of the case; "" for the whole.
  const BatchRow* row = nullptr;  ///< case_finished, case_unchanged.
  std::string message = {};       ///< case_retried: why.
  std::size_t total = 0;          ///< Cases asked for.
  std::size_t done = 0;           ///< Of these, finished before or now.
  std::size_t failed = 0;         ///< Of these.
};
inline constexpr std::string_view kBatchEventNames[] = {
    "started", "case_started", "case_finished", "case_unchanged", "case_retried", "waiting", "finished"};
template <>
inline constexpr std::span<const std::string_view> enum_names<BatchEvent::Kind>{kBatchEventNames};

/// Called for every event, and `waiting` at least ten times a second; false stops the batch.
using BatchWatcher = std::function<bool(const BatchEvent&)>;

/// How a batch went. The lists are short however many cases there are.
struct BatchReport {
  static constexpr std::size_t kListed = 10;            ///< Longest list.
  std::size_t total = 0;                                ///< Cases asked for.
  std::size_t done = 0;                                 ///< Of these, with a row.
  std::size_t unchanged = 0;                            ///< Of these, done before.
  std::size_t failed = 0;                               ///< Of these.
  std::size_t retried = 0;                              ///< Whose worker was killed from outside.
  std::size_t left_over = 0;                            ///< Cases in the folder that were not asked for.
  bool interrupted = false;                             ///< Stopped by the watcher.
  double seconds = 0.0;                                 ///< Wall time.
  StageTimes stages;                                    ///< Sums over the cases run.
  std::vector<std::pair<std::string, double>> slowest;  ///< Names and seconds of cases run.
  std::vector<BatchRow> failures;                       ///< The first that failed, in the order of the plan.

  /// 0, 130 when interrupted, 3 when a case failed; without keep-going that of the case.
  int exit_code = 0;
};

/// Runs cases on worker processes: forks, so call it before threads are started. Writes to `folder`: cases/NAME each,
/// results.csv and results.jsonl with a row each in the order of the plan, timings.csv, batch.json.
/// When a failed case stops it, the tables hold the cases done or found to be done until then, none of an earlier run.
/// Killed at any moment it loses at most what runs: with `resume` it goes on to the same bytes.
/// @throws InvalidInput when the folder holds results already (without `resume`), other things, or another shard, or is
///         in use; SystemFailure when it cannot be written.
BatchReport run_batch(const std::vector<BatchCase>& plan, const std::string& folder, const BatchOptions& options = {},
                      const BatchWatcher& watcher = {});

/// Joins the folders of all shards of a batch: the same bytes as without shards.
/// @returns its report. @throws InvalidInput when one is missing, there twice, unfinished or of another batch.
BatchReport merge_batches(const std::vector<std::string>& shards, const std::string& folder);

}  // namespace crashsim
