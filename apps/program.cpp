/// The program: subcommands, errors and exit codes.

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>

#include <fmt/format.h>

#include "command.hpp"

namespace crashsim::cli {
namespace {

int complain(const std::string& what, int exit_code) {
  constexpr std::size_t kLongest = 4000;
  const std::string message = shortened(what, kLongest);
  std::fputs(("crashsim: " + message + "\n").c_str(), stderr);  // never throws, whatever stderr is
  return exit_code;
}

std::vector<std::unique_ptr<Command>> make_commands(CLI::App& app) {
  std::vector<std::unique_ptr<Command>> commands;
  for (const auto make : {make_info, make_pulse, make_correct, make_wall, make_identify, make_simulate, make_predict,
                          make_pitch, make_identify_pitch, make_identify_vertical, make_select, make_compare, make_run,
                          make_batch, make_merge, make_design, make_export, make_schema})
    commands.push_back(make(app));
  return commands;
}

/// Names of flags or subcommands that an unknown argument may have meant.
std::string unknown_argument(const CLI::App& app, const std::string& argument) {
  std::vector<std::string> spellings;
  std::string kind = "argument", where;
  if (app.get_subcommands().empty() && !argument.starts_with('-')) {
    kind = "subcommand";
    for (const CLI::App* command : app.get_subcommands(nullptr)) spellings.push_back(command->get_name());
  } else {
    const CLI::App& scope = app.get_subcommands().empty() ? app : *app.get_subcommands().front();
    if (&scope != &app) where = scope.get_name();
    if (argument.starts_with('-')) kind = "option";
    for (const CLI::Option* option : scope.get_options())
      for (const std::string& name : option->get_lnames()) spellings.push_back("--" + name);
  }
  const std::string name = argument.substr(0, argument.find('='));
  const std::string_view nearest = nearest_name(name, {spellings.begin(), spellings.end()});
  const std::string hint = nearest.empty() ? "" : fmt::format(", did you mean '{}'?", nearest);
  return fmt::format("{}unknown {} '{}'{} (see crashsim {}{}--help)", where.empty() ? "" : where + ": ", kind, name,
                     hint, where, where.empty() ? "" : " ");
}

/// What the parser says, put in our words where it is hard to read: "--cfc: 1 required Hz missing".
std::string words_of(const CLI::ParseError& error) {
  const std::string text = error.what();
  const bool lacks_value = dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr && text.ends_with(" missing");
  return lacks_value ? text.substr(0, text.find(':')) + ": needs a value" : text;
}

int usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* scope = app.get_subcommands().empty() ? &app : app.get_subcommands().front();
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    const std::vector<std::string> rest = app.remaining(true);
    if (!rest.empty()) return complain(unknown_argument(app, rest.front()), kUserCanFix);
  }
  const std::string where = scope == &app ? "" : scope->get_name() + ": ";
  return complain(fmt::format("{}{} (see crashsim {}{}--help)", where, words_of(error),
                              scope == &app ? "" : scope->get_name(), scope == &app ? "" : " "),
                  kUserCanFix);
}

int run_command(const std::vector<std::unique_ptr<Command>>& commands) {
  const auto chosen =
      std::find_if(commands.begin(), commands.end(), [](const auto& command) { return command->app().parsed(); });
  return (*chosen)->run();
}

}  // namespace

int run_program(const std::vector<std::string>& arguments) {
  CLI::App app("From a crash trace to an identified, simulated and judged lumped-parameter model.", "crashsim");
  app.set_version_flag("--version", std::string("crashsim ") + kVersion);
  app.require_subcommand(0, 1);
  app.footer("crashsim COMMAND --help tells more.\nExample:\n  crashsim run data/fe-car/case.toml -o fe-car");
  const auto commands = make_commands(app);
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    if (!app.get_subcommands().empty()) return run_command(commands);
    fmt::print(stderr, "{}", app.help());
    return kUserCanFix;
  } catch (const CLI::Success& asked) {
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    return usage_error(app, error);
  } catch (const InvalidInput& error) {
    return complain(error.what(), kUserCanFix);
  } catch (const NumericalFailure& error) {
    return complain(error.what(), kNumbersFailed);
  } catch (const std::bad_alloc&) {
    return complain("out of memory", kMachineFailed);
  } catch (const std::exception& error) {
    return complain(error.what(), kMachineFailed);
  }
}

}  // namespace crashsim::cli
