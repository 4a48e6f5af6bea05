#pragma once
/// The container of LS-DYNA's binout: LSDA, a tree of directories with typed variables, written as a list of records.
///
/// A file is a header of eight bytes (sizes of the fields below, order of bytes) and records, each with its length in
/// bytes (of the whole record), a command and data. Variables follow the change to their directory; symbol tables,
/// written whenever the program saves its work, repeat where they are and are not needed to read them.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "io/input_file.hpp"

namespace crashsim::io {

enum class LsdaType : std::uint8_t { i1 = 1, i2, i4, i8, u1, u2, u4, u8, r4, r8, link };

/// Bytes of one value.
std::size_t size_of(LsdaType type);

/// How a file writes its records: sizes of their fields [bytes] and order of bytes.
struct LsdaLayout {
  std::size_t header = 8, length = 8, offset = 8, command = 1, type = 1;
  bool swapped = false;  ///< Whether its numbers have another order of bytes than this machine's.
};

/// A variable as it lies in its file.
struct LsdaVariable {
  std::string_view name;
  LsdaType type = LsdaType::i1;
  std::size_t count = 0;         ///< Number of values.
  const char* values = nullptr;  ///< Not aligned.
};

/// Whether a file begins as LSDA does: with a legal header and the record that leads to the symbol tables.
bool is_lsda(std::string_view bytes);

/// The variable of a record that LsdaScanner has found.
LsdaVariable lsda_variable(const char* record, const LsdaLayout& layout);

/// Values [first, first + count) of a variable. Integers beyond 2^53 are rounded.
void decode(const LsdaVariable& variable, const LsdaLayout& layout, std::size_t first, std::size_t count, double* out);

/// Where and why the records of a file end.
struct LsdaEnd {
  std::string problem;          ///< What is wrong with the file's end, "" when it is whole.
  bool open_directory = false;  ///< Whether it ends among the variables of a directory: others may be missing.
  std::size_t lost_bytes = 0;   ///< Behind the last whole record.
  std::size_t faults = 0;       ///< Records passed over because they make no sense.
  std::string first_fault;      ///< What the first of them is.
};

/// Goes through the variables of a file, in the order in which they were written.
class LsdaScanner {
 public:
  /// @throws InvalidInput when the header is not that of an LSDA file.
  explicit LsdaScanner(const InputFile& file);

  /// Goes to the next variable; false at the end of what can be read.
  bool next();

  /// Directory of the variable: "/nodout/d000001".
  [[nodiscard]] const std::string& directory() const { return directory_; }
  /// Another number for each change of the directory.
  [[nodiscard]] std::size_t directory_number() const { return directory_number_; }
  [[nodiscard]] const LsdaVariable& variable() const { return variable_; }
  /// Where the variable's record is, for lsda_variable().
  [[nodiscard]] const char* record() const { return bytes_.data() + record_; }
  [[nodiscard]] const LsdaLayout& layout() const { return layout_; }
  /// Valid once next() has returned false.
  [[nodiscard]] const LsdaEnd& end() const { return end_; }

 private:
  bool begin_record();
  bool stop(std::string problem);
  bool finish();
  bool change_directory(std::string_view path);
  bool read_variable();
  void read_symbol_table();
  void note_fault(std::string_view what);
  [[nodiscard]] std::uint64_t number(std::size_t at, std::size_t size) const;

  std::string_view bytes_;
  LsdaLayout layout_;
  std::size_t at_ = 0;      // where the next record begins
  std::size_t record_ = 0;  // where the present one does
  std::uint64_t length_ = 0, command_ = 0;
  std::uint64_t next_table_ = 0;  // where the next symbol table should be; 0 when there is none
  bool unsaved_ = false;          // whether variables follow the last symbol table
  std::string directory_ = "/";
  std::size_t directory_number_ = 1;
  LsdaVariable variable_;
  LsdaEnd end_;
};

}  // namespace crashsim::io
