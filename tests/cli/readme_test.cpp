/// The README's tour: every command of it, word for word, prints what the README says.

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/files.hpp>
#include <crashsim/units.hpp>

#include "support/source_dir.hpp"
#include "support/workspace.hpp"

namespace crashsim {
namespace {

/// Another processor's mathematics library may differ in the last bit, which moves what is badly determined (kind:
/// regression, relative).
constexpr double kElsewhere = 0.05;

struct Step {
  std::string command;
  std::vector<std::string> printed;
};

std::vector<Step> tour_of(const std::string& readme) {
  constexpr std::string_view kIndent = "    ", kCommand = "    $ crashsim ";
  std::vector<Step> steps;
  bool inside = false;
  std::istringstream lines(readme);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(kCommand)) {
      steps.push_back({line.substr(kCommand.size()), {}});
      inside = true;
    } else if (!line.starts_with(kIndent)) {
      inside = false;
    } else if (inside) {
      steps.back().printed.push_back(line.substr(kIndent.size()));
    }
  }
  return steps;
}

/// Lines whose numbers one test does not determine, or that tell the time.
bool varies(const std::string& line) {
  const auto begins = [&](std::string_view text) { return line.starts_with("  " + std::string(text)); };
  return begins("wall time") || begins("evaluations") || begins("their condition") || begins("verdict") ||
         begins("starts within") || begins("k") || begins("c1") || begins("c2") || begins("c3") || begins("c4") ||
         begins("c5") || begins("c6") || begins("c7");
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    while (line.ends_with(' ')) line.pop_back();
    lines.push_back(line);
  }
  return lines;
}

void expect_alike(const std::string& printed, const std::string& promised) {
  std::istringstream left(printed), right(promised);
  for (std::string a, b; right >> b;) {
    ASSERT_TRUE(left >> a) << printed << "\nREADME: " << promised;
    const auto x = parse_number(a), y = parse_number(b);
    if (x && y)
      EXPECT_NEAR(*x, *y, kElsewhere * std::abs(*y)) << printed << "\nREADME: " << promised;
    else
      EXPECT_EQ(a, b) << printed << "\nREADME: " << promised;
  }
}

TEST(Readme, ItsTourPrintsWhatItSays) {
  const std::vector<Step> tour = tour_of(read_file(std::string(test::source_dir()) + "/README.md"));
  constexpr std::size_t kSteps = 9;
  ASSERT_EQ(tour.size(), kSteps);
  const test::Workspace workspace;
  for (const Step& step : tour) {
    SCOPED_TRACE(step.command);
    const test::Finished run = workspace.run(test::words_of(step.command));
    EXPECT_EQ(run.exit_code, test::kDone) << run.err;
    const std::vector<std::string> printed = lines_of(run.out + run.err);
    ASSERT_EQ(printed.size(), step.printed.size());
    for (std::size_t i = 0; i < printed.size(); ++i)
      if (!varies(step.printed[i])) expect_alike(printed[i], step.printed[i]);
  }
}

}  // namespace
}  // namespace crashsim
