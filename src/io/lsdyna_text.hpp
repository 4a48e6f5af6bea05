#pragma once
/// What the ASCII databases of LS-DYNA share: lines, Fortran's numbers, and the preamble with title and legend.

#include <span>
#include <string>
#include <string_view>
#include <unordered_map>

namespace crashsim::io {

/// The lines of a text that have their end: one that a killed run left without is not among them.
class CompleteLines {
 public:
  CompleteLines(std::string_view text, std::size_t offset) : text_(text), next_(offset) {}

  /// The next line, without its end; false when there is none.
  bool next(std::string_view& line);
  /// Where the last line starts in the text.
  [[nodiscard]] std::size_t offset() const { return offset_; }
  /// Where the next one does.
  [[nodiscard]] std::size_t position() const { return next_; }
  void move_to(std::size_t offset) { next_ = offset; }

 private:
  std::string_view text_;
  std::size_t offset_ = 0, next_ = 0;
};

/// Reads the number that a text starts with, as Fortran writes it: also "1.23450-101", whose exponent left no room for
/// its E. One that overflowed its field ("*****") or is not finite becomes NaN. Returns its length, 0 when there is
/// none.
std::size_t scan_fortran(std::string_view text, double& value);

/// Whether a text is one such number, with blanks around it.
bool is_fortran_number(std::string_view text, double& value);

/// Reads the numbers of a text, parted by blanks or only by the sign of the next. Returns how many there are; 0 when
/// there are more than fit or anything else is among them.
std::size_t scan_numbers(std::string_view text, std::span<double> numbers);

/// "hourglass_energy" for "Hourglass energy ..".
std::string snake_case(std::string_view label);

/// What stands before the states.
struct LsdynaHeader {
  std::string title, version, date;  ///< "" when absent.
  std::unordered_map<std::string_view, std::string_view> legend;

  /// "" when the entity has no title.
  [[nodiscard]] std::string_view title_of(std::string_view entity) const;
};

/// "ls-dyna smp d R13 ... date 07/28/2023", the second line of every file and of what a restarted run appends.
bool is_version_line(std::string_view line);

/// Where a legend that starts with this line ends in the text; npos when the line starts none, or it has no end before
/// the next legend or run.
std::size_t end_of_legend(std::string_view text, const CompleteLines& lines, std::string_view line);

/// Reads what stands in the text before `states`. The result refers to the text.
LsdynaHeader parse_lsdyna_header(std::string_view text, std::size_t states);

}  // namespace crashsim::io
