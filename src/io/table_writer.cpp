#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/files.hpp>
#include <crashsim/table_io.hpp>

namespace crashsim {
namespace {

constexpr std::size_t kCellLength = 25;  // "-1.2345678901234567e-300" and its comma

std::string one_line(std::string text) {
  for (char& c : text)
    if (c == '\n' || c == '\r') c = ' ';
  return text;
}

std::string header(const Comments& comments, const std::vector<Column>& columns) {
  std::string text;
  for (const auto& [key, value] : comments) text += fmt::format("# {} = {}\n", key, one_line(value));
  for (std::size_t i = 0; i < columns.size(); ++i) text += fmt::format("{}{}", i == 0 ? "" : ",", columns[i].name);
  return text + "\n";
}

}  // namespace

std::string format_csv(const Comments& comments, const std::vector<Column>& columns) {
  const std::size_t rows = columns.empty() ? 0 : columns.front().values.size();
  for (const Column& column : columns)
    if (column.values.size() != rows)
      throw InvalidInput(fmt::format("column {} has {} cells, {} has {}: all columns must be equally long", column.name,
                                     column.values.size(), columns.front().name, rows));
  std::string text = header(comments, columns);
  const std::size_t used = text.size();
  text.resize(used + rows * columns.size() * kCellLength);
  char* at = text.data() + used;
  for (std::size_t row = 0; row < rows; ++row) {
    for (const Column& column : columns) {
      const double value = column.values[row];
      if (!std::isnan(value)) at = std::to_chars(at, at + kCellLength, value).ptr;
      *at++ = ',';
    }
    at[-1] = '\n';
  }
  text.resize(static_cast<std::size_t>(at - text.data()));
  return text;
}

void write_csv(const std::string& path, const Comments& comments, const std::vector<Column>& columns, bool overwrite) {
  write_output(path, format_csv(comments, columns), overwrite);
}

}  // namespace crashsim
