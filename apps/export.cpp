/// crashsim export: a model for other programs, or traces as an ISO-MME test.

#include <filesystem>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "folder_command.hpp"
#include "interrupt.hpp"

namespace crashsim::cli {
namespace {

class ExportCommand : public FolderCommand {
 public:
  explicit ExportCommand(CLI::App& parent)
      : FolderCommand(
            parent, "export",
            "Write a crush model for LS-DYNA or OpenRadioss (an include file with curves, spring and damper), or as "
            "a table: x, k, F(x) and v, c, F(v) in columns, in SI, the shorter columns ending in empty cells. Or "
            "write traces (pulse.csv, response.csv, pitch.csv, any file that is read) as a folder with an ISO-MME "
            "test",
            "crashsim export data/syn-a/model.json --to lsdyna --units t-mm-s -o syn-a.k") {
    app().add_option("file", file_, "model.json; for iso-mme: the traces")->required()->type_name("FILE");
    options_.flags.add_to(app(), "Options");
    add_output("PATH", "file to write, - for standard output; for iso-mme: folder");
    add_reporting();
  }

  int run() override {
    resolve(options_);
    return options_.values.to == kIsoMmeTarget ? write_test() : write_model();
  }

 private:
  int write_model() const {
    check_output({file_});
    const Exported exported = export_model(read_model(file_), options_.values, record_of({file_}));
    write(exported.text);
    report(exported.notes);
    return kDone;
  }

  int write_test() const {
    check_folder({}, {file_});
    const ExportOptions& options = options_.values;
    TraceSet traces = read_traces(file_, {options.channels, "", options.units});
    keep_chosen(options.channels, traces);
    IsoMmeTest test = make_iso_mme_test(traces, options.test_name.empty() ? own_name() : options.test_name);
    test.record = to_json(record_of(traces.input_files));
    if (!output().empty()) {
      const CooperativeInterrupt finish_first;
      write_iso_mme(test, output(), overwrite());
    }
    std::vector<std::string> notes = std::move(traces.warnings);
    notes.insert(notes.end(), test.notes.begin(), test.notes.end());
    report(notes);
    return kDone;
  }

  /// Without those that were not asked for.
  static void keep_chosen(const std::vector<std::string>& selectors, TraceSet& set) {
    if (selectors.empty()) return;
    std::set<std::size_t> chosen;
    for (const std::string& selector : selectors)
      for (const std::size_t i : select_channels(set, selector)) chosen.insert(i);
    std::vector<Trace> kept;
    for (const std::size_t i : chosen) kept.push_back(std::move(set.traces[i]));
    set.traces = std::move(kept);
  }

  /// The name of the file without its ending, or of the folder.
  [[nodiscard]] std::string own_name() const {
    namespace fs = std::filesystem;
    fs::path path = fs::absolute(file_).lexically_normal();
    if (!path.has_filename()) path = path.parent_path();
    return (fs::is_directory(path) ? path.filename() : path.stem()).string();
  }

  [[nodiscard]] Record record_of(const std::vector<std::string>& inputs) const {
    return record({file_}, entries_of(options_.values, ""), inputs);
  }

  void report(const std::vector<std::string>& notes) const {
    say(fmt::format("{} for {}", file_, options_.values.to));
    for (const std::string& note : notes) say("  note: " + note);
    print_json(nlohmann::ordered_json({{"to", options_.values.to}, {"notes", notes}}).dump(2) + "\n");
  }

  std::string file_;
  Bound<ExportOptions> options_;
};

}  // namespace

std::unique_ptr<Command> make_export(CLI::App& app) { return std::make_unique<ExportCommand>(app); }

}  // namespace crashsim::cli
