/// crashsim compare: curves of a model against those of a test.

#include <fmt/format.h>

#include "command.hpp"
#include "comparison_table.hpp"

namespace crashsim::cli {
namespace {

class CompareCommand : public Command {
 public:
  explicit CompareCommand(CLI::App& parent)
      : Command(parent, "compare", "Compare two files of curves: errors and ISO/TS 18571 ratings",
                "crashsim run data/fe-car/case.toml -o fe-car\n"
                "  crashsim compare fe-car/pulse.csv fe-car/response.csv --end 90ms -o rating.json") {
    app().add_option("reference", reference_, "the test: pulse.csv or any CSV")->required()->type_name("A");
    app().add_option("candidate", candidate_, "the model: response.csv or any CSV")->required()->type_name("B");
    options_.flags.add_to(app(), "Options");
    add_output("FILE", "rating.json to write, - for standard output");
    add_reporting();
  }

  int run() override {
    resolve(options_);
    if (!output().empty()) check_output({reference_, candidate_});
    const TraceSet reference = read_traces(reference_), candidate = read_traces(candidate_);
    std::vector<std::string> inputs = reference.input_files;
    inputs.insert(inputs.end(), candidate.input_files.begin(), candidate.input_files.end());
    if (!output().empty()) check_output(inputs);
    const Comparison comparison = crashsim::compare(reference, candidate, options_.values);
    const std::string text =
        format_comparison(comparison, record({reference_, candidate_}, entries_of(options_.values, ""), inputs));
    write(text);
    say(fmt::format("{} against {}", candidate_, reference_));
    for (const std::string& line : table_of(comparison)) say(line);
    for (const std::string& note : comparison.notes) say("  note: " + note);
    print_json(text);
    return kDone;
  }

 private:
  std::string reference_, candidate_;
  Bound<CompareOptions> options_;
};

}  // namespace

std::unique_ptr<Command> make_compare(CLI::App& app) { return std::make_unique<CompareCommand>(app); }

}  // namespace crashsim::cli
