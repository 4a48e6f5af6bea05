#pragma once
/// Small cases for batches, and the folders that batches leave behind.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <crashsim/files.hpp>

#include "support/workspace.hpp"

namespace crashsim::test {

/// SHA-256 of the files below a folder by their names; of a batch without what tells times.
inline std::map<std::string, std::string> files_in(const std::string& folder) {
  namespace fs = std::filesystem;
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    if (entry.is_regular_file() && name != "timings.csv" && !name.starts_with(".batch/"))
      files[name] = sha256_of_file(entry.path().string());
  }
  return files;
}

/// Lines of a text.
inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

/// A workspace with cases/c00.toml, c01.toml, ..: the synthetic model at different speeds. Some milliseconds each.
class BatchWorkspace : public Workspace {
 public:
  explicit BatchWorkspace(int count = 0) {
    std::filesystem::create_directory(path("in"));
    std::filesystem::copy_file(path("data/syn-a/model.json"), path("in/model.json"));
    for (int i = 0; i < count; ++i) simulated(fmt::format("c{:02}", i), 10.0 + 0.25 * i);
  }

  void simulated(const std::string& name, double speed_mps, const std::string& more = "") const {
    file("in/" + name + ".toml", fmt::format("[impact]\nspeed = {}\n[crush]\nmodel = \"model.json\"\n[simulate]\n"
                                             "to_max_crush = true\ndt = 0.001\n{}",
                                             speed_mps, more));
  }

  /// A case that takes hours.
  void endless(const std::string& name) const {
    file("in/trace.csv", half_sine_trace());
    file("in/" + name + ".toml", "[pulse]\nfile = \"trace.csv\"\n[identify]\nstarts = 1000000\n");
  }

  /// Runs `crashsim batch in/*.toml -o FOLDER` with further arguments.
  [[nodiscard]] Finished batch(const std::string& folder, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"batch", "in/*.toml", "-o", folder};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  [[nodiscard]] std::map<std::string, std::string> files_of(const std::string& folder) const {
    return files_in(path(folder));
  }
};

}  // namespace crashsim::test
