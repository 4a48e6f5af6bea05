#pragma once
/// batch.json: which batch a folder holds, and which shard of it.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <crashsim/batch.hpp>

#include "batch/folder.hpp"

namespace crashsim::batch {

inline constexpr const char* kBatchFile = "batch.json";
inline constexpr const char* kPlan = "plan";  ///< Among what is private: the cases of the shard.

struct BatchIdentity {
  std::string version;      ///< Of crashsim.
  std::size_t cases = 0;    ///< Of the whole batch.
  std::string plan_sha256;  ///< Of their names and files, in order.
  BatchShard shard;

  bool operator==(const BatchIdentity&) const = default;
};

BatchIdentity identify_batch(const std::vector<BatchCase>& plan, const BatchShard& shard);

std::string to_json(const BatchIdentity& identity);

/// Every count-th case of a plan, from the index-th on.
std::vector<BatchCase> shard_of(const std::vector<BatchCase>& plan, const BatchShard& shard);

/// A plan as text, a case a line, and back. @throws InvalidInput naming `path` when it is damaged, or see check_plan().
std::string format_plan(const std::vector<BatchCase>& plan);
std::vector<BatchCase> parse_plan(const std::string& text, const std::string& path);

/// What the folder says; none when it holds no batch. @throws InvalidInput when its batch.json is damaged.
std::optional<BatchIdentity> find_batch(const Folder& folder);

}  // namespace crashsim::batch
