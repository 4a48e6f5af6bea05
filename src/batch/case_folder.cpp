#include "batch/case_folder.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/sweep.hpp>

namespace crashsim::batch {
namespace {

/// Files that a case leaves behind, whatever it asked for.
bool is_of_case(std::string_view name) {
  constexpr std::string_view kFiles[] = {"pulse.csv",       "model.json", "response.csv", "pitch.csv",  "coupled.csv",
                                         "comparison.json", kSamples,     kSampleSummary, kCaseSummary, kCaseRecord};
  return std::find(std::begin(kFiles), std::end(kFiles), name) != std::end(kFiles) ||
         (name.starts_with("prediction_") && name.ends_with(".csv"));
}

/// Refuses to remove a folder with files that somebody else put there.
void check_removable(const Folder& cases, const std::string& name, const std::vector<FileText>& files) {
  const auto folder = cases.find(name);
  if (!folder) return;
  for (const std::string& entry : folder->names()) {
    const auto is_written = [&](const FileText& file) { return file.name == entry; };
    if (!is_of_case(entry) && std::none_of(files.begin(), files.end(), is_written))
      throw InvalidInput(
          fmt::format("{}: would be lost when the case is run again: move it elsewhere", folder->path_of(entry)));
  }
}

/// Moves a case's folder out of the way, where what is half done is cleared.
void move_away(const Folder& cases, const Folder& half_done, const std::string& name) {
  if (!cases.has(name)) return;
  const std::string old = name + ".old";
  half_done.remove(old);
  cases.move(name, half_done, old);
  half_done.remove(old);
}

}  // namespace

void put_case_files(const Folder& batch, const std::string& name, const std::vector<FileText>& files) {
  const Folder cases = batch.inside(kCases), half_done = batch.inside(kPrivate).inside(kHalfDone);
  check_removable(cases, name, files);
  const std::string made = name + ".new";
  half_done.remove(made);
  {
    const Folder folder = half_done.inside(made);
    for (const FileText& file : files) folder.write(file.name, file.text);
  }
  move_away(cases, half_done, name);
  half_done.move(made, cases, name);
}

void remove_case_files(const Folder& batch, const std::string& name) {
  const Folder half_done = batch.inside(kPrivate).inside(kHalfDone);
  half_done.remove(name + ".new");
  half_done.remove(name + ".old");
  const auto cases = batch.find(kCases);
  if (!cases || !cases->has(name)) return;
  check_removable(*cases, name, {});
  move_away(*cases, half_done, name);
}

std::uint64_t case_bytes(const Folder& batch, const std::string& name) {
  std::uint64_t bytes = 0;
  const auto cases = batch.find(kCases);
  if (const auto folder = cases ? cases->find(name) : std::nullopt)
    for (const std::string& entry : folder->names())
      if (is_of_case(entry)) bytes += folder->size_of(entry).value_or(0);
  return bytes;
}

}  // namespace crashsim::batch
