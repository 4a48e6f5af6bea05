/// crashsim predict: what an identified model says of other speeds.

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "command.hpp"
#include "interrupt.hpp"

namespace crashsim::cli {
namespace {

/// Columns of the table on standard error.
struct ShownMetric {
  const char* heading;
  double Metrics::*member;
  double factor;
};
constexpr ShownMetric kShown[] = {{"t_m [ms]", &Metrics::t_m_s, 1e3},
                                  {"crush [mm]", &Metrics::max_crush_m, 1e3},
                                  {"OLC [g]", &Metrics::olc_g, 1.0},
                                  {"peak [g]", &Metrics::peak_decel_g, 1.0},
                                  {"energy [kJ]", &Metrics::energy_j, 1e-3}};
constexpr double kKmhPerMps = 3.6;

/// "612 (598..640)"; an end that does not exist is left open.
std::string cell(const PredictedSpeed& row, const ShownMetric& shown) {
  const auto number = [&](const Metrics& metrics) {
    const double value = metrics.*shown.member;
    return std::isnan(value) ? std::string() : fmt::format("{:.4g}", shown.factor * value);
  };
  const std::string value = number(row.value), low = number(row.low), high = number(row.high);
  const bool has_width = low != high;  // energy of a given speed and mass has none
  const std::string band = has_width ? fmt::format(" ({}..{})", low, high) : "";
  return (value.empty() ? "-" : value) + band;
}

class PredictCommand : public Command {
 public:
  explicit PredictCommand(CLI::App& parent)
      : Command(parent, "predict", "Predict other speeds from a model, with bands where it was identified here",
                "crashsim predict data/neon-kw400/model.json --speed 40km/h..72km/h:5 -o prediction.csv") {
    app().add_option("model", file_, "model.json")->required()->type_name("MODEL");
    options_.flags.add_to(app(), "Options", {"speed", "mass", "level", "end", "dt", "rtol", "jobs"});
    add_output("FILE", "prediction.csv to write, - for standard output");
    add_reporting();
  }

  int run() override {
    resolve(options_);
    check_output({file_});
    const PredictionBasis basis = read_prediction_basis(file_);
    const SpeedPrediction prediction = predict(basis, options_.values);
    write(format_prediction(prediction, record({file_}, entries_of(options_.values, ""), {file_})));
    report(prediction);
    return prediction.usable() ? kDone : kNumbersFailed;
  }

 private:
  void report(const SpeedPrediction& prediction) const {
    say(fmt::format("prediction of {}: {} speed{}", file_, prediction.speeds.size(),
                    prediction.speeds.size() == 1 ? "" : "s"));
    std::string heading = fmt::format("  {:>12}", "speed [km/h]");
    for (const ShownMetric& shown : kShown) heading += fmt::format("  {:>20}", shown.heading);
    say(heading);
    for (const PredictedSpeed& row : prediction.speeds) {
      std::string line = fmt::format("  {:>12.4g}", kKmhPerMps * row.impact_speed_mps);
      for (const ShownMetric& shown : kShown) line += fmt::format("  {:>20}", cell(row, shown));
      say(line + (row.extrapolated() ? "  extrapolated" : ""));
    }
    say("  " + prediction.message);
    for (const PredictedSpeed& row : prediction.speeds)
      if (!row.reasons.empty())
        say(fmt::format("  warning: {:.4g} km/h: {}", kKmhPerMps * row.impact_speed_mps, fmt::join(row.reasons, "; ")));
    print_json(prediction_json(prediction));
  }

  std::string file_;
  Bound<PredictOptions> options_;
};

}  // namespace

std::unique_ptr<Command> make_predict(CLI::App& app) { return std::make_unique<PredictCommand>(app); }

}  // namespace crashsim::cli
