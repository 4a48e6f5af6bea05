/// Motion of LS-DYNA's rigid bodies (rbdout): of the centre of mass in global axes, then along the body's own axes.

#include <array>
#include <limits>

#include "io/lsdyna_ascii.hpp"
#include "io/lsdyna_variables.hpp"
#include "text.hpp"

namespace crashsim::io {
namespace {

using Names = std::array<std::string_view, 6>;

/// What a label's line holds: translations, then rotations.
struct Motion {
  std::string_view label;
  std::size_t count;
  Names global, local;
};
constexpr Motion kMotions[] = {{"coordinates:", 3, {"global_x", "global_y", "global_z"}, {}},
                               {"displacements:",
                                6,
                                {"global_dx", "global_dy", "global_dz", "global_rdx", "global_rdy", "global_rdz"},
                                {"local_dx", "local_dy", "local_dz", "local_rdx", "local_rdy", "local_rdz"}},
                               {"velocities:",
                                6,
                                {"global_vx", "global_vy", "global_vz", "global_rvx", "global_rvy", "global_rvz"},
                                {"local_vx", "local_vy", "local_vz", "local_rvx", "local_rvy", "local_rvz"}},
                               {"accelerations:",
                                6,
                                {"global_ax", "global_ay", "global_az", "global_rax", "global_ray", "global_raz"},
                                {"local_ax", "local_ay", "local_az", "local_rax", "local_ray", "local_raz"}},
                               {"row 1", 3, {"dircos_11", "dircos_12", "dircos_13"}, {}},
                               {"row 2", 3, {"dircos_21", "dircos_22", "dircos_23"}, {}},
                               {"row 3", 3, {"dircos_31", "dircos_32", "dircos_33"}, {}}};

bool marks_rbdout(std::string_view line) { return line.starts_with("r i g i d   b o d y   m o t i o n"); }

double time_of_state(std::string_view line) {
  constexpr std::string_view kTime = "time=";
  double time = 0.0;
  const std::size_t at = line.find(kTime);
  const bool has_time = at != std::string_view::npos && is_fortran_number(line.substr(at + kTime.size()), time);
  return has_time ? time : std::numeric_limits<double>::quiet_NaN();
}

/// "12" of "rigid body      12" and "nodal rigid body      12"; "" for other lines.
std::string_view body_of(std::string_view words) {
  constexpr std::string_view kNodal = "nodal ", kBody = "rigid body";
  if (words.starts_with(kNodal)) words.remove_prefix(kNodal.size());
  if (!words.starts_with(kBody)) return "";
  const std::string_view number = trimmed(words.substr(kBody.size()));
  return number.find_first_not_of("0123456789") == std::string_view::npos ? number : "";
}

void put_motion(std::string_view words, std::string_view body, bool is_local, LsdynaSlots& slots) {
  for (const Motion& motion : kMotions) {
    if (!words.starts_with(motion.label)) continue;
    std::array<double, 6> values{};
    const Names& names = is_local ? motion.local : motion.global;
    const std::size_t count = scan_numbers(words.substr(motion.label.size()), values);
    if (count != motion.count || names[0].empty()) return;
    for (std::size_t i = 0; i < count; ++i) slots.put({body, names[i]}, values[i]);
    return;
  }
}

void parse_rbdout(CompleteLines& lines, LsdynaSlots& slots) {
  std::string_view body;
  bool is_local = false;
  for (std::string_view line; slots.next(lines, line);) {
    const std::string_view words = trimmed(line);
    if (marks_rbdout(words)) {
      slots.start(time_of_state(words), lines.offset());
      body = {};
    } else if (const std::string_view number = body_of(words); !number.empty()) {
      body = number;
      is_local = false;
    } else if (words.starts_with("output in ") && words.find("local coordinate") != std::string_view::npos) {
      is_local = true;
    } else if (!body.empty()) {
      put_motion(words, body, is_local, slots);
    }
  }
}

Trace describe(LsdynaSlot slot, const LsdynaHeader& header) {
  return lsdyna_trace({"rbdout", slot.variable}, slot.entity, header.title_of(slot.entity));
}

}  // namespace

const LsdynaDatabase kRbdout = {"rbdout", marks_rbdout, read_lines<parse_rbdout, describe>};

}  // namespace crashsim::io
