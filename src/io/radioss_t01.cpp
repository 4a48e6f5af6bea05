/// OpenRadioss time history, the binary file itself (`*T01`, /TFILE/3 and /TFILE/4).

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "io/radioss_t01_header.hpp"
#include "io/reader.hpp"
#include "io/unit_system.hpp"

namespace crashsim::io {
namespace {

constexpr std::size_t kWord = 4;
constexpr std::size_t kStatesAtOnce = 64;  // keeps the pieces written to a channel long and those read in the cache

/// Where things stand in a state; all states are alike.
class StateLayout {
 public:
  explicit StateLayout(const RadiossT01Header& header) : records_(header.state) {
    for (const RadiossT01Record& record : records_) {
      lengths_.push_back(bytes_);
      for (std::size_t i = 0; i < record.values; ++i) values_.push_back(bytes_ + kWord + i * kWord);
      bytes_ += record.values * kWord + 2 * kWord;
    }
  }

  [[nodiscard]] std::size_t bytes() const { return bytes_; }
  [[nodiscard]] std::size_t time() const { return values_.front(); }
  [[nodiscard]] std::size_t value(std::size_t trace) const { return values_[trace + 1]; }

  /// The first record whose lengths are not what they should be; none when the state is whole.
  [[nodiscard]] const RadiossT01Record* damaged_record(const char* state) const {
    for (std::size_t i = 0; i < records_.size(); ++i) {
      const std::size_t length = records_[i].values * kWord;
      const char* const record = state + lengths_[i];
      if (big_endian_word(record) != length || big_endian_word(record + kWord + length) != length) return &records_[i];
    }
    return nullptr;
  }

 private:
  const std::vector<RadiossT01Record>& records_;
  std::vector<std::size_t> lengths_;  // offsets of the records' first lengths
  std::vector<std::size_t> values_;   // offsets of time and of each trace
  std::size_t bytes_ = 0;
};

/// One channel on its way out of the states.
struct Column {
  std::size_t offset = 0;  ///< In a state.
  double to_si = 1.0;
  std::vector<double> values;
};

/// Reads the states of a file, all of them in one pass.
class StateReader {
 public:
  StateReader(const InputFile& file, const RadiossT01Header& header, double to_seconds)
      : path_(file.path()), header_(header), layout_(header), to_seconds_(to_seconds) {
    data_ = file.bytes().substr(header.bytes);
    whole_ = data_.size() / layout_.bytes();
    if (whole_ == 0)
      throw InvalidInput(fmt::format(
          "{}: byte {}: no whole state of {} bytes follows the header: the run wrote none, or the file is cut off",
          path_, header.bytes, layout_.bytes()));
  }

  [[nodiscard]] Column column(std::size_t trace, double to_si) const {
    Column column{layout_.value(trace), to_si, {}};
    column.values.reserve(whole_);
    return column;
  }

  /// The times of the states, and their values into the columns.
  std::vector<double> read(std::vector<Column>& columns) {
    times_.reserve(whole_);
    for (std::size_t state = 0; state < whole_; state += kStatesAtOnce) {
      find_usable(state, std::min(state + kStatesAtOnce, whole_));
      for (Column& column : columns) {
        column.values.resize(read_);
        for (const char* usable : usable_)
          column.values.push_back(big_endian_float(usable + column.offset) * column.to_si);
      }
      read_ = times_.size();
      if (damaged_at_ != kNowhere) break;
    }
    if (times_.empty())
      throw InvalidInput(fmt::format("{}: byte {}: no state has a time that is a number", path_, header_.bytes));
    return std::move(times_);
  }

  /// What a careful reader should know of the states.
  [[nodiscard]] std::vector<std::string> warnings() const {
    std::vector<std::string> warnings;
    const std::size_t end = whole_ * layout_.bytes();
    if (damaged_at_ != kNowhere) {
      warnings.push_back(fmt::format(
          "{}: byte {}: no state where state {} of about {} should be: the file is damaged there, and its last {} "
          "bytes are left out",
          path_, header_.bytes + damaged_at_, damaged_at_ / layout_.bytes() + 1, whole_, data_.size() - damaged_at_));
    } else if (end != data_.size()) {
      warnings.push_back(fmt::format(
          "{}: byte {}: the file ends within a state: the {} whole states are kept, {} of the next one's {} "
          "bytes are left out",
          path_, header_.bytes + end, whole_, data_.size() - end, layout_.bytes()));
    }
    if (replaced_ > 0)
      warnings.push_back(
          fmt::format("{}: byte {}: the run was restarted: {} state{} of an earlier run gave way to those "
                      "from there on",
                      path_, header_.bytes + first_restart_, replaced_, replaced_ == 1 ? "" : "s"));
    if (timeless_ > 0)
      warnings.push_back(fmt::format("{}: byte {}: {} with a time that is no number: left out", path_,
                                     header_.bytes + first_timeless_,
                                     timeless_ == 1 ? "a state" : fmt::format("{} states", timeless_)));
    return warnings;
  }

 private:
  static constexpr std::size_t kNowhere = std::string_view::npos;

  /// Notes the states of a block that can be used, and their times.
  void find_usable(std::size_t state, std::size_t end) {
    usable_.clear();
    for (; state < end; ++state) {
      const std::size_t at = state * layout_.bytes();
      const char* const bytes = data_.data() + at;
      if (const RadiossT01Record* damaged = layout_.damaged_record(bytes)) {
        if (state == 0)
          throw InvalidInput(
              fmt::format("{}: byte {}: the first state is not as the header says: no record of {} bytes for {}", path_,
                          header_.bytes, damaged->values * kWord, damaged->what));
        damaged_at_ = at;
        return;
      }
      const double time_s = big_endian_float(bytes + layout_.time()) * to_seconds_;
      if (!std::isfinite(time_s)) {
        if (timeless_++ == 0) first_timeless_ = at;
        continue;
      }
      if (!times_.empty() && time_s <= times_.back()) replace_from(time_s, at);
      times_.push_back(time_s);
      usable_.push_back(bytes);
    }
  }

  /// A restarted run computes the states from a time on anew: what it wrote last counts.
  void replace_from(double time_s, std::size_t at) {
    if (replaced_ == 0) first_restart_ = at;
    const auto first = std::lower_bound(times_.begin(), times_.end(), time_s);
    replaced_ += static_cast<std::size_t>(times_.end() - first);
    times_.erase(first, times_.end());
    read_ = std::min(read_, times_.size());
    usable_.resize(times_.size() - read_);
  }

  const std::string& path_;
  const RadiossT01Header& header_;
  StateLayout layout_;
  double to_seconds_;
  std::string_view data_;  // from the first state on
  std::size_t whole_ = 0;
  std::vector<double> times_;
  std::vector<const char*> usable_;  // states of this block that count
  std::size_t read_ = 0;             // states of the blocks before that count
  std::size_t damaged_at_ = kNowhere, replaced_ = 0, first_restart_ = 0, timeless_ = 0, first_timeless_ = 0;
};

/// The units asked for, else those the file says, else SI.
UnitSystem choose_units(const std::string& asked, const RadiossT01Header& header, TraceSet& set) {
  const UnitSystem units = asked.empty() && header.units ? *header.units : parse_unit_system(asked);
  if (header.units && *header.units != units)
    set.warnings.push_back(
        fmt::format("{}: units = {} is used, but the file says that its units are {:g} kg, {:g} m, {:g} s", set.path,
                    asked, header.units->mass_kg, header.units->length_m, header.units->time_s));
  return units;
}

bool detects(const InputFile& file) { return !file.is_folder() && is_radioss_t01(file.bytes()); }

TraceSet read(const InputFile& file, const ReadOptions& options, const Choose& choose) {
  RadiossT01Header header = read_radioss_t01_header(file.bytes(), file.path());
  TraceSet set;
  set.path = file.path();
  set.input_files = {file.path()};
  set.title = std::move(header.title);
  set.metadata = std::move(header.metadata);
  set.traces = std::move(header.traces);
  const UnitSystem units = choose_units(options.units, header, set);

  StateReader states(file, header, to_si(units, Dimension::time));
  const std::vector<std::size_t> chosen = choose(set);
  std::vector<Column> columns;
  for (const std::size_t i : chosen) columns.push_back(states.column(i, to_si(units, set.traces[i].dimension)));
  const auto time_s = std::make_shared<const std::vector<double>>(states.read(columns));
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    Trace& trace = set.traces[chosen[i]];
    trace.values = std::move(columns[i].values);
    trace.time_s = time_s;
    trace.has_samples = true;
  }
  for (std::string& warning : states.warnings()) set.warnings.push_back(std::move(warning));
  warn_when_implausible(set, units);
  return set;
}

}  // namespace

const Reader kRadiossT01Reader = {"radioss_t01", "OpenRadioss time history (T01)", detects, read};

}  // namespace crashsim::io
