#include "io/lsda.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include <crashsim/error.hpp>

namespace crashsim::io {
namespace {

enum Command : std::uint64_t { null = 1, cd, data, variable_entry, begin_table, end_table, table_offset };

constexpr std::size_t kHeader = 8;
constexpr std::size_t kLongestPath = 1024;
template <class Bits>
Bits reversed(Bits bits) {
  if constexpr (sizeof(Bits) == 8) return __builtin_bswap64(bits);
  if constexpr (sizeof(Bits) == 4) return __builtin_bswap32(bits);
  if constexpr (sizeof(Bits) == 2) return __builtin_bswap16(bits);
  return bits;
}

template <class Bits>
Bits load(const char* p, bool swapped) {
  Bits bits;
  std::memcpy(&bits, p, sizeof bits);
  return swapped ? reversed(bits) : bits;
}

std::uint64_t load_unsigned(const char* p, std::size_t size, bool swapped) {
  switch (size) {
    case 1:
      return load<std::uint8_t>(p, swapped);
    case 2:
      return load<std::uint16_t>(p, swapped);
    case 4:
      return load<std::uint32_t>(p, swapped);
    default:
      return load<std::uint64_t>(p, swapped);
  }
}

template <class Value, class Bits>
void decode_as(const char* p, bool swapped, std::size_t count, double* out) {
  const auto all = [&](auto swap) {
    for (std::size_t i = 0; i < count; ++i)
      out[i] = static_cast<double>(std::bit_cast<Value>(load<Bits>(p + i * sizeof(Bits), swap)));
  };
  swapped ? all(std::true_type{}) : all(std::false_type{});
}

/// What is wrong with a header, "" when it is that of an LSDA file.
std::string header_problem(std::string_view bytes) {
  if (bytes.size() < kHeader) return fmt::format("has {} bytes, fewer than the header's 8", bytes.size());
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  if (byte(0) < kHeader) return fmt::format("header of {} bytes: must be at least 8", byte(0));
  constexpr const char* kFields[] = {"", "length", "offset", "command", "type"};
  for (std::size_t i = 1; i <= 4; ++i)
    if (!std::has_single_bit(byte(i)) || byte(i) > 8)
      return fmt::format("header: {} fields of {} bytes: must be 1, 2, 4 or 8", kFields[i], byte(i));
  if (byte(5) > 1)
    return fmt::format("header: order of bytes {}: must be 0 (big-endian) or 1 (little-endian)", byte(5));
  if (byte(6) != 0) return fmt::format("header: format of floating-point numbers {}: must be 0 (IEEE)", byte(6));
  return "";
}

/// Layout by a header without problem.
LsdaLayout layout_of(std::string_view bytes) {
  const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(bytes[i])); };
  const bool little = byte(5) == 1;
  return {byte(0), byte(1), byte(2), byte(3), byte(4), little != (std::endian::native == std::endian::little)};
}

/// What is wrong with the beginning of a file: its header and the record behind it.
std::string beginning_problem(std::string_view bytes) {
  if (std::string problem = header_problem(bytes); !problem.empty()) return problem;
  const LsdaLayout l = layout_of(bytes);
  const std::size_t length = l.length + l.command + l.offset;
  if (bytes.size() < l.header + length) return fmt::format("ends at byte {}, in its first record", bytes.size());
  const char* const record = bytes.data() + l.header;
  if (load_unsigned(record, l.length, l.swapped) != length ||
      load_unsigned(record + l.length, l.command, l.swapped) != Command::table_offset)
    return fmt::format("byte {}: the first record does not lead to a symbol table", l.header);
  return "";
}

bool is_name(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~' && c != '/'; });
}

}  // namespace

std::size_t size_of(LsdaType type) {
  constexpr std::size_t kSizes[] = {0, 1, 2, 4, 8, 1, 2, 4, 8, 4, 8, 1};
  return kSizes[static_cast<std::size_t>(type)];
}

bool is_lsda(std::string_view bytes) { return beginning_problem(bytes).empty(); }

LsdaVariable lsda_variable(const char* record, const LsdaLayout& l) {
  const auto length = static_cast<std::size_t>(load_unsigned(record, l.length, l.swapped));
  const char* const type = record + l.length + l.command;
  const char* const name = type + l.type + 1;
  LsdaVariable variable;
  variable.type = static_cast<LsdaType>(load_unsigned(type, l.type, l.swapped));
  variable.name = {name, static_cast<unsigned char>(name[-1])};
  variable.values = name + variable.name.size();
  variable.count = static_cast<std::size_t>(record + length - variable.values) / size_of(variable.type);
  return variable;
}

void decode(const LsdaVariable& variable, const LsdaLayout& layout, std::size_t first, std::size_t count, double* out) {
  const char* const p = variable.values + first * size_of(variable.type);
  switch (variable.type) {
    case LsdaType::i1:
      return decode_as<std::int8_t, std::uint8_t>(p, layout.swapped, count, out);
    case LsdaType::i2:
      return decode_as<std::int16_t, std::uint16_t>(p, layout.swapped, count, out);
    case LsdaType::i4:
      return decode_as<std::int32_t, std::uint32_t>(p, layout.swapped, count, out);
    case LsdaType::i8:
      return decode_as<std::int64_t, std::uint64_t>(p, layout.swapped, count, out);
    case LsdaType::u1:
    case LsdaType::link:
      return decode_as<std::uint8_t, std::uint8_t>(p, layout.swapped, count, out);
    case LsdaType::u2:
      return decode_as<std::uint16_t, std::uint16_t>(p, layout.swapped, count, out);
    case LsdaType::u4:
      return decode_as<std::uint32_t, std::uint32_t>(p, layout.swapped, count, out);
    case LsdaType::u8:
      return decode_as<std::uint64_t, std::uint64_t>(p, layout.swapped, count, out);
    case LsdaType::r4:
      return decode_as<float, std::uint32_t>(p, layout.swapped, count, out);
    case LsdaType::r8:
      return decode_as<double, std::uint64_t>(p, layout.swapped, count, out);
  }
}

LsdaScanner::LsdaScanner(const InputFile& file) : bytes_(file.bytes()) {
  if (const std::string problem = beginning_problem(bytes_); !problem.empty())
    throw InvalidInput(fmt::format("{}: not an LSDA file (binout): {}", file.path(), problem));
  layout_ = layout_of(bytes_);
  at_ = layout_.header;
}

std::uint64_t LsdaScanner::number(std::size_t at, std::size_t size) const {
  return load_unsigned(bytes_.data() + at, size, layout_.swapped);
}

bool LsdaScanner::stop(std::string problem) {
  end_.problem = std::move(problem);
  end_.lost_bytes = bytes_.size() - at_;
  at_ = bytes_.size();
  return false;
}

bool LsdaScanner::finish() {
  if (!end_.problem.empty()) return false;
  if (next_table_ != 0)
    return stop(fmt::format("ends at byte {}, before the symbol table that belongs to byte {}", at_, next_table_));
  if (unsaved_) return stop(fmt::format("ends at byte {} without a symbol table", at_));
  return false;
}

/// Reads the length and command of the record at `at_` and goes behind it; false at the end.
bool LsdaScanner::begin_record() {
  const std::size_t left = bytes_.size() - at_;
  if (left == 0) return finish();
  const std::size_t fields = layout_.length + layout_.command;
  if (left < fields) return stop(fmt::format("ends at byte {}, in a record", bytes_.size()));
  record_ = at_;
  length_ = number(at_, layout_.length);
  command_ = number(at_ + layout_.length, layout_.command);
  if (command_ < Command::null || command_ > Command::table_offset)
    return stop(fmt::format("byte {}: a record of command {}, which LSDA has not", at_, command_));
  if (command_ == Command::cd || command_ == Command::begin_table) end_.open_directory = false;
  if (length_ > left)
    return stop(fmt::format("byte {}: a record of {} bytes where the file has {} more", at_, length_, left));
  if (length_ < fields) return stop(fmt::format("byte {}: a record of {} bytes", at_, length_));
  at_ += static_cast<std::size_t>(length_);
  return true;
}

bool LsdaScanner::next() {
  const std::size_t fields = layout_.length + layout_.command;
  while (begin_record()) {
    const std::string_view body = bytes_.substr(record_ + fields, at_ - record_ - fields);
    switch (command_) {
      case Command::cd:
        if (!change_directory(body)) return false;
        break;
      case Command::data:
        unsaved_ = end_.open_directory = true;
        if (read_variable()) return true;
        break;
      case Command::begin_table:
        read_symbol_table();
        break;
      case Command::table_offset:
        if (body.size() >= layout_.offset) next_table_ = number(record_ + fields, layout_.offset);
        break;
      case Command::null:
        break;
      default:
        return stop(fmt::format("byte {}: a record of command {} outside of a symbol table", record_, command_));
    }
  }
  return false;
}

bool LsdaScanner::change_directory(std::string_view path) {
  if (path.starts_with('/') || directory_ == "/") directory_.clear();
  while (!path.empty()) {
    const std::size_t slash = std::min(path.find('/'), path.size());
    const std::string_view part = path.substr(0, slash);
    path.remove_prefix(std::min(slash + 1, path.size()));
    if (part == "..") {
      directory_.resize(directory_.empty() ? 0 : directory_.rfind('/'));
    } else if (!part.empty() && part != ".") {
      directory_ += '/';
      directory_ += part;
    }
    if (directory_.size() > kLongestPath)
      return stop(fmt::format("byte {}: a directory's path of more than {} characters", record_, kLongestPath));
  }
  if (directory_.empty()) directory_.assign(1, '/');
  ++directory_number_;
  return true;
}

void LsdaScanner::note_fault(std::string_view what) {
  if (end_.faults++ == 0) end_.first_fault = fmt::format("byte {}: {}", record_, what);
}

/// False for a variable to pass over.
bool LsdaScanner::read_variable() {
  const std::size_t fields = layout_.length + layout_.command + layout_.type + 1;
  const std::size_t length = at_ - record_;
  if (length < fields) return note_fault("a variable without a name"), false;
  const std::uint64_t type = number(record_ + fields - 1 - layout_.type, layout_.type);
  const std::size_t name = static_cast<unsigned char>(bytes_[record_ + fields - 1]);
  if (name == 0) return note_fault("a variable without a name"), false;
  if (name > length - fields) return note_fault("a variable's name longer than its record"), false;
  if (!is_name(bytes_.substr(record_ + fields, name))) return note_fault("a variable's name is no text"), false;
  if (type == 0 || type > static_cast<std::uint64_t>(LsdaType::link))
    return note_fault(
               fmt::format("variable {} of type {}, which LSDA has not", bytes_.substr(record_ + fields, name), type)),
           false;
  if ((length - fields - name) % size_of(static_cast<LsdaType>(type)) != 0)
    return note_fault(fmt::format("variable {} of {} bytes, no whole number of values",
                                  bytes_.substr(record_ + fields, name), length - fields - name)),
           false;
  if (type == static_cast<std::uint64_t>(LsdaType::link)) return false;
  variable_ = lsda_variable(record(), layout_);
  return true;
}

/// Only its last record matters: where the next table is.
void LsdaScanner::read_symbol_table() {
  unsaved_ = false;
  next_table_ = 0;
  const std::size_t last = layout_.length + layout_.command + layout_.offset;
  if (at_ - record_ < 2 * layout_.length + 2 * layout_.command + layout_.offset) return;
  if (number(at_ - last, layout_.length) != last) return;
  if (number(at_ - last + layout_.length, layout_.command) == Command::end_table)
    next_table_ = number(at_ - layout_.offset, layout_.offset);
}

}  // namespace crashsim::io
