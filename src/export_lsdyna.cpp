/// Cards of LS-DYNA: fields of 10 columns, of 8 for nodes and elements, of 20 for points of curves.

#include <cmath>

#include <fmt/format.h>

#include "export_cards.hpp"

namespace crashsim {
namespace {

constexpr int kWidth = 10, kNodeWidth = 16;
constexpr int kResampled = 2000;        // LS-DYNA resamples curves of materials, by default to 100 points
constexpr double kElasticShare = 1e-3;  // of the largest force, before a plastic spring unloads by its own curve

std::string curve(int id, const std::string& title, const CardCurve& points) {
  return fmt::format(
      "*DEFINE_CURVE_TITLE\n{}\n"
      "$     lcid      sidr       sfa       sfo      offa      offo    dattyp     lcint\n"
      "{:10}{:10}{:>10}{:>10}{:>10}{:>10}{:10}{:10}\n"
      "$                 a1                  o1\n{}",
      title, id, 0, "1.0", "1.0", "0.0", "0.0", 0, kResampled, curve_lines(points));
}

std::string part(int id, const std::string& title, int section, int material) {
  return fmt::format("*PART\n{}\n$      pid     secid       mid\n{:10}{:10}{:10}\n", title, id, section, material);
}

std::string spring_material(const CardModel& cards, int id) {
  if (!cards.rate.argument.empty())
    return curve(id + 1, "crashsim rate, factor over velocity", cards.rate) +
           fmt::format("*MAT_SPRING_NONLINEAR_ELASTIC\n$      mid       lcd       lcr\n{:10}{:10}{:10}\n", id, id,
                       id + 1);
  if (std::isnan(cards.unloading_stiffness))
    return fmt::format("*MAT_SPRING_NONLINEAR_ELASTIC\n$      mid       lcd\n{:10}{:10}\n", id, id);
  const double reach = cards.spring.argument.back(), force = cards.unloading_stiffness * reach;
  const double elastic = kElasticShare * cards.peak_force;
  return curve(id + 2, "crashsim unloading, force over deflection", {{-reach, 0.0, reach}, {-force, 0.0, force}}) +
         fmt::format(
             "*MAT_SPRING_GENERAL_NONLINEAR\n$      mid      lcdl      lcdu      beta       tyi       cyi\n"
             "{:10}{:10}{:10}{:>10}{}{}\n",
             id, id, id + 2, "0.0", number_field(elastic, kWidth), number_field(-elastic, kWidth));
}

std::string nodes(const CardModel& cards, int id) {
  const auto node = [](int number, double x, int fixed) {
    return fmt::format("{:8}{}{}{}{:8}{:8}\n", number, number_field(x, kNodeWidth), number_field(0.0, kNodeWidth),
                       number_field(0.0, kNodeWidth), fixed, fixed);
  };
  std::string text = fmt::format(
      "$ Node {} is the vehicle, node {} the barrier: put your own numbers into the elements and leave these out.\n"
      "*NODE\n$    nid               x               y               z      tc      rc\n{}{}",
      id, id + 1, node(id, 0.0, 0), node(id + 1, cards.length, 7));
  text += fmt::format("$ For a run on its own, also:\n$*ELEMENT_MASS\n${:7}{:8}{}\n", id + 2, id,
                      number_field(cards.mass, kNodeWidth));
  if (!std::isnan(cards.speed))
    text += fmt::format("$*INITIAL_VELOCITY_NODE\n${:9}{}{:>10}{:>10}\n", id, number_field(cards.speed, kWidth), "0.0",
                        "0.0");
  return text;
}

}  // namespace

std::string lsdyna_cards(const CardModel& cards, int id) {
  const bool has_spring = !cards.spring.argument.empty(), has_damper = !cards.damper.argument.empty();
  std::string text = "*KEYWORD\n";
  if (has_spring)
    text += curve(id, "crashsim spring, force over deflection", cards.spring) + spring_material(cards, id) +
            part(id, "crashsim spring", id, id);
  if (has_damper)
    text += curve(id + 1, "crashsim damper, force over velocity", cards.damper) +
            fmt::format("*MAT_DAMPER_NONLINEAR_VISCOUS\n$      mid      lcdr\n{:10}{:10}\n", id + 1, id + 1) +
            part(id + 1, "crashsim damper", id, id + 1);
  text += fmt::format(
      "*SECTION_DISCRETE\n$    secid       dro        kd        v0        cl        fd\n"
      "{:10}{:10}{:>10}{:>10}{:>10}{:>10}\n$      cdl       tdl\n{:>10}{:>10}\n",
      id, 0, "0.0", "0.0", "0.0", "0.0", "0.0", "0.0");
  text += nodes(cards, id);
  text += "*ELEMENT_DISCRETE\n$    eid     pid      n1      n2     vid               s      pf          offset\n";
  for (const int part_id : {has_spring ? id : 0, has_damper ? id + 1 : 0})
    if (part_id > 0)
      text += fmt::format("{:8}{:8}{:8}{:8}{:8}{:>16}{:8}{:>16}\n", part_id, part_id, id, id + 1, 0, "1.0", 0, "0.0");
  return text;
}

}  // namespace crashsim
