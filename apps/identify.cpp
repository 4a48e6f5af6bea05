/// crashsim identify: a crush model from pulses.

#include <cmath>

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
                "  crashsim identify pulse.csv -o model.json\n"
                "  crashsim pulse data/fe-car/C40.csv --channel LEFT_REAR_VX --channel RIGHT_REAR_VX -o pulse40.csv\n"
                "  crashsim identify pulse40.csv pulse.csv --law crush_damping -o joint.json") {
    app()
        .add_option("pulse", files_, "pulse.csv, or any trace that `pulse` reads without options")
        ->required()
        ->type_name("PULSE");
    options_.flags.add_to(app(), "Options");
    errors_.flags.add_to(app(), "Uncertainty", {"resample", "replicates", "level", "profile", "block"});
    add_output("FILE", "model.json to write, - for standard output");
    add_reporting();
  }

  int run() override {
    resolve(options_, errors_);
    errors_.values.seed = options_.values.seed;
    errors_.values.jobs = options_.values.jobs;
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
    Uncertainty errors;
    if (!fit.ordinates.empty()) {
      if (fit.usable()) errors = judge_watched(pulses, fit);
      const Record made_by = record(files_, all_entries(), inputs);
      write(format_model(fit.model, &fit, &made_by, fit.usable() ? &errors : nullptr));
    }
    report(fit, summary);
    report(errors);
    if (fit.outcome == IdentifyOutcome::interrupted || errors.outcome == UncertaintyOutcome::interrupted)
      return kInterruptedExit;
    return fit.usable() ? kDone : kNumbersFailed;
  }

 private:
  Identification identify_watched(const std::vector<Pulse>& pulses) const {
    return watch_starts(quiet(), [&](const Progress& progress) { return identify(pulses, options_.values, progress); });
  }

  Uncertainty judge_watched(const std::vector<Pulse>& pulses, const Identification& fit) const {
    return watch("replicates", quiet(), [&](const Progress& progress) {
      return uncertainty(pulses, options_.values, fit, errors_.values, progress);
    });
  }

  /// Entries of both tables; seed and jobs are the fit's.
  std::vector<ConfigEntry> all_entries() const {
    std::vector<ConfigEntry> entries = entries_of(options_.values, "");
    for (ConfigEntry& entry : entries_of(errors_.values, ""))
      if (entry.key != "seed" && entry.key != "jobs") entries.push_back(std::move(entry));
    return entries;
  }

  /// What was asked beyond the standard errors.
  void report(const Uncertainty& errors) const {
    if (!errors_.values.profile || errors.ordinates.empty()) return;
    say(fmt::format("  {:<4} {:>14} {:>14}", "", "profile from", "to"));
    for (const OrdinateUncertainty& o : errors.ordinates)
      say(fmt::format("  {:<4} {:>14.6g} {:>14.6g} {}{}", o.name, o.profile_low, o.profile_high,
                      o.profile_low_open ? " open below" : "", o.profile_high_open ? " open above" : ""));
    say("  " + errors.message);
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
      if (fit.tests.size() > 1 || has_corrections(fit)) report_tests(fit);
    }
    warn(fit.warnings);
    print_json(format_summary(summary));
  }

  static bool has_corrections(const Identification& fit) {
    const TestReport& test = fit.tests.front();
    return !std::isnan(test.time_shift_s) || !std::isnan(test.gain) || !std::isnan(test.bias_mps2);
  }

  void report_tests(const Identification& fit) const {
    const auto cell = [](double value, double error, double scale) {
      return std::isnan(value) ? "-" : fmt::format("{:.4g} +- {:.2g}", scale * value, scale * error);
    };
    say(fmt::format("  {:<24} {:>9} {:>9} {:>10} {:>20} {:>20} {:>20}", "test", "speed m/s", "weight", "E",
                    "time shift ms", "gain", "bias m/s^2"));
    for (std::size_t i = 0; i < fit.tests.size(); ++i) {
      const TestReport& t = fit.tests[i];
      say(fmt::format("  {:<24} {:>9.3f} {:>9.3g} {:>10.6f} {:>20} {:>20} {:>20}", files_[i], t.impact_speed_mps,
                      t.weight, t.error.total, cell(t.time_shift_s, t.time_shift_error_s, 1e3),
                      cell(t.gain, t.gain_error, 1.0), cell(t.bias_mps2, t.bias_error_mps2, 1.0)));
    }
  }

  std::vector<std::string> files_;
  Bound<IdentifyOptions> options_;
  Bound<UncertaintyOptions> errors_;
};

}  // namespace

std::unique_ptr<Command> make_identify(CLI::App& app) { return std::make_unique<IdentifyCommand>(app); }

}  // namespace crashsim::cli
