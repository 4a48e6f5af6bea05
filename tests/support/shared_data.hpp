#pragma once
/// Real traces and oracle numbers that are not part of this repository: tests that need them skip when they are absent.
///
///     const auto header = shared_data("nhtsa-10146/v10146.EV5");
///     if (!header) GTEST_SKIP() << kNoSharedData;

#include <filesystem>
#include <optional>
#include <string_view>

#include "support/source_dir.hpp"

namespace crashsim::test {

inline constexpr std::string_view kNoSharedData = "the shared test data is not beside this repository";

namespace detail {
inline std::optional<std::filesystem::path> beside_the_source(std::string_view folder, std::string_view relative) {
  const auto path = std::filesystem::path(source_dir()) / ".." / "shared" / folder / relative;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return std::nullopt;
  return path.lexically_normal();
}
}  // namespace detail

/// A file or folder of the shared traces; empty when it is absent.
inline std::optional<std::filesystem::path> shared_data(std::string_view relative) {
  return detail::beside_the_source("data", relative);
}

/// The shared oracle numbers (JSON); empty when they are absent.
inline std::optional<std::filesystem::path> shared_oracles() {
  return detail::beside_the_source("oracles", "oracles.json");
}

}  // namespace crashsim::test
