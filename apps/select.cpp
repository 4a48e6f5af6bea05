/// crashsim select: which crush model predicts best.

#include <cmath>

#include <fmt/format.h>

#include "command.hpp"
#include "interrupt.hpp"
#include "progress.hpp"

namespace crashsim::cli {
namespace {

std::string percent(double fraction) {
  if (std::isnan(fraction)) return "-";
  return std::isinf(fraction) ? "no t_m" : fmt::format("{:+.1f} %", 100.0 * fraction);
}

std::string cell(double value, int decimals) {
  if (std::isnan(value)) return "-";
  return std::isinf(value) ? "inf" : fmt::format("{:.{}f}", value, decimals);
}

class SelectCommand : public Command {
 public:
  explicit SelectCommand(CLI::App& parent)
      : Command(parent, "select",
                "Compare crush models by AICc and by how each predicts the tests that it was not fitted to",
                "crashsim pulse data/fe-car/C40.csv --channel LEFT_REAR_VX --channel RIGHT_REAR_VX -o c40.csv\n"
                "  crashsim pulse data/fe-car/C56.csv --channel LEFT_REAR_VX --channel RIGHT_REAR_VX -o c56.csv\n"
                "  crashsim select c40.csv c56.csv --method equation-error -o selection.csv") {
    app()
        .add_option("pulse", files_, "pulse.csv, or any trace that `pulse` reads without options; one a test")
        ->required()
        ->type_name("PULSE");
    options_.flags.add_to(app(), "Options");
    add_output("FILE", "selection.csv or selection.json to write, - for standard output (CSV)");
    add_reporting();
  }

  int run() override {
    resolve(options_);
    check_output(files_);
    std::vector<Pulse> pulses;
    std::vector<std::string> inputs;
    for (const std::string& file : files_) {
      PulseOptions read;
      read.mass_kg = options_.values.mass_kg;
      pulses.push_back(read_pulse(file, read));
      inputs.insert(inputs.end(), pulses.back().input_files.begin(), pulses.back().input_files.end());
    }
    check_output(inputs);
    const Selection selection = watch(
        "fits", quiet(), [&](const Progress& progress) { return select_model(pulses, options_.values, progress); });
    const Record made_by = record(files_, entries_of(options_.values, ""), inputs);
    const std::string json_text = format_selection_json(selection, made_by);
    if (!selection.rows.empty())
      write(output().ends_with(".json") ? json_text : format_selection_csv(selection, made_by));
    report(selection);
    print_json(json_text);
    if (selection.outcome == SelectOutcome::interrupted) return kInterruptedExit;
    return selection.usable() ? kDone : kNumbersFailed;
  }

 private:
  void report(const Selection& selection) const {
    say(fmt::format("selection from {}: {}", fmt::join(files_, ", "), name_of(selection.outcome)));
    if (!selection.message.empty()) say("  " + selection.message);
    if (selection.rows.empty()) return;
    say(heading(selection));
    for (const SelectionRow& row : selection.rows) say(line_of(row));
    say(fmt::format("  {:.0f} effective observations; * recommended, ~ as good as the best", selection.observations));
    if (selection.usable()) say("recommended: " + selection.recommendation);
  }

  /// Tests left out by their speed, each with the errors of maximum crush and of t_m.
  static std::string heading(const Selection& selection) {
    std::string line = fmt::format("  {:<26} {:>3} {:>7} {:>6} {:>6} {:>6} {:>8} {:>6} {:>8}", "", "par", "E", "accel",
                                   "vel", "displ", "AICc", "weight", "score");
    for (const LeftOutTest& test : selection.rows.front().left_out)
      line += fmt::format(" {:>17}", fmt::format("C, t_m {:.4g} m/s", test.impact_speed_mps));
    return line;
  }

  static std::string line_of(const SelectionRow& row) {
    std::string line = fmt::format("{} {:<26}", row.recommended ? '*' : row.as_good_as_best ? '~' : ' ', row.name);
    if (row.outcome != IdentifyOutcome::completed)
      return fmt::format("{} {}: {}", line, name_of(row.outcome), row.message);
    line += fmt::format(" {:>3} {:>7} {:>6} {:>6} {:>6} {:>8} {:>6} {:>8}", row.parameters, cell(row.error.total, 4),
                        cell(row.error.accel, 3), cell(row.error.velocity, 3), cell(row.error.displacement, 3),
                        cell(row.aicc, 1), cell(row.aicc_weight, 2), cell(row.prediction_error, 3));
    for (const LeftOutTest& test : row.left_out)
      line += fmt::format(" {:>8} {:>8}", test.predicted ? percent(test.max_crush_error) : "failed",
                          percent(test.t_m_error));
    return line;
  }

  std::vector<std::string> files_;
  Bound<SelectOptions> options_;
};

}  // namespace

std::unique_ptr<Command> make_select(CLI::App& app) { return std::make_unique<SelectCommand>(app); }

}  // namespace crashsim::cli
