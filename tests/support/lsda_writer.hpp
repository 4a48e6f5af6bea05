#pragma once
/// LSDA files (LS-DYNA's binout) as LS-DYNA writes them, to read and to spoil: any size of fields, either order of
/// bytes.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace crashsim::test {

/// Sizes of the fields of records [bytes] and order of bytes.
struct LsdaFormat {
  unsigned length = 8, offset = 8, command = 1, type = 1;
  bool big_endian = false;
};

/// Number of a C++ type among LSDA's.
template <class T>
constexpr unsigned lsda_type() {
  if constexpr (std::is_same_v<T, char>) return 1;
  if constexpr (std::is_same_v<T, float>) return 9;
  if constexpr (std::is_same_v<T, double>) return 10;
  constexpr unsigned kLog2[] = {0, 1, 2, 0, 3, 0, 0, 0, 4};
  return kLog2[sizeof(T)] + (std::is_signed_v<T> ? 0 : 4);
}

class LsdaWriter {
 public:
  explicit LsdaWriter(LsdaFormat format = {}) : format_(format) {
    bytes_ = {8,
              static_cast<char>(format.length),
              static_cast<char>(format.offset),
              static_cast<char>(format.command),
              static_cast<char>(format.type),
              static_cast<char>(format.big_endian ? 0 : 1),
              0,
              0};
    begin_record(7, format.offset);
    link_ = bytes_.size();
    append(0, format.offset);
  }

  /// Goes to a directory, absolute or relative.
  void cd(std::string_view path) {
    begin_record(2, path.size());
    bytes_ += path;
    if (path.front() == '/') directory_.clear();
    directory_ += path;
  }

  template <class T>
  void write(std::string_view name, const std::vector<T>& values) {
    entries_.push_back({directory_, std::string(name), lsda_type<T>(), bytes_.size(), values.size()});
    begin_record(3, format_.type + 1 + name.size() + values.size() * sizeof(T));
    append(lsda_type<T>(), format_.type);
    append(name.size(), 1);
    bytes_ += name;
    for (const T value : values) append_value(value);
  }
  template <class T>
  requires std::is_arithmetic_v<T>
  void write(std::string_view name, T value) { write(name, std::vector<T>{value}); }
  /// Text, filled with blanks.
  void write(std::string_view name, std::string text, std::size_t width) {
    text.resize(width, ' ');
    write(name, std::vector<char>(text.begin(), text.end()));
  }

  /// A record as it is told, right or wrong.
  void write_record(unsigned command, std::string_view body) {
    begin_record(command, body.size());
    bytes_ += body;
  }

  /// Writes the symbol table of what has been written since the last one: LS-DYNA does after each output. The paths of
  /// directories must be absolute for other readers to understand it.
  void save() {
    const std::size_t begin = bytes_.size();
    begin_record(5, 0);
    std::string directory;
    for (const Entry& entry : entries_) {
      if (entry.directory != directory) begin_record(2, entry.directory.size()), bytes_ += entry.directory;
      directory = entry.directory;
      begin_record(4, entry.name.size() + format_.type + format_.offset + format_.length);
      bytes_ += entry.name;
      append(entry.type, format_.type);
      append(entry.at, format_.offset);
      append(entry.count, format_.length);
    }
    begin_record(6, format_.offset);
    overwrite(link_, begin, format_.offset);
    link_ = bytes_.size();
    append(0, format_.offset);
    overwrite(begin, bytes_.size() - begin, format_.length);
    entries_.clear();
  }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  [[nodiscard]] std::string& bytes() { return bytes_; }

 private:
  struct Entry {
    std::string directory, name;
    unsigned type = 0;
    std::size_t at = 0, count = 0;
  };

  void begin_record(unsigned command, std::size_t body) {
    append(format_.length + format_.command + body, format_.length);
    append(command, format_.command);
  }
  [[nodiscard]] std::string number(std::uint64_t value, std::size_t size) const {
    std::string text(size, '\0');
    for (std::size_t i = 0; i < size; ++i)
      text[format_.big_endian ? size - 1 - i : i] = static_cast<char>(value >> (8 * i) & 0xff);
    return text;
  }
  void append(std::uint64_t value, std::size_t size) { bytes_ += number(value, size); }
  void overwrite(std::size_t at, std::uint64_t value, std::size_t size) {
    bytes_.replace(at, size, number(value, size));
  }
  template <class T>
  void append_value(T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (format_.big_endian != (std::endian::native == std::endian::big)) std::reverse(raw, raw + sizeof(T));
    bytes_.append(raw, sizeof(T));
  }

  LsdaFormat format_;
  std::string bytes_, directory_ = "/";
  std::size_t link_ = 0;  // where the offset of the next symbol table goes
  std::vector<Entry> entries_;
};

}  // namespace crashsim::test
