/// crashsim identify: a crush model from pulses.

#include <fmt/format.h>

#include "command.hpp"
#include "interrupt.hpp"
#include "progress.hpp"

namespace crashsim::cli {
namespace {

class IdentifyCommand : public Command {
 public:
  explicit IdentifyCommand(CLI::App& parent)
      : Command(parent, "identify", "Identify spring and damper from one pulse or several of the same structure",
                "crashsim pulse data/fe-car/C56.csv --channel LEFT_REAR_VX --channel RIGHT_REAR_VX -o pulse.csv\n"
                "  crashsim identify pulse.csv -o model.json") {
    app()
        .add_option("pulse", files_, "pulse.csv, or any trace that `pulse` reads without options")
        ->required()
        ->type_name("PULSE");
    options_.flags.add_to(app(), "Options");
    add_output("FILE", "model.json to write, - for standard output");
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
    const Identification fit = identify_watched(pulses);
    const Summary summary = summarize(fit);
    if (!fit.ordinates.empty()) {
      const Record made_by = record(files_, entries_of(options_.values, ""), inputs);
      write(format_model(fit.model, &fit, &made_by));
    }
    report(fit, summary);
    if (fit.outcome == IdentifyOutcome::interrupted) return kInterruptedExit;
    return fit.usable() ? kDone : kNumbersFailed;
  }

 private:
  Identification identify_watched(const std::vector<Pulse>& pulses) const {
    return watch_starts(quiet(), [&](const Progress& progress) { return identify(pulses, options_.values, progress); });
  }

  void report(const Identification& fit, const Summary& summary) const {
    say(fmt::format("identification from {}: {}", fmt::join(files_, ", "), name_of(fit.outcome)));
    if (!fit.message.empty()) say("  " + fit.message);
    if (!fit.ordinates.empty()) {
      say(summary);
      say(fmt::format("  {:<4} {:>14} {:>14} {:>14}", "", "value", "std. error", "upper bound"));
      for (const OrdinateReport& o : fit.ordinates)
        say(fmt::format("  {:<4} {:>14.6g} {:>14} {:>14.4g}{}{}", o.name, o.value,
                        std::isnan(o.standard_error) ? "-" : fmt::format("{:.3g}", o.standard_error), o.upper_bound,
                        o.at_bound ? "  at bound" : "", o.untouched ? "  no sample depends on it" : ""));
    }
    warn(fit.warnings);
    print_json(format_summary(summary));
  }

  std::vector<std::string> files_;
  Bound<IdentifyOptions> options_;
};

}  // namespace

std::unique_ptr<Command> make_identify(CLI::App& app) { return std::make_unique<IdentifyCommand>(app); }

}  // namespace crashsim::cli
