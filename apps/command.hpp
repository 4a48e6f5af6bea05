#pragma once
/// What every subcommand shares: its flags, its outputs and how it reports.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include <crashsim/crashsim.hpp>

#include "options.hpp"

namespace crashsim::cli {

inline constexpr int kDone = 0;
inline constexpr int kUserCanFix = 2;
inline constexpr int kNumbersFailed = 3;
inline constexpr int kMachineFailed = 4;

/// An options struct with its flags.
template <class S>
struct Bound {
  Flags<S> flags;
  S values;
};

class Command {
 public:
  /// @param example a command that works on the data of this project.
  Command(CLI::App& parent, const std::string& name, const std::string& what, const std::string& example);
  virtual ~Command() = default;
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;

  /// Does the work. @returns the exit code.
  virtual int run() = 0;

  [[nodiscard]] const CLI::App& app() const { return app_; }
  [[nodiscard]] CLI::App& app() { return app_; }

 protected:
  /// `-o FILE`, and the flag that lets it replace a file: --overwrite, also spelled --force where that is nothing else;
  /// none when it is "".
  void add_output(const std::string& type_name, const std::string& what,
                  const std::string& overwrite = "--overwrite,--force");
  /// `--json`, `--quiet` and `--config`.
  void add_reporting();

  /// Fills options: from the configuration file first, then from the command line. Also checks the outputs asked for.
  template <class... S>
  void resolve(Bound<S>&... bound) {
    for (const ConfigEntry& entry : config_entries()) {
      if (set_shared(entry) || (... || bound.flags.set_from_config(bound.values, entry))) continue;
      std::vector<std::string_view> known = shared_keys();
      [[maybe_unused]] const auto append = [&](const auto& names) {
        known.insert(known.end(), names.begin(), names.end());
      };
      (append(bound.flags.names()), ...);
      detail::throw_unknown_name(entry.where, entry.key, known);
    }
    (bound.flags.set_from_command_line(bound.values), ...);
  }

  /// Refuses, before any work is done, an output that exists, is an input, or is missing while nothing else is asked;
  /// again when reading has told of further inputs (the channel files of a header).
  void check_output(const std::vector<std::string>& inputs) const;
  /// Refuses to write a folder, a file that exists (without --overwrite), one of the inputs or the configuration.
  void check_writable(const std::string& path, const std::vector<std::string>& inputs) const;
  /// Writes the output, if one was asked for.
  void write(const std::string& text) const;

  /// A line of the summary on stderr, unless --quiet.
  void say(const std::string& line) const;
  /// Names, values and units of a summary, one a line.
  void say(const Summary& summary) const;
  /// The same of two summaries with the same names, side by side under two headings.
  void say(const Summary& left, const Summary& right, const std::string& left_name,
           const std::string& right_name) const;
  void warn(const std::vector<std::string>& warnings) const;
  /// JSON on stdout, with --json.
  void print_json(const std::string& json) const;

  /// Every option of several structs, for the record.
  template <class... S>
  static std::vector<ConfigEntry> options_of(const S&... values) {
    std::vector<ConfigEntry> all;
    const auto append = [&all](const std::vector<ConfigEntry>& entries) {
      all.insert(all.end(), entries.begin(), entries.end());
    };
    (append(entries_of(values, "")), ...);
    return all;
  }

  [[nodiscard]] Record record(std::vector<std::string> arguments, std::vector<ConfigEntry> options,
                              const std::vector<std::string>& inputs) const;
  [[nodiscard]] bool quiet() const { return quiet_; }
  [[nodiscard]] bool json() const { return json_; }
  [[nodiscard]] bool overwrite() const { return overwrite_; }
  [[nodiscard]] const std::string& output() const { return output_; }

 private:
  [[nodiscard]] std::vector<ConfigEntry> config_entries() const;
  /// Keys of the flags that this subcommand shares with others.
  [[nodiscard]] std::vector<std::string_view> shared_keys() const;
  /// Sets one of them; false when the key is none.
  bool set_shared(const ConfigEntry& entry);

  CLI::App& app_;
  std::string output_, config_;
  bool overwrite_ = false, json_ = false, quiet_ = false;
};

/// Runs the program on its arguments (without the program's name). @returns the exit code.
int run_program(const std::vector<std::string>& arguments);

std::unique_ptr<Command> make_info(CLI::App& app);
std::unique_ptr<Command> make_pulse(CLI::App& app);
std::unique_ptr<Command> make_identify(CLI::App& app);
std::unique_ptr<Command> make_identify_pitch(CLI::App& app);
std::unique_ptr<Command> make_identify_vertical(CLI::App& app);
std::unique_ptr<Command> make_correct(CLI::App& app);
std::unique_ptr<Command> make_wall(CLI::App& app);
std::unique_ptr<Command> make_simulate(CLI::App& app);
std::unique_ptr<Command> make_predict(CLI::App& app);
std::unique_ptr<Command> make_pitch(CLI::App& app);
std::unique_ptr<Command> make_compare(CLI::App& app);
std::unique_ptr<Command> make_run(CLI::App& app);
std::unique_ptr<Command> make_batch(CLI::App& app);
std::unique_ptr<Command> make_merge(CLI::App& app);
std::unique_ptr<Command> make_design(CLI::App& app);
std::unique_ptr<Command> make_export(CLI::App& app);
std::unique_ptr<Command> make_select(CLI::App& app);
std::unique_ptr<Command> make_schema(CLI::App& app);

}  // namespace crashsim::cli
