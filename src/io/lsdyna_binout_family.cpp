#include "io/lsdyna_binout_family.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <tuple>

#include <fmt/format.h>

#include "text.hpp"

namespace crashsim::io {
namespace {

namespace fs = std::filesystem;

constexpr int kAfterContinuations = 1'000'000'000;

/// A file's name in its parts: "car.binout", "0003" and 2 of "car.binout0003%002".
struct Name {
  std::string stem, process;
  int part = 0;  ///< 0 of the file that the others continue.

  [[nodiscard]] std::string base() const { return stem + process; }
};

std::size_t digits_at_end(std::string_view text) {
  const auto first = std::find_if_not(text.rbegin(), text.rend(), is_digit);
  return static_cast<std::size_t>(first - text.rbegin());
}

/// Takes "%002" off a name's end, or underscores behind a number; returns the part that they make it.
int take_part(std::string_view& name) {
  constexpr std::size_t kLeastDigits = 2, kMostDigits = 8;
  const std::size_t digits = digits_at_end(name);
  if (digits >= kLeastDigits && digits <= kMostDigits && name.size() > digits + 1 &&
      name[name.size() - digits - 1] == '%') {
    int part = 0;
    std::from_chars(name.data() + name.size() - digits, name.data() + name.size(), part);
    name.remove_suffix(digits + 1);
    return part;
  }
  const std::size_t last = name.find_last_not_of('_');
  if (last == std::string_view::npos || last + 1 == name.size() || !is_digit(name[last])) return 0;
  const auto underscores = static_cast<int>(name.size() - last - 1);
  name.remove_suffix(name.size() - last - 1);
  return kAfterContinuations + underscores;
}

Name parse_name(std::string_view text) {
  constexpr std::size_t kProcessDigits = 4;
  Name name;
  name.part = take_part(text);
  const std::size_t digits = digits_at_end(text);
  const std::string_view stem = text.substr(0, text.size() - digits);
  const bool of_process = digits >= kProcessDigits && to_lower(stem).ends_with("binout");
  name.stem = of_process ? stem : text;
  if (of_process) name.process = text.substr(stem.size());
  return name;
}

bool same_run(const Name& a, const Name& b) { return a.stem == b.stem && a.process.size() == b.process.size(); }

/// Says which parts are missing before each of `names`, which are sorted.
void warn_of_gaps(const std::vector<Name>& names, const fs::path& folder, std::vector<std::string>& warnings) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool first = i == 0 || names[i - 1].process != names[i].process;
    const int expected = first ? 0 : names[i - 1].part + 1;
    if (names[i].part == expected || (names[i].part > kAfterContinuations && !first)) continue;
    const std::string base = (folder / names[i].base()).string();
    const int missing = std::min(names[i].part, kAfterContinuations) - expected;
    warnings.push_back(fmt::format(
        "{}{} is missing{}: its part of the run is not there", base,
        expected == 0 ? "" : fmt::format("%{:03}", expected),
        missing > 1 && names[i].part < kAfterContinuations ? fmt::format(", and {} after it", missing - 1) : ""));
  }
}

}  // namespace

BinoutFamily binout_family(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  const std::string own_text = fs::path(path).filename().string();
  const Name own = parse_name(own_text);
  std::vector<std::pair<Name, std::string>> members = {{own, path}};
  std::error_code ignored;
  for (fs::directory_iterator at(folder.empty() ? "." : folder, ignored), end; at != end; at.increment(ignored)) {
    const std::string text = at->path().filename().string();
    const Name name = parse_name(text);
    if (text == own_text || !same_run(name, own) || at->is_directory(ignored)) continue;
    members.emplace_back(name, (folder / text).string());
  }
  std::sort(members.begin(), members.end(), [](const auto& a, const auto& b) {
    return std::tie(a.first.process, a.first.part) < std::tie(b.first.process, b.first.part);
  });
  BinoutFamily family;
  std::vector<Name> names;
  for (const auto& [name, file] : members) {
    names.push_back(name);
    family.paths.push_back(file);
  }
  warn_of_gaps(names, folder, family.warnings);
  return family;
}

}  // namespace crashsim::io
