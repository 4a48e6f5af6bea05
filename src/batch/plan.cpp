/// Which cases a batch has.

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string_view>

#include <glob.h>

#include <fmt/format.h>

#include <crashsim/batch.hpp>
#include <crashsim/error.hpp>
#include <crashsim/files.hpp>

#include "batch/case_name.hpp"
#include "json.hpp"
#include "text.hpp"

namespace crashsim {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kCase = ".toml", kRecord = ".json";

bool is_case_file(const std::string& path) { return path.ends_with(kCase) || path.ends_with(kRecord); }

/// Files that a pattern matches, sorted by their bytes.
std::vector<std::string> files_matching(const std::string& pattern, const std::string& where) {
  ::glob_t found{};
  const int status = ::glob(pattern.c_str(), GLOB_NOSORT | GLOB_BRACE, nullptr, &found);
  std::vector<std::string> files;
  for (std::size_t i = 0; status == 0 && i < found.gl_pathc; ++i) files.emplace_back(found.gl_pathv[i]);
  ::globfree(&found);
  if (files.empty()) throw InvalidInput(fmt::format("{}{}: matches no file", where, pattern));
  std::sort(files.begin(), files.end());
  return files;
}

bool is_pattern(const std::string& text) {
  return text.find_first_of("*?[{") != std::string::npos && !fs::exists(text);
}

/// What a case is called that its file does not name.
std::string name_of_case(const fs::path& path) {
  std::string name = path.filename().string();
  for (const std::string_view extension : {kCase, kRecord})
    if (name.ends_with(extension)) name.resize(name.size() - extension.size());
  if (name != "case" && name != "case.lock") return name;
  const std::string folder = fs::absolute(path).lexically_normal().parent_path().filename().string();
  return folder.empty() ? name : folder;
}

class Plan {
 public:
  void add_argument(const std::string& argument) {
    for (const std::string& file : is_pattern(argument) ? files_matching(argument, "") : std::vector{argument}) {
      if (fs::is_directory(file))
        throw InvalidInput(
            fmt::format("{}: is a folder: name its cases, as in '{}'", file, (fs::path(file) / "*.toml").string()));
      if (is_case_file(file))
        add({name_of_case(file), file}, "");
      else
        add_manifest(file);
    }
  }

  std::vector<BatchCase> take() {
    if (cases_.empty()) throw InvalidInput("no case: name case files, globs or manifests");
    return std::move(cases_);
  }

 private:
  void add_manifest(const std::string& path) {
    const std::string text = read_file(path);
    if (text.find('\0') != std::string::npos)
      throw InvalidInput(
          fmt::format("{}: is no manifest: give a text file with a case file a line, a case (.toml) or "
                      "the record of one (.json)",
                      path));
    std::size_t number = 0;
    for (const std::string_view raw : split(text, '\n')) {
      ++number;
      const std::string_view line = trimmed(raw);
      if (line.empty() || line.front() == '#') continue;
      add_line(std::string(line), fs::path(path).parent_path(), fmt::format("{}:{}: ", path, number));
    }
  }

  /// One line of a manifest: `file`, `glob` or `name = file`.
  void add_line(const std::string& line, const fs::path& folder, const std::string& where) {
    constexpr std::string_view kIs = " = ";
    const std::size_t is = line.find(kIs);
    const std::string name(is == std::string::npos ? "" : trimmed(line.substr(0, is)));
    const std::string given(is == std::string::npos ? line : trimmed(line.substr(is + kIs.size())));
    const std::string path = (folder / given).lexically_normal().string();
    if (is != std::string::npos) return add_file({name, path}, where);
    for (const std::string& file : is_pattern(path) ? files_matching(path, where) : std::vector{path})
      add_file({name_of_case(file), file}, where);
  }

  void add_file(const BatchCase& found, const std::string& where) {
    if (!is_case_file(found.path))
      throw InvalidInput(
          fmt::format("{}{:.200}: is no case: a line of a manifest names a case (.toml) or the record of "
                      "one (.json)",
                      where, found.path));
    add(found, where);
  }

  void add(const BatchCase& found, const std::string& where) {
    batch::check_case(found, where);
    const auto [other, is_new] = named_.emplace(found.name, cases_.size());
    if (!is_new) {
      const std::string& first = cases_[other->second].path;
      throw InvalidInput(first == found.path
                             ? fmt::format("{}{}: is asked for twice: leave one out", where, found.path)
                             : fmt::format("{}{} and {}: are both called '{}': name them in a manifest, as in "
                                           "'{}-2 = {}'",
                                           where, first, found.path, found.name, found.name, found.path));
    }
    cases_.push_back(found);
  }

  std::vector<BatchCase> cases_;
  std::map<std::string, std::size_t> named_;
};

}  // namespace

namespace batch {
namespace {

/// A text as JSON can hold it, with marks for what is not UTF-8.
std::string as_utf8(const std::string& text) {
  const std::string quoted = Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
  return Json::parse(quoted).get<std::string>();
}

}  // namespace

void check_case(const BatchCase& one, const std::string& where) {
  constexpr std::size_t kLongest = 200;
  for (const std::string& text : {one.name, one.path})
    if (const std::string shown = as_utf8(text); shown != text)
      throw InvalidInput(
          fmt::format("{}'{:.200}': is not UTF-8, as the files of a batch are: rename it", where, shown));
  const auto is_unfit = [](char c) { return c == '/' || static_cast<unsigned char>(c) < ' ' || c == '\x7f'; };
  if (!one.name.empty() && one.name.size() <= kLongest && one.name.front() != '.' &&
      std::none_of(one.name.begin(), one.name.end(), is_unfit))
    return;
  throw InvalidInput(
      fmt::format("{}'{:.60}': is no name for the folder of a case: it must have 1 to {} bytes, no '/' and "
                  "no control character, and not start with '.'; name the case in a manifest: name = file",
                  where, one.name, kLongest));
}

void check_plan(const std::vector<BatchCase>& plan, const std::string& where) {
  std::set<std::string_view> names;
  for (const BatchCase& one : plan) {
    check_case(one, where);
    if (!names.insert(one.name).second)
      throw InvalidInput(fmt::format("{}'{}': is the name of two cases: rename one", where, one.name));
  }
}

}  // namespace batch

std::vector<BatchCase> plan_batch(const std::vector<std::string>& arguments) {
  Plan plan;
  for (const std::string& argument : arguments) plan.add_argument(argument);
  return plan.take();
}

}  // namespace crashsim
