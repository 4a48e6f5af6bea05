#include <crashsim/batch_folder.hpp>

#include <filesystem>
#include <limits>
#include <set>
#include <string_view>
#include <unordered_map>

#include <fmt/format.h>

#include <crashsim/error.hpp>

#include "batch/batch_file.hpp"
#include "batch/case_folder.hpp"
#include "batch/case_name.hpp"
#include "batch/folder_lock.hpp"
#include "batch/journal.hpp"
#include "batch/tables.hpp"

namespace crashsim {
namespace {

using batch::BatchIdentity;
using batch::Folder;
using batch::Journal;

constexpr std::uint64_t kNoRow = std::numeric_limits<std::uint64_t>::max();

Folder open_or_make(const std::string& path) {
  std::error_code error;
  if (path.empty()) throw InvalidInput("where to? Name the folder of the batch");
  if (std::filesystem::exists(path, error) && !std::filesystem::is_directory(path, error))
    throw InvalidInput(fmt::format("{}: is a file: name a folder for the results of the batch", path));
  std::filesystem::create_directories(path, error);
  if (error) throw SystemFailure(fmt::format("{}: cannot be made: {}", path, error.message()));
  Folder folder(path);
  if (!folder.has(batch::kPrivate) && !folder.names().empty())
    throw InvalidInput(fmt::format("{}: is not empty and holds no batch: choose another folder", path));
  return folder;
}

/// Writes a file in place of an earlier one, whole or not at all, also when the power goes.
void replace(const Folder& folder, const Folder& half_done, const std::string& name, std::string_view text) {
  half_done.remove(name);
  half_done.write(name, text);
  half_done.sync(name);
  half_done.move(name, folder, name);
  folder.sync();
}

}  // namespace

struct BatchFolder::Content {
  Content(const std::string& path, const std::vector<BatchCase>& plan, const BatchShard& shard, bool resume)
      : folder(open_or_make(path)),
        own(folder.inside(batch::kPrivate)),
        lock(own, path),
        cases(batch::shard_of(plan, shard)),
        offsets(cases.size(), kNoRow),
        journal(own, [this](std::uint64_t offset, std::string_view text) { find_case(offset, text); }) {
    const BatchIdentity asked = batch::identify_batch(plan, shard);
    if (const auto held = batch::find_batch(folder)) check(*held, shard, resume);
    own.remove(batch::kHalfDone);
    half_done.emplace(own.inside(batch::kHalfDone));
    for (const char* table : {batch::kTableCsv, batch::kTableJson, batch::kTimings}) folder.remove(table);
    replace(own, *half_done, batch::kPlan, batch::format_plan(cases));
    replace(folder, *half_done, batch::kBatchFile, batch::to_json(asked));
    (void)folder.inside(batch::kCases);
    index_of = {};
  }

  /// What a line of the journal says; the last one of a case counts.
  void find_case(std::uint64_t offset, std::string_view text) {
    if (index_of.empty())
      for (std::size_t i = 0; i < cases.size(); ++i) index_of.emplace(cases[i].name, i);
    const std::string name = batch_row_from_json(text).name;
    if (const auto found = index_of.find(name); found != index_of.end())
      offsets[found->second] = offset;
    else
      left_over.insert(name);
  }

  void check(const BatchIdentity& held, const BatchShard& asked, bool resume) const {
    if (!resume) {
      std::size_t done = left_over.size();
      for (const std::uint64_t offset : offsets) done += offset == kNoRow ? 0 : 1;
      throw InvalidInput(
          fmt::format("{}: holds a batch already, {} cases of it are done: go on with --resume, or choose "
                      "another folder",
                      folder.path(), done));
    }
    if (held.shard != asked)
      throw InvalidInput(fmt::format("{}: holds shard {}/{}, not {}/{}: choose another folder for each shard",
                                     folder.path(), held.shard.index, held.shard.count, asked.index, asked.count));
  }

  Folder folder, own;
  batch::FolderLock lock;
  std::vector<BatchCase> cases;
  std::vector<std::uint64_t> offsets;  ///< Of their lines in the journal.
  std::unordered_map<std::string_view, std::size_t> index_of;
  std::set<std::string> left_over;
  Journal journal;
  std::optional<Folder> half_done;
};

BatchFolder::BatchFolder(const std::string& path, const std::vector<BatchCase>& plan, const BatchOptions& options) {
  batch::check_plan(plan, "");
  content_ = std::make_unique<Content>(path, plan, parse_shard(options.shard), options.resume);
}

BatchFolder::~BatchFolder() = default;

const std::string& BatchFolder::path() const { return content_->folder.path(); }

const std::vector<BatchCase>& BatchFolder::cases() const { return content_->cases; }

std::optional<BatchRow> BatchFolder::row_of(std::size_t index) const {
  const std::uint64_t offset = content_->offsets.at(index);
  if (offset == kNoRow) return std::nullopt;
  return batch_row_from_json(content_->journal.at(offset));
}

std::size_t BatchFolder::left_over() const { return content_->left_over.size(); }

void BatchFolder::record(std::size_t index, const BatchRow& row) {
  if (row.name != content_->cases.at(index).name)
    throw InvalidInput(fmt::format("row '{}': is not of case {} of the batch, which is '{}'", row.name, index,
                                   content_->cases[index].name));
  if (row.identity.empty()) batch::remove_case_files(content_->folder, row.name);
  content_->offsets[index] = content_->journal.append(to_json(row));
}

void BatchFolder::write_tables(const std::vector<bool>& of) const {
  using Line = std::string (*)(const BatchRow&);
  struct Table {
    const char* name;
    std::string header;
    Line line;
    std::unique_ptr<batch::FileWriter> file;
  };
  Table tables[] = {{batch::kTableCsv, batch::results_header(), batch::results_line, {}},
                    {batch::kTableJson, "", batch::results_json, {}},
                    {batch::kTimings, batch::timings_header(), batch::timings_line, {}}};
  for (Table& table : tables) {
    content_->half_done->remove(table.name);
    table.file = std::make_unique<batch::FileWriter>(*content_->half_done, table.name);
    table.file->append(table.header);
  }
  for (std::size_t i = 0; i < cases().size(); ++i)
    if (const auto row = of.empty() || of.at(i) ? row_of(i) : std::nullopt)
      for (const Table& table : tables) table.file->append(table.line(*row));
  for (const Table& table : tables) {
    table.file->close();
    content_->half_done->move(table.name, content_->folder, table.name);
  }
}

}  // namespace crashsim
