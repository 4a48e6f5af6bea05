/// The reader of LS-DYNA's ASCII databases: which one a file holds, and what they have in common.

#include "io/lsdyna_ascii.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "text.hpp"

namespace crashsim::io {
namespace {

constexpr const LsdynaDatabase* kDatabases[] = {&kNodout, &kRcforc, &kRwforc, &kSecforc, &kRbdout, &kGlstat, &kMatsum};

struct Found {
  const LsdynaDatabase* database;
  std::size_t states;  ///< Where the preamble ends.
};

/// The database by the first line that marks one; it stands near the beginning, but for the legend.
std::optional<Found> find_database(std::string_view text) {
  constexpr std::size_t kSearched = std::size_t{1} << 16;  // bytes outside legends
  CompleteLines lines(text, 0);
  std::size_t searched = 0, states = 0;
  for (std::string_view line; searched < kSearched && lines.next(line); searched += line.size() + 1) {
    const std::size_t legend = end_of_legend(text, lines, line);
    if (legend != std::string_view::npos) lines.move_to(legend);
    if (legend != std::string_view::npos || is_version_line(line)) states = lines.position();
    const std::string_view words = trimmed(line);
    for (const LsdynaDatabase* database : kDatabases)
      if (database->marks(words)) return Found{database, states};
  }
  return std::nullopt;
}

/// Whether a file starts as every database does, with a title and the program's version.
bool has_preamble(std::string_view text) {
  constexpr int kLines = 5;
  constexpr std::size_t kLongest = 1024;
  CompleteLines lines(text.substr(0, kLongest), 0);
  std::string_view line;
  for (int i = 0; i < kLines && lines.next(line); ++i)
    if (is_version_line(line)) return true;
  return false;
}

bool detects(const InputFile& file) {
  return !file.is_folder() && (has_preamble(file.bytes()) || find_database(file.bytes()));
}

[[noreturn]] void refuse(const std::string& path) {
  std::string known;
  for (const LsdynaDatabase* database : kDatabases)
    known += fmt::format("{}{}", known.empty() ? "" : ", ", database->name);
  throw InvalidInput(fmt::format(
      "{}: an LS-DYNA file without states, or of a database that is not read; those that are: {}", path, known));
}

TraceSet read(const InputFile& file, const ReadOptions& options, const Choose& choose) {
  TraceSet set;
  set.path = file.path();
  set.input_files = {file.path()};
  const auto found = find_database(file.bytes());
  if (!found) refuse(file.path());
  const LsdynaInput input{file.bytes(), parse_lsdyna_header(file.bytes(), found->states), found->states,
                          parse_unit_system(options.units)};
  set.title = input.header.title;
  for (const auto& [key, value] : {std::pair<std::string, std::string>{"database", found->database->name},
                                   {"version", input.header.version},
                                   {"date", input.header.date}})
    if (!value.empty()) set.metadata.emplace_back(key, value);
  found->database->read(input, set, choose);
  warn_when_implausible(set, input.units);
  return set;
}

}  // namespace

void read_lsdyna_lines(const LsdynaLines& database, const LsdynaInput& input, TraceSet& set, const Choose& choose) {
  LsdynaSlots slots(input.text);
  CompleteLines first(input.text, input.states);
  database.parse(first, slots);
  if (slots.too_many())
    throw InvalidInput(
        fmt::format("{}: the first state has more than {} values, more channels than fit memory: the "
                    "file is damaged",
                    set.path, most_channels(input.text.size())));
  for (const LsdynaSlot& slot : slots.slots()) set.traces.push_back(database.describe(slot, input.header));
  if (set.traces.empty()) throw InvalidInput(fmt::format("{}: no whole state", set.path));

  const std::vector<std::size_t> chosen = choose(set);
  LsdynaStates states(chosen.size(), slots.expected_states());
  slots.collect(states, chosen);
  CompleteLines all(input.text, input.states);
  database.parse(all, slots);
  slots.finish();
  states.give(set, chosen, input.units, input.text);
  slots.warn(set);
}

const Reader kLsdynaAsciiReader = {
    "lsdyna_ascii", "LS-DYNA ASCII (nodout, rcforc, rwforc, secforc, rbdout, glstat, matsum)", detects, read};

}  // namespace crashsim::io
