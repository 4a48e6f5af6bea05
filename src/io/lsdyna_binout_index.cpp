#include "io/lsdyna_binout_index.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include <fmt/format.h>

#include <crashsim/error.hpp>

#include "text.hpp"

namespace crashsim::io {
namespace {

/// The number of a state's directory: 7 for "d000007".
std::optional<std::uint32_t> state_number(std::string_view name) {
  constexpr std::size_t kMostDigits = 9;
  if (name.size() < 2 || name.size() > 1 + kMostDigits || name.front() != 'd') return std::nullopt;
  std::uint32_t number = 0;
  for (const char c : name.substr(1)) {
    if (!is_digit(c)) return std::nullopt;
    number = 10 * number + static_cast<std::uint32_t>(c - '0');
  }
  return number;
}

/// Whether two lists of numbers are equal, whatever their types.
bool same_numbers(const BinoutConstant& a, const BinoutConstant& b) {
  const LsdaVariable &x = a.variable, &y = b.variable;
  if (x.count != y.count) return false;
  if (x.type == y.type && a.layout.swapped == b.layout.swapped)
    return std::memcmp(x.values, y.values, x.count * size_of(x.type)) == 0;
  constexpr std::size_t kBlock = 256;
  std::array<double, kBlock> left{}, right{};
  for (std::size_t from = 0; from < x.count; from += kBlock) {
    const std::size_t count = std::min(kBlock, x.count - from);
    decode(x, a.layout, from, count, left.data());
    decode(y, b.layout, from, count, right.data());
    if (left != right) return false;
  }
  return true;
}

/// Whether a constant says whose the values of a database are.
bool names_entities(std::string_view constant) {
  return (constant.ends_with("ids") && constant != "legend_ids") || constant == "side";
}

}  // namespace

std::vector<double> BinoutConstant::numbers() const {
  std::vector<double> numbers(variable.count);
  decode(variable, layout, 0, numbers.size(), numbers.data());
  return numbers;
}

std::string BinoutConstant::text() const {
  const std::string_view bytes(variable.values, variable.count * size_of(variable.type));
  return std::string(trimmed(bytes.substr(0, bytes.find('\0'))));
}

void BinoutIndex::add(const InputFile& file) {
  LsdaScanner scanner(file);
  layouts_.push_back(scanner.layout());
  file_bytes_ += file.bytes().size();
  file_ = &file;
  branch_ = nullptr;
  title_differs_ = false;
  for (std::size_t directory = 0; scanner.next();) {
    if (scanner.directory_number() != directory) enter(scanner.directory());
    directory = scanner.directory_number();
    if (branch_ == nullptr) continue;
    in_metadata_ ? add_constant(scanner) : add_to_state(scanner);
  }
  finish_file(scanner.end());
}

/// Many small records must not need much more memory than the file has bytes.
void BinoutIndex::count_use(std::size_t bytes) {
  constexpr std::size_t kAlways = std::size_t{16} << 20;
  used_bytes_ += bytes;
  if (used_bytes_ > kAlways + file_bytes_)
    throw InvalidInput(
        fmt::format("{}: binout of {} bytes: more and smaller variables than any LS-DYNA run writes: "
                    "the file is damaged",
                    file_->path(), file_bytes_));
}

void BinoutIndex::enter(const std::string& directory) {
  branch_ = nullptr;
  const std::size_t slash = directory.rfind('/');
  const std::string_view last = std::string_view(directory).substr(slash + 1);
  const auto number = state_number(last);
  in_metadata_ = last == "metadata";
  if (slash == 0 || (!number && !in_metadata_)) return;
  state_number_ = number.value_or(0);
  branch_ = find_branch(std::string_view(directory).substr(1, slash - 1));
  if (branch_ != nullptr && number) branch_->files = layouts_.size();
}

/// The branch of a path, made when it is new; none for paths that are no text.
BinoutBranch* BinoutIndex::find_branch(std::string_view path) {
  if (const auto found = branch_by_path_.find(path); found != branch_by_path_.end()) return &branches_[found->second];
  if (!std::all_of(path.begin(), path.end(), [](char c) { return c > ' ' && c <= '~'; })) return nullptr;
  count_use(2 * sizeof(BinoutBranch));
  BinoutBranch& branch = branches_.emplace_back();
  branch.path = path;
  branch_by_path_.emplace(branch.path, branches_.size() - 1);
  return &branch;
}

void BinoutIndex::add_constant(const LsdaScanner& scanner) {
  const LsdaVariable& variable = scanner.variable();
  if (variable.name == "title") compare_title(scanner);
  const auto found = branch_->constants.find(variable.name);
  if (found == branch_->constants.end()) {
    count_use(2 * sizeof(BinoutConstant));
    branch_->constants.emplace(variable.name, BinoutConstant{variable, scanner.layout()});
  } else if (branch_->states.empty()) {
    found->second = {variable, scanner.layout()};
  } else if (names_entities(variable.name) && !same_numbers(found->second, {variable, scanner.layout()})) {
    branch_->ids_change = std::min(branch_->ids_change, branch_->states.size());
  }
}

/// Files of two runs in one folder look like files of one.
void BinoutIndex::compare_title(const LsdaScanner& scanner) {
  const std::string title = BinoutConstant{scanner.variable(), scanner.layout()}.text();
  if (title_.empty()) title_ = title;
  if (title_differs_ || title.empty() || title == title_) return;
  title_differs_ = true;
  warnings_.push_back(fmt::format("{}: {} has the title '{}', the run '{}': is the file of another run?", file_->path(),
                                  branch_->path, title, title_));
}

void BinoutIndex::begin_state() {
  count_use(sizeof(BinoutState));
  branch_->open = true;
  branch_->states.push_back({kUnset, state_number_, 0});
}

/// The series of a variable, made when it is new; mostly it is the one after the last.
BinoutSeries* BinoutIndex::find_series(const LsdaVariable& variable) {
  std::size_t& next = branch_->next_series;
  if (next >= branch_->series.size()) next = 0;
  if (branch_->series.empty() || branch_->series[next].name != variable.name) {
    const auto found = branch_->series_by_name.find(variable.name);
    if (found == branch_->series_by_name.end()) {
      count_use(2 * sizeof(BinoutSeries));
      BinoutSeries& series = branch_->series.emplace_back();
      series.name = variable.name;
      series.count = variable.count;
      next = branch_->series.size() - 1;
      branch_->series_by_name.emplace(series.name, next);
    } else {
      next = found->second;
    }
  }
  return &branch_->series[next++];
}

/// Adds a variable to the state of its directory. One that the state already has begins the state again: a restarted
/// run writes into the file of the first.
void BinoutIndex::add_to_state(const LsdaScanner& scanner) {
  const LsdaVariable& variable = scanner.variable();
  auto& states = branch_->states;
  if (!branch_->open || states.back().number != state_number_) begin_state();
  if (variable.name == "time") {
    if (variable.count != 1) return;
    if (!std::isnan(states.back().time)) begin_state();
    decode(variable, scanner.layout(), 0, 1, &states.back().time);
    return;
  }
  if (variable.count == 0) return;
  append(*find_series(variable), scanner);
}

void BinoutIndex::append(BinoutSeries& series, const LsdaScanner& scanner) {
  if (scanner.variable().count != series.count) {
    ++series.misfits;
    return;
  }
  if (series.name == "ids" && !series.records.empty()) compare_ids(series, scanner);
  const auto file = static_cast<std::uint32_t>(layouts_.size() - 1);
  const auto record = static_cast<std::uint32_t>(series.records.size());
  const auto after_last = [&] {
    return series.runs.empty() ? 0 : series.runs.back().state + (record - series.runs.back().record);
  };
  if (after_last() == branch_->states.size()) begin_state();
  const auto state = static_cast<std::uint32_t>(branch_->states.size() - 1);
  if (series.runs.empty() || after_last() != state || series.runs.back().file != file) {
    count_use(sizeof(BinoutRun));
    series.runs.push_back({state, record, file});
  }
  count_use(sizeof(const char*));
  series.records.push_back(scanner.record());
  ++branch_->states.back().variables;
}

/// Element databases repeat the ids in each state.
void BinoutIndex::compare_ids(const BinoutSeries& series, const LsdaScanner& scanner) {
  const LsdaLayout& layout = layouts_[series.runs.front().file];
  if (!same_numbers({lsda_variable(series.records.front(), layout), layout}, {scanner.variable(), scanner.layout()}))
    branch_->ids_change = std::min(branch_->ids_change, branch_->states.size() - 1);
}

/// Marks the states that a cut has left incomplete: the one that was being written, and the last ones that hold less
/// than those before them.
void BinoutIndex::drop_incomplete(bool open_directory, std::string& dropped) {
  for (BinoutBranch& branch : branches_) {
    if (!branch.open || branch.files != layouts_.size()) continue;
    branch.open = false;
    BinoutState& last = branch.states.back();
    const bool writing = open_directory && &branch == branch_ && !in_metadata_;
    const bool poorer = branch.states.size() > 1 && last.variables < branch.states.end()[-2].variables;
    if (!writing && !poorer && !std::isnan(last.time)) continue;
    dropped += fmt::format("{}{}/d{:06}", dropped.empty() ? "" : ", ", branch.path, last.number);
    last.number = BinoutState::kDropped;
  }
}

void BinoutIndex::finish_file(const LsdaEnd& end) {
  if (end.faults > 0)
    warnings_.push_back(fmt::format("{}: {} record{} without sense left out; the first: {}", file_->path(), end.faults,
                                    end.faults == 1 ? "" : "s", end.first_fault));
  if (end.problem.empty()) return;
  std::string dropped;
  drop_incomplete(end.open_directory, dropped);
  warnings_.push_back(fmt::format("{}: {}: the file is cut or its run was killed; {} bytes are lost{}{}", file_->path(),
                                  end.problem, end.lost_bytes,
                                  dropped.empty() ? "" : ", and the states they leave incomplete: ", dropped));
}

}  // namespace crashsim::io
