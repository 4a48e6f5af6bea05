#include "io/lsdyna_variables.hpp"

#include <string>
#include <utility>

#include <fmt/format.h>

#include "text.hpp"

namespace crashsim::io {
namespace {

struct Suffix {
  std::string_view text;
  Dimension dimension;
};

/// Endings of names, the more particular first.
constexpr Suffix kSuffixes[] = {{"displacement", Dimension::length},
                                {"coordinate", Dimension::length},
                                {"centroid", Dimension::length},
                                {"rbvelocity", Dimension::speed},
                                {"velocity", Dimension::speed},
                                {"acceleration", Dimension::acceleration},
                                {"force", Dimension::force},
                                {"moment", Dimension::moment},
                                {"momentum", Dimension::impulse},
                                {"energy", Dimension::energy},
                                {"energy_by_part", Dimension::energy},
                                {"work", Dimension::energy},
                                {"mass", Dimension::mass},
                                {"time_step", Dimension::time}};

constexpr Suffix kExact[] = {{"axial", Dimension::force},
                             {"shear", Dimension::force},
                             {"shear_s", Dimension::force},
                             {"shear_t", Dimension::force},
                             {"moment_s", Dimension::moment},
                             {"moment_t", Dimension::moment},
                             {"torsion", Dimension::moment},
                             {"time", Dimension::time},
                             {"failure_time", Dimension::time},
                             {"length", Dimension::length},
                             {"cycle", Dimension::none},
                             {"percent_increase", Dimension::none},
                             {"tie_count", Dimension::none},
                             {"number_of_nodes", Dimension::none},
                             {"number_of_elements", Dimension::none},
                             {"num_bad_shells", Dimension::none},
                             {"energy_ratio", Dimension::none},
                             {"energy_ratio_wo_eroded", Dimension::none},
                             {"total_energy_ratio", Dimension::none}};

/// Rigid bodies (rbdout): "global_rvx" is the rate about x. Directions of their axes have no dimension.
Dimension rigid_body_dimension(std::string_view name) {
  if (name.starts_with("dircos")) return Dimension::none;
  for (const std::string_view frame : {"global_", "local_"}) {
    if (!name.starts_with(frame)) continue;
    const std::string_view kind = name.substr(frame.size(), name.size() - frame.size() - 1);
    if (kind.empty() || kind == "d") return Dimension::length;
    if (kind == "v") return Dimension::speed;
    if (kind == "a") return Dimension::acceleration;
    if (kind == "rd") return Dimension::angle;
    if (kind == "rv") return Dimension::angular_rate;
    if (kind == "ra") return Dimension::angular_acceleration;
  }
  return Dimension::unknown;
}

Dimension of_rotation(Dimension translation) {
  switch (translation) {
    case Dimension::length:
      return Dimension::angle;
    case Dimension::speed:
      return Dimension::angular_rate;
    case Dimension::acceleration:
      return Dimension::angular_acceleration;
    default:
      return translation;
  }
}

bool is_about_axis(std::string_view name) {
  return name.starts_with("rx_") || name.starts_with("ry_") || name.starts_with("rz_");
}

/// 'X' for "x_velocity", "rx_velocity", "global_x_velocity" and "global_vx".
char axis_of(LsdynaVariable variable) {
  std::string_view name = variable.name;
  if (variable.database == "rbdout") {
    const bool moves = name.starts_with("global_") || name.starts_with("local_");
    return moves && name.back() >= 'x' && name.back() <= 'z' ? static_cast<char>(name.back() - 'x' + 'X') : ' ';
  }
  if (name.starts_with("global_")) name.remove_prefix(7);
  if (is_about_axis(name)) name.remove_prefix(1);
  const bool along = name.size() > 1 && name[0] >= 'x' && name[0] <= 'z' && name[1] == '_';
  return along ? static_cast<char>(name[0] - 'x' + 'X') : ' ';
}

/// "VX" for "x_velocity", as crash traces are called everywhere; other names stay as they are.
std::string short_name(LsdynaVariable variable) {
  const char axis = axis_of(variable);
  if (axis == ' ' || variable.database == "rbdout" || variable.name.starts_with("global_"))
    return std::string(variable.name);
  const bool rotation = is_about_axis(variable.name);
  const std::string_view kind = variable.name.substr(rotation ? 3 : 2);
  constexpr std::pair<std::string_view, std::string_view> kShort[] = {{"displacement", "D"}, {"velocity", "V"},
                                                                      {"acceleration", "A"}, {"coordinate", ""},
                                                                      {"force", "F"},        {"moment", "M"}};
  for (const auto& [long_kind, letter] : kShort)
    if (kind == long_kind) return fmt::format("{}{}{}", rotation ? "R" : "", letter, axis);
  return std::string(variable.name);
}

}  // namespace

Dimension lsdyna_dimension(LsdynaVariable variable) {
  if (variable.database == "rbdout")
    if (const Dimension found = rigid_body_dimension(variable.name); found != Dimension::unknown) return found;
  for (const Suffix& known : kExact)
    if (variable.name == known.text) return known.dimension;
  for (const Suffix& known : kSuffixes)
    if (variable.name.ends_with(known.text))
      return is_about_axis(variable.name) ? of_rotation(known.dimension) : known.dimension;
  return Dimension::unknown;
}

Trace lsdyna_trace(LsdynaVariable variable, std::string_view entity, std::string_view title) {
  Trace trace;
  trace.database = std::string(variable.database);
  trace.location = std::string(trimmed(title).empty() ? entity : trimmed(title));
  trace.id = entity.empty() ? fmt::format("{}/{}", variable.database, variable.name)
                            : fmt::format("{}/{}/{}", variable.database, entity, variable.name);
  trace.name = entity.empty() ? std::string(variable.name) : fmt::format("{}_{}", trace.location, short_name(variable));
  trace.axis = axis_of(variable);
  trace.dimension = lsdyna_dimension(variable);
  trace.has_samples = false;
  return trace;
}

}  // namespace crashsim::io
