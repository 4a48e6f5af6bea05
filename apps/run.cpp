/// crashsim run: the whole chain of a case, or again what made an output.

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "comparison_table.hpp"
#include "folder_command.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "sample_report.hpp"

namespace crashsim::cli {
namespace {

namespace fs = std::filesystem;

/// The command line that a record stands for, without its outputs.
std::vector<std::string> command_line_of(const Record& record) {
  std::vector<std::string> line = {record.command};
  for (const ConfigEntry& entry : record.options) {
    const std::string flag = "--" + entry.key;
    if (const auto* texts = std::get_if<std::vector<std::string>>(&entry.value)) {
      for (const std::string& text : *texts) line.push_back(flag + "=" + text);
    } else if (const auto* is_on = std::get_if<bool>(&entry.value)) {
      line.push_back(flag + (*is_on ? "=true" : "=false"));
    } else if (const std::string text = text_of(entry.value); !text.empty()) {
      line.push_back(flag + "=" + text);
    }
  }
  line.emplace_back("--");
  line.insert(line.end(), record.arguments.begin(), record.arguments.end());
  return line;
}

/// Whether a record holds the options of a case: its command reads them from the record.
bool is_of_case(const Record& record) { return record.command == "design"; }

class RunCommand : public FolderCommand {
 public:
  explicit RunCommand(CLI::App& parent)
      : FolderCommand(
            parent, "run",
            "Run a case: pulse, identification, simulation, heave and pitch, comparison, sweep; or an output's record "
            "again",
            "crashsim run data/fe-car/case.toml -o fe-car") {
    app()
        .add_option("case", file_, "case.toml; or a case.lock.json or other output, to make it again")
        ->required()
        ->type_name("CASE");
    options_.flags.add_to(app(), "Options", {"jobs"});
    add_output("DIR", "folder to write; the file, when the record of another command is run again");
    add_reporting();
  }

  int run() override {
    const std::string extension = fs::path(file_).extension().string();
    if (extension != ".toml") {
      const auto record = find_record(file_);
      if (record && record->command != "run") return run_again(*record);
      if (!record && (extension == ".json" || extension == ".csv"))
        throw InvalidInput(fmt::format(
            "{}: holds no record of what made it: give a case (.toml), or an output that crashsim wrote", file_));
    }
    Case study = read_case(file_);
    options_.values = study.identify;
    resolve(options_);
    study.identify = options_.values;
    std::vector<std::string> inputs = case_inputs(study);
    inputs.push_back(file_);
    check_folder(case_file_names(study), inputs);
    const CaseResult result = run_watched(study);
    const std::vector<FileText> files = case_files(study, result);
    write_files(files);
    report(study, result);
    const auto is_summary = [](const FileText& file) { return file.name == kCaseSummary; };
    print_json(std::find_if(files.begin(), files.end(), is_summary)->text);
    if (interrupted()) return kInterruptedExit;
    return result.usable() ? kDone : kNumbersFailed;
  }

 private:
  int run_again(const Record& record) {
    resolve(options_);
    verify_inputs(record);
    if (record.version != kVersion)
      say(fmt::format("  warning: {} was made by crashsim {}, this is {}", file_, record.version, kVersion));
    std::vector<std::string> line =
        is_of_case(record) ? std::vector<std::string>{record.command, "--", file_} : command_line_of(record);
    std::vector<std::string> shared;
    if (!output().empty()) shared.insert(shared.end(), {"-o", output()});
    if (overwrite()) shared.emplace_back("--overwrite");
    if (json()) shared.emplace_back("--json");
    if (quiet()) shared.emplace_back("--quiet");
    if (record.command == "identify" || is_of_case(record))
      shared.push_back(fmt::format("--jobs={}", options_.values.jobs));
    line.insert(line.begin() + 1, shared.begin(), shared.end());
    return run_program(line);
  }

  /// The case itself, then its samples.
  CaseResult run_watched(const Case& study) const {
    const Case alone = without_samples(study);
    CaseResult result = watch("starts", quiet(), [&](const Progress& progress) { return run_case(alone, progress); });
    if (!has_samples(study) || interrupted() || result.response.outcome == CrushOutcome::not_run) return result;
    const SamplePlan plan = plan_samples(study, result);
    result.samples = watch("samples", quiet(), [&](const Progress& progress) {
      return run_samples(plan, 0, plan.table.planned, progress);
    });
    return result;
  }

  void report(const Case& study, const CaseResult& result) const {
    say(fmt::format("case {}{}", study.path, study.what.title.empty() ? "" : ": " + study.what.title));
    if (result.pulse) {
      say(fmt::format("  pulse from {}", fmt::join(result.pulse->channels, ", ")));
      warn(result.pulse->warnings);
    }
    if (result.identification) report_fit(*result.identification);
    if (result.response.outcome != CrushOutcome::not_run) report_motion(result);
    if (result.forcing) {
      for (const std::string& step : result.forcing->steps) say("  " + step);
      warn(result.forcing->warnings);
    }
    if (result.pitch) report_pitch(*result.pitch, result.coupled);
    note(result.notes);
    for (const Prediction& prediction : result.predictions)
      say(fmt::format("prediction at {}: {}", prediction.name, prediction.response.brief_report()));
    for (const NamedComparison& comparison : result.comparisons) {
      say(fmt::format("model against test, {}", comparison.doc));
      for (const std::string& line : table_of(comparison.result)) say(line);
    }
    if (result.samples)
      for (const std::string& line : table_of(*result.samples)) say(line);
    if (!output().empty()) say(fmt::format("results in {}", output()));
  }

  void report_fit(const Identification& fit) const {
    say(fmt::format("identification: {}", name_of(fit.outcome)));
    if (!fit.message.empty()) say("  " + fit.message);
    if (!fit.ordinates.empty())
      say(fmt::format(
          "  E = {:.6g} (acceleration {:.4g}, velocity {:.4g}, displacement {:.4g}), {} of {} starts within "
          "0.1 % of it, {:.3g} s",
          fit.error.total, fit.error.accel, fit.error.velocity, fit.error.displacement, fit.starts_at_best,
          fit.starts.size(), fit.seconds));
    if (!fit.verdict.message.empty()) say("  verdict: " + fit.verdict.message);
    warn(fit.warnings);
  }

  void report_pitch(const PitchResponse& pitch, const std::optional<CoupledResponse>& coupled) const {
    say(fmt::format("heave and pitch: {}", pitch.brief_report()));
    note(pitch.notes);
    const Summary phases = summarize(pitch);
    if (!coupled) return say(phases);
    say(fmt::format("coupled with the crush: {}", coupled->brief_report()));
    note(coupled->notes);
    Summary together;
    for (const SummaryItem& item : summarize(*coupled))
      if (std::any_of(phases.begin(), phases.end(), [&](const SummaryItem& same) { return same.name == item.name; }))
        together.push_back(item);
    say(phases, together, "two phases", "coupled");
  }

  void note(const std::vector<std::string>& notes) const {
    for (const std::string& text : notes) say("  note: " + text);
  }

  void report_motion(const CaseResult& result) const {
    const Summary model = summarize(result.response, result.model.mass_kg);
    say(fmt::format("simulation: {}", result.response.brief_report()));
    if (result.pulse)
      say(summarize(*result.pulse), model, "test", "model");
    else
      say(model);
  }

  std::string file_;
  Bound<IdentifyOptions> options_;
};

}  // namespace

std::unique_ptr<Command> make_run(CLI::App& app) { return std::make_unique<RunCommand>(app); }

}  // namespace crashsim::cli
