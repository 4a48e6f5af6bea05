/// The unit of work of a batch: one case, from its file to its folder and its row.

#include <exception>
#include <filesystem>
#include <new>

#include <fmt/format.h>

#include <crashsim/batch.hpp>
#include <crashsim/case.hpp>
#include <crashsim/error.hpp>
#include <crashsim/messages.hpp>
#include <crashsim/outputs.hpp>
#include <crashsim/sweep.hpp>

#include "batch/case_folder.hpp"
#include "batch/case_name.hpp"
#include "case_sections.hpp"
#include "sha256.hpp"
#include "stage_clock.hpp"

namespace crashsim {
namespace {

constexpr int kUserCanFix = 2, kNumbersFailed = 3, kMachineFailed = 4;  // exit codes of the program

/// Reads a case as `crashsim run` does, to be run by one thread.
Case read_study(const std::string& path) {
  if (!std::filesystem::is_regular_file(path) && std::filesystem::exists(path))
    throw InvalidInput(fmt::format("{}: is no regular file: a case of a batch must be one", path));
  Case study = read_case(path);
  study.identify.jobs = 1;
  return study;
}

/// Outcome and message of a part that cannot be relied on; false when it can.
template <class Part>
bool blame(const Part& part, BatchRow& row) {
  if (part.usable()) return false;
  row.outcome = name_of(part.outcome);
  row.message = part.message;
  return true;
}

/// The first part of a case that failed, in the order in which they are run.
void blame_first(const CaseResult& result, BatchRow& row) {
  row.exit_code = kNumbersFailed;
  if (result.identification && blame(*result.identification, row)) return;
  if (blame(result.response, row)) return;
  if (result.pitch && blame(*result.pitch, row)) return;
  if (result.coupled && blame(*result.coupled, row)) return;
  for (const Prediction& prediction : result.predictions)
    if (blame(prediction.response, row)) {
      row.message = fmt::format("prediction at {}: {}", prediction.name, row.message);
      return;
    }
  if (result.samples && !result.samples->usable()) {
    const std::vector<std::string>& outcomes = result.samples->outcomes;
    row.outcome = outcomes.empty() ? std::string(kNumericalFailure) : outcomes.front();
    row.message = fmt::format("none of the {} samples completed: the first ended as {}: see {}",
                              result.samples->planned, row.outcome, kSamples);
  }
}

void tell_results(const CaseResult& result, BatchRow& row) {
  row.values = summarize(result);
  row.outcome = std::get<std::string>(row.values.front().value);
  row.values.erase(row.values.begin());
  row.parts = summary_parts(result);
  if (!result.usable()) blame_first(result, row);
}

void fail(BatchRow& row, std::string_view outcome, int exit_code, std::string_view message) {
  constexpr std::size_t kLongest = 1000;  // rows are small
  row.outcome = outcome;
  row.exit_code = exit_code;
  row.message = shortened(message, kLongest);
}

/// Runs a case. @returns its files; none when it failed, and the row says why.
std::vector<FileText> compute(const BatchCase& what, StageClock& clock, BatchRow& row) {
  try {
    const Case study = read_study(what.path);
    const double read_s = clock.lap();
    const CaseResult result = run_case(study);
    row.stages = result.stages;
    row.stages.read_s = read_s;
    clock.lap();
    std::vector<FileText> files = case_files(study, result);
    tell_results(result, row);
    return files;
  } catch (const InvalidInput& error) {
    fail(row, kInvalidInput, kUserCanFix, error.what());
  } catch (const NumericalFailure& error) {
    fail(row, kNumericalFailure, kNumbersFailed, error.what());
  } catch (const std::bad_alloc&) {
    fail(row, kOutOfMemory, kMachineFailed, "out of memory: give it more, or ask for less");
  } catch (const std::exception& error) {
    fail(row, kSystemFailure, kMachineFailed, error.what());
  }
  return {};
}

}  // namespace

BatchRow run_batch_case(const BatchCase& what, const std::string& folder) {
  batch::check_case(what, "");
  BatchRow row;
  row.name = what.name;
  StageClock whole, clock;
  const std::vector<FileText> files = compute(what, clock, row);
  const batch::Folder target(folder);
  if (files.empty()) {
    batch::remove_case_files(target, what.name);
  } else {
    batch::put_case_files(target, what.name, files);
    for (const FileText& file : files) row.bytes += file.text.size();
    row.identity = sha256_of(files.back().text);  // the record's
    row.stages.write_s = clock.lap();
  }
  row.seconds = whole.lap();
  return row;
}

bool is_batch_case_done(const BatchCase& what, const std::string& folder, const BatchRow& done) {
  if (done.identity.empty()) return false;
  try {
    batch::check_case(what, "");
    const Case study = read_study(what.path);
    const std::string record =
        (std::filesystem::path(folder) / batch::kCases / what.name / batch::kCaseRecord).string();
    std::vector<std::string> inputs;
    if (const auto written = find_record(record))
      for (const RecordedInput& input : written->inputs) inputs.push_back(input.path);
    const Record now = make_record("run", {study.path}, entries_of(study), inputs);
    return sha256_of(format_record(now)) == done.identity &&
           batch::case_bytes(batch::Folder(folder), what.name) == done.bytes;
  } catch (const std::exception&) {  // something is gone: running it will tell what
    return false;
  }
}

}  // namespace crashsim
