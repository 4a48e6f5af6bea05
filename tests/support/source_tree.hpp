#pragma once
/// The project's own sources, for tests that hold the architecture to its word.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/source_dir.hpp"

namespace crashsim::test {

/// Text of a file of the source tree, by its path in it.
inline std::string source_text(const std::string& path) {
  std::ifstream file(std::filesystem::path(source_dir()) / path);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  return {std::istreambuf_iterator<char>(file), {}};
}

/// C++ sources in a folder and below, as paths in the source tree, sorted; none when there is no such folder.
inline std::vector<std::string> sources_in(const std::string& folder) {
  const std::filesystem::path root = source_dir();
  std::vector<std::string> paths;
  if (!std::filesystem::is_directory(root / folder)) return paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".hpp" || extension == ".cpp")
      paths.push_back(entry.path().lexically_relative(root).generic_string());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// One #include.
struct Include {
  std::string file;  ///< Who includes.
  std::string name;  ///< What, with its quotes or angle brackets.
};

inline std::vector<Include> includes_in(const std::string& folder) {
  static const std::regex directive(R"((?:^|\n)[ \t]*#[ \t]*include[ \t]*(<[^>]+>|"[^"]+"))");
  std::vector<Include> found;
  for (const std::string& path : sources_in(folder)) {
    const std::string text = source_text(path);
    for (std::sregex_iterator match(text.begin(), text.end(), directive), end; match != end; ++match)
      found.push_back({path, (*match)[1]});
  }
  return found;
}

}  // namespace crashsim::test
