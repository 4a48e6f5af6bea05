#include "io/lsdyna_nodout_rows.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "io/lsdyna_text.hpp"
#include "text.hpp"

namespace crashsim::io {
namespace {

constexpr std::string_view kNames = "nodal point";

/// "x-disp" and "x-rot vel" without their axis.
struct Kind {
  std::string_view text, name;
  bool is_rotation;
};
constexpr Kind kKinds[] = {{"disp", "displacement", false},  {"vel", "velocity", false},
                           {"accl", "acceleration", false},  {"coor", "coordinate", false},
                           {"rot", "displacement", true},    {"rot vel", "velocity", true},
                           {"rot acc", "acceleration", true}};

std::string variable_of(std::string_view name) {
  if (name.size() > 2 && name[0] >= 'x' && name[0] <= 'z' && name[1] == '-')
    for (const Kind& kind : kKinds)
      if (name.substr(2) == kind.text) return fmt::format("{}{}_{}", kind.is_rotation ? "r" : "", name[0], kind.name);
  return snake_case(name);
}

}  // namespace

std::optional<NodoutHead> parse_nodout_head(std::string_view text, std::size_t at) {
  constexpr std::string_view kTime = "at time";
  CompleteLines lines(text, at);
  std::string_view line;
  if (!lines.next(line)) return std::nullopt;
  NodoutHead head;
  if (const std::size_t time = line.find(kTime); time != std::string_view::npos) {
    head.time_at = at + time + kTime.size();
    const std::string_view rest = line.substr(time + kTime.size());
    head.time_text = trimmed(rest.substr(0, rest.find(')')));
  }
  head.rows = lines.position();
  while (lines.next(line) && trimmed(line).empty()) head.rows = lines.position();
  if (!trimmed(line).starts_with(kNames)) return head;
  head.names = trimmed(line);
  head.rows = lines.position();
  return head;
}

std::vector<std::string> nodout_variables(std::string_view names) {
  std::vector<std::string> variables;
  if (!names.starts_with(kNames)) return variables;
  names = trimmed(names.substr(kNames.size()));
  while (!names.empty()) {
    const std::size_t end = std::min(names.find("  "), names.size());
    variables.push_back(variable_of(names.substr(0, end)));
    names = trimmed(names.substr(end));
  }
  return variables;
}

std::optional<NodoutRow> parse_nodout_row(std::string_view text, std::size_t at) {
  const std::size_t end = text.find('\n', at);
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view line = text.substr(at, end - at);
  const std::string_view words = trimmed(line);
  if (words.empty() || !is_digit(words.front())) return std::nullopt;
  return NodoutRow{at, static_cast<std::size_t>(words.data() + words.size() - line.data()), end};
}

std::size_t nodout_width(std::string_view row, std::size_t columns) {
  constexpr std::size_t kUsual = 12;
  const auto points = static_cast<std::size_t>(std::count(row.begin(), row.end(), '.'));
  const std::size_t first = row.find('.'), last = row.rfind('.');
  if (points != columns || columns < 2 || (last - first) % (columns - 1) != 0) return kUsual;
  return (last - first) / (columns - 1);
}

std::string_view nodout_node(std::string_view row, std::size_t width, std::size_t columns) {
  if (row.size() <= width * columns) return "";
  const std::string_view number = trimmed(row.substr(0, row.size() - width * columns));
  return number.find_first_not_of("0123456789") == std::string_view::npos ? number : "";
}

bool scan_nodout_field(std::string_view field, double& value) { return is_fortran_number(field, value); }

}  // namespace crashsim::io
