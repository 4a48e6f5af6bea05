#include "command.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <fmt/format.h>

#include "interrupt.hpp"
#include "shown_number.hpp"

namespace crashsim::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kNameWidth = 34;
constexpr int kValueWidth = 14;

std::string shown_value(const SummaryItem& item) {
  if (const auto* number = std::get_if<double>(&item.value)) return shown_number(item.name, *number);
  if (const auto* count = std::get_if<std::int64_t>(&item.value)) return fmt::format("{}", *count);
  if (const auto* flag = std::get_if<bool>(&item.value)) return *flag ? "yes" : "no";
  const auto& text = std::get<std::string>(item.value);
  return text.empty() ? "-" : text;
}

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return fs::equivalent(a, b, ignored);
}

}  // namespace

Command::Command(CLI::App& parent, const std::string& name, const std::string& what, const std::string& example)
    : app_(*parent.add_subcommand(name, what)) {
  app_.footer("Example:\n  " + example);
}

void Command::add_output(const std::string& type_name, const std::string& what, const std::string& overwrite) {
  app_.add_option("-o,--output", output_, what)
      ->type_name(type_name)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  if (!overwrite.empty()) app_.add_flag(overwrite, overwrite_, "replace an output that exists");
}

void Command::add_reporting() {
  app_.add_flag("--json", json_, "summary as JSON on standard output");
  app_.add_flag("--quiet", quiet_, "no summary on standard error");
  app_.add_option("--config", config_, "options from a TOML file; the command line wins")->type_name("FILE");
}

std::vector<ConfigEntry> Command::config_entries() const {
  if (config_.empty()) return {};
  const auto commands = app_.get_parent()->get_subcommands(nullptr);
  std::vector<ConfigEntry> entries;
  for (const ConfigEntry& entry : read_config(config_)) {
    const auto is_named = [&](const CLI::App* command) { return command->get_name() == entry.section; };
    if (!entry.section.empty() && std::none_of(commands.begin(), commands.end(), is_named))
      throw InvalidInput(fmt::format("{}: [{}] is no subcommand: options of this one stand in [{}] or before any table",
                                     entry.where, entry.section, app_.get_name()));
    if (entry.section.empty() || entry.section == app_.get_name()) entries.push_back(entry);
  }
  return entries;
}

std::vector<std::string_view> Command::shared_keys() const {
  std::vector<std::string_view> keys = {"output", "overwrite", "json", "quiet"};
  std::erase_if(keys,
                [&](std::string_view key) { return app_.get_option_no_throw("--" + std::string(key)) == nullptr; });
  return keys;
}

bool Command::set_shared(const ConfigEntry& entry) {
  const std::string what = entry.where + ": " + entry.key;
  const CLI::Option* named = app_.get_option_no_throw("--" + entry.key);
  const auto is_named = [&](const char* flag) { return named != nullptr && named == app_.get_option_no_throw(flag); };
  if (is_named("--output")) {
    const std::string path = detail::to_text(entry.value, what);
    if (named->count() == 0) output_ = path;
    return true;
  }
  for (const auto& [flag, member] :
       {std::pair("--overwrite", &overwrite_), std::pair("--json", &json_), std::pair("--quiet", &quiet_)}) {
    if (!is_named(flag)) continue;
    const bool value = detail::to_bool(entry.value, what);
    if (named->count() == 0) *member = value;
    return true;
  }
  return false;
}

void Command::check_output(const std::vector<std::string>& inputs) const {
  if (output_.empty()) {
    if (json_) return;
    throw InvalidInput(
        fmt::format("{}: where to? Name the output with -o FILE ('-' for standard output), or "
                    "ask for the summary alone with --json",
                    app_.get_name()));
  }
  if (output_ == "-" && json_) throw InvalidInput("-o - and --json both write to standard output: choose one of them");
  if (output_ != "-") check_writable(output_, inputs);
}

void Command::check_writable(const std::string& path, const std::vector<std::string>& inputs) const {
  const auto is_output = [&](const std::string& input) { return is_same_file(path, input); };
  if (std::any_of(inputs.begin(), inputs.end(), is_output) || is_output(config_))
    throw InvalidInput(fmt::format("{}: is an input: choose another name for the output", path));
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) throw InvalidInput(fmt::format("{}: is a folder: name a file to write", path));
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, ignored))
    throw InvalidInput(fmt::format("{}: there is no folder {}: make it first", path, folder.string()));
  if (!overwrite_ && fs::is_regular_file(path, ignored))
    throw InvalidInput(fmt::format("{}: exists already; choose another name, or --{} to replace it", path,
                                   app_.get_option("--overwrite")->get_lnames().back()));
}

void Command::write(const std::string& text) const {
  const CooperativeInterrupt finish_first;
  if (!output_.empty()) write_output(output_, text, overwrite_);
}

void Command::say(const std::string& line) const {
  if (!quiet_) fmt::print(stderr, "{}\n", line);
}

void Command::say(const Summary& summary) const {
  for (const SummaryItem& item : summary) say(fmt::format("  {:<{}} {}", item.doc, kNameWidth, shown_value(item)));
}

void Command::say(const Summary& left, const Summary& right, const std::string& left_name,
                  const std::string& right_name) const {
  say(fmt::format("  {:<{}} {:<{}} {}", "", kNameWidth, left_name, kValueWidth, right_name));
  for (std::size_t i = 0; i < left.size(); ++i)
    say(fmt::format("  {:<{}} {:<{}} {}", left[i].doc, kNameWidth, shown_value(left[i]), kValueWidth,
                    shown_value(right[i])));
}

void Command::warn(const std::vector<std::string>& warnings) const {
  for (const std::string& warning : warnings) say("  warning: " + warning);
}

void Command::print_json(const std::string& json) const {
  if (json_) write_output("-", json, false);
}

Record Command::record(std::vector<std::string> arguments, std::vector<ConfigEntry> options,
                       const std::vector<std::string>& inputs) const {
  return make_record(app_.get_name(), std::move(arguments), std::move(options), inputs);
}

}  // namespace crashsim::cli
