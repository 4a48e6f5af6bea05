/// Help and version: every command's help shows an example, and that example works as it stands.

#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/crashsim.hpp>

#include "support/workspace.hpp"

namespace crashsim {
namespace {

using test::Finished;
using test::kDone;
using test::kUserCanFix;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

/// The command lines below "Example:" in a help text.
std::vector<std::string> examples_in(const std::string& help) {
  constexpr std::string_view kMark = "Example:\n", kCommand = "  crashsim ";
  std::vector<std::string> lines;
  const std::size_t mark = help.find(kMark);
  if (mark == std::string::npos) return lines;
  std::istringstream rest(help.substr(mark + kMark.size()));
  for (std::string line; std::getline(rest, line);)
    if (line.starts_with(kCommand)) lines.push_back(line.substr(kCommand.size()));
  return lines;
}

class Help : public testing::TestWithParam<const char*> {
 protected:
  test::Workspace workspace;
};

TEST_P(Help, ShowsAnExample) {
  const Finished help = workspace.run({GetParam(), "--help"});
  EXPECT_EQ(help.exit_code, kDone);
  EXPECT_THAT(help.err, IsEmpty());
  EXPECT_THAT(help.out, AllOf(HasSubstr("Usage: crashsim " + std::string(GetParam())), HasSubstr("Example:\n")));
  EXPECT_THAT(examples_in(help.out), Not(IsEmpty()));
}

TEST_P(Help, ItsExampleWorksWordForWord) {
  std::string last;
  for (const std::string& example : examples_in(workspace.run({GetParam(), "--help"}).out)) {
    const Finished finished = workspace.run(test::words_of(example));
    EXPECT_EQ(finished.exit_code, kDone) << "crashsim " << example << "\n" << finished.err;
    last = test::words_of(example).front();
  }
  EXPECT_EQ(last, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Commands, Help,
                         testing::Values("info", "pulse", "correct", "wall", "identify", "simulate", "predict", "pitch",
                                         "identify-pitch", "identify-vertical", "select", "compare", "run", "batch",
                                         "merge", "design", "export", "schema"));

class Program : public testing::Test {
 protected:
  test::Workspace workspace;
};

TEST_F(Program, TellsTheLibrarysVersion) {
  const Finished finished = workspace.run({"--version"});
  EXPECT_EQ(finished.exit_code, kDone);
  EXPECT_EQ(finished.out, std::string("crashsim ") + kVersion + "\n");
}

TEST_F(Program, HelpsOnAllCommands) {
  const Finished finished = workspace.run({"--help"});
  EXPECT_EQ(finished.exit_code, kDone);
  for (const char* command :
       {"info", "pulse", "correct", "wall", "identify", "simulate", "predict", "pitch", "identify-pitch",
        "identify-vertical", "select", "compare", "run", "batch", "merge", "design", "export", "schema"})
    EXPECT_THAT(finished.out, HasSubstr(command));
  EXPECT_THAT(examples_in(finished.out), SizeIs(1));
}

TEST_F(Program, ItsExampleIsThatOfRun) {
  EXPECT_EQ(examples_in(workspace.run({"--help"}).out), examples_in(workspace.run({"run", "--help"}).out));
}

TEST_F(Program, WithoutACommandHelpsOnStandardErrorAndFails) {
  const Finished finished = workspace.run({});
  EXPECT_EQ(finished.exit_code, kUserCanFix);
  EXPECT_THAT(finished.out, IsEmpty());
  EXPECT_THAT(finished.err, HasSubstr("Example:\n"));
}

TEST_F(Program, HelpNamesUnitsDefaultsAndChoices) {
  const Finished finished = workspace.run({"identify", "--help"});
  EXPECT_THAT(finished.out, AllOf(HasSubstr("{l1, l2, huber} [l1]"), HasSubstr("[100]"), HasSubstr("--mass kg")));
}

}  // namespace
}  // namespace crashsim
