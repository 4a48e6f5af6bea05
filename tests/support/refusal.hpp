#pragma once
/// A command line that must be refused, and what the message must say.

#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "support/workspace.hpp"

namespace crashsim::test {

/// Every message names what is wrong, where, and the rule or remedy. The output asked for is always `out`.
struct Refusal {
  const char* what;
  std::vector<std::pair<std::string, std::string>> files;  ///< Name and text.
  std::vector<std::string> arguments;
  std::vector<std::string> message;  ///< Pieces that the message holds.
  int exit_code = kUserCanFix;
};
inline void PrintTo(const Refusal& refusal, std::ostream* out) { *out << refusal.what; }

/// Runs it and checks exit code, message, silence on standard output, and that nothing was left behind.
inline void expect_refused(const Refusal& refusal) {
  const Workspace workspace;
  for (const auto& [name, text] : refusal.files) workspace.file(name, text);
  const std::vector<std::string> before = workspace.names();
  const Finished finished = workspace.run(refusal.arguments);
  EXPECT_EQ(finished.exit_code, refusal.exit_code) << finished.err;
  EXPECT_THAT(finished.err, testing::StartsWith("crashsim: "));
  for (const std::string& piece : refusal.message) EXPECT_THAT(finished.err, testing::HasSubstr(piece));
  EXPECT_THAT(finished.out, testing::IsEmpty());
  EXPECT_EQ(workspace.names(), before);
}

}  // namespace crashsim::test
