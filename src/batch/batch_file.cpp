#include "batch/batch_file.hpp"

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/files.hpp>
#include <crashsim/version.hpp>

#include "batch/case_name.hpp"
#include "json.hpp"
#include "sha256.hpp"
#include "text.hpp"

namespace crashsim::batch {
namespace {

constexpr const char* kFormat = "crashsim.batch";
constexpr int kFormatVersion = 1;

}  // namespace

BatchIdentity identify_batch(const std::vector<BatchCase>& plan, const BatchShard& shard) {
  std::string all;
  for (const BatchCase& one : plan) all += one.name + '\0' + one.path + '\0';
  return {kVersion, plan.size(), sha256_of(all), shard};
}

std::string to_json(const BatchIdentity& identity) {
  return format_json({{"format", kFormat},
                      {"version", kFormatVersion},
                      {"crashsim", identity.version},
                      {"cases", identity.cases},
                      {"plan_sha256", identity.plan_sha256},
                      {"shard", fmt::format("{}/{}", identity.shard.index, identity.shard.count)}});
}

std::vector<BatchCase> shard_of(const std::vector<BatchCase>& plan, const BatchShard& shard) {
  std::vector<BatchCase> mine;
  const auto step = static_cast<std::size_t>(shard.count);
  for (auto i = static_cast<std::size_t>(shard.index - 1); i < plan.size(); i += step) mine.push_back(plan[i]);
  return mine;
}

std::string format_plan(const std::vector<BatchCase>& plan) {
  std::string text;
  for (const BatchCase& one : plan) text += format_json_line(Json::array({one.name, one.path})) + "\n";
  return text;
}

std::vector<BatchCase> parse_plan(const std::string& text, const std::string& path) {
  std::vector<BatchCase> plan;
  for (const std::string_view line : split(text, '\n')) {
    if (line.empty()) continue;
    const Json pair = parse_json(line, path);
    if (!pair.is_array() || pair.size() != 2 || !pair[0].is_string() || !pair[1].is_string())
      throw InvalidInput(fmt::format("{}: is damaged: run the batch again with --resume", path));
    plan.push_back({pair[0].get<std::string>(), pair[1].get<std::string>()});
  }
  check_plan(plan, path + ": ");
  return plan;
}

std::optional<BatchIdentity> find_batch(const Folder& folder) {
  if (!folder.has(kBatchFile)) return std::nullopt;
  const std::string path = folder.path_of(kBatchFile);
  const Json json = parse_json(read_file(path), path);
  try {
    if (json.at("format") != kFormat || json.at("version") != kFormatVersion)
      throw InvalidInput(fmt::format("{}: is not of a batch that this crashsim can read", path));
    return BatchIdentity{json.at("crashsim").get<std::string>(), json.at("cases").get<std::size_t>(),
                         json.at("plan_sha256").get<std::string>(), parse_shard(json.at("shard").get<std::string>())};
  } catch (const Json::exception&) {
    throw InvalidInput(fmt::format("{}: is damaged: move the folder away and run the batch again", path));
  }
}

}  // namespace crashsim::batch
