/// crashsim design: sensitivities of a case's vehicle and its best numbers under limits.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "folder_command.hpp"
#include "interrupt.hpp"
#include "progress.hpp"

namespace crashsim::cli {
namespace {

class DesignCommand : public FolderCommand {
 public:
  explicit DesignCommand(CLI::App& parent)
      : FolderCommand(parent, "design",
                      "Design with the coupled model of crush, heave and pitch: sensitivities, the optimum under "
                      "limits, and a trade-off curve",
                      "crashsim design data/design/case.toml -o design") {
    app()
        .add_option("case", file_, "case.toml with a [design]; or a case.lock.json, to make it again")
        ->required()
        ->type_name("CASE");
    options_.flags.add_to(app(), "Options", {"jobs"});
    add_output("DIR", "folder to write");
    add_reporting();
  }

  int run() override {
    Case study = read_case(file_);
    options_.values = study.design;
    resolve(options_);
    study.design = options_.values;
    if (study.design.jobs > 0) study.identify.jobs = study.design.jobs;
    if (study.design.parameters.empty())
      throw InvalidInput(fmt::format(
          "{}: has no [design] parameters: name what may change (crashsim schema case lists the keys)", study.path));
    std::vector<std::string> inputs = case_inputs(study);
    inputs.push_back(file_);
    check_folder(design_file_names(study), inputs);
    const DesignCaseResult result = run_watched(study);
    const std::vector<FileText> files = design_files(study, result);
    write_files(files);
    report(study, result);
    const auto is_summary = [](const FileText& file) { return file.name == kDesignSummary; };
    print_json(std::find_if(files.begin(), files.end(), is_summary)->text);
    if (interrupted()) return kInterruptedExit;
    return result.usable() ? kDone : kNumbersFailed;
  }

 private:
  DesignCaseResult run_watched(const Case& study) const {
    return watch_starts(quiet(), [&](const Progress& progress) { return run_design(study, progress); });
  }

  void report(const Case& study, const DesignCaseResult& result) const {
    const DesignResult& design = result.design;
    say(fmt::format("design of {}{}", study.path, study.what.title.empty() ? "" : ": " + study.what.title));
    if (result.base.identification) say("  model identified: " + result.base.identification->brief_report());
    for (const std::string& note : result.notes) say("  note: " + note);
    if (!design.sensitivities.empty()) report_sensitivities(design);
    say(fmt::format("optimum: {}", design.brief_report()));
    if (std::isfinite(design.after.t_m_s)) report_optimum(design);
    if (!design.trade_off.empty()) report_trade_off(design);
    warn(design.warnings);
    if (!output().empty()) say(fmt::format("results in {}", output()));
  }

  void report_sensitivities(const DesignResult& design) const {
    say("sensitivities of the given model, % per %");
    std::string line = fmt::format("  {:<26}", "");
    for (const auto& response : kDesignResponses) line += fmt::format(" {:>13}", response.name);
    say(line);
    for (std::size_t i = 0; i < design.variables.size(); ++i) {
      line = fmt::format("  {:<26}", design.variables[i].name);
      for (std::size_t r = 0; r < kDesignResponses.size(); ++r)
        line += fmt::format(" {:>13}", cell(design.sensitivities[i * kDesignResponses.size() + r].relative));
      say(line);
    }
  }

  void report_optimum(const DesignResult& design) const {
    Summary before, after;
    for (const DesignVariable& variable : design.variables) {
      before.push_back({variable.name, variable.before, variable.name});
      after.push_back({variable.name, variable.after, variable.name});
    }
    const auto append = [](Summary& to, const Summary& items) { to.insert(to.end(), items.begin(), items.end()); };
    append(before, summarize(design.before));
    append(after, summarize(design.after));
    say(before, after, "given", "optimum");
  }

  void report_trade_off(const DesignResult& design) const {
    say("trade-off");
    std::string line = fmt::format("  {:>16} {:>16}", fmt::format("{} <=", name_of(design.traded)),
                                   fmt::format("least {}", name_of(design.minimised)));
    for (const DesignVariable& variable : design.variables) line += fmt::format(" {:>20}", variable.name);
    say(line);
    for (const TradeOffPoint& point : design.trade_off) {
      line = fmt::format("  {:>16.5g} {:>16}", point.limit, point.feasible ? cell(point.objective) : "none");
      for (const double value : point.values) line += fmt::format(" {:>20}", cell(value));
      say(line);
    }
  }

  static std::string cell(double value) { return std::isnan(value) ? "-" : fmt::format("{:.5g}", value); }

  std::string file_;
  Bound<DesignOptions> options_;
};

}  // namespace

std::unique_ptr<Command> make_design(CLI::App& app) { return std::make_unique<DesignCommand>(app); }

}  // namespace crashsim::cli
