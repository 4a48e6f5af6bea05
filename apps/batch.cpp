/// crashsim batch: many cases, a folder and a row each.

#include <fmt/format.h>

#include "batch_report.hpp"
#include "command.hpp"
#include "interrupt.hpp"
#include "progress.hpp"

namespace crashsim::cli {
namespace {

class BatchCommand : public Command {
 public:
  explicit BatchCommand(CLI::App& parent)
      : Command(
            parent, "batch",
            "Run many cases on worker processes: a folder and a row of one table each; killed at any moment it goes "
            "on where it was",
            "crashsim batch 'data/*-kw400/case.toml' data/paper/free.toml -o study") {
    app()
        .add_option("cases", cases_,
                    "case.toml; a record (case.lock.json); a glob in quotes; or a manifest: a text file with one of "
                    "them a line, relative to it, `name = file` to name it")
        ->required()
        ->type_name("CASE|GLOB|MANIFEST");
    options_.flags.add_to(app(), "Options");
    add_output("DIR", "folder to write: cases/NAME, results.csv, results.jsonl, timings.csv", "");
    app()
        .add_option("--log-json", log_, "append every event to a file, as JSON lines; '-' for standard error")
        ->type_name("FILE");
    add_reporting();
  }

  int run() override {
    resolve(options_);
    if (output().empty() || output() == "-")
      throw InvalidInput("batch: where to? Name the folder for the results with -o DIR");
    EventLog log(log_);
    const std::vector<BatchCase> plan = plan_batch(cases_);
    const BatchReport report = run_watched(plan, log);
    log.write(report);
    say(fmt::format("batch in {}", output()));
    for (const std::string& line : lines_of(report)) say(line);
    if (report.interrupted)
      say("interrupted: what is finished is kept; go on with --resume");
    else if (report.done < report.total)
      say("stopped at the failed case; --keep-going finishes the others; go on with --resume");
    else
      say(fmt::format("results in {}/results.csv", output()));
    print_json(json_of(report));
    return report.exit_code;
  }

 private:
  BatchReport run_watched(const std::vector<BatchCase>& plan, EventLog& log) {
    const CooperativeInterrupt keep_what_is_finished;
    ProgressLine line("cases", quiet());
    return run_batch(plan, output(), options_.values, [&](const BatchEvent& event) {
      log.write(event);
      if (event.kind == BatchEvent::Kind::case_unchanged) line.begin_after(++unchanged_);
      if (event.kind == BatchEvent::Kind::waiting) line.show(event.done, event.total, event.failed);
      return !interrupted();
    });
  }

  std::vector<std::string> cases_;
  std::string log_;
  std::size_t unchanged_ = 0;
  Bound<BatchOptions> options_;
};

}  // namespace

std::unique_ptr<Command> make_batch(CLI::App& app) { return std::make_unique<BatchCommand>(app); }

}  // namespace crashsim::cli
