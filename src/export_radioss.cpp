/// Cards of OpenRadioss: fields of 10 columns for whole numbers, of 20 for others.

#include <cmath>

#include <fmt/format.h>

#include "export_cards.hpp"

namespace crashsim {
namespace {

constexpr int kWidth = 20;
constexpr double kSpringMass = 1e-3;       // of the vehicle's: an element needs one for its time step
constexpr int kElastic = 0, kPlastic = 1;  // hardening flag: the same way back, or down along K

std::string function(int id, const std::string& title, const CardCurve& points) {
  return fmt::format("/FUNCT/{}\n{}\n#                  X                   Y\n{}", id, title, curve_lines(points));
}

/// The force is f(d) (1 + g(d')) + h(d'): spring, its rate and damper in one element.
std::string property(const CardModel& cards, int id) {
  const bool has_spring = !cards.spring.argument.empty(), has_damper = !cards.damper.argument.empty();
  const bool is_plastic = !std::isnan(cards.unloading_stiffness);
  const double fastest = cards.rate.force.empty() ? 1.0 : cards.rate.force.back();  // K1 sets the time step
  const double elastic = has_spring ? fastest * cards.steepest : cards.newton_per_metre;
  const auto number = [](double value) { return number_field(value, kWidth); };
  std::string text = fmt::format("/PROP/TYPE4/{}\ncrashsim spring and damper\n", id);
  text += fmt::format(
      "#               Mass                                 sens_ID    Isflag     Ileng\n{}{:30}{:10}{:10}{:10}\n",
      number(kSpringMass * cards.mass), "", 0, 0, 0);
  text += fmt::format(
      "#                 K1                  C1                  A1                  B1                  "
      "D1\n{}{}{}{}{}\n",
      number(is_plastic ? cards.unloading_stiffness : elastic), number(0.0), number(1.0), number(0.0), number(1.0));
  text += fmt::format(
      "# fct_ID11        H1  fct_ID21  fct_ID31  fct_ID41                     delta_min           delta_max\n"
      "{:10}{:10}{:10}{:10}{:10}{:10}{}{}\n",
      has_spring ? id : 0, is_plastic ? kPlastic : kElastic, cards.rate.argument.empty() ? 0 : id + 1, 0,
      has_damper ? id + 1 : 0, "", number(0.0), number(0.0));
  text += fmt::format("#                 F1                  E1             Ascale1             Hscale1\n{}{}{}{}\n",
                      number(1.0), number(cards.rate.argument.empty() ? 0.0 : 1.0), number(1.0), number(1.0));
  return text;
}

/// g = factor - 1.
CardCurve less_one(CardCurve factor) {
  for (double& g : factor.force) g -= 1.0;
  return factor;
}

}  // namespace

std::string radioss_cards(const CardModel& cards, int id) {
  std::string text;
  if (!cards.spring.argument.empty()) text += function(id, "crashsim spring, force over deflection", cards.spring);
  if (!cards.damper.argument.empty()) text += function(id + 1, "crashsim damper, force over velocity", cards.damper);
  if (!cards.rate.argument.empty())
    text += function(id + 1, "crashsim rate, relative rise of the force over velocity", less_one(cards.rate));
  text += property(cards, id);
  text += fmt::format("/PART/{}\ncrashsim spring and damper\n#  prop_ID    mat_ID subset_ID\n{:10}{:10}{:10}\n", id, id,
                      0, 0);
  text += fmt::format(
      "# Node {} is the vehicle, node {} the barrier: put your own numbers into the element and leave these out.\n"
      "# For a run on its own, give node {} the mass {:.9g} (/ADMAS) less half the element's and the impact speed\n"
      "# (/INIVEL), and hold node {} (/BCS).\n/NODE\n",
      id, id + 1, id, cards.mass, id + 1);
  for (const auto& [node, x] : {std::pair(id, 0.0), std::pair(id + 1, cards.length)})
    text += fmt::format("{:10}{}{}{}\n", node, number_field(x, kWidth), number_field(0.0, kWidth),
                        number_field(0.0, kWidth));
  text += fmt::format("/SPRING/{}\n#  sprg_ID  node_ID1  node_ID2\n{:10}{:10}{:10}\n", id, id, id, id + 1);
  return text;
}

}  // namespace crashsim
