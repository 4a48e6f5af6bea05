/// Forces of LS-DYNA: contacts (rcforc), rigid walls (rwforc) and cross-sections (secforc).

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "io/lsdyna_ascii.hpp"
#include "io/lsdyna_variables.hpp"
#include "text.hpp"

namespace crashsim::io {
namespace {

/// Takes the first word off a text.
std::string_view take_word(std::string_view& text) {
  text = trimmed(text);
  const std::size_t end = std::min(text.find_first_of(" \t"), text.size());
  const std::string_view word = text.substr(0, end);
  text = trimmed(text.substr(end));
  return word;
}

bool is_whole_number(std::string_view word) { return !word.empty() && std::all_of(word.begin(), word.end(), is_digit); }

// ---- rcforc: "  slave           2 time 4.87301E-03  x  0.00000E+00  y ...  tied          4  tied area  1.00000E+00"

/// What the two surfaces of a contact are called, by the version of LS-DYNA.
constexpr std::pair<std::string_view, std::string_view> kSides[] = {
    {"slave", "slave"}, {"master", "master"}, {"surfa", "slave"}, {"surfb", "master"}};

/// The name that binout's users know a side by; "" when it is none.
std::string_view side_of(std::string_view word) {
  for (const auto& [name, side] : kSides)
    if (same_ignoring_case(word, name)) return side;
  return "";
}

struct ContactLine {
  std::string_view entity;     ///< "slave           2".
  std::string_view time_text;  ///< As it stands.
  std::string_view values;     ///< The rest.
};

bool parse_contact_line(std::string_view line, ContactLine& contact) {
  std::string_view rest = trimmed(line);
  const char* begin = rest.data();
  if (side_of(take_word(rest)).empty()) return false;
  const std::string_view number = take_word(rest);
  contact.entity = std::string_view(begin, static_cast<std::size_t>(number.data() + number.size() - begin));
  const bool has_time = is_whole_number(number) && take_word(rest) == "time";
  contact.time_text = take_word(rest);
  contact.values = rest;
  return has_time && !contact.time_text.empty();
}

bool marks_rcforc(std::string_view line) {
  ContactLine contact;
  return parse_contact_line(line, contact) ||
         (line.starts_with("interface number") && line.find("resultants are undefined") != std::string_view::npos);
}

/// A label and the number after it.
struct Labelled {
  std::string_view label;
  double value;
};
constexpr std::size_t kMostLabels = 16;

/// The labelled numbers of a contact's line; none when the line ends in anything else, as one cut short does.
std::size_t parse_labelled(std::string_view rest, std::array<Labelled, kMostLabels>& found) {
  std::size_t count = 0;
  std::string_view label;
  while (!rest.empty()) {
    const std::string_view word = take_word(rest);
    double value = 0.0;
    if (!is_fortran_number(word, value)) {
      const char* begin = label.empty() ? word.data() : label.data();
      label = std::string_view(begin, static_cast<std::size_t>(word.data() + word.size() - begin));
      continue;
    }
    if (label.empty() || count == found.size()) return 0;
    found[count++] = {label, value};
    label = {};
  }
  return label.empty() ? count : 0;
}

void parse_rcforc(CompleteLines& lines, LsdynaSlots& slots) {
  ContactLine contact;
  std::array<Labelled, kMostLabels> values;
  for (std::string_view line; slots.next(lines, line);) {
    if (!parse_contact_line(line, contact)) continue;
    const std::size_t count = parse_labelled(contact.values, values);
    if (count > 0) slots.start_line(contact.time_text, {contact.entity, values[0].label}, lines.offset());
    for (std::size_t i = 0; i < count; ++i) slots.put({contact.entity, values[i].label}, values[i].value);
  }
}

Trace describe_rcforc(LsdynaSlot slot, const LsdynaHeader& header) {
  constexpr std::pair<std::string_view, std::string_view> kVariables[] = {
      {"x", "x_force"},   {"y", "y_force"},   {"z", "z_force"},      {"mx", "x_moment"},
      {"my", "y_moment"}, {"mz", "z_moment"}, {"tied", "tie_count"}, {"tied area", "tie_area"}};
  std::string variable = snake_case(slot.variable);
  for (const auto& [label, name] : kVariables)
    if (slot.variable == label) variable = name;
  std::string_view rest = slot.entity;
  const std::string_view side = side_of(take_word(rest)), title = header.title_of(rest);
  return lsdyna_trace({"rcforc", variable}, fmt::format("{} {}", rest, side),
                      title.empty() ? "" : fmt::format("{} {}", title, side));
}

// ---- rwforc: " 4.87301E-03       1   1.234567E+00   0.000000E+00   0.000000E+00   0.000000E+00"

bool is_wall_header(std::string_view line) {
  return line.find("normal-force") != std::string_view::npos && line.find("wall") != std::string_view::npos;
}

/// Parts " 4.87301E-03" and "1", which touch when the number has eight digits.
std::pair<std::string_view, std::string_view> time_and_wall(std::string_view line) {
  constexpr std::size_t kTimeWidth = 12;
  std::string_view rest = line;
  const std::string_view time = take_word(rest), wall = take_word(rest);
  if (is_whole_number(wall)) return {time, wall};
  if (line.size() < kTimeWidth) return {};
  rest = line.substr(kTimeWidth);
  return {trimmed(line.substr(0, kTimeWidth)), take_word(rest)};
}

void parse_rwforc(CompleteLines& lines, LsdynaSlots& slots) {
  constexpr std::array<std::string_view, 4> kVariables = {"normal_force", "x_force", "y_force", "z_force"};
  bool has_walls = false;  // not the forces on a wall's segments, nor those of its transducers
  for (std::string_view line; slots.next(lines, line);) {
    if (is_wall_header(line) || trimmed(line).starts_with("total force")) {
      has_walls = true;
    } else if (line.find("seg#") != std::string_view::npos || line.find("transducer") != std::string_view::npos) {
      has_walls = false;
    } else if (has_walls) {
      const auto [time, wall] = time_and_wall(line);
      if (!is_whole_number(wall)) continue;
      std::array<double, 4> forces{};
      const char* rest = wall.data() + wall.size();
      const char* end = line.data() + line.size();
      if (scan_numbers({rest, static_cast<std::size_t>(end - rest)}, forces) != forces.size()) continue;
      slots.start_line(time, {wall, kVariables[0]}, lines.offset());
      for (std::size_t i = 0; i < forces.size(); ++i) slots.put({wall, kVariables[i]}, forces[i]);
    }
  }
}

Trace describe_rwforc(LsdynaSlot slot, const LsdynaHeader& header) {
  return lsdyna_trace({"rwforc", slot.variable}, slot.entity, header.title_of(slot.entity));
}

// ---- secforc: three lines a section: number, time, forces; "ac ID =   33377" or "global system", moments; centroid,
// area

bool marks_secforc(std::string_view line) {
  return line.starts_with("line#1") && line.find("section#") != std::string_view::npos;
}

/// The line without what stands before its numbers: the system they are in.
std::string_view without_system(std::string_view line) {
  const std::string_view words = trimmed(line);
  if (words.starts_with("global system")) return words.substr(std::string_view("global system").size());
  const std::size_t sign = words.find('=');
  if (sign == std::string_view::npos) return words;
  std::string_view rest = words.substr(sign + 1);
  return is_whole_number(take_word(rest)) ? rest : std::string_view();
}

void parse_secforc(CompleteLines& lines, LsdynaSlots& slots) {
  constexpr std::size_t kValues = 4, kLinesOfSection = 3;
  constexpr std::string_view kVariables[kLinesOfSection][kValues] = {
      {"x_force", "y_force", "z_force", "total_force"},
      {"x_moment", "y_moment", "z_moment", "total_moment"},
      {"x_centroid", "y_centroid", "z_centroid", "area"}};
  std::string_view section;
  std::size_t expected = kLinesOfSection;  // which of its lines comes next
  for (std::string_view line; slots.next(lines, line);) {
    std::string_view rest = line;
    const std::string_view number = take_word(rest);
    std::array<double, kValues> values{};
    if (is_whole_number(number)) {
      const std::string_view time = take_word(rest);
      section = number;
      expected = scan_numbers(rest, values) == kValues ? 0 : kLinesOfSection;
      if (expected == 0) slots.start_line(time, {section, kVariables[0][0]}, lines.offset());
    } else if (expected < kLinesOfSection && scan_numbers(without_system(line), values) != kValues) {
      expected = kLinesOfSection;
    }
    if (expected == kLinesOfSection) continue;
    for (std::size_t i = 0; i < kValues; ++i) slots.put({section, kVariables[expected][i]}, values[i]);
    ++expected;
  }
}

Trace describe_secforc(LsdynaSlot slot, const LsdynaHeader& header) {
  return lsdyna_trace({"secforc", slot.variable}, slot.entity, header.title_of(slot.entity));
}

}  // namespace

const LsdynaDatabase kRcforc = {"rcforc", marks_rcforc, read_lines<parse_rcforc, describe_rcforc>};
const LsdynaDatabase kRwforc = {"rwforc", is_wall_header, read_lines<parse_rwforc, describe_rwforc>};
const LsdynaDatabase kSecforc = {"secforc", marks_secforc, read_lines<parse_secforc, describe_secforc>};

}  // namespace crashsim::io
