/// Reading the samples of a case again, to join them.

#include <fmt/format.h>

#include <crashsim/error.hpp>
#include <crashsim/sweep.hpp>
#include <crashsim/units.hpp>

#include "sample_runner.hpp"
#include "text.hpp"

namespace crashsim {
namespace {

double number_of(std::string_view cell, const std::string& where) {
  if (cell.empty()) return kUnset;
  const auto number = parse_number(cell);
  if (!number) throw InvalidInput(fmt::format("{}: '{}' is not a number", where, cell));
  return *number;
}

void append_row(std::string_view line, const std::string& where, SampleTable& table) {
  const std::vector<std::string_view> cells = split(line, ',');
  const std::size_t inputs = table.inputs.size();
  if (cells.size() != table.columns() + 2)
    throw InvalidInput(fmt::format("{}: has {} cells, there are {} columns", where, cells.size(), table.columns() + 2));
  const double sample = number_of(cells[0], where);
  if (!(sample >= 0.0 && sample < static_cast<double>(table.planned)))
    throw InvalidInput(fmt::format("{}: '{}' is no sample of {}", where, cells[0], table.planned));
  table.samples.push_back(static_cast<std::uint64_t>(sample));
  table.outcomes.emplace_back(cells[inputs + 1]);
  for (std::size_t i = 1; i < cells.size(); ++i)
    if (i != inputs + 1) table.numbers.push_back(number_of(cells[i], where));
}

}  // namespace

SampleTable read_samples(const std::string& path, const SampleTable& study) {
  SampleTable table = study;
  table.samples.clear();
  table.outcomes.clear();
  table.numbers.clear();
  const std::string text = read_file(path);
  bool has_header = false;
  std::size_t line_number = 0;
  for (const std::string_view line : split(text, '\n')) {
    ++line_number;
    if (line.empty() || line.front() == '#') continue;
    if (has_header) {
      append_row(line, fmt::format("{}:{}", path, line_number), table);
    } else if (line != sample_header(table)) {
      throw InvalidInput(fmt::format("{}:{}: has other columns than the samples of this study", path, line_number));
    }
    has_header = true;
  }
  return table;
}

}  // namespace crashsim
