/// crashsim simulate: the motion of a crush model.

#include <fmt/format.h>

#include "command.hpp"

namespace crashsim::cli {
namespace {

class SimulateCommand : public Command {
 public:
  explicit SimulateCommand(CLI::App& parent)
      : Command(parent, "simulate", "Simulate the crush of a model",
                "crashsim simulate data/neon-kw400/model.json --speed 56km/h -o response.csv") {
    app().add_option("model", file_, "model.json")->required()->type_name("MODEL");
    options_.flags.add_to(app(), "Options");
    add_output("FILE", "response.csv to write, - for standard output");
    add_reporting();
  }

  int run() override {
    resolve(options_);
    check_output({file_});
    const CrushModel model = read_model(file_);
    const CrushResponse response = simulate(model, options_.values);
    const Summary summary = summarize(response, model.mass_kg);
    write(format_response(response, model.mass_kg, record({file_}, entries_of(options_.values, ""), {file_})));
    say(fmt::format("simulation of {}: {}", file_, response.brief_report()));
    say(summary);
    print_json(format_summary(summary));
    return response.usable() ? kDone : kNumbersFailed;
  }

 private:
  std::string file_;
  Bound<SimulateOptions> options_;
};

}  // namespace

std::unique_ptr<Command> make_simulate(CLI::App& app) { return std::make_unique<SimulateCommand>(app); }

}  // namespace crashsim::cli
