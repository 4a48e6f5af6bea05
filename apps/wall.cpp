/// crashsim wall: the force on a load-cell wall, by rows of cells.

#include <array>

#include <fmt/format.h>

#include "command.hpp"

namespace crashsim {
namespace cli {

struct MotionOptions {
  std::string pulse;
};
constexpr std::array<Field<MotionOptions>, 1> kMotionFields = {{
    {"pulse", "pulse", "", "pulse.csv or trace of the same test, for AHOF400, KW400 and the change of momentum",
     &MotionOptions::pulse},
}};

}  // namespace cli

template <>
constexpr std::span<const Field<cli::MotionOptions>> fields<cli::MotionOptions>{cli::kMotionFields};

namespace cli {
namespace {

class WallCommand : public Command {
 public:
  explicit WallCommand(CLI::App& parent)
      : Command(parent, "wall", "Add up the cells of a load-cell wall: force, its height, rows",
                "crashsim wall data/wall/rows.csv --cell-height 0.25m -o wall.csv") {
    app()
        .add_option("file", file_, "trace with load cells (NHTSA EV5), or a table of row sums (row_a_n, ...)")
        ->required()
        ->type_name("FILE");
    options_.flags.add_to(app(), "Options");
    motion_.flags.add_to(app(), "Motion of the vehicle");
    add_output("FILE", "wall.csv to write, - for standard output");
    add_reporting();
  }

  int run() override {
    resolve(options_, motion_);
    const std::string& pulse_path = motion_.values.pulse;
    check_output({file_, pulse_path});
    const LoadCellWall wall = read_wall(file_, options_.values);
    std::vector<std::string> inputs = wall.input_files, warnings = wall.warnings;
    WallNumbers numbers;
    if (pulse_path.empty()) {
      numbers = wall_numbers(wall);
    } else {
      const Pulse pulse = read_pulse(pulse_path);
      inputs.insert(inputs.end(), pulse.input_files.begin(), pulse.input_files.end());
      numbers = wall_numbers(wall, &pulse);
    }
    for (const std::string& warning : check_momentum(numbers)) warnings.push_back(warning);
    check_output(inputs);
    write(format_wall(wall, record({file_}, options_of(options_.values, motion_.values), inputs)));
    report(wall, summarize(wall, numbers), warnings);
    return kDone;
  }

 private:
  void report(const LoadCellWall& wall, const Summary& summary, const std::vector<std::string>& warnings) const {
    say(fmt::format("load-cell wall of {}", file_));
    for (const std::string& step : wall.steps) say("  " + step);
    say(summary);
    warn(warnings);
    print_json(format_summary(summary));
  }

  std::string file_;
  Bound<WallOptions> options_;
  Bound<MotionOptions> motion_;
};

}  // namespace

std::unique_ptr<Command> make_wall(CLI::App& app) { return std::make_unique<WallCommand>(app); }

}  // namespace cli
}  // namespace crashsim
