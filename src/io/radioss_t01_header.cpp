#include "io/radioss_t01_header.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "io/radioss_variables.hpp"
#include "io/reader.hpp"
#include "text.hpp"

namespace crashsim::io {
namespace {

constexpr std::size_t kWord = 4;
constexpr std::size_t kTitleRecord = 84, kDateRecord = 80, kCountsRecord = 24;
constexpr std::size_t kDateLength = 24;  // "Sun Nov 22 09:14:56 2026", the program follows
constexpr int kMostAdditionalRecords = 16;

int integer(std::string_view record, std::size_t at) {
  return std::bit_cast<std::int32_t>(big_endian_word(record.data() + at));
}

/// Walks over the records of the header.
class Records {
 public:
  Records(std::string_view bytes, const std::string& path) : bytes_(bytes), path_(path) {}

  [[nodiscard]] std::size_t offset() const { return at_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

  /// The next record, of `size` bytes. @throws InvalidInput
  std::string_view next(std::size_t size, std::string_view what) {
    const std::string_view record = next_of_any_size(what);
    if (record.size() != size)
      refuse(at_ - record.size() - 2 * kWord, what,
             fmt::format("a record of {} bytes where {} are expected", record.size(), size));
    return record;
  }
  /// The next record, of at least `size` bytes. @throws InvalidInput
  std::string_view next_from(std::size_t size, std::string_view what) {
    const std::string_view record = next_of_any_size(what);
    if (record.size() < size)
      refuse(at_ - record.size() - 2 * kWord, what,
             fmt::format("a record of {} bytes where at least {} are expected", record.size(), size));
    return record;
  }
  /// A list of so many integers; no record when there are none. @throws InvalidInput
  std::vector<int> integers(int count, std::string_view what) {
    std::vector<int> list;
    if (count == 0) return list;
    const std::string_view record = next(static_cast<std::size_t>(count) * kWord, what);
    for (std::size_t at = 0; at < record.size(); at += kWord) list.push_back(integer(record, at));
    return list;
  }
  /// A count in a record. @throws InvalidInput when it is negative.
  int count(std::string_view record, std::size_t at, std::string_view what) const {
    const int value = integer(record, at);
    if (value < 0) refuse(at_ - record.size() - kWord + at, what, fmt::format("a count of {}", value));
    return value;
  }
  [[noreturn]] void refuse(std::size_t at, std::string_view what, std::string_view problem) const {
    throw InvalidInput(fmt::format("{}: byte {}: {}: {}: the file is damaged or no OpenRadioss time history", path_, at,
                                   what, problem));
  }

 private:
  std::string_view next_of_any_size(std::string_view what) {
    if (left() < kWord) end_of_file(what);
    const std::size_t size = big_endian_word(bytes_.data() + at_);
    if (left() < 2 * kWord || size > left() - 2 * kWord) end_of_file(what);
    if (big_endian_word(bytes_.data() + at_ + kWord + size) != size)
      refuse(at_, what, fmt::format("the lengths around a record of {} bytes differ", size));
    const std::string_view record = bytes_.substr(at_ + kWord, size);
    at_ += size + 2 * kWord;
    return record;
  }
  [[noreturn]] void end_of_file(std::string_view what) const {
    throw InvalidInput(
        fmt::format("{}: byte {}: the file ends within its header ({}): it is cut off or damaged", path_, at_, what));
  }

  std::string_view bytes_;
  const std::string& path_;
  std::size_t at_ = 0;
};

/// The decimal that was meant by a number in single precision: 0.001, not 0.0010000000474974513.
double decimal_of(float value) {
  char text[32];
  const char* const end = std::to_chars(std::begin(text), std::end(text), value).ptr;
  double decimal = value;
  std::from_chars(text, end, decimal);
  return decimal;
}

std::optional<UnitSystem> units_in(std::string_view record) {
  const auto number = [&](std::size_t i) { return decimal_of(big_endian_float(record.data() + i * kWord)); };
  const UnitSystem units{number(0), number(1), number(2)};
  for (const double unit : {units.mass_kg, units.length_m, units.time_s})
    if (!std::isfinite(unit) || !(unit > 0.0)) return std::nullopt;
  return units;
}

/// Builds the header from its records.
class Parser {
 public:
  Parser(std::string_view bytes, const std::string& path)
      : records_(bytes, path), most_channels_(most_channels(bytes.size())) {}

  RadiossT01Header parse() {
    read_run();
    const std::string_view counts = read_counts();
    const auto count = [&](std::size_t i) { return records_.count(counts, i * kWord, "counts"); };
    const int parts = count(0), materials = count(1), properties = count(2), subsets = count(3), groups = count(4);
    header_.state.push_back({"time", 1});
    read_global(count(5));
    read_parts(parts);
    read_titles(materials, "MATERIAL");
    read_titles(properties, "PROPERTY");
    read_subsets(subsets);
    for (int i = 0; i < groups; ++i) read_group();
    header_.bytes = records_.offset();
    return std::move(header_);
  }

 private:
  void say(std::string key, std::string value) { header_.metadata.emplace_back(std::move(key), std::move(value)); }

  /// @throws InvalidInput when so many more channels do not fit memory.
  void check_room(std::size_t more, std::string_view what) const {
    if (header_.traces.size() + more > most_channels_)
      records_.refuse(records_.offset(), what,
                      fmt::format("with its {} the file has more channels than fit memory ({})", more, most_channels_));
  }

  void add(const std::string& entity, RadiossVariable variable, std::size_t order) {
    const std::string name = variable.name.empty() ? fmt::format("var{}", order) : std::string(variable.name);
    header_.traces.push_back(radioss_trace(entity, name, variable.dimension, header_.traces.size() + 2));
  }

  /// A record of a state; empty ones are not written.
  void add_record(std::string what, std::size_t values) {
    if (values > 0) header_.state.push_back({std::move(what), values});
  }

  void read_run() {
    const std::string_view title = records_.next(kTitleRecord, "title");
    header_.title = with_single_blanks(title.substr(kWord));
    const std::string_view date = records_.next(kDateRecord, "date and program");
    say("DATE", with_single_blanks(date.substr(0, kDateLength)));
    say("PROGRAM", with_single_blanks(date.substr(kDateLength)));
    say("FORMAT", std::to_string(integer(title, 0)));
  }

  /// Between date and counts newer versions say how many records follow, the length of titles, and the units.
  std::string_view read_counts() {
    const std::string_view first = records_.next_from(kWord, "counts");
    if (first.size() == kCountsRecord) return first;
    const int additional = first.size() == kWord ? integer(first, 0) : -1;
    if (additional < 0 || additional > kMostAdditionalRecords)
      records_.refuse(records_.offset() - first.size(), "counts",
                      fmt::format("a record of {} bytes where {} are expected", first.size(), kCountsRecord));
    for (int i = 0; i < additional; ++i) {
      const std::string_view record = records_.next_from(0, "additional record");
      if (record.size() == 3 * kWord) header_.units = units_in(record);
    }
    if (header_.units)
      say("UNITS", fmt::format("{:g} kg, {:g} m, {:g} s", header_.units->mass_kg, header_.units->length_m,
                               header_.units->time_s));
    return records_.next(kCountsRecord, "counts");
  }

  void read_global(int count) {
    const std::vector<int> codes = records_.integers(count, "codes of global variables");
    check_room(codes.size(), "global variables");
    for (std::size_t i = 0; i < codes.size(); ++i) add("", radioss_global_variable(codes[i]), i + 1);
    add_record("global variables", codes.size());
  }

  /// The variables of a part or subset. @returns how many
  std::size_t read_part_variables(const std::string& entity, int count, std::string_view what) {
    const std::vector<int> codes = records_.integers(count, what);
    check_room(codes.size(), what);
    for (std::size_t i = 0; i < codes.size(); ++i) add(entity, radioss_part_variable(codes[i]), i + 1);
    return codes.size();
  }

  void read_parts(int count) {
    std::size_t values = 0;
    for (int i = 0; i < count; ++i) {
      const std::string what = fmt::format("part {} of {}", i + 1, count);
      const std::string_view record = records_.next_from(5 * kWord, what);
      const int id = integer(record, 0);
      const std::string title(trimmed(record.substr(kWord, record.size() - 5 * kWord)));
      say(fmt::format("PART[{}]", id), title);
      values += read_part_variables(title.empty() ? std::to_string(id) : title,
                                    records_.count(record, record.size() - kWord, what), what);
    }
    add_record("variables of parts", values);
  }

  void read_titles(int count, std::string_view kind) {
    for (int i = 0; i < count; ++i) {
      const std::string_view record = records_.next_from(kWord, kind);
      say(fmt::format("{}[{}]", kind, integer(record, 0)), with_single_blanks(record.substr(kWord)));
    }
  }

  void read_subsets(int count) {
    std::size_t values = 0;
    for (int i = 0; i < count; ++i) {
      const std::string what = fmt::format("subset {} of {}", i + 1, count);
      const std::string_view record = records_.next_from(5 * kWord, what);
      const int id = integer(record, 0);
      const std::string title(trimmed(record.substr(5 * kWord)));
      const int children = records_.count(record, 2 * kWord, what), parts = records_.count(record, 3 * kWord, what);
      const int variables = records_.count(record, 4 * kWord, what);
      say(fmt::format("SUBSET[{}]", id), title);
      records_.integers(children, what);
      records_.integers(parts, what);
      values += read_part_variables(title.empty() ? std::to_string(id) : title, variables, what);
    }
    add_record("variables of subsets", values);
  }

  void read_group() {
    const std::string_view record = records_.next_from(5 * kWord, "time-history group");
    const std::string title = with_single_blanks(record.substr(5 * kWord));
    const std::string what = fmt::format("group '{}'", title);
    const int kind = integer(record, kWord);
    const int count = records_.count(record, 3 * kWord, what), variables = records_.count(record, 4 * kWord, what);
    say(fmt::format("GROUP[{}]", integer(record, 0)), title);
    std::vector<std::string> entities;
    for (int i = 0; i < count; ++i) {
      const std::string_view entity = records_.next_from(kWord, what);
      const std::string name = with_single_blanks(entity.substr(kWord));
      entities.push_back(name.empty() ? std::to_string(integer(entity, 0)) : name);
    }
    const std::vector<int> codes = records_.integers(variables, what);
    if (!codes.empty() && entities.size() > records_.left() / kWord / codes.size())
      records_.refuse(records_.offset(), what,
                      fmt::format("a state of {} entities with {} variables is larger than the rest of the file",
                                  entities.size(), codes.size()));
    check_room(entities.size() * codes.size(), what);
    for (const std::string& entity : entities)
      for (std::size_t i = 0; i < codes.size(); ++i) add(entity, radioss_group_variable(kind, codes[i]), i + 1);
    add_record(what, entities.size() * codes.size());
  }

  Records records_;
  std::size_t most_channels_;
  RadiossT01Header header_;
};

}  // namespace

bool is_radioss_t01(std::string_view bytes) {
  constexpr std::size_t kDate = kTitleRecord + 2 * kWord;
  if (bytes.size() < kDate + kWord) return false;
  const char* const start = bytes.data();
  return big_endian_word(start) == kTitleRecord && big_endian_word(start + kDate - kWord) == kTitleRecord &&
         big_endian_word(start + kDate) == kDateRecord;
}

RadiossT01Header read_radioss_t01_header(std::string_view bytes, const std::string& path) {
  return Parser(bytes, path).parse();
}

}  // namespace crashsim::io
