/// LS-DYNA's binout: time histories of many databases in one LSDA container.

#include <algorithm>
#include <map>
#include <memory>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "io/lsdyna_binout_entities.hpp"
#include "io/lsdyna_binout_family.hpp"
#include "io/lsdyna_binout_history.hpp"
#include "io/lsdyna_variables.hpp"
#include "io/reader.hpp"
#include "io/unit_system.hpp"
#include "text.hpp"

namespace crashsim::io {
namespace {

using Clock = std::shared_ptr<const std::vector<double>>;

/// A database with its states in order.
struct Database {
  const BinoutBranch* branch = nullptr;
  std::string name;  ///< As lsdyna_variables knows it.
  std::vector<std::uint32_t> history;
  Clock clock;  ///< Times of the history [s].
};

/// Where a trace's values are.
struct Channel {
  std::uint32_t database = 0, series = 0, column = 0;
};

/// A run's files, what is where in them, and its traces.
struct Run {
  std::vector<std::unique_ptr<const InputFile>> others;  ///< Files beside the one that was asked for.
  BinoutIndex index;
  std::vector<Database> databases;
  std::vector<Channel> channels;  ///< Of the traces.
  std::size_t bytes = 0;          ///< In all files.
  double time_to_si = 1.0;
  TraceSet set;

  void warn(const std::string& text) { set.warnings.push_back(fmt::format("{}: {}", set.path, text)); }
};

/// A file of a known name that begins like LSDA but is damaged is told what is wrong with it.
bool detects(const InputFile& file) {
  if (file.is_folder()) return false;
  if (is_lsda(file.bytes())) return true;
  const std::size_t slash = file.path().rfind('/');
  const std::string name = to_lower(file.path().substr(slash == std::string::npos ? 0 : slash + 1));
  constexpr char kHeaderBytes = 8;
  return name.find("binout") != std::string::npos && file.bytes().starts_with(kHeaderBytes);
}

void open_files(const InputFile& file, Run& run) {
  BinoutFamily family = binout_family(file.path());
  run.set.warnings = std::move(family.warnings);
  for (const std::string& path : family.paths) {
    if (path != file.path()) {
      try {
        run.others.push_back(std::make_unique<const InputFile>(path));
        if (!is_lsda(run.others.back()->bytes())) throw InvalidInput(fmt::format("{}: not an LSDA file", path));
      } catch (const InvalidInput& error) {
        run.set.warnings.push_back(
            fmt::format("{}; left out, though its name is that of a part of the run", error.what()));
        continue;
      }
    }
    const InputFile& member = path == file.path() ? file : *run.others.back();
    run.set.input_files.push_back(path);
    run.bytes += member.bytes().size();
    run.index.add(member);
  }
  const auto& warnings = run.index.warnings();
  run.set.warnings.insert(run.set.warnings.end(), warnings.begin(), warnings.end());
}

bool is_text(std::string_view bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](char c) { return static_cast<unsigned char>(c) >= ' '; });
}

/// Title, version and other texts of the databases; those that all have in common once.
void describe_run(Run& run) {
  constexpr std::string_view kCommon[] = {"title", "version", "revision", "date", "build_id"};
  std::map<std::string, std::string> common;
  for (const BinoutBranch& branch : run.index.branches())
    for (const auto& [name, constant] : branch.constants) {
      if (constant.variable.type != LsdaType::i1 || name == "legend") continue;
      std::string text = constant.text();
      if (text.empty() || !is_text(text)) continue;
      std::string key = fmt::format("{}/{}", branch.path, name);
      if (std::find(std::begin(kCommon), std::end(kCommon), name) != std::end(kCommon)) {
        const auto [first, is_new] = common.emplace(name, text);
        if (first->second == text && (!is_new || name == "title")) continue;
        if (is_new) key = name;
      }
      run.set.metadata.emplace_back(std::move(key), std::move(text));
    }
  run.set.title = common["title"];
}

/// "rwforc" for the branch "rwforc/forces": its walls' total forces are what other files call rwforc.
std::string database_name(const std::string& path) { return path == "rwforc/forces" ? "rwforc" : path; }

/// Appends the traces of one variable.
void list_series(const Database& database, Channel channel, const std::vector<BinoutEntity>* entities, Run& run) {
  const BinoutSeries& series = database.branch->series[channel.series];
  const LsdynaVariable variable{database.name, series.name};
  for (; channel.column < series.count; ++channel.column) {
    const BinoutEntity whole, &entity = entities == nullptr ? whole : (*entities)[channel.column];
    run.set.traces.push_back(lsdyna_trace(variable, entity.name, entity.title));
    run.channels.push_back(channel);
  }
}

/// What is particular about the variables of a database.
struct Oddities {
  std::vector<std::string> gaps, misfits, too_many;
};

void warn_of(const Oddities& odd, const Database& database, Run& run) {
  const auto warn = [&](const std::vector<std::string>& names, std::string_view what) {
    if (!names.empty()) run.warn(fmt::format("{}: {}: {}", database.branch->path, what, some_of(names)));
  };
  warn(odd.gaps, "variables that some states lack, with times of their own");
  warn(odd.misfits, "variables with another number of values in some states, which are left out");
  warn(odd.too_many, "left out, with the others more channels than fit memory");
}

/// Appends the traces of a database.
void list_database(Database database, Run& run) {
  BinoutEntities entities(*database.branch, run.index);
  Oddities odd;
  const std::size_t states = database.history.size();
  for (std::size_t i = 0; i < database.branch->series.size(); ++i) {
    const BinoutSeries& series = database.branch->series[i];
    if (series.records.empty() || series.name == "ids") continue;
    const LsdaType type = lsda_variable(series.records.front(), run.index.layout(series.runs.front().file)).type;
    if (series.count > 1 && size_of(type) == 1) continue;  // text
    if (series.misfits > 0) odd.misfits.push_back(fmt::format("{} ({})", series.name, series.misfits));
    const std::size_t present = records_of(series, database.history).size();
    if (present == 0) continue;
    if (present < states) odd.gaps.push_back(fmt::format("{} (in {} of {})", series.name, present, states));
    if (run.channels.size() + series.count > most_channels(run.bytes)) {
      odd.too_many.push_back(fmt::format("{} ({})", series.name, series.count));
      continue;
    }
    list_series(database, {static_cast<std::uint32_t>(run.databases.size()), static_cast<std::uint32_t>(i), 0},
                entities.of(series), run);
  }
  for (const std::string& text : entities.warnings()) run.warn(text);
  warn_of(odd, database, run);
  run.databases.push_back(std::move(database));
}

void list_channels(Run& run) {
  for (const BinoutBranch& branch : run.index.branches()) {
    if (branch.series.empty()) continue;
    std::vector<std::string> notes;
    Database database{&branch, database_name(branch.path), history_of(branch, notes), nullptr};
    for (const std::string& text : notes) run.warn(text);
    if (database.history.empty()) {
      run.warn(fmt::format("{}: no state with a time: left out", branch.path));
      continue;
    }
    std::vector<double> times;
    for (const std::uint32_t state : database.history) times.push_back(branch.states[state].time * run.time_to_si);
    database.clock = std::make_shared<const std::vector<double>>(std::move(times));
    list_database(std::move(database), run);
  }
  if (!run.set.traces.empty()) return;
  const std::string why = run.set.warnings.empty() ? "" : ". " + run.set.warnings.front();
  throw InvalidInput(fmt::format("{}: a binout without time histories{}", run.set.path, why));
}

/// Times of a variable that only some states have.
Clock clock_of(const std::vector<BinoutRecord>& records, const Database& database, double time_to_si) {
  if (records.size() == database.history.size()) return database.clock;
  std::vector<double> times;
  for (const BinoutRecord& record : records) times.push_back(database.branch->states[record.state].time * time_to_si);
  return std::make_shared<const std::vector<double>>(std::move(times));
}

/// Reads the chosen traces of one variable.
void read_series(std::span<const std::size_t> chosen, const UnitSystem& system, Run& run) {
  const Channel& channel = run.channels[chosen.front()];
  const Database& database = run.databases[channel.database];
  const auto records = records_of(database.branch->series[channel.series], database.history);
  const Clock clock = clock_of(records, database, run.time_to_si);
  std::vector<BinoutColumn> columns;
  for (const std::size_t i : chosen) {
    Trace& trace = run.set.traces[i];
    trace.values.resize(records.size());
    trace.time_s = clock;
    trace.has_samples = true;
    columns.push_back({run.channels[i].column, trace.values.data()});
  }
  read_columns(records, run.index, to_si(system, run.set.traces[chosen.front()].dimension), columns);
}

TraceSet read(const InputFile& file, const ReadOptions& options, const Choose& choose) {
  const UnitSystem system = parse_unit_system(options.units);
  Run run;
  run.set.path = file.path();
  run.time_to_si = to_si(system, Dimension::time);
  open_files(file, run);
  describe_run(run);
  list_channels(run);
  const std::vector<std::size_t> chosen = choose(run.set);
  const auto series_of = [&](std::size_t i) {
    return std::pair(run.channels[chosen[i]].database, run.channels[chosen[i]].series);
  };
  for (std::size_t begin = 0, end = 0; begin < chosen.size(); begin = end) {
    while (end < chosen.size() && series_of(end) == series_of(begin)) ++end;
    read_series(std::span(chosen).subspan(begin, end - begin), system, run);
  }
  warn_when_implausible(run.set, system);
  return std::move(run.set);
}

}  // namespace

const Reader kLsdynaBinoutReader = {"lsdyna_binout", "LS-DYNA binout", detects, read};

}  // namespace crashsim::io
