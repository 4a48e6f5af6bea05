/// crashsim compare: curves of a model against those of a test.

#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "command.hpp"
#include "comparison_table.hpp"

namespace crashsim {
namespace cli {

struct TableOptions {
  TableFormat format = TableFormat::plain;
};
constexpr std::array<Field<TableOptions>, 1> kTableFields = {{
    {"table", "table", "", "prints the tables to standard output, to be pasted into a report",
     choice<&TableOptions::format>()},
}};

}  // namespace cli

template <>
constexpr std::span<const Field<cli::TableOptions>> fields<cli::TableOptions>{cli::kTableFields};

namespace cli {
namespace {

class CompareCommand : public Command {
 public:
  explicit CompareCommand(CLI::App& parent)
      : Command(parent, "compare", "Compare two files of curves: errors, ISO/TS 18571 ratings, metrics side by side",
                "crashsim run data/fe-car/case.toml -o fe-car\n"
                "  crashsim compare fe-car/pulse.csv fe-car/response.csv --end 90ms -o rating.json") {
    app().add_option("reference", reference_, "the test: pulse.csv or any CSV")->required()->type_name("A");
    app().add_option("candidate", candidate_, "the model: response.csv or any CSV")->required()->type_name("B");
    options_.flags.add_to(app(), "Options");
    table_.flags.add_to(app(), "Options");
    add_output("FILE", "rating.json to write, - for standard output");
    add_reporting();
  }

  int run() override {
    resolve(options_, table_);
    const bool prints_table = app().count("--table") > 0;
    if (prints_table && (json() || output() == "-"))
      throw InvalidInput("--table and the JSON both write to standard output: choose one of them");
    if (!output().empty()) check_output({reference_, candidate_});
    const TraceSet reference = read_traces(reference_), candidate = read_traces(candidate_);
    std::vector<std::string> inputs = reference.input_files;
    inputs.insert(inputs.end(), candidate.input_files.begin(), candidate.input_files.end());
    if (!output().empty()) check_output(inputs);
    const Comparison comparison = crashsim::compare(reference, candidate, options_.values);
    std::vector<MetricComparison> metrics;
    if (options_.values.channels.empty()) metrics = compare_metrics(reference, candidate);
    const std::string text = format_comparison(
        comparison, metrics, record({reference_, candidate_}, entries_of(options_.values, ""), inputs));
    write(text);
    say(fmt::format("{} against {}", candidate_, reference_));
    if (prints_table)
      print_tables(comparison, metrics);
    else
      say_tables(comparison, metrics);
    for (const std::string& note : comparison.notes) say("  note: " + note);
    for (const TraceSet* set : {&reference, &candidate}) warn(check_motion(*set));
    print_json(text);
    return kDone;
  }

 private:
  void say_tables(const Comparison& comparison, const std::vector<MetricComparison>& metrics) const {
    for (const std::string& line : table_of(comparison)) say(line);
    for (const std::string& line : table_of(metrics)) say(line);
  }

  void print_tables(const Comparison& comparison, const std::vector<MetricComparison>& metrics) const {
    const TableFormat format = table_.values.format;
    std::string text = fmt::format("{}\n", fmt::join(table_of(comparison, format), "\n"));
    if (!metrics.empty()) text += fmt::format("\n{}\n", fmt::join(table_of(metrics, format), "\n"));
    write_output("-", text, false);
  }

  std::string reference_, candidate_;
  Bound<CompareOptions> options_;
  Bound<TableOptions> table_;
};

}  // namespace

std::unique_ptr<Command> make_compare(CLI::App& app) { return std::make_unique<CompareCommand>(app); }

}  // namespace cli
}  // namespace crashsim
