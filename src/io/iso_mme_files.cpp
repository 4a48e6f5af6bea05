#include "io/iso_mme_files.hpp"

#include <filesystem>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <crashsim/error.hpp>

#include "io/test_files.hpp"
#include "text.hpp"

namespace crashsim::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTest = ".mme", kList = ".chn", kChannelFolder = "channel";

using Folder = std::map<std::string, std::string>;  // as files_in() gives it

std::vector<std::string> with_extension(const Folder& folder, std::string_view extension) {
  std::vector<std::string> found;
  for (const auto& [name, path] : folder)
    if (name.ends_with(extension) && name.size() > extension.size()) found.push_back(path);
  return found;
}

/// The file of that stem, else the only one of its kind; "" when there is none or several.
std::string pick(const Folder& folder, const std::string& stem, std::string_view extension) {
  const auto exact = folder.find(stem + std::string(extension));
  if (exact != folder.end()) return exact->second;
  const auto found = with_extension(folder, extension);
  return found.size() == 1 ? found.front() : "";
}

bool is_channel_folder(const fs::path& folder) {
  std::error_code ignored;
  fs::path name = fs::absolute(folder.empty() ? "." : folder, ignored).lexically_normal();
  if (!name.has_filename()) name = name.parent_path();
  return to_lower(name.filename().string()) == kChannelFolder;
}

fs::path folder_above(const fs::path& folder) {
  const fs::path name = folder.has_filename() ? folder : folder.parent_path();
  const bool by_name = name.has_filename() && name.filename() != "." && name.filename() != "..";
  return by_name ? name.parent_path() : name / "..";
}

/// The Channel folder of a test's folder, or that itself where there is none.
fs::path channel_folder_of(const fs::path& folder) {
  const Folder files = files_in(folder);
  const auto found = files.find(std::string(kChannelFolder));
  std::error_code ignored;
  return found != files.end() && fs::is_directory(found->second, ignored) ? fs::path(found->second) : folder;
}

bool has_channels(const Folder& folder, const std::string& stem) {
  for (const auto& [name, path] : folder)
    if (channel_number(path) > 0 && stem_of(path) == stem) return true;
  return false;
}

void find_channels(const fs::path& folder, std::string stem, IsoMmeFiles& files) {
  const Folder in_folder = files_in(folder);
  if (files.list.empty()) files.list = pick(in_folder, stem, kList);
  if (!files.list.empty() && !has_channels(in_folder, stem)) stem = stem_of(files.list);
  for (const auto& [name, path] : in_folder)
    if (channel_number(path) > 0 && stem_of(path) == stem) files.channels.emplace(channel_number(path), path);
}

/// TEST.mme beside the channels or, when those have a folder of their own, above it.
std::string find_test(const fs::path& channels, const std::string& stem) {
  const std::string beside = pick(files_in(channels), stem, kTest);
  return beside.empty() && is_channel_folder(channels) ? pick(files_in(folder_above(channels)), stem, kTest) : beside;
}

IsoMmeFiles find_in_folder(const fs::path& folder) {
  const fs::path channels = channel_folder_of(folder);
  for (const std::string_view extension : {kTest, kList}) {
    const auto found = with_extension(files_in(extension == kTest ? folder : channels), extension);
    if (found.size() > 1)
      throw InvalidInput(
          fmt::format("{}: holds several tests: name one of {}", folder.string(), fmt::join(found, ", ")));
    if (found.size() == 1)
      return find_iso_mme_files(found.front(), false, extension == kTest ? IsoMmeFile::test : IsoMmeFile::channel_list);
  }
  return {};
}

}  // namespace

bool is_iso_mme_folder(const std::string& path) {
  return !with_extension(files_in(path), kTest).empty() ||
         !with_extension(files_in(channel_folder_of(path)), kList).empty();
}

IsoMmeFiles find_iso_mme_files(const std::string& path, bool is_folder, IsoMmeFile kind) {
  if (is_folder) return find_in_folder(path);
  const fs::path folder = fs::path(path).parent_path();
  const std::string stem = stem_of(path);
  IsoMmeFiles files;
  if (kind == IsoMmeFile::test) {
    files.test = path;
    find_channels(channel_folder_of(folder), stem, files);
    return files;
  }
  files.test = find_test(folder, stem);
  if (kind == IsoMmeFile::channel_list) files.list = path;
  find_channels(folder, stem, files);
  if (kind == IsoMmeFile::channel) {
    files.only = path;
    files.channels[channel_number(path)] = path;
  }
  return files;
}

}  // namespace crashsim::io
