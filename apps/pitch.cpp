/// crashsim pitch: heave and pitch of a vehicle under the barrier's force.

#include <fmt/format.h>

#include "command.hpp"

namespace crashsim::cli {
namespace {

class PitchCommand : public Command {
 public:
  explicit PitchCommand(CLI::App& parent)
      : Command(parent, "pitch", "Simulate heave and pitch under the barrier's force",
                "crashsim pitch data/paper/table1.json --mass 2582kg --force data/fe-car/C56.csv "
                "--channel barrier_impulse_FTZ --velocity LEFT_REAR_VX --force-arm 1.7m -o pitch.csv") {
    app()
        .add_option("vehicle", file_, "vehicle.json, or a TOML file with a [vehicle]")
        ->required()
        ->type_name("VEHICLE");
    forcing_.flags.add_to(app(), "Force");
    options_.flags.add_to(app(), "Motion");
    vehicle_.flags.add_to(app(), "Vehicle: instead of what its file says");
    add_output("FILE", "pitch.csv to write, - for standard output", "--overwrite");
    add_reporting();
  }

  int run() override {
    vehicle_.values = read_vehicle(file_);
    resolve(forcing_, options_, vehicle_);
    if (forcing_.values.file.empty())
      throw InvalidInput("pitch: --force is required: the trace with the barrier's force");
    check_output({file_, forcing_.values.file});
    const MeasuredForcing measured = read_forcing(forcing_.values);
    std::vector<std::string> inputs = {file_};
    inputs.insert(inputs.end(), measured.input_files.begin(), measured.input_files.end());
    check_output(inputs);
    const PitchResponse response = simulate_pitch(vehicle_.values, measured.forcing, options_.values);
    write(
        format_pitch(response, record({file_}, options_of(forcing_.values, options_.values, vehicle_.values), inputs)));
    say(fmt::format("heave and pitch of {}: {}", file_, response.brief_report()));
    for (const std::string& step : measured.steps) say("  " + step);
    warn(measured.warnings);
    for (const std::string& note : response.notes) say("  note: " + note);
    const Summary summary = summarize(response);
    say(summary);
    for (const Mode& mode : response.modes)
      say(fmt::format("  free motion: {:.4g} Hz, damping ratio {:.3g}", mode.frequency_hz, mode.damping_ratio));
    print_json(format_summary(summary));
    return response.usable() ? kDone : kNumbersFailed;
  }

 private:
  std::string file_;
  Bound<ForcingOptions> forcing_;
  Bound<PitchOptions> options_;
  Bound<HeavePitchModel> vehicle_;
};

}  // namespace

std::unique_ptr<Command> make_pitch(CLI::App& app) { return std::make_unique<PitchCommand>(app); }

}  // namespace crashsim::cli
