/// crashsim pulse: a trace file becomes a crash pulse.

#include <fmt/format.h>

#include "command.hpp"

namespace crashsim::cli {
namespace {

class PulseCommand : public Command {
 public:
  explicit PulseCommand(CLI::App& parent)
      : Command(parent, "pulse", "Make a crash pulse of a trace: filtered, integrated, from impact on",
                "crashsim pulse data/fe-car/C56.csv --channel LEFT_REAR_VX --channel RIGHT_REAR_VX -o pulse.csv") {
    app().add_option("file", file_, "trace: NHTSA EV5, OpenRadioss CSV, any CSV")->required()->type_name("FILE");
    options_.flags.add_to(app(), "Options");
    add_output("FILE", "pulse.csv to write, - for standard output");
    add_reporting();
  }

  int run() override {
    resolve(options_);
    check_output({file_});
    const Pulse pulse = read_pulse(file_, options_.values);
    check_output(pulse.input_files);
    const Summary summary = summarize(pulse);
    write(format_pulse(pulse, record({file_}, entries_of(options_.values, ""), pulse.input_files)));
    report(pulse, summary);
    return std::isnan(pulse.t_m_s) ? kNumbersFailed : kDone;
  }

 private:
  void report(const Pulse& pulse, const Summary& summary) const {
    say(fmt::format("pulse of {}", file_));
    for (const std::string& channel : pulse.channels) say("  channel " + channel);
    for (const std::string& step : pulse.steps) say("  " + step);
    say(summary);
    warn(pulse.warnings);
    print_json(format_summary(summary));
  }

  std::string file_;
  Bound<PulseOptions> options_;
};

}  // namespace

std::unique_ptr<Command> make_pulse(CLI::App& app) { return std::make_unique<PulseCommand>(app); }

}  // namespace crashsim::cli
