#include "batch_report.hpp"

#include <cerrno>
#include <chrono>
#include <cstring>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <crashsim/error.hpp>

namespace crashsim::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string on_one_line(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

/// 2024-05-01T12:30:00.250Z
std::string now() {
  using namespace std::chrono;
  const auto time = floor<milliseconds>(system_clock::now());
  const auto seconds = floor<std::chrono::seconds>(time);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(system_clock::to_time_t(seconds)),
                     (time - seconds).count());
}

Json json_of(const StageTimes& stages) {
  Json json = Json::object();
  for (const auto& stage : kStageTimes) json[std::string(stage.name)] = stages.*stage.member;
  return json;
}

Json numbers_of(const BatchReport& report) {
  Json json = {{"total", report.total},
               {"done", report.done},
               {"unchanged", report.unchanged},
               {"failed", report.failed},
               {"retried", report.retried},
               {"left_over", report.left_over},
               {"interrupted", report.interrupted},
               {"exit_code", report.exit_code},
               {"seconds", report.seconds},
               {"stages", json_of(report.stages)}};
  json["slowest"] = Json::array();
  for (const auto& [name, seconds] : report.slowest) json["slowest"].push_back({{"case", name}, {"seconds", seconds}});
  json["failures"] = Json::array();
  for (const BatchRow& row : report.failures)
    json["failures"].push_back({{"case", row.name}, {"outcome", row.outcome}, {"message", row.message}});
  return json;
}

std::string stages_line(const StageTimes& stages) {
  std::string line;
  for (const auto& stage : kStageTimes)
    if (stages.*stage.member > 0.0)
      line += fmt::format("{}{} {:.3g} s", line.empty() ? "" : ", ", stage.doc, stages.*stage.member);
  return line;
}

}  // namespace

std::vector<std::string> lines_of(const BatchReport& report) {
  constexpr std::size_t kSlowest = 3;
  std::vector<std::string> lines;
  std::string counts = fmt::format("  {} of {} cases done", report.done, report.total);
  if (report.unchanged > 0) counts += fmt::format(", {} of them before", report.unchanged);
  const std::size_t run = report.done - report.unchanged;
  counts += fmt::format(", {} failed, {:.3g} s", report.failed, report.seconds);
  if (run > 0 && report.seconds > 0.0) counts += fmt::format(", {:.3g}/s", static_cast<double>(run) / report.seconds);
  lines.push_back(counts);
  if (const std::string stages = stages_line(report.stages); !stages.empty())
    lines.push_back("  time in cases: " + stages);
  std::string slowest;
  for (std::size_t i = 0; i < std::min(kSlowest, report.slowest.size()); ++i)
    slowest += fmt::format("{}{} {:.3g} s", i > 0 ? ", " : "", report.slowest[i].first, report.slowest[i].second);
  if (!slowest.empty()) lines.push_back("  slowest: " + slowest);
  if (report.retried > 0)
    lines.push_back(fmt::format("  {} cases were run again after their process had been killed", report.retried));
  if (report.left_over > 0)
    lines.push_back(
        fmt::format("  note: {} cases in the folder were not asked for; they are not in the tables", report.left_over));
  for (const BatchRow& row : report.failures)
    lines.push_back(fmt::format("  failed: {}: {}: {}", row.name, row.outcome, row.message));
  if (report.failed > report.failures.size())
    lines.push_back(fmt::format("  and {} more", report.failed - report.failures.size()));
  return lines;
}

std::string json_of(const BatchReport& report) {
  return numbers_of(report).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

EventLog::EventLog(const std::string& path) : path_(path) {
  if (path.empty()) return;
  file_ = path == "-" ? stderr : std::fopen(path.c_str(), "ae");
  if (file_ == nullptr) throw SystemFailure(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
}

EventLog::~EventLog() {
  if (file_ != nullptr && file_ != stderr) std::fclose(file_);
}

void EventLog::write(const BatchEvent& event) {
  if (file_ == nullptr || event.kind == BatchEvent::Kind::waiting) return;
  Json json = {{"time", now()}, {"event", name_of(event.kind)}};
  if (!event.name.empty()) json["case"] = event.name;
  if (event.row != nullptr) {
    json["outcome"] = event.row->outcome;
    if (event.row->failed()) json["message"] = event.row->message;
    json["seconds"] = event.row->seconds;
    json["stages"] = json_of(event.row->stages);
  }
  if (!event.message.empty()) json["message"] = event.message;
  json["done"] = event.done;
  json["failed"] = event.failed;
  json["total"] = event.total;
  write_line(on_one_line(json));
}

void EventLog::write(const BatchReport& report) {
  if (file_ == nullptr) return;
  Json json = {{"time", now()}, {"event", "report"}};
  json.update(numbers_of(report));
  write_line(on_one_line(json));
}

void EventLog::write_line(const std::string& line) {
  if (std::fputs((line + "\n").c_str(), file_) < 0 || std::fflush(file_) != 0)
    throw SystemFailure(fmt::format("{}: cannot be written: {}", path_, std::strerror(errno)));
}

}  // namespace crashsim::cli
