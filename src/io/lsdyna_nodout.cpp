/// Motion of LS-DYNA's nodes (nodout, nodouthf).
///
/// Every state is written alike, byte for byte but for the digits: its layout is learned from the first and the fields
/// are read where they stand. A state that differs (nodes in another order, a restart, damage) is read row by row.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "io/lsdyna_ascii.hpp"
#include "io/lsdyna_nodout_rows.hpp"
#include "io/lsdyna_variables.hpp"
#include "text.hpp"

namespace crashsim::io {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);
constexpr std::size_t kMostColumns = 32;  // bits of Row::wanted

/// Blocks with the same columns: those of translations, those of rotations.
struct Kind {
  std::string_view names;
  std::vector<std::string> variables;
  std::size_t width = 0;                                  ///< Of a column.
  std::unordered_map<std::string_view, std::size_t> row;  ///< Of each node.
};

/// A row of the first state. Positions count from the state's start.
struct Row {
  NodoutRow place;
  std::size_t kind = 0;
  std::string_view node;
  std::uint32_t wanted = 0;  ///< A bit for each column.
  std::size_t channel = 0;   ///< Of the first column wanted.
  std::size_t seen_in = 0;   ///< The last state read row by row that had it.
};

/// A block of the first state. Positions count from the state's start.
struct Block {
  std::size_t at = 0, time_at = 0, time_length = 0, mark_end = 0, rows = 0;
  std::size_t first = 0, last = 0;  ///< Its rows, and the one after them.
};

class Nodout {
 public:
  Nodout(std::string_view text, std::size_t from)
      : text_(text), most_(most_channels(text.size())), start_(text.find(kNodoutMark, from)) {}

  void learn();
  [[nodiscard]] std::vector<Trace> describe(std::string_view database, const LsdynaHeader& header) const;
  void choose(const std::vector<std::size_t>& chosen);
  [[nodiscard]] std::size_t expected_states() const;
  /// Whether the first state has more values than memory holds; the others were not learned.
  [[nodiscard]] bool too_many() const { return channels_ > most_; }
  void read(LsdynaStates& states);
  void warn(TraceSet& set) const;

 private:
  [[nodiscard]] std::size_t kind_of(std::string_view names) const;
  void learn_block(const NodoutHead& head, std::size_t at);
  bool read_as_first(std::size_t at, LsdynaStates& states);
  bool matches(const Block& block, std::size_t at) const;
  bool read_row(const Row& row, std::size_t at, double time, LsdynaStates& states) const;
  std::size_t read_by_rows(std::size_t at, LsdynaStates& states);
  std::size_t read_block(const NodoutHead& head, double time, std::string& why, LsdynaStates& states);
  [[nodiscard]] bool starts_new_state(const NodoutHead& head, std::string_view time_text) const;
  [[nodiscard]] std::size_t next_mark(std::size_t from) const { return text_.find(kNodoutMark, from); }

  std::string_view text_;
  std::size_t most_, channels_ = 0;  // channels that the file may have, and has
  std::size_t start_;                // where the first state starts
  std::size_t length_ = 0;           // of the first state, to the end of its last row
  std::size_t stride_ = 0;           // from its start to that of the second; 0 when there is none
  std::vector<Kind> kinds_;
  std::vector<Block> blocks_;
  std::vector<Row> rows_;
  std::size_t state_ = 0, seen_ = 0;  // when reading by rows: the state's number, how many rows it had
  std::size_t unknown_ = 0;
  std::string_view first_unknown_;
};

std::size_t Nodout::kind_of(std::string_view names) const {
  for (std::size_t i = 0; i < kinds_.size(); ++i)
    if (kinds_[i].names == names) return i;
  return kNone;
}

// ---- The first state

void Nodout::learn_block(const NodoutHead& head, std::size_t at) {
  std::size_t kind = kind_of(head.names);
  if (kind == kNone) {
    std::vector<std::string> variables = nodout_variables(head.names);
    if (variables.empty() || variables.size() > kMostColumns) return;
    kind = kinds_.size();
    kinds_.push_back({head.names, std::move(variables), 0, {}});
  }
  Kind& k = kinds_[kind];
  const std::size_t columns = k.variables.size();
  Block block{at - start_,
              head.time_at - start_,
              head.time_text.size(),
              text_.find('\n', at) - start_,
              head.rows - start_,
              rows_.size(),
              0};
  auto place = parse_nodout_row(text_, head.rows);
  for (; place && !too_many(); place = parse_nodout_row(text_, place->end + 1)) {
    const std::string_view row = text_.substr(place->at, place->length);
    const std::size_t width = k.row.empty() ? nodout_width(row, columns) : k.width;
    const std::string_view node = nodout_node(row, width, columns);
    double value = 0.0;
    bool is_whole = !node.empty();
    for (std::size_t c = 0; is_whole && c < columns; ++c)
      is_whole = scan_nodout_field(row.substr(row.size() - (columns - c) * width, width), value);
    if (!is_whole || !k.row.emplace(node, rows_.size()).second) continue;
    k.width = width;
    length_ = place->end + 1 - start_;
    rows_.push_back({{place->at - start_, place->length, place->end - start_}, kind, node});
    channels_ += columns;
  }
  block.last = rows_.size();
  if (block.first != block.last) blocks_.push_back(block);
}

void Nodout::learn() {
  std::string_view time_text;
  for (std::size_t at = start_; at != std::string_view::npos; at = next_mark(at + kNodoutMark.size())) {
    const auto head = parse_nodout_head(text_, at);
    if (!head) return;
    double time = 0.0;
    if (!is_fortran_number(head->time_text, time)) continue;
    if (rows_.empty()) {
      start_ = at;
      blocks_.clear();
      time_text = head->time_text;
    } else if (starts_new_state(*head, time_text)) {
      stride_ = at - start_;
      return;
    }
    learn_block(*head, at);
  }
}

/// Whether a block does not belong to the state before it: its time is another, or its node has been there.
bool Nodout::starts_new_state(const NodoutHead& head, std::string_view time_text) const {
  if (head.time_text != time_text) return true;
  const std::size_t kind = kind_of(head.names);
  const auto place = parse_nodout_row(text_, head.rows);
  if (kind == kNone || !place) return false;
  const Kind& k = kinds_[kind];
  const auto row = k.row.find(nodout_node(text_.substr(place->at, place->length), k.width, k.variables.size()));
  return row != k.row.end() && rows_[row->second].seen_in == state_;
}

std::vector<Trace> Nodout::describe(std::string_view database, const LsdynaHeader& header) const {
  std::vector<Trace> traces;
  for (const Row& row : rows_)
    for (const std::string& variable : kinds_[row.kind].variables)
      traces.push_back(lsdyna_trace({database, variable}, row.node, header.title_of(row.node)));
  return traces;
}

void Nodout::choose(const std::vector<std::size_t>& chosen) {
  std::size_t next = 0, trace = 0;
  for (Row& row : rows_) {
    row.channel = next;
    for (std::size_t c = 0; c < kinds_[row.kind].variables.size(); ++c, ++trace) {
      if (next == chosen.size() || chosen[next] != trace) continue;
      row.wanted |= std::uint32_t{1} << c;
      ++next;
    }
  }
}

std::size_t Nodout::expected_states() const { return stride_ == 0 ? 1 : (text_.size() - start_) / stride_ + 1; }

// ---- States like the first

bool Nodout::matches(const Block& block, std::size_t at) const {
  constexpr std::string_view kTime = "at time";
  const auto same = [&](std::size_t from, std::size_t to) {
    return std::memcmp(text_.data() + at + from, text_.data() + start_ + from, to - from) == 0;
  };
  return same(block.at, block.at + kNodoutMark.size()) && same(block.time_at - kTime.size(), block.time_at) &&
         same(block.mark_end, block.rows);
}

/// Reads the wanted fields of a row that starts at a position. False when one is no number.
bool Nodout::read_row(const Row& row, std::size_t at, double time, LsdynaStates& states) const {
  const std::size_t width = kinds_[row.kind].width, columns = kinds_[row.kind].variables.size();
  const char* fields = text_.data() + at + row.place.length - columns * width;
  std::size_t channel = row.channel;
  double* values = states.row();
  for (std::uint32_t left = row.wanted; left != 0; left &= left - 1, ++channel) {
    double value = 0.0;
    if (!scan_nodout_field(fields + static_cast<std::size_t>(std::countr_zero(left)) * width, width, value))
      return false;
    if (std::isnan(value)) states.note_missing(channel, time);
    values[channel] = value;
  }
  return true;
}

/// Reads the state at a position when it is laid out as the first.
bool Nodout::read_as_first(std::size_t at, LsdynaStates& states) {
  if (text_.size() - at < length_) return false;
  const auto time_text = [&](const Block& block) {
    return trimmed(
        text_.substr(at + block.time_at, text_.find_first_of(")\n", at + block.time_at) - at - block.time_at));
  };
  double time = 0.0;
  if (!is_fortran_number(time_text(blocks_.front()), time) || std::isnan(time)) return false;
  for (const Block& block : blocks_) {
    if (!matches(block, at) || time_text(block) != time_text(blocks_.front())) return false;
    for (std::size_t i = block.first; i < block.last; ++i) {
      const Row& row = rows_[i];
      const char* here = text_.data() + at + row.place.at;
      const std::size_t id = row.place.length - kinds_[row.kind].width * kinds_[row.kind].variables.size();
      if (std::memcmp(here, text_.data() + start_ + row.place.at, id) != 0 || text_[at + row.place.end] != '\n' ||
          !read_row(row, at + row.place.at, time, states))
        return false;
    }
  }
  states.keep(time);
  return true;
}

// ---- Other states

/// Reads the rows of a block. Returns where they end.
std::size_t Nodout::read_block(const NodoutHead& head, double time, std::string& why, LsdynaStates& states) {
  const std::size_t kind = kind_of(head.names);
  std::size_t end = head.rows;
  if (kind == kNone) return end;
  const Kind& k = kinds_[kind];
  for (auto place = parse_nodout_row(text_, end); place; place = parse_nodout_row(text_, end)) {
    end = place->end + 1;
    const std::string_view line = text_.substr(place->at, place->length);
    const std::string_view node = nodout_node(line, k.width, k.variables.size());
    const auto found = k.row.find(node);
    if (found == k.row.end()) {
      if (!node.empty() && unknown_++ == 0) first_unknown_ = node;
      continue;
    }
    Row& row = rows_[found->second];
    if (row.seen_in == state_) continue;
    if (line.size() == row.place.length && read_row(row, place->at, time, states)) {
      row.seen_in = state_;
      ++seen_;
    } else if (why.empty()) {
      why = fmt::format("the row of node {} at byte {} is damaged", node, place->at);
    }
  }
  return end;
}

/// Reads the state at a position. Returns where the next starts.
std::size_t Nodout::read_by_rows(std::size_t at, LsdynaStates& states) {
  ++state_;
  seen_ = 0;
  std::string why, time_text;
  double time = std::numeric_limits<double>::quiet_NaN();
  std::size_t next = at;
  for (bool is_first = true;; is_first = false) {
    const auto head = parse_nodout_head(text_, next);
    if (!head) {
      next = std::string_view::npos;
      break;
    }
    if (is_first) {
      time_text = head->time_text;
      if (!is_fortran_number(time_text, time)) why = "its time is no number";
    } else if (starts_new_state(*head, time_text)) {
      break;
    }
    next = next_mark(read_block(*head, time, why, states));
    if (next == std::string_view::npos) break;
  }
  if (why.empty() && !std::isnan(time) && seen_ == rows_.size()) {
    states.keep(time);
  } else {
    if (why.empty()) why = fmt::format("with {} of {} rows", seen_, rows_.size());
    const bool at_end = next == std::string_view::npos;
    states.lose(time, at, std::min(next, text_.size()), why, at_end);
  }
  return next;
}

void Nodout::read(LsdynaStates& states) {
  for (std::size_t at = start_; at != std::string_view::npos;) {
    if (!read_as_first(at, states)) {
      states.forget_row();
      at = read_by_rows(at, states);
    } else if (stride_ != 0 && text_.substr(std::min(at + stride_, text_.size())).starts_with(kNodoutMark)) {
      at += stride_;
    } else {
      at = next_mark(at + length_);
    }
  }
}

void Nodout::warn(TraceSet& set) const {
  if (unknown_ > 0)
    set.warnings.push_back(
        fmt::format("{}: {} rows are of nodes that the first state has not and were not read, the "
                    "first of node {}",
                    set.path, unknown_, first_unknown_));
}

bool marks(std::string_view line) { return line.starts_with(kNodoutMark); }

void read_nodout(const LsdynaInput& input, TraceSet& set, const Choose& choose) {
  Nodout nodout(input.text, input.states);
  nodout.learn();
  if (nodout.too_many())
    throw InvalidInput(
        fmt::format("{}: the first state has more than {} values, more channels than fit memory: the "
                    "file is damaged",
                    set.path, most_channels(input.text.size())));
  const std::string name = std::filesystem::path(set.path).filename();  // the content of both is the same
  set.traces = nodout.describe(name.starts_with("nodouthf") ? "nodouthf" : "nodout", input.header);
  if (set.traces.empty()) throw InvalidInput(fmt::format("{}: no whole state", set.path));
  const std::vector<std::size_t> chosen = choose(set);
  nodout.choose(chosen);
  LsdynaStates states(chosen.size(), nodout.expected_states());
  nodout.read(states);
  states.give(set, chosen, input.units, input.text);
  nodout.warn(set);
}

}  // namespace

const LsdynaDatabase kNodout = {"nodout", marks, read_nodout};

}  // namespace crashsim::io
