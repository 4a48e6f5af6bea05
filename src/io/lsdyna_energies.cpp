/// Energies of LS-DYNA: of the whole model (glstat) and of its parts (matsum).

#include <array>
#include <limits>
#include <utility>

#include "io/lsdyna_ascii.hpp"
#include "io/lsdyna_variables.hpp"
#include "text.hpp"

namespace crashsim::io {
namespace {

// ---- glstat: " kinetic energy.................   9.93442E-06",
// " stonewall energy...............   0.00000E+00 wall# 1"

struct DottedLine {
  std::string_view label, rest;
};

/// The last of the dots that a count touches, as in "time step..12345"; npos when there are none.
std::size_t dots_before_count(std::string_view words) {
  const std::size_t end = words.find_last_not_of("0123456789");
  const bool are_dots =
      end != std::string_view::npos && end + 1 < words.size() && words.substr(0, end + 1).ends_with("..");
  return are_dots ? end : std::string_view::npos;
}

/// Parts a label from what follows its dots; both empty when the line has none.
DottedLine parse_dotted_line(std::string_view line) {
  const std::string_view words = trimmed(line);
  std::size_t end = words.find(". ");
  if (end == std::string_view::npos) end = dots_before_count(words);
  if (end == std::string_view::npos) return {};
  std::string_view label = words.substr(0, end);
  while (label.ends_with('.') || label.ends_with(' ')) label.remove_suffix(1);
  return {label, trimmed(words.substr(end + 1))};
}

/// Only this database: others have labels with dots too, but those of their parts.
bool marks_glstat(std::string_view line) {
  const std::string_view label = parse_dotted_line(line).label;
  return label == "kinetic energy" || label == "total energy";
}

void parse_glstat(CompleteLines& lines, LsdynaSlots& slots) {
  for (std::string_view line; slots.next(lines, line);) {
    const auto [label, rest] = parse_dotted_line(line);
    double value = 0.0;
    const std::size_t length = scan_fortran(rest, value);
    if (label.empty() || length == 0 || (length < rest.size() && !is_blank(rest[length]))) continue;
    const std::string_view suffix = trimmed(rest.substr(length));
    if (label == "time")
      slots.start(suffix.empty() ? value : std::numeric_limits<double>::quiet_NaN(), lines.offset());
    else
      slots.put({suffix, label}, value);
  }
}

Trace describe_glstat(LsdynaSlot slot, const LsdynaHeader&) {
  constexpr std::pair<std::string_view, std::string_view> kVariables[] = {
      {"rigid body stopper energy", "rb_stopper_energy"},           {"total energy / initial energy", "energy_ratio"},
      {"energy ratio w/o eroded energy", "energy_ratio_wo_eroded"}, {"time per zone cycle.(nanosec)", "nzc"},
      {"reached the minimum time step", "num_bad_shells"},          {"percentage increase", "percent_increase"}};
  std::string variable = snake_case(slot.variable);
  for (const auto& [label, name] : kVariables)
    if (slot.variable == label) variable = name;
  std::string_view entity = slot.entity;
  if (const std::size_t number = entity.find_first_of("0123456789"); number != std::string_view::npos)
    entity = entity.substr(number);
  return lsdyna_trace({"glstat", variable}, entity, snake_case(slot.entity));
}

// ---- matsum: " time =   4.8730E-03", " mat.#=   10             inten=   0.0000E+00     kinen=   0.0000E+00"

constexpr std::string_view kPart = "mat.#";

bool marks_matsum(std::string_view line) { return line.starts_with("mat.#="); }

/// "inten=   0.0000E+00".
struct Assignment {
  std::string_view name;
  double value;
};
constexpr std::size_t kMostAssignments = 16;

/// The assignments that make up a line; none when anything else is in it, as where it was cut short.
std::size_t parse_assignments(std::string_view line, std::array<Assignment, kMostAssignments>& found) {
  std::string_view rest = trimmed(line);
  std::size_t count = 0;
  while (!rest.empty()) {
    const std::size_t sign = rest.find('=');
    if (sign == std::string_view::npos || count == found.size()) return 0;
    const std::string_view name = trimmed(rest.substr(0, sign));
    if (name.empty() || name.find(' ') != std::string_view::npos) return 0;
    rest = trimmed(rest.substr(sign + 1));
    double value = 0.0;
    const std::size_t length = scan_fortran(rest, value);
    if (length == 0 || (length < rest.size() && !is_blank(rest[length]))) return 0;
    found[count++] = {name, value};
    rest = trimmed(rest.substr(length));
  }
  return count;
}

/// "10" of " mat.#=   10       inten=...".
std::string_view part_number(std::string_view line) {
  const std::string_view rest = trimmed(line.substr(line.find('=') + 1));
  return rest.substr(0, rest.find_first_not_of("0123456789"));
}

void parse_matsum(CompleteLines& lines, LsdynaSlots& slots) {
  std::string_view part;
  std::array<Assignment, kMostAssignments> values;
  for (std::string_view line; slots.next(lines, line);) {
    const std::size_t count = parse_assignments(line, values);
    if (count == 1 && values[0].name == "time") {
      slots.start(values[0].value, lines.offset());
      part = {};
      continue;
    }
    std::size_t i = 0;
    if (count > 0 && values[0].name == kPart) {
      part = part_number(line);
      i = 1;
    }
    if (part.empty()) continue;
    for (; i < count; ++i) slots.put({part, values[i].name}, values[i].value);
  }
}

Trace describe_matsum(LsdynaSlot slot, const LsdynaHeader& header) {
  constexpr std::pair<std::string_view, std::string_view> kVariables[] = {{"inten", "internal_energy"},
                                                                          {"kinen", "kinetic_energy"},
                                                                          {"hgeng", "hourglass_energy"},
                                                                          {"eroded_ie", "eroded_internal_energy"},
                                                                          {"eroded_ke", "eroded_kinetic_energy"},
                                                                          {"eroded_he", "eroded_hourglass_energy"},
                                                                          {"x-mom", "x_momentum"},
                                                                          {"y-mom", "y_momentum"},
                                                                          {"z-mom", "z_momentum"},
                                                                          {"x-rbv", "x_rbvelocity"},
                                                                          {"y-rbv", "y_rbvelocity"},
                                                                          {"z-rbv", "z_rbvelocity"}};
  std::string variable = snake_case(slot.variable);
  for (const auto& [label, name] : kVariables)
    if (slot.variable == label) variable = name;
  return lsdyna_trace({"matsum", variable}, slot.entity, header.title_of(slot.entity));
}

}  // namespace

const LsdynaDatabase kGlstat = {"glstat", marks_glstat, read_lines<parse_glstat, describe_glstat>};
const LsdynaDatabase kMatsum = {"matsum", marks_matsum, read_lines<parse_matsum, describe_matsum>};

}  // namespace crashsim::io
