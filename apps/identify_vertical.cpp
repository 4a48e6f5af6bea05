/// crashsim identify-vertical: the law of the barrier's vertical force from measured forces and crush.

#include <fmt/format.h>

#include "command.hpp"
#include "interrupt.hpp"
#include "named_fit.hpp"
#include "progress.hpp"

namespace crashsim::cli {
namespace {

class IdentifyVerticalCommand : public Command {
 public:
  explicit IdentifyVerticalCommand(CLI::App& parent)
      : Command(parent, "identify-vertical", "Identify the law of the barrier's vertical force from forces and crush",
                "crashsim identify-vertical data/fe-car/C56.csv --channel barrier_impulse_FTZ "
                "--longitudinal barrier_impulse_FNX --crush LEFT_REAR_DX --crush RIGHT_REAR_DX "
                "--free angle,angle-rate -o law.json") {
    app().add_option("trace", file_, "trace with forces and crush")->required()->type_name("TRACE");
    forcing_.flags.add_to(app(), "Force", {"channel", "vertical-sign", "longitudinal", "cfc", "columns", "units"});
    crush_.flags.add_to(app(), "Crush");
    options_.flags.add_to(app(), "Identification");
    law_.flags.add_to(app(), "Law: what is not free, and where the first start begins");
    add_output("FILE", "law.json to write, - for standard output", "--overwrite");
    add_reporting();
  }

  int run() override {
    resolve(forcing_, crush_, options_, law_);
    split_free(options_.values);
    forcing_.values.file = file_;
    check_output({file_});
    const MeasuredVertical measured = read_vertical_target(forcing_.values, crush_.values);
    check_output(measured.input_files);
    const VerticalIdentification fit = identify_watched(measured.target);
    if (!fit.parameters.empty()) {
      const Record made_by = record({file_}, options(), measured.input_files);
      write(format_vertical_law(fit.law, &fit, &made_by));
    }
    report(fit, measured);
    if (fit.outcome == IdentifyOutcome::interrupted) return kInterruptedExit;
    return fit.usable() ? kDone : kNumbersFailed;
  }

 private:
  VerticalIdentification identify_watched(const VerticalForceTarget& target) const {
    return watch_starts(quiet(), [&](const Progress& progress) {
      return identify_vertical(target, law_.values, options_.values, progress);
    });
  }

  void report(const VerticalIdentification& fit, const MeasuredVertical& measured) const {
    const Summary summary = summarize(fit);
    say(fmt::format("law of the vertical force from {}: {}", file_, name_of(fit.outcome)));
    for (const std::string& step : measured.steps) say("  " + step);
    warn(measured.warnings);
    if (!fit.message.empty()) say("  " + fit.message);
    if (!fit.parameters.empty()) {
      say(without_numbers(summary, fit.parameters));
      for (const std::string& line : table_of(fit.parameters)) say(line);
    }
    warn(fit.warnings);
    print_json(format_summary(summary));
  }

  /// The trace is an argument, and what has no flag here is never set.
  [[nodiscard]] std::vector<ConfigEntry> options() const {
    ForcingOptions forces = forcing_.values;
    forces.file.clear();
    return options_of(forces, crush_.values, options_.values, law_.values);
  }

  std::string file_;
  Bound<ForcingOptions> forcing_;
  Bound<CrushChannelOptions> crush_;
  Bound<IdentifyVerticalOptions> options_;
  Bound<VerticalForceLaw> law_;
};

}  // namespace

std::unique_ptr<Command> make_identify_vertical(CLI::App& app) {
  return std::make_unique<IdentifyVerticalCommand>(app);
}

}  // namespace crashsim::cli
