#pragma once
/// Independent programs that tests compare with, as script/oracles installs them.
///
///     const auto python = oracle_python("lasso-python");
///     if (!python) GTEST_SKIP() << kNoOracle;

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "support/source_dir.hpp"

namespace crashsim::test {

inline constexpr std::string_view kNoOracle = "script/oracles has not been run";

/// The interpreter that has the packages of tests/oracles/<name>.txt; empty when they are not installed.
inline std::optional<std::string> oracle_python(std::string_view name) {
  const auto environment = std::filesystem::path(source_dir()) / "build/oracles" / name;
  if (!std::filesystem::exists(environment / "installed.txt")) return std::nullopt;
  return (environment / "bin/python").string();
}

}  // namespace crashsim::test
