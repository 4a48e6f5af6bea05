#pragma once
/// A folder of its own in which a test runs the program, with the project's data beside it as a user has them.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <crashsim/files.hpp>

#include "support/program.hpp"
#include "support/source_dir.hpp"
#include "support/temp_dir.hpp"

namespace crashsim::test {

inline constexpr int kDone = 0, kUserCanFix = 2, kNumbersFailed = 3, kMachineFailed = 4, kInterrupted = 130;

class Workspace {
 public:
  Workspace() {
    std::filesystem::create_directory_symlink(std::string(test::source_dir()) + "/data", dir_.path("data"));
  }

  /// Runs `crashsim` in the folder.
  [[nodiscard]] Finished run(const std::vector<std::string>& arguments, Launch launch = {}) const {
    launch.folder = dir_.path("");
    return test::run(CRASHSIM_EXECUTABLE, arguments, launch);
  }

  [[nodiscard]] std::string path(std::string_view name) const { return dir_.path(name); }
  std::string file(std::string_view name, std::string_view text) const { return dir_.file(name, text); }
  [[nodiscard]] std::string text_of(std::string_view name) const { return read_file(dir_.path(name)); }
  [[nodiscard]] bool has(std::string_view name) const {
    return std::filesystem::exists(std::filesystem::symlink_status(dir_.path(name)));
  }
  /// Names in a folder of the workspace, sorted; without the data.
  [[nodiscard]] std::vector<std::string> names(std::string_view folder = "") const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(dir_.path(folder)))
      if (entry.path().filename() != "data") names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

 private:
  TempDir dir_;
};

/// The words of a command line; quotes keep blanks and globs together, as in a shell.
inline std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  std::string word;
  bool quoted = false;
  for (const char c : line + " ") {
    if (c == '\'') {
      quoted = !quoted;
    } else if (c != ' ' || quoted) {
      word += c;
    } else if (!word.empty()) {
      words.push_back(word);
      word.clear();
    }
  }
  return words;
}

inline constexpr double kTraceSpeed_mps = 15.0;

/// A half-sine deceleration of 100 ms after 10 ms of rest, as a foreign CSV file in g that says mass and speed. The
/// vehicle rebounds when `speed_change_mps` is above 15.
inline std::string half_sine_trace(double speed_change_mps = 16.5, double step_s = 1e-4) {
  constexpr double kDuration_s = 0.1, kRest_s = 0.01, kEnd_s = 0.12, kG = 9.80665;
  std::string text = fmt::format("# mass_kg = 1500\n# impact_speed_mps = {}\ntime_s,accel_g\n", kTraceSpeed_mps);
  const double peak_g = speed_change_mps * std::numbers::pi / (2.0 * kDuration_s) / kG;
  const long first = std::lround(-kRest_s / step_s), last = std::lround(kEnd_s / step_s);
  for (long i = first; i <= last; ++i) {
    const double t = static_cast<double>(i) * step_s;
    const double accel_g = t > 0.0 && t < kDuration_s ? -peak_g * std::sin(std::numbers::pi * t / kDuration_s) : 0.0;
    text += fmt::format("{:.6f},{:.9g}\n", t, accel_g);
  }
  return text;
}

/// A model written by hand: a spring of 1 MN/m and a little damping.
inline constexpr const char* kModelText =
    R"({"format": "crashsim.crush_model", "version": 1, "mass_kg": 1500, "impact_speed_mps": 15,
 "spring": {"knots_m": [0, 1], "ordinates_n_per_m": [1e6, 1e6]},
 "damper": {"knots_mps": [0, 20], "ordinates_ns_per_m": [1000, 2000]}}
)";

}  // namespace crashsim::test
