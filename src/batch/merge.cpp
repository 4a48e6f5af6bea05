/// Shards joined to the batch they are of.

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <unordered_map>

#include <sys/resource.h>
#include <unistd.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <crashsim/batch.hpp>
#include <crashsim/batch_folder.hpp>
#include <crashsim/error.hpp>

#include "batch/batch_file.hpp"
#include "batch/case_folder.hpp"
#include "batch/folder_lock.hpp"
#include "batch/journal.hpp"
#include "stage_clock.hpp"

namespace crashsim {
namespace {

namespace fs = std::filesystem;
using batch::BatchIdentity;
using batch::Folder;

/// The folder of one shard, held while it is read.
class Shard {
 public:
  explicit Shard(const std::string& path)
      : folder_(open(path)), own_(folder_.inside(batch::kPrivate)), lock_(own_, path) {
    identity_ = *batch::find_batch(folder_);
    cases_ = batch::parse_plan(own_.read(batch::kPlan), own_.path_of(batch::kPlan));
    std::unordered_map<std::string, std::uint64_t> lines;
    journal_ = std::make_unique<batch::Journal>(
        own_, [&](std::uint64_t offset, std::string_view text) { lines[batch_row_from_json(text).name] = offset; });
    std::vector<std::string> missing;
    for (const BatchCase& one : cases_) {
      const auto line = lines.find(one.name);
      if (line == lines.end())
        missing.push_back(one.name);
      else
        offsets_.push_back(line->second);
    }
    if (!missing.empty())
      throw InvalidInput(
          fmt::format("{}: shard {} lacks {} of its {} cases, the first is '{}': finish it with --resume", path,
                      shard(), missing.size(), cases_.size(), missing.front()));
  }

  [[nodiscard]] const std::string& path() const { return folder_.path(); }
  [[nodiscard]] const BatchIdentity& identity() const { return identity_; }
  [[nodiscard]] std::string shard() const { return fmt::format("{}/{}", identity_.shard.index, identity_.shard.count); }
  [[nodiscard]] const std::vector<BatchCase>& cases() const { return cases_; }
  [[nodiscard]] BatchRow row_of(std::size_t index) const { return batch_row_from_json(journal_->at(offsets_[index])); }

  [[nodiscard]] std::vector<FileText> files_of(const std::string& name) const {
    std::vector<FileText> files;
    const auto cases = folder_.find(batch::kCases);
    if (const auto folder = cases ? cases->find(name) : std::nullopt)
      for (const std::string& file : folder->names())
        if (folder->size_of(file)) files.push_back({file, folder->read(file)});
    return files;
  }

  [[nodiscard]] std::uint64_t bytes_of(const std::string& name) const { return batch::case_bytes(folder_, name); }

 private:
  static Folder open(const std::string& path) {
    if (!fs::is_directory(path)) throw InvalidInput(fmt::format("{}: no such folder", path));
    Folder folder(path);
    if (!batch::find_batch(folder) || !folder.has(batch::kPrivate))
      throw InvalidInput(
          fmt::format("{}: holds no batch: name the folders that crashsim batch --shard has written", path));
    return folder;
  }

  Folder folder_, own_;
  batch::FolderLock lock_;
  BatchIdentity identity_;
  std::vector<BatchCase> cases_;
  std::vector<std::uint64_t> offsets_;
  std::unique_ptr<batch::Journal> journal_;
};

/// Shards stay open while they are joined, some descriptors each: as many as the system allows.
void allow_many_files() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);  // where it is refused, opening a file tells
}

/// Refuses a folder that is named twice, also by another path.
void check_named_once(const std::vector<std::string>& paths) {
  std::map<fs::path, std::string> named;
  for (const std::string& path : paths) {
    std::error_code ignored;  // opening it tells
    const auto [other, is_new] = named.emplace(fs::weakly_canonical(path, ignored), path);
    if (!is_new && !ignored)
      throw InvalidInput(fmt::format("{} and {}: are the same folder: leave one out", other->second, path));
  }
}

/// The shards in their order. @throws InvalidInput unless they are all of one batch, each once.
std::vector<std::unique_ptr<Shard>> open_shards(const std::vector<std::string>& paths) {
  check_named_once(paths);
  allow_many_files();
  std::vector<std::unique_ptr<Shard>> shards;
  for (const std::string& path : paths) {
    auto shard = std::make_unique<Shard>(path);
    BatchIdentity same = shard->identity();
    if (!shards.empty()) same.shard.index = shards.front()->identity().shard.index;
    if (!shards.empty() && same != shards.front()->identity())
      throw InvalidInput(fmt::format(
          "{} and {}: are not shards of one batch (cases, their order, number of shards or version differ): "
          "name all shards of one, each run with the same cases",
          shards.front()->path(), path));
    for (const auto& other : shards)
      if (other->identity().shard == shard->identity().shard)
        throw InvalidInput(
            fmt::format("{} and {}: are both shard {}: leave one out", other->path(), path, shard->shard()));
    shards.push_back(std::move(shard));
  }
  if (shards.empty()) throw InvalidInput("no shard: name the folders that crashsim batch --shard has written");
  std::sort(shards.begin(), shards.end(),
            [](const auto& a, const auto& b) { return a->identity().shard.index < b->identity().shard.index; });
  std::vector<std::string> missing;
  const int count = shards.front()->identity().shard.count;
  for (int index = 1; index <= count; ++index)
    if (std::none_of(shards.begin(), shards.end(),
                     [&](const auto& shard) { return shard->identity().shard.index == index; }))
      missing.push_back(fmt::format("{}/{}", index, count));
  if (!missing.empty())
    throw InvalidInput(fmt::format("shard {}: not given: name all shards", fmt::join(missing, ", ")));
  return shards;
}

std::vector<BatchCase> joined_plan(const std::vector<std::unique_ptr<Shard>>& shards) {
  const BatchIdentity& asked = shards.front()->identity();
  std::vector<BatchCase> plan;
  for (std::size_t i = 0; i < asked.cases; ++i) {
    const std::vector<BatchCase>& cases = shards[i % shards.size()]->cases();
    if (i / shards.size() >= cases.size()) break;
    plan.push_back(cases[i / shards.size()]);
  }
  if (batch::identify_batch(plan, asked.shard).plan_sha256 != asked.plan_sha256)
    throw InvalidInput(fmt::format("{}: its plan does not fit those of the other shards: run it again with --resume",
                                   shards.front()->path()));
  return plan;
}

/// Refuses files that are not those the row tells of; others that lie beside them do not count.
void check_size(const Shard& shard, const BatchRow& row) {
  if (const std::uint64_t bytes = shard.bytes_of(row.name); bytes != row.bytes)
    throw InvalidInput(fmt::format(
        "{}: the files of case '{}' have {} bytes, not the {} that were written: run the shard again with --resume",
        shard.path(), row.name, bytes, row.bytes));
}

/// Copies what the shards have into a new folder.
BatchReport join(const std::vector<std::unique_ptr<Shard>>& shards, const std::string& path) {
  StageClock clock;
  BatchFolder whole(path, joined_plan(shards), {});
  const Folder folder(path);
  BatchReport report;
  report.total = whole.cases().size();
  for (std::size_t i = 0; i < report.total; ++i) {
    const Shard& shard = *shards[i % shards.size()];
    const BatchRow row = shard.row_of(i / shards.size());
    const std::vector<FileText> files = shard.files_of(row.name);
    if (!row.identity.empty() && files.empty())
      throw InvalidInput(fmt::format("{}: the files of case '{}' are gone: run the shard again with --resume",
                                     shard.path(), row.name));
    if (!row.identity.empty()) check_size(shard, row);
    if (!row.identity.empty()) batch::put_case_files(folder, row.name, files);
    whole.record(i, row);
    ++report.done;
    for (const auto& stage : kStageTimes) report.stages.*stage.member += row.stages.*stage.member;
    if (!row.failed()) continue;
    ++report.failed;
    if (report.failures.size() < BatchReport::kListed) report.failures.push_back(row);
  }
  whole.write_tables();
  report.seconds = clock.lap();
  return report;
}

}  // namespace

BatchReport merge_batches(const std::vector<std::string>& paths, const std::string& path) {
  const std::vector<std::unique_ptr<Shard>> shards = open_shards(paths);
  if (fs::exists(path) && !(fs::is_directory(path) && fs::is_empty(path)))
    throw InvalidInput(fmt::format("{}: exists already: choose another folder for the joined batch", path));
  fs::path target = fs::path(path).lexically_normal();
  if (!target.has_filename()) target = target.parent_path();
  const std::string beside = fmt::format("{}.{}.part", target.string(), ::getpid());
  try {
    BatchReport report = join(shards, beside);
    fs::rename(beside, target);
    return report;
  } catch (const fs::filesystem_error& error) {
    std::error_code ignored;
    fs::remove_all(beside, ignored);
    throw SystemFailure(fmt::format("{}: cannot be written: {}", path, error.code().message()));
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(beside, ignored);
    throw;
  }
}

}  // namespace crashsim
