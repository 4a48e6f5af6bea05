#include "io/test_files.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "text.hpp"

namespace crashsim::io {

namespace fs = std::filesystem;

std::map<std::string, std::string> files_in(const fs::path& folder) {
  std::map<std::string, std::string> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    files.emplace(to_lower(name), (folder / name).string());
  }
  return files;
}

int channel_number(const std::string& path) {
  const std::string extension = fs::path(path).extension().string();
  const bool digits =
      extension.size() >= 4 && extension.size() <= 6 && std::all_of(extension.begin() + 1, extension.end(), is_digit);
  return digits ? std::stoi(extension.substr(1)) : 0;
}

std::string stem_of(const std::string& path) { return to_lower(fs::path(path).stem().string()); }

std::vector<std::size_t> choose_compartment(const std::vector<std::size_t>& wanted,
                                            const std::vector<std::size_t>& present, const std::vector<bool>& usable,
                                            TraceSet& set) {
  if (present.empty()) return wanted;
  std::string absent;
  for (const std::size_t i : wanted)
    if (!usable[i]) absent += fmt::format("{}{}", absent.empty() ? "" : ", ", set.traces[i].id);
  if (!absent.empty())
    set.warnings.push_back(
        fmt::format("{}: compartment channel {} has no file here: what is taken instead may differ", set.path, absent));
  return present;
}

}  // namespace crashsim::io
