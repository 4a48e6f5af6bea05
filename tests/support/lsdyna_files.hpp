#pragma once
/// Files as LS-DYNA writes them, of random runs whose numbers are known.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "support/random.hpp"

namespace crashsim::test {

/// A run's file and what it says.
struct LsdynaRun {
  std::string text;
  std::size_t states_at = 0;                          ///< Where the preamble ends.
  std::vector<std::size_t> state_ends;                ///< Where the last line of each state ends.
  std::vector<double> times;                          ///< As printed.
  std::map<std::string, std::vector<double>> values;  ///< By id, as printed.
};

/// How a run is made: its entities always, the numbers by the seed.
struct LsdynaPlan {
  std::uint64_t seed = 1;
  int states = 12;
  int first_state = 0;  ///< Of those of the whole run, by which their times count.
  int entities = 3;
  std::string line_end = "\n";
};

class LsdynaWriter {
 public:
  LsdynaWriter(const LsdynaPlan& plan, std::string database)
      : plan_(plan), database_(std::move(database)), random_(plan.seed) {}

  void preamble(const std::vector<std::string>& legend) {
    line(" A run of 3 parts, 12 7");
    line("                    ls-dyna smp d R13 R13.1.1_27_8731a0 date 07/28/2023");
    line("");
    if (!legend.empty()) line("{BEGIN LEGEND}");
    if (!legend.empty()) line(" Entity #        Title");
    for (const std::string& entry : legend) line(entry);
    if (!legend.empty()) line("{END LEGEND}");
    line("");
    run_.states_at = run_.text.size();
  }
  void line(const std::string& text) { run_.text += text + plan_.line_end; }
  /// Ends a line whose parts were put().
  void end_line() { line(""); }
  void put(const std::string& text) { run_.text += text; }

  /// The time of state `i` as printed.
  std::string time(int i, int width, int decimals) {
    std::string text = fmt::format("{:{}.{}E}", 1e-3 * (plan_.first_state + i) + 3e-5 * (i % 2), width, decimals);
    if (static_cast<std::size_t>(i) == run_.times.size()) run_.times.push_back(std::strtod(text.c_str(), nullptr));
    return text;
  }
  /// A random number of a channel as printed.
  std::string number(const std::string& channel, int width, int decimals) {
    const double size = random_.between(-10.0, 10.0) * std::pow(10.0, random_.whole(-26, 26));
    return keep(channel, fmt::format("{:{}.{}E}", random_.whole(0, 9) == 0 ? 0.0 : size, width, decimals));
  }
  std::string keep(const std::string& channel, std::string text) {
    run_.values[database_ + "/" + channel].push_back(std::strtod(text.c_str(), nullptr));
    return text;
  }
  void end_state() { run_.state_ends.push_back(run_.text.size()); }
  LsdynaRun take() { return std::move(run_); }

 private:
  LsdynaPlan plan_;
  std::string database_;
  Random random_;
  LsdynaRun run_;
};

inline constexpr const char* kTranslations =
    " nodal point  x-disp     y-disp      z-disp      x-vel       y-vel       z-vel      x-accl      y-accl      "
    "z-accl      x-coor      y-coor      z-coor";
inline constexpr const char* kRotations =
    " nodal point  x-rot      y-rot       z-rot       x-rot vel   y-rot vel   z-rot vel   x-rot acc   y-rot acc   "
    "z-rot acc";

inline std::string nodout_head(int step, const std::string& time) {
  return fmt::format(" n o d a l   p r i n t   o u t   f o r   t i m e  s t e p{:8d}{:30}( at time{} )", step, "",
                     time);
}

/// Number of node `n`, the last with all its ten digits.
inline long node_number(int n, int nodes) { return n + 1 == nodes ? 1234567890L : 17L + 1000L * n * n; }

inline LsdynaRun nodout_run(const LsdynaPlan& plan) {
  LsdynaWriter writer(plan, "nodout");
  writer.preamble({"       17     LEFT REAR, at 3"});
  const std::vector<std::string> kinds[2] = {{"displacement", "velocity", "acceleration", "coordinate"},
                                             {"displacement", "velocity", "acceleration"}};
  for (int i = 0; i < plan.states; ++i) {
    for (const bool rotation : {false, true}) {
      for (int blank = 0; blank < 3; ++blank) writer.line("");
      writer.line(nodout_head(i, writer.time(i, 14, 7)));
      writer.line("");
      writer.line(rotation ? kRotations : kTranslations);
      for (int n = 0; n < plan.entities; ++n) {
        const long node = node_number(n, plan.entities);
        writer.put(node > 999999999L ? fmt::format("{}", node) : fmt::format("{:9d} ", node));
        for (const std::string& kind : kinds[rotation])
          for (const char axis : {'x', 'y', 'z'})
            writer.put(writer.number(fmt::format("{}/{}{}_{}", node, rotation ? "r" : "", axis, kind), 12, 5));
        writer.end_line();
      }
    }
    writer.end_state();
  }
  return writer.take();
}

inline LsdynaRun rcforc_run(const LsdynaPlan& plan) {
  LsdynaWriter writer(plan, "rcforc");
  writer.preamble({"        2     Front to barrier", "    10001     All"});
  for (int i = 0; i < plan.states; ++i) {
    writer.line(" interface number,     10001,is single surface-resultants are undefined");
    for (int n = 0; n < plan.entities; ++n)
      for (const char* side : {"slave", "master"}) {
        const std::string id = fmt::format("{} {}/", n + 2, side);
        writer.put(fmt::format("  {:6}{:11d} time{}", side, n + 2, writer.time(i, 12, 5)));
        for (const char axis : {'x', 'y', 'z'})
          writer.put(fmt::format("  {} {}", axis, writer.number(fmt::format("{}{}_force", id, axis), 12, 5)));
        writer.put(fmt::format(" mass {}", writer.number(id + "mass", 12, 5)));
        if (n == 0)
          for (const char axis : {'x', 'y', 'z'})
            writer.put(fmt::format("  m{} {}", axis, writer.number(fmt::format("{}{}_moment", id, axis), 12, 5)));
        if (n == 1) {
          writer.put(fmt::format("  tied {}", writer.keep(id + "tie_count", fmt::format("{:10d}", 7 + i))));
          writer.put(fmt::format("  tied area {}", writer.number(id + "tie_area", 12, 5)));
        }
        writer.end_line();
      }
    writer.end_state();
  }
  return writer.take();
}

inline LsdynaRun rwforc_run(const LsdynaPlan& plan) {
  LsdynaWriter writer(plan, "rwforc");
  writer.preamble({"        1     Barrier"});
  writer.line("    time       wall#   normal-force    x-force        y-force        z-force");
  for (int i = 0; i < plan.states; ++i) {
    for (int n = 0; n < plan.entities; ++n) {
      const int wall = n == 1 ? 12345678 : n + 1;  // touches its time
      writer.put(fmt::format("{}{:8d}", writer.time(i, 12, 5), wall));
      for (const char* name : {"normal", "x", "y", "z"})
        writer.put(writer.number(fmt::format("{}/{}_force", wall, name), 15, 6));
      writer.end_line();
      if (n != 0) continue;
      writer.line("                seg#    ");
      writer.line("                   1                  1.000000E+00   2.000000E+00   3.000000E+00");
      writer.line("  total force                         1.000000E+00   2.000000E+00   3.000000E+00");
    }
    writer.end_state();
  }
  return writer.take();
}

inline LsdynaRun secforc_run(const LsdynaPlan& plan) {
  LsdynaWriter writer(plan, "secforc");
  writer.preamble({"        1     Section 7 left rail"});
  writer.line(" line#1  section#     time        x-force     y-force     z-force    magnitude");
  writer.line(" line#2  resultant  moments       x-moment    y-moment    z-moment   magnitude");
  writer.line(" line#3  centroids                x           y           z            area  ");
  const std::vector<std::string> rows[3] = {{"x_force", "y_force", "z_force", "total_force"},
                                            {"x_moment", "y_moment", "z_moment", "total_moment"},
                                            {"x_centroid", "y_centroid", "z_centroid", "area"}};
  for (int i = 0; i < plan.states; ++i) {
    for (int n = 0; n < plan.entities; ++n)
      for (int row = 0; row < 3; ++row) {
        writer.put(row == 0 ? fmt::format("{:12d}{}", n + 1, writer.time(i, 15, 5)) : "");
        writer.put(row != 1 ? "" : n == 0 ? "global system              " : "ac ID =   33377            ");
        writer.put(row == 2 ? std::string(27, ' ') : "");
        for (std::size_t c = 0; c < 4; ++c)
          writer.put(writer.number(fmt::format("{}/{}", n + 1, rows[row][c]), c == 0 ? 15 : 12, 4));
        writer.line(row == 2 && n + 1 < plan.entities ? plan.line_end : "");
      }
    writer.end_state();
    writer.line("");
  }
  return writer.take();
}

inline LsdynaRun rbdout_run(const LsdynaPlan& plan) {
  LsdynaWriter writer(plan, "rbdout");
  writer.preamble({});
  const auto motion = [&](const char* label, const std::string& prefix, const std::string& kind, bool turns) {
    writer.put(fmt::format("{:>15}:  ", label));
    for (const bool rotation : {false, true})
      for (const char axis : {'x', 'y', 'z'})
        if (!rotation || turns)
          writer.put(writer.number(fmt::format("{}_{}{}{}", prefix, rotation ? "r" : "", kind, axis), 12, 4));
    writer.end_line();
  };
  for (int i = 0; i < plan.states; ++i) {
    writer.line("1");
    writer.line("");
    writer.line(
        fmt::format("  r i g i d   b o d y   m o t i o n   a t  cycle={:8d}    time={}", i, writer.time(i, 15, 6)));
    for (int n = 0; n < plan.entities; ++n) {
      writer.line("");
      writer.line(fmt::format(" {}rigid body{:8d}", n == 0 ? "" : "nodal ", n + 1));
      writer.line("   global             x           y           z          x-rot       y-rot       z-rot");
      const std::string global = fmt::format("{}/global", n + 1), local = fmt::format("{}/local", n + 1);
      motion("coordinates", global, "", false);
      motion("displacements", global, "d", true);
      motion("velocities", global, "v", true);
      motion("accelerations", global, "a", true);
      writer.line("");
      writer.line("principal or user defined local coordinate direction vectors");
      writer.line("                     a           b           c");
      for (int row = 1; row <= 3; ++row) {
        writer.put(fmt::format("     row {}", row));
        for (int c = 1; c <= 3; ++c) writer.put(writer.number(fmt::format("{}/dircos_{}{}", n + 1, row, c), 15, 4));
        writer.end_line();
      }
      writer.line("");
      writer.line(" output in principal or user defined local coordinate directions");
      writer.line("                      a           b           c          a-rot       b-rot       c-rot");
      motion("displacements", local, "d", true);
      motion("velocities", local, "v", true);
      motion("accelerations", local, "a", true);
    }
    writer.end_state();
  }
  return writer.take();
}

inline LsdynaRun glstat_run(const LsdynaPlan& plan) {
  LsdynaWriter writer(plan, "glstat");
  writer.preamble({});
  const std::pair<const char*, const char*> labels[] = {
      {"time step......................", "time_step"},
      {"kinetic energy.................", "kinetic_energy"},
      {"internal energy................", "internal_energy"},
      {"stonewall energy...............", ""},
      {"rigid body stopper energy......", "rb_stopper_energy"},
      {"hourglass energy ..............", "hourglass_energy"},
      {"total energy / initial energy..", "energy_ratio"},
      {"energy ratio w/o eroded energy.", "energy_ratio_wo_eroded"},
      {"global x velocity..............", "global_x_velocity"},
      {"energy of a later version......", "energy_of_a_later_version"}};
  for (int i = 0; i < plan.states; ++i) {
    writer.line("");
    writer.line(fmt::format(" dt of cycle{:8d} is controlled by solid         100449 of part        10", i));
    writer.line("");
    writer.line(fmt::format(" time...........................{}", writer.time(i, 14, 5)));
    for (const auto& [label, variable] : labels) {
      const bool each_wall = std::string(variable).empty();
      for (int wall = 1; wall <= (each_wall ? plan.entities : 1); ++wall) {
        const std::string id = each_wall ? fmt::format("{}/stonewall_energy", wall) : variable;
        writer.line(
            fmt::format(" {}{}{}", label, writer.number(id, 14, 5), each_wall ? fmt::format(" wall#{:2d}", wall) : ""));
      }
    }
    writer.line(fmt::format(" time per zone cycle.(nanosec)..{}", writer.keep("nzc", fmt::format("{:14d}", i))));
    writer.line("");
    writer.line(" number of shell elements that  ");
    writer.line(fmt::format(" reached the minimum time step..{}", writer.keep("num_bad_shells", "    0")));
    writer.line(fmt::format(" percentage increase............{}", writer.number("percent_increase", 14, 5)));
    writer.end_state();
  }
  return writer.take();
}

inline LsdynaRun matsum_run(const LsdynaPlan& plan) {
  LsdynaWriter writer(plan, "matsum");
  writer.preamble({"        1     Plate 1"});
  for (int i = 0; i < plan.states; ++i) {
    writer.line("");
    writer.line(fmt::format(" time ={}", writer.time(i, 13, 4)));
    for (int n = 0; n < plan.entities; ++n) {
      const int part = n == 1 ? 12345678 : n + 1;
      const auto pair = [&](const char* label, const char* variable) {
        return fmt::format("{}={}", label, writer.number(fmt::format("{}/{}", part, variable), 13, 4));
      };
      writer.put(fmt::format(" mat.#={:5d}             {}     ", part, pair("inten", "internal_energy")));
      writer.put(pair("kinen", "kinetic_energy") + "     ");
      writer.line(pair("eroded_ie", "eroded_internal_energy"));
      writer.put(" " + pair("x-mom", "x_momentum") + "     ");
      writer.put(pair("y-mom", "y_momentum") + "     ");
      writer.line(pair("z-mom", "z_momentum"));
      writer.line(" " + pair("x-rbv", "x_rbvelocity"));
      writer.put(fmt::format("{:25}{}     ", "", pair("hgeng", "hourglass_energy")));
      writer.line(pair("+mass", "mass"));
      if (n + 1 < plan.entities) writer.line(plan.line_end);
    }
    writer.end_state();
    writer.line("");
    writer.line("       Maximum mass increase in solid elements      =   0.2122E-07 ID=   36456");
  }
  return writer.take();
}

}  // namespace crashsim::test
