/// crashsim correct: accelerometers made to agree with each other and with what is known otherwise.

#include <array>

#include <fmt/format.h>

#include "command.hpp"

namespace crashsim {
namespace cli {

struct WallFileOptions {
  std::string wall;
};
constexpr std::array<Field<WallFileOptions>, 1> kWallFileFields = {{
    {"wall", "wall", "", "load-cell wall of the same test, as `crashsim wall` reads or writes it",
     &WallFileOptions::wall},
}};

}  // namespace cli

template <>
constexpr std::span<const Field<cli::WallFileOptions>> fields<cli::WallFileOptions>{cli::kWallFileFields};

namespace cli {
namespace {

/// "1.012 +- 0.004", "-" when not corrected.
std::string with_error(double value, double error, double factor, int decimals) {
  if (std::isnan(value)) return "-";
  return fmt::format("{:.{}f} +- {:.{}f}", factor * value, decimals, factor * error, decimals);
}

class CorrectCommand : public Command {
 public:
  explicit CorrectCommand(CLI::App& parent)
      : Command(parent, "correct",
                "Correct accelerometers so that they agree with each other, with speed and with the wall",
                "crashsim correct data/sensors/channels.csv --channel '*' --rebound -1.4m/s -o corrected.csv\n"
                "  crashsim pulse corrected.csv -o pulse.csv\n"
                "  crashsim correct data/sensors/channels.csv --channel '*' --json") {
    app().add_option("file", file_, "trace with the accelerometers of the compartment")->required()->type_name("FILE");
    pulse_.flags.add_to(app(), "Channels");
    options_.flags.add_to(app(), "Corrections");
    wall_.flags.add_to(app(), "Corrections");
    add_output("FILE", "corrected.csv to write, - for standard output");
    add_reporting();
  }

  int run() override {
    resolve(pulse_, options_, wall_);
    check_output({file_, wall_.values.wall});
    const SensorCorrection correction = correct();
    std::vector<std::string> inputs = correction.input_files;
    check_output(inputs);
    write(format_correction(correction,
                            record({file_}, options_of(pulse_.values, options_.values, wall_.values), inputs)));
    report(correction);
    print_json(format_summary(correction));
    return correction.usable() ? kDone : kNumbersFailed;
  }

 private:
  SensorCorrection correct() const {
    if (wall_.values.wall.empty()) return read_sensor_correction(file_, pulse_.values, options_.values);
    WallOptions of_wall;
    of_wall.cell_height_m = 1.0;  // heights do not matter here, and nobody need tell them
    if (pulse_.values.t0.rule != TimeZero::trace) of_wall.time_zero_s = read_pulse(file_, pulse_.values).time_zero_s;
    const LoadCellWall wall = read_wall(wall_.values.wall, of_wall);
    SensorCorrection correction = read_sensor_correction(file_, pulse_.values, options_.values, &wall);
    correction.input_files.insert(correction.input_files.end(), wall.input_files.begin(), wall.input_files.end());
    correction.warnings.insert(correction.warnings.end(), wall.warnings.begin(), wall.warnings.end());
    return correction;
  }

  void report(const SensorCorrection& correction) const {
    say(fmt::format("correction of {}: {}", file_, name_of(correction.outcome)));
    if (!correction.message.empty()) say("  " + correction.message);
    for (const std::string& step : correction.steps) say("  " + step);
    if (correction.usable()) report_numbers(correction);
    warn(correction.warnings);
  }

  void report_numbers(const SensorCorrection& correction) const {
    say(summarize(correction));
    say(fmt::format("  {:<32} {:>16} {:>18} {:>18} {:>16}", "channel", "bias m/s^2", "gain", "time shift ms",
                    "to mean m/s^2"));
    for (const ChannelCorrection& c : correction.channels)
      say(fmt::format("  {:<32} {:>16} {:>18} {:>18} {:>16}", c.channel,
                      with_error(c.bias_mps2, c.bias_error_mps2, 1.0, 2), with_error(c.gain, c.gain_error, 1.0, 4),
                      with_error(c.time_shift_s, c.time_shift_error_s, 1e3, 3),
                      fmt::format("{:.3g} -> {:.3g}", c.rms_before_mps2, c.rms_after_mps2)));
    for (const CorrectionCondition& c : correction.conditions)
      say(fmt::format("  {}: known {:.4g} +- {:.2g} m/s, channels {:.4g} -> {:.4g} m/s", c.name, c.known_mps,
                      c.standard_deviation_mps, c.before_mps, c.after_mps));
    for (const std::string& share : correction.by_prior) say("  by the prior: " + share);
  }

  std::string file_;
  Bound<PulseOptions> pulse_;
  Bound<SensorCorrectionOptions> options_;
  Bound<WallFileOptions> wall_;
};

}  // namespace

std::unique_ptr<Command> make_correct(CLI::App& app) { return std::make_unique<CorrectCommand>(app); }

}  // namespace cli
}  // namespace crashsim
