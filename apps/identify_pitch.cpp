/// crashsim identify-pitch: numbers of a vehicle on its axles from its measured heave and pitch.

#include <algorithm>

#include <fmt/format.h>

#include "command.hpp"
#include "interrupt.hpp"
#include "named_fit.hpp"
#include "progress.hpp"

namespace crashsim::cli {
namespace {

class IdentifyPitchCommand : public Command {
 public:
  explicit IdentifyPitchCommand(CLI::App& parent)
      : Command(parent, "identify-pitch", "Identify numbers of a vehicle on its axles from measured heave and pitch",
                "crashsim identify-pitch data/paper/table1.json --mass 1190kg --pitch-inertia 1876 --cg-height 504mm "
                "--force data/fe-car/C56.csv --longitudinal barrier_impulse_FNX --start impact "
                "--motion data/fe-car/C56.csv --front LEFT_MID_DZ --front-position=-2.286 --rear LEFT_REAR_DZ "
                "--rear-position=-3.1327 --cg-position=-2.486 --free force-height --starts 5 -o vehicle.json") {
    app()
        .add_option("vehicle", file_, "vehicle.json, or a TOML file with a [vehicle]: the first guess")
        ->required()
        ->type_name("VEHICLE");
    forcing_.flags.add_to(app(), "Force");
    motion_.flags.add_to(app(), "Measured motion");
    options_.flags.add_to(app(), "Identification");
    simulation_.flags.add_to(app(), "Motion");
    vehicle_.flags.add_to(app(), "Vehicle: instead of what its file says");
    add_output("FILE", "vehicle.json to write, - for standard output", "--overwrite");
    add_reporting();
  }

  int run() override {
    vehicle_.values = read_vehicle(file_);
    resolve(forcing_, motion_, options_, simulation_, vehicle_);
    split_free(options_.values);
    require_files();
    check_output({file_, forcing_.values.file, motion_.values.file});
    const MeasuredForcing forces = read_forcing(forcing_.values);
    const MeasuredMotion motion = read_motion(motion_.values);
    std::vector<std::string> inputs = {file_};
    for (const auto& read : {forces.input_files, motion.input_files})
      for (const std::string& input : read)
        if (std::ranges::find(inputs, input) == inputs.end()) inputs.push_back(input);
    check_output(inputs);
    const PitchIdentification fit = identify_watched(forces.forcing, motion);
    if (!fit.parameters.empty()) {
      const Record made_by = record(
          {file_}, options_of(forcing_.values, motion_.values, options_.values, simulation_.values, vehicle_.values),
          inputs);
      write(format_vehicle(fit.model, &fit, &made_by));
    }
    report(fit, forces, motion);
    if (fit.outcome == IdentifyOutcome::interrupted) return kInterruptedExit;
    return fit.usable() ? kDone : kNumbersFailed;
  }

 private:
  void require_files() const {
    if (forcing_.values.file.empty())
      throw InvalidInput("identify-pitch: --force is required: the trace with the barrier's force");
    if (motion_.values.file.empty())
      throw InvalidInput("identify-pitch: --motion is required: the trace with the body's vertical motion");
  }

  PitchIdentification identify_watched(const PitchForcing& forcing, const MeasuredMotion& motion) const {
    const PitchTarget target{motion.heave_m, motion.pitch_rad, motion.heave_velocity_mps, motion.pitch_rate_radps};
    return watch_starts(quiet(), [&](const Progress& progress) {
      return identify_pitch(vehicle_.values, forcing, target, simulation_.values, options_.values, progress);
    });
  }

  void report(const PitchIdentification& fit, const MeasuredForcing& forces, const MeasuredMotion& motion) const {
    const Summary summary = summarize(fit);
    say(fmt::format("identification of {} from {}: {}", file_, motion_.values.file, name_of(fit.outcome)));
    for (const std::string& step : forces.steps) say("  " + step);
    warn(forces.warnings);
    if (motion_.values.file != forcing_.values.file) warn(motion.warnings);
    if (!fit.message.empty()) say("  " + fit.message);
    if (!fit.parameters.empty()) {
      say(without_numbers(summary, fit.parameters));
      for (const std::string& line : table_of(fit.parameters)) say(line);
    }
    warn(fit.warnings);
    print_json(format_summary(summary));
  }

  std::string file_;
  Bound<ForcingOptions> forcing_;
  Bound<MotionOptions> motion_;
  Bound<IdentifyPitchOptions> options_;
  Bound<PitchOptions> simulation_;
  Bound<HeavePitchModel> vehicle_;
};

}  // namespace

std::unique_ptr<Command> make_identify_pitch(CLI::App& app) { return std::make_unique<IdentifyPitchCommand>(app); }

}  // namespace crashsim::cli
