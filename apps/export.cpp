/// crashsim export: a model for other programs.

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command.hpp"

namespace crashsim::cli {
namespace {

class ExportCommand : public Command {
 public:
  explicit ExportCommand(CLI::App& parent)
      : Command(
            parent, "export",
            "Write a crush model for LS-DYNA or OpenRadioss (an include file with curves, spring and damper), or as "
            "a table. The table has x, k, F(x) and v, c, F(v) in columns, in SI; the shorter columns end in empty "
            "cells",
            "crashsim export data/syn-a/model.json --to lsdyna --units t-mm-s -o syn-a.k") {
    app().add_option("model", file_, "model.json")->required()->type_name("MODEL");
    options_.flags.add_to(app(), "Options");
    add_output("FILE", "file to write, - for standard output");
    add_reporting();
  }

  int run() override {
    resolve(options_);
    check_output({file_});
    const Exported exported =
        export_model(read_model(file_), options_.values, record({file_}, entries_of(options_.values, ""), {file_}));
    write(exported.text);
    say(fmt::format("{} for {}", file_, options_.values.to));
    for (const std::string& note : exported.notes) say("  note: " + note);
    print_json(nlohmann::ordered_json({{"to", options_.values.to}, {"notes", exported.notes}}).dump(2) + "\n");
    return kDone;
  }

 private:
  std::string file_;
  Bound<ExportOptions> options_;
};

}  // namespace

std::unique_ptr<Command> make_export(CLI::App& app) { return std::make_unique<ExportCommand>(app); }

}  // namespace crashsim::cli
