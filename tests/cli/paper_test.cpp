/// docs/paper.md: its command gives the numbers of its tables.

#include <cmath>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <crashsim/files.hpp>
#include <crashsim/units.hpp>

#include "support/source_dir.hpp"
#include "support/workspace.hpp"

namespace crashsim {
namespace {

using nlohmann::json;

/// What another processor's mathematics library may move: the fit is not determined to the last digit.
constexpr double kElsewhere = 0.03;

/// Cells of the table that has this header, row by row.
std::vector<std::vector<std::string>> table_below(const std::string& page, const std::string& header) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(page.substr(page.find(header)));
  std::string line;
  for (int i = 0; i < 2; ++i) std::getline(lines, line);  // header and rule
  while (std::getline(lines, line) && line.starts_with('|')) {
    std::istringstream cells(line.substr(1));
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, '|');) {
      const auto first = cell.find_first_not_of(' '), last = cell.find_last_not_of(' ');
      rows.back().push_back(cell.substr(first, last - first + 1));
    }
  }
  return rows;
}

TEST(Paper, ItsRatingsAreThoseOfItsCommand) {
  const std::string page = read_file(std::string(test::source_dir()) + "/docs/paper.md");
  const test::Workspace workspace;
  const test::Finished run = workspace.run({"run", "data/paper/case.toml", "-o", "paper"});
  ASSERT_EQ(run.exit_code, test::kDone) << run.err;
  const json comparisons = json::parse(workspace.text_of("paper/comparison.json"));
  const std::map<std::string, std::string> comparison_of = {{"to maximum crush", "to_max_crush"},
                                                            {"whole record", "whole_record"},
                                                            {"whole record, coupled", "heave_and_pitch_coupled"},
                                                            {"from maximum crush, two phases", "heave_and_pitch"}};
  const std::map<std::string, std::string> channel_of = {{"acceleration", "accel_mps2"},
                                                         {"velocity", "velocity_mps"},
                                                         {"displacement", "displacement_m"},
                                                         {"pitch", "pitch_rad"},
                                                         {"vertical velocity", "heave_velocity_mps"}};
  const auto rows = table_below(page, "| channel | range |");
  constexpr std::size_t kRows = 10;
  ASSERT_EQ(rows.size(), kRows);
  for (const std::vector<std::string>& row : rows) {
    SCOPED_TRACE(row[0] + ", " + row[1]);
    bool found = false;
    for (const json& channel : comparisons[comparison_of.at(row[1])]["channels"]) {
      if (channel["name"] != channel_of.at(row[0])) continue;
      found = true;
      const double error = *parse_number(row[2].substr(0, row[2].find(' ')));
      const double rating = *parse_number(row[3].substr(0, row[3].find(' ')));
      EXPECT_NEAR(100.0 * channel["errors"]["mean_abs_relative"].get<double>(), error, kElsewhere * error + 0.005);
      EXPECT_NEAR(channel["iso18571"]["overall"].get<double>(), rating, kElsewhere * rating);
      EXPECT_EQ(channel["iso18571"]["grade"], row[3].substr(row[3].find(' ') + 1));
    }
    EXPECT_TRUE(found);
  }
}

TEST(Paper, TheReadmesRatingsOfSuspensionsAreThoseOfTheirCases) {
  const std::string page = read_file(std::string(test::source_dir()) + "/README.md");
  const auto rows = table_below(page, "| case | suspension |");
  constexpr std::size_t kRows = 3;
  ASSERT_EQ(rows.size(), kRows);
  const test::Workspace workspace;
  for (const std::vector<std::string>& row : rows) {
    SCOPED_TRACE(row[0]);
    const std::string file = row[0].substr(1, row[0].size() - 2);
    ASSERT_EQ(workspace.run({"run", file, "-o", "out", "--force"}).exit_code, test::kDone);
    const json comparisons = json::parse(workspace.text_of("out/comparison.json"));
    int compared = 0;
    for (const json& channel : comparisons["heave_and_pitch"]["channels"]) {
      const std::size_t column = channel["name"] == "pitch_rad" ? 2 : (channel["name"] == "heave_velocity_mps" ? 3 : 0);
      if (column == 0) continue;
      ++compared;
      const double rating = *parse_number(row[column].substr(0, row[column].find(' ')));
      EXPECT_NEAR(channel["iso18571"]["overall"].get<double>(), rating, kElsewhere * rating);
      EXPECT_EQ(channel["iso18571"]["grade"], row[column].substr(row[column].find(' ') + 1));
    }
    EXPECT_EQ(compared, 2);
  }
}

TEST(Paper, ItsErrataDoWhatItSays) {
  const test::Workspace workspace;
  std::string force = "time_s,vertical_force_n\n";
  for (int i = 0; i <= 2000; ++i) {
    const double t = 1e-4 * i;
    force +=
        format_number(t) + "," + format_number(t < 0.08 ? 60e3 * std::sin(std::numbers::pi * t / 0.08) : 0.0) + "\n";
  }
  workspace.file("force.csv", force);
  std::string one_wheel = read_file(std::string(test::source_dir()) + "/data/paper/table1.json");
  one_wheel.replace(one_wheel.find("true"), 4, "false");
  workspace.file("axle.json", one_wheel);
  const std::vector<std::string> truck = {"--mass", "2582", "--pitch-inertia", "6158"};
  const auto result = [&](const std::string& vehicle, std::vector<std::string> options) {
    std::vector<std::string> line = {"pitch",  vehicle, "--force", "force.csv", "--start",
                                     "impact", "--end", "0.2",     "--quiet",   "--json"};
    line.insert(line.end(), options.begin(), options.end());
    const test::Finished run = workspace.run(line);
    EXPECT_EQ(run.exit_code, test::kDone) << run.err;
    return json::parse(run.out);
  };
  const auto with = [&](std::vector<std::string> options) {
    options.insert(options.end(), truck.begin(), truck.end());
    return options;
  };
  constexpr double kDigits = 5e-4;
  const json printed = result("axle.json", with({"--force-arm", "1", "--formulation", "as_printed"}));
  const json derived = result("axle.json", with({"--force-arm", "1"}));
  EXPECT_NEAR(printed["heave_min_m"], -0.1550, kDigits);
  EXPECT_NEAR(derived["heave_min_m"], -0.1506, kDigits);
  EXPECT_NEAR(printed["pitch_max_rad"], derived["pitch_max_rad"], 1e-4 * 0.0687);
  const json wheels = result("data/paper/table1.json", with({"--force-arm", "1.4"}));
  EXPECT_NEAR(wheels["pitch_max_rad"], 0.0836, kDigits);
  EXPECT_NEAR(result("axle.json", with({"--force-arm", "1.4"}))["pitch_max_rad"], 0.0964, kDigits);
  EXPECT_NEAR(result("data/paper/table1.json", {"--mass", "2582", "--force-arm", "1.4"})["pitch_max_rad"], 0.169,
              kDigits);
  EXPECT_NEAR(result("data/paper/table1.json", {"--mass", "2582", "--force-arm", "1.4"})["heave_min_m"], -0.113,
              kDigits);
  EXPECT_NEAR(result("data/paper/table1.json", {"--force-arm", "1.4"})["heave_min_m"], -0.214, kDigits);
}

}  // namespace
}  // namespace crashsim
