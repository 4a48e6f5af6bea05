/// crashsim merge: the shards of a batch joined.

#include <fmt/format.h>

#include "batch_report.hpp"
#include "command.hpp"

namespace crashsim::cli {
namespace {

class MergeCommand : public Command {
 public:
  explicit MergeCommand(CLI::App& parent)
      : Command(parent, "merge", "Join the shards of a batch: the same files as from one run of all cases",
                "crashsim batch 'data/*-kw400/case.toml' --shard 1/2 -o shard1\n"
                "  crashsim batch 'data/*-kw400/case.toml' --shard 2/2 -o shard2\n"
                "  crashsim merge shard1 shard2 -o joined") {
    app()
        .add_option("shards", shards_, "folders that crashsim batch --shard has written")
        ->required()
        ->type_name("DIR");
    add_output("DIR", "folder to write", "");
    add_reporting();
  }

  int run() override {
    resolve();
    if (output().empty() || output() == "-")
      throw InvalidInput("merge: where to? Name the folder for the joined batch with -o DIR");
    const BatchReport report = merge_batches(shards_, output());
    say(fmt::format("{} shards joined in {}", shards_.size(), output()));
    for (const std::string& line : lines_of(report)) say(line);
    print_json(json_of(report));
    return kDone;
  }

 private:
  std::vector<std::string> shards_;
};

}  // namespace

std::unique_ptr<Command> make_merge(CLI::App& app) { return std::make_unique<MergeCommand>(app); }

}  // namespace crashsim::cli
