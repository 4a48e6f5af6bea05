#include "io/csv_layout.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/units.hpp>

#include "io/reader.hpp"
#include "number.hpp"
#include "text.hpp"

namespace crashsim::io {
namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
constexpr std::size_t kLinesBeforeNumbers = 1000;
constexpr std::size_t kBinarySample = 4096;

/// Walks over a text line by line; lines come without their end.
class Lines {
 public:
  Lines(std::string_view text, std::size_t offset, std::size_t number) : text_(text), next_(offset), number_(number) {}
  bool next() {
    if (next_ >= text_.size()) return false;
    offset_ = next_;
    const std::size_t end = std::min(text_.find('\n', offset_), text_.size());
    line_ = text_.substr(offset_, end - offset_);
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    next_ = end + 1;
    ++number_;
    return true;
  }
  [[nodiscard]] std::string_view line() const { return line_; }
  [[nodiscard]] std::size_t offset() const { return offset_; }
  [[nodiscard]] std::size_t number() const { return number_; }

 private:
  std::string_view text_, line_;
  std::size_t next_, offset_ = 0, number_;
};

bool is_comment(std::string_view line) {
  const std::string_view text = trimmed(line);
  return text.starts_with('#') || text.starts_with('%') || text.starts_with("//");
}

/// LS-PrePost ends each curve that it saves so.
bool is_end_of_curve(std::string_view line) { return same_ignoring_case(trimmed(line), "endcurve"); }

std::string_view without_mark(std::string_view comment) {
  return comment.substr(std::min(comment.find_first_not_of("#%/ \t"), comment.size()));
}

std::optional<std::pair<std::string, std::string>> key_and_value(std::string_view comment) {
  const std::string_view text = without_mark(comment);
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return std::nullopt;
  return std::pair(std::string(trimmed(text.substr(0, equals))), std::string(trimmed(text.substr(equals + 1))));
}

bool is_separator(char c, char separator) { return separator == ' ' ? is_blank(c) : c == separator; }

/// Takes the next cell off a line: without blanks and quotes around it.
std::string_view take_cell(std::string_view& line, char separator) {
  const auto skip_blanks = [&] {
    while (!line.empty() && is_blank(line.front()) && (separator == ' ' || line.front() != separator))
      line.remove_prefix(1);
  };
  skip_blanks();
  std::string_view cell;
  if (line.starts_with('"')) {
    const std::size_t end = std::min(line.find('"', 1), line.size());
    cell = line.substr(1, end - 1);
    line.remove_prefix(std::min(end + 1, line.size()));
    skip_blanks();
  }
  std::size_t end = 0;
  while (end < line.size() && !is_separator(line[end], separator)) ++end;
  if (cell.empty()) cell = line.substr(0, end);
  line.remove_prefix(end);
  return trimmed(cell);
}

/// Takes the separator after a cell; false at the end of the line.
bool take_separator(std::string_view& line, char separator) {
  if (separator == ' ') return !(line = trimmed(line)).empty();
  if (line.empty()) return false;
  line.remove_prefix(1);
  return true;
}

/// The first cells of a line, no more than `most`.
std::vector<std::string_view> split_cells(std::string_view line, char separator, std::size_t most) {
  std::vector<std::string_view> cells;
  line = separator == ' ' ? trimmed(line) : line;
  do cells.push_back(take_cell(line, separator));
  while (take_separator(line, separator) && cells.size() < most);
  return cells;
}

std::size_t count_cells(std::string_view line, char separator) {
  std::size_t count = 0;
  line = separator == ' ' ? trimmed(line) : line;
  do {
    take_cell(line, separator);
    ++count;
  } while (take_separator(line, separator));
  return count;
}

/// The number in a cell: empty cells are NaN, and unless ',' separates it may be the decimal mark.
std::optional<double> cell_number(std::string_view cell, char separator) {
  if (cell.empty()) return std::nan("");
  if (separator == ',' || cell.find(',') == std::string_view::npos) return parse_number(cell);
  std::string with_point(cell);
  std::replace(with_point.begin(), with_point.end(), ',', '.');
  return parse_number(with_point);
}

/// The separator that makes a row of at least two numbers of a line.
std::optional<char> separator_of_numbers(std::string_view line, std::size_t most) {
  for (const char separator : {';', '\t', ',', ' '}) {
    if (separator != ' ' && line.find(separator) == std::string_view::npos) continue;
    const auto cells = split_cells(line, separator, most);
    const auto is_number = [&](std::string_view cell) { return cell_number(cell, separator).has_value(); };
    if (cells.size() < 2 || cells.front().empty()) continue;
    if (std::all_of(cells.begin(), cells.end(), is_number)) return separator;
    if (separator != ',' && separator != ' ') return std::nullopt;
  }
  return std::nullopt;
}

struct TextLine {
  std::string_view text;
  std::size_t number;
};

/// Cells of a header; none when they do not fit the numbers.
std::vector<std::string> header_cells(const TextLine& line, const CsvLayout& layout, std::size_t most) {
  auto cells = split_cells(line.text, layout.separator, most);
  while (cells.size() > layout.columns && cells.back().empty()) cells.pop_back();
  if (cells.size() != layout.columns) return {};
  return {cells.begin(), cells.end()};
}

std::string without_brackets(const std::string& cell) {
  const bool bracketed = cell.size() > 2 && (cell.front() == '[' || cell.front() == '(');
  return bracketed ? cell.substr(1, cell.size() - 2) : cell;
}

bool are_units(const std::vector<std::string>& cells) {
  const auto is_unit = [](const std::string& cell) { return find_unit(without_brackets(cell)).has_value(); };
  return std::any_of(cells.begin(), cells.end(), is_unit) &&
         std::all_of(cells.begin(), cells.end(), [&](const std::string& c) { return c.empty() || is_unit(c); });
}

/// Names, and units where a row of them stands under the names, from the lines before the numbers: the last that are
/// no comments, or else the last comment where it has as many cells.
void find_header(const std::vector<TextLine>& before, std::string_view last_comment, std::size_t most,
                 CsvLayout& layout) {
  if (before.empty()) {
    layout.names = header_cells({without_mark(last_comment), 0}, layout, most);
    return;
  }
  layout.names = header_cells(before.back(), layout, most);
  if (layout.names.empty()) {
    layout.odd_line = before.back().number;
    const auto cells = split_cells(before.back().text, layout.separator, most);
    layout.odd_names.assign(cells.begin(), cells.end());
    return;
  }
  if (before.size() < 2 || !are_units(layout.names)) return;
  const auto names = header_cells(before[before.size() - 2], layout, most);
  if (names.empty()) return;
  layout.units = std::exchange(layout.names, names);
  std::transform(layout.units.begin(), layout.units.end(), layout.units.begin(), without_brackets);
}

[[noreturn]] void refuse_row(const std::string& path, std::size_t line, std::string_view row, const CsvLayout& layout) {
  throw InvalidInput(
      fmt::format("{}:{}: {} cells, but the rows before have {}: the row is ragged or the file truncated", path, line,
                  count_cells(row, layout.separator), layout.columns));
}

/// Reads the cells of one row into `row`, those that are wanted.
void read_row(const Lines& lines, const CsvLayout& layout, const std::vector<bool>& wanted, const std::string& path,
              std::vector<double>& row) {
  std::string_view rest = lines.line();
  if (layout.separator == ' ') rest = trimmed(rest);
  for (std::size_t column = 0; column < layout.columns; ++column) {
    if (column > 0 && !take_separator(rest, layout.separator)) refuse_row(path, lines.number(), lines.line(), layout);
    if (wanted[column]) {
      const char* end = scan_number(rest.data(), rest.data() + rest.size(), row[column]);
      const auto used = static_cast<std::size_t>(end - rest.data());
      if (used > 0 && (used == rest.size() || is_separator(*end, layout.separator))) {
        rest.remove_prefix(used);
        continue;
      }
    }
    const std::string_view cell = take_cell(rest, layout.separator);
    if (!wanted[column]) continue;
    const auto value = cell_number(cell, layout.separator);
    if (!value)
      throw InvalidInput(
          fmt::format("{}:{}: column {}: '{}' is not a number", path, lines.number(), column + 1, cell.substr(0, 40)));
    row[column] = *value;
  }
  const bool ends = trimmed(rest).empty() || (take_separator(rest, layout.separator) && trimmed(rest).empty());
  if (!ends) refuse_row(path, lines.number(), lines.line(), layout);
}

void check_time(double time, double previous, const std::string& path, std::size_t line) {
  if (!std::isfinite(time))
    throw InvalidInput(fmt::format("{}:{}: time is {}: must be a finite number", path, line, time));
  if (time <= previous)
    throw InvalidInput(fmt::format("{}:{}: time {} is not after the one before it, {}: times must increase", path, line,
                                   time, previous));
}

/// About how many rows there are, from the lines of the first part; no more than can be.
std::size_t estimate_rows(std::string_view rows, std::size_t columns) {
  constexpr std::size_t kSample = std::size_t{1} << 16;
  constexpr double kMargin = 1.02;
  const std::string_view sample = rows.substr(0, kSample);
  const auto lines = static_cast<double>(std::count(sample.begin(), sample.end(), '\n')) + 1.0;
  const double share = static_cast<double>(rows.size()) / static_cast<double>(sample.size());
  const std::size_t most = rows.size() / (2 * columns) + 1;
  return std::min(static_cast<std::size_t>(kMargin * lines * share) + 1, most);
}

}  // namespace

std::optional<CsvLayout> find_layout(std::string_view text) {
  if (text.substr(0, kBinarySample).find('\0') != std::string_view::npos) return std::nullopt;
  const std::size_t most = most_channels(text.size()) + 1;
  CsvLayout layout;
  std::vector<TextLine> before;
  std::string_view last_comment;
  for (Lines lines(text, text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0, 0);
       lines.next() && lines.number() <= kLinesBeforeNumbers;) {
    if (trimmed(lines.line()).empty()) continue;
    if (is_comment(lines.line())) {
      last_comment = lines.line();
      if (auto pair = key_and_value(lines.line())) layout.comments.push_back(std::move(*pair));
      continue;
    }
    if (const auto separator = separator_of_numbers(lines.line(), most)) {
      layout.separator = *separator;
      const auto cells = split_cells(lines.line(), *separator, most);
      layout.columns = cells.size();
      layout.data_offset = lines.offset();
      layout.data_line = lines.number();
      find_header(before, last_comment, most, layout);
      if (layout.odd_line != 0 && cells.back().empty()) {  // rows end with a separator, the header does not
        layout.odd_line = 0;
        --layout.columns;
        find_header(before, last_comment, most, layout);
      }
      return layout;
    }
    before.push_back({lines.line(), lines.number()});
  }
  return std::nullopt;
}

std::vector<std::vector<double>> read_columns(std::string_view text, const CsvLayout& layout,
                                              const std::vector<bool>& wanted, std::size_t time_column,
                                              const std::string& path) {
  std::vector<std::vector<double>> columns(layout.columns);
  const std::size_t rows = estimate_rows(text.substr(layout.data_offset), layout.columns);
  for (std::size_t column = 0; column < layout.columns; ++column)
    if (wanted[column]) columns[column].reserve(rows);
  std::vector<double> row(layout.columns);
  double previous = -std::numeric_limits<double>::infinity();
  bool ended = false;
  for (Lines lines(text, layout.data_offset, layout.data_line - 1); lines.next();) {
    if (trimmed(lines.line()).empty() || is_comment(lines.line())) continue;
    if (ended)
      throw InvalidInput(fmt::format("{}:{}: a second curve begins: save each to a file of its own, or all as CSV",
                                     path, lines.number()));
    ended = is_end_of_curve(lines.line());
    if (ended) continue;
    read_row(lines, layout, wanted, path, row);
    check_time(row[time_column], previous, path, lines.number());
    previous = row[time_column];
    for (std::size_t column = 0; column < layout.columns; ++column)
      if (wanted[column]) columns[column].push_back(row[column]);
  }
  return columns;
}

void warn_when_open_ended(std::string_view text, TraceSet& set) {
  if (text.empty() || text.back() == '\n' || trimmed(text.substr(text.rfind('\n') + 1)).empty()) return;
  set.warnings.push_back(
      fmt::format("{}: the last line has no end: if the file was cut off there, its last number is too", set.path));
}

}  // namespace crashsim::io
