/// What belongs together stays together: the version, and the header of all headers.
#include <crashsim/crashsim.hpp>

#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "support/source_tree.hpp"

namespace crashsim::test {
namespace {

using testing::UnorderedElementsAreArray;

TEST(Package, VersionIsTheProjects) {
  const std::string text = source_text("CMakeLists.txt");
  std::smatch match;
  ASSERT_TRUE(std::regex_search(text, match, std::regex(R"(project\(crashsim VERSION ([0-9.]+))")));
  EXPECT_EQ(kVersion, match[1].str());
}

TEST(Package, UmbrellaHeaderIncludesEveryPublicHeader) {
  const std::string umbrella = "include/crashsim/crashsim.hpp";
  std::vector<std::string> headers = {"<crashsim/version.hpp>"};  // configured, not in the source folder
  for (const std::string& path : sources_in("include"))
    if (path != umbrella) headers.push_back("<" + path.substr(std::string("include/").size()) + ">");
  std::vector<std::string> included;
  for (const Include& include : includes_in("include"))
    if (include.file == umbrella) included.push_back(include.name);
  EXPECT_THAT(included, UnorderedElementsAreArray(headers)) << "list every public header in " << umbrella;
}

}  // namespace
}  // namespace crashsim::test
