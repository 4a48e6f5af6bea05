/// crashsim compare: tables for reports, metrics side by side, and files that are out of balance.

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "support/workspace.hpp"

namespace crashsim {
namespace {

using nlohmann::json;
using test::Finished;
using test::kDone;
using test::kUserCanFix;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

class CompareCommand : public testing::Test {
 protected:
  /// A pulse, and a model of the same motion at another speed change.
  void SetUp() override {
    workspace.file("a.csv", test::half_sine_trace());
    workspace.file("b.csv", test::half_sine_trace(16.0));
    for (const std::string name : {"a", "b"})
      ASSERT_EQ(workspace.run({"pulse", name + ".csv", "-o", name + "_pulse.csv", "--quiet"}).exit_code, kDone);
  }
  [[nodiscard]] Finished compare(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"compare", "a_pulse.csv", "b_pulse.csv"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return workspace.run(arguments);
  }
  test::Workspace workspace;
};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Cells of a Markdown row or a CSV line.
std::size_t cells_of(const std::string& line, char separator) {
  return static_cast<std::size_t>(std::count(line.begin(), line.end(), separator));
}

TEST_F(CompareCommand, PutsTheMetricsOfTwoMotionsSideBySide) {
  const Finished finished = compare({"-o", "rating.json"});
  ASSERT_EQ(finished.exit_code, kDone) << finished.err;
  EXPECT_THAT(finished.err, AllOf(HasSubstr("metric "), HasSubstr("maximum dynamic crush"), HasSubstr("difference")));
  const json metrics = json::parse(workspace.text_of("rating.json"))["metrics"];
  for (const std::string name : {"a", "b"}) {
    const Finished pulse = workspace.run({"pulse", name + "_pulse.csv", "--json", "--quiet"});
    const json numbers = json::parse(pulse.out);
    for (const auto& [key, compared] : metrics.items())
      EXPECT_EQ(compared[name == "a" ? "reference" : "candidate"], numbers[key]) << key;
  }
  const double a = metrics["max_crush_m"]["reference"], b = metrics["max_crush_m"]["candidate"];
  EXPECT_EQ(metrics["max_crush_m"]["difference"].get<double>(), (b - a) / a);
}

TEST_F(CompareCommand, LeavesMetricsOutWhereThereAreNone) {
  const Finished finished = workspace.run({"compare", "a.csv", "b.csv", "--json"});
  EXPECT_FALSE(json::parse(finished.out).contains("metrics"));
  EXPECT_THAT(finished.err, Not(HasSubstr("maximum dynamic crush")));
  EXPECT_THAT(compare({"--channel", "velocity_mps"}).err, Not(HasSubstr("maximum dynamic crush")));
}

TEST_F(CompareCommand, PrintsTablesForReports) {
  const Finished finished = compare({"--table", "markdown", "--quiet"});
  ASSERT_EQ(finished.exit_code, kDone) << finished.err;
  EXPECT_THAT(finished.err, IsEmpty());
  const std::vector<std::string> lines = lines_of(finished.out);
  constexpr std::size_t kChannels = 3, kMetrics = 18, kAround = 2 + 2 + 1 + 2;  // heads, range, blank line
  ASSERT_THAT(lines, SizeIs(kChannels + kMetrics + kAround));
  EXPECT_EQ(lines[0], "| channel | unit | grade | mean error | largest | relative | R | Z | EP | EM | ES |");
  EXPECT_THAT(lines[2], StartsWith("| accel_mps2 | m/s^2 | "));
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(cells_of(lines[i], '|'), cells_of(lines[0], '|')) << lines[i];
  EXPECT_EQ(lines[8], "| metric | unit | reference | candidate | difference |");
  EXPECT_THAT(finished.out, HasSubstr("| maximum dynamic crush | mm | "));
}

TEST_F(CompareCommand, PrintsTablesForSpreadsheets) {
  const Finished finished = compare({"--table", "csv", "--quiet"});
  ASSERT_EQ(finished.exit_code, kDone) << finished.err;
  const std::vector<std::string> lines = lines_of(finished.out);
  ASSERT_GT(lines.size(), 6u);
  EXPECT_THAT(lines[0], StartsWith("channel,unit,start_s,end_s,grade,mean_abs,rms,max_abs,mean_abs_relative,overall,"));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(cells_of(lines[i], ','), cells_of(lines[0], ','));
  EXPECT_EQ(lines[5], "metric,reference,candidate,difference");
  const json metrics = json::parse(compare({"--json"}).out)["metrics"];
  const std::string crush = lines[7];
  ASSERT_THAT(crush, StartsWith("max_crush_m,"));
  EXPECT_EQ(std::stod(crush.substr(crush.find(',') + 1)), metrics["max_crush_m"]["reference"].get<double>());
}

TEST_F(CompareCommand, PrintsItsOrdinaryTableWhenAsked) {
  const Finished finished = compare({"--table", "plain"});
  EXPECT_THAT(finished.out, AllOf(HasSubstr("mean error"), HasSubstr("maximum dynamic crush")));
  EXPECT_THAT(finished.err, Not(HasSubstr("mean error")));
}

TEST_F(CompareCommand, WritesOneThingToStandardOutput) {
  for (const std::vector<std::string>& other : {std::vector<std::string>{"--json"}, {"-o", "-"}}) {
    std::vector<std::string> arguments = {"--table", "csv"};
    arguments.insert(arguments.end(), other.begin(), other.end());
    const Finished finished = compare(arguments);
    EXPECT_EQ(finished.exit_code, kUserCanFix);
    EXPECT_THAT(finished.err, HasSubstr("--table and the JSON both write to standard output: choose one of them"));
  }
  EXPECT_THAT(compare({"--table", "html"}).err, HasSubstr("known: plain, markdown, csv"));
}

TEST_F(CompareCommand, WarnsOfAFileThatIsOutOfBalance) {
  std::string text = "# impact_speed_mps = 15\ntime_s,accel_mps2,velocity_mps,displacement_m\n";
  for (int i = 0; i <= 100; ++i) {
    const double t = 1e-3 * i;
    text += fmt::format("{},{},{},{}\n", t, -220.0, 15.0 - 200.0 * t, 15.0 * t - 100.0 * t * t);
  }
  workspace.file("odd.csv", text);
  const std::string warning = "velocity is not the integral of acceleration: they differ by 13.3 % of the impact speed";
  EXPECT_THAT(workspace.run({"compare", "a_pulse.csv", "odd.csv"}).err, HasSubstr("warning: odd.csv: " + warning));
  EXPECT_THAT(workspace.run({"pulse", "odd.csv", "--json"}).err, HasSubstr("warning: " + warning));
  EXPECT_THAT(compare({}).err, Not(HasSubstr("not the integral")));
}

}  // namespace
}  // namespace crashsim
