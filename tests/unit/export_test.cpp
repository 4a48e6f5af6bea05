/// Exported cards read back by their columns: their curves are the model's forces, their references hold, their signs
/// and units are the solver's.

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/error.hpp>
#include <crashsim/export.hpp>
#include <crashsim/simulate.hpp>

#include "support/exported_decks.hpp"

namespace crashsim {
namespace {

using test::Curve;
using test::curve_of;
using test::Deck;
using test::expect_force;
using test::fields_of;
using test::kPrinted;
using test::kRecord;
using test::kSystems;
using test::lsdyna_curve;
using test::number;
using test::reach_of;
using test::syn_a;
using test::System;
using test::to;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using testing::ThrowsMessage;

constexpr double kShortField = 1e-3;  // rounding: what is left in ten columns

CrushModel random_model(test::Random& random) {
  CrushModel model;
  model.mass_kg = random.between(800, 3000);
  model.impact_speed_mps = random.between(8, 20);
  model.extrapolation = static_cast<Extrapolation>(random.whole(0, 1));
  model.law = static_cast<CrushLaw>(random.whole(0, 1));
  for (int i = random.whole(1, 7); i-- > 0;) {
    model.spring.knots.push_back(model.spring.knots.empty() ? 0.0
                                                            : model.spring.knots.back() + random.between(0.02, 0.3));
    model.spring.ordinates.push_back(random.between(0, 2e6));
  }
  if (model.law == CrushLaw::force) model.spring.ordinates.front() = 0.0;
  for (int i = random.whole(1, 6); i-- > 0;) {
    model.damper.knots.push_back(model.damper.knots.empty() ? 0.0
                                                            : model.damper.knots.back() + random.between(0.5, 5.0));
    model.damper.ordinates.push_back(random.between(0, 9e4));
  }
  return model;
}

TEST(ExportToLsdyna, CurvesAreTheModelsForces) {
  test::Random random(1);
  for (int i = 0; i < 40; ++i) {
    const CrushModel model = random_model(random);
    const System& system = kSystems[i % 4];
    const Deck deck(export_model(model, to("lsdyna", system.name, 7), kRecord).text, '$', '*');
    expect_force(lsdyna_curve(deck, 7), system.length_m, system.force_n(), reach_of(model.spring),
                 [&](double x) { return spring_force(model, x); });
    expect_force(lsdyna_curve(deck, 8), system.speed_mps(), system.force_n(), reach_of(model.damper),
                 [&](double v) { return damper_force(model, v); });
  }
}

TEST(ExportToLsdyna, CardsBelongTogether) {
  const Exported exported = export_model(syn_a(), to("lsdyna", "t-mm-s", 4000), kRecord);
  const Deck deck(exported.text, '$', '*');
  EXPECT_EQ(fields_of(deck.one("*MAT_SPRING_NONLINEAR_ELASTIC")[0], {10, 10}),
            (std::vector<std::string>{"4000", "4000"}));
  EXPECT_EQ(fields_of(deck.one("*MAT_DAMPER_NONLINEAR_VISCOUS")[0], {10, 10}),
            (std::vector<std::string>{"4001", "4001"}));
  const auto parts = deck.all("*PART");
  ASSERT_THAT(parts, SizeIs(2));
  EXPECT_EQ(fields_of(parts[0][1], {10, 10, 10}), (std::vector<std::string>{"4000", "4000", "4000"}));
  EXPECT_EQ(fields_of(parts[1][1], {10, 10, 10}), (std::vector<std::string>{"4001", "4000", "4001"}));
  const auto section = deck.one("*SECTION_DISCRETE");
  ASSERT_THAT(section, SizeIs(2)) << "the second card is mandatory";
  EXPECT_EQ(fields_of(section[0], {10, 10, 10, 10, 10, 10})[0], "4000");
  const auto elements = deck.one("*ELEMENT_DISCRETE");
  ASSERT_THAT(elements, SizeIs(2));
  for (std::size_t i = 0; i < 2; ++i) {
    const auto fields = fields_of(elements[i], {8, 8, 8, 8, 8, 16, 8, 16});
    EXPECT_EQ(fields[1], std::to_string(4000 + i)) << "part";
    EXPECT_EQ(fields[2], "4000") << "vehicle";
    EXPECT_EQ(fields[3], "4001") << "barrier";
    EXPECT_EQ(fields[5], "1.0") << "a blank scale would be zero";
  }
  const auto nodes = deck.one("*NODE");
  ASSERT_THAT(nodes, SizeIs(2));
  const auto vehicle = fields_of(nodes[0], {8, 16, 16, 16, 8, 8}), barrier = fields_of(nodes[1], {8, 16, 16, 16, 8, 8});
  EXPECT_GT(number(barrier[1]) - number(vehicle[1]), 1.5 * 700.0) << "mm: the spring does not turn over";
  EXPECT_THAT(exported.text, HasSubstr("$ record = {\"format\":\"crashsim.record\""));
  EXPECT_THAT(exported.text, HasSubstr("positive in tension: crush is compression, negative"));
  EXPECT_THAT(exported.notes, ElementsAre(HasSubstr("loss of contact is not in the cards")));
  EXPECT_THAT(exported.text, HasSubstr("$ NOTE: loss of contact"));
}

TEST(ExportToLsdyna, PlasticUnloadingIsAStraightLineBack) {
  CrushModel model = syn_a();
  model.unloading = {.kind = UnloadingKind::plastic, .unloading_stiffness_n_per_m = 7e6};
  const Exported exported = export_model(model, to("lsdyna", "t-mm-s", 10), kRecord);
  const Deck deck(exported.text, '$', '*');
  EXPECT_THAT(deck.all("*MAT_SPRING_NONLINEAR_ELASTIC"), IsEmpty());
  const auto fields = fields_of(deck.one("*MAT_SPRING_GENERAL_NONLINEAR")[0], {10, 10, 10, 10, 10, 10});
  EXPECT_THAT(std::vector<std::string>(fields.begin(), fields.begin() + 4), ElementsAre("10", "10", "12", "0.0"));
  EXPECT_GT(number(fields[4]), 0.0) << "tension";
  EXPECT_NEAR(number(fields[5]), -number(fields[4]), kShortField * number(fields[4])) << "compression";
  const Curve unloading = lsdyna_curve(deck, 12);
  EXPECT_NEAR(unloading.at(-100.0), -100.0 * 7e3, kPrinted * 7e5) << "N over mm";
  EXPECT_THAT(exported.notes, Contains(HasSubstr("the damper works in unloading, too")));
}

TEST(ExportToLsdyna, RestitutionTellsTheUnloadingStiffnessAtTheModelsSpeed) {
  constexpr double kSolver = 1e-6;  // solver: maximum crush, relative
  CrushModel model = syn_a();
  model.unloading = {.kind = UnloadingKind::plastic, .restitution = 0.2};
  const Exported exported = export_model(model, to("lsdyna"), kRecord);
  const double crush = simulate(model).max_crush_m, v = model.impact_speed_mps;
  const double force = spring_force(model, crush), k_u = force * force / (0.04 * model.mass_kg * v * v);
  EXPECT_NEAR(lsdyna_curve(Deck(exported.text, '$', '*'), 3).at(0.1), 0.1 * k_u, kSolver * k_u);
  EXPECT_THAT(exported.notes, Contains(HasSubstr("that of restitution 0.2 at 15.5556 m/s")));
  model.unloading.restitution = 0.0;
  EXPECT_THAT(export_model(model, to("lsdyna"), kRecord).notes,
              Contains(HasSubstr("restitution 0 cannot be had from a spring: the cards unload with 0.05")));
  model.impact_speed_mps = kUnset;
  EXPECT_THAT([&] { export_model(model, to("lsdyna"), kRecord); },
              ThrowsMessage<InvalidInput>(HasSubstr("give the model impact_speed_mps")));
}

TEST(ExportToRadioss, CurvesAreTheModelsForces) {
  test::Random random(2);
  for (int i = 0; i < 40; ++i) {
    const CrushModel model = random_model(random);
    const System& system = kSystems[i % 4];
    const Deck deck(export_model(model, to("radioss", system.name, 7), kRecord).text, '#', '/');
    expect_force(curve_of(deck.one("/FUNCT/7"), 1), system.length_m, system.force_n(), reach_of(model.spring),
                 [&](double x) { return spring_force(model, x); });
    expect_force(curve_of(deck.one("/FUNCT/8"), 1), system.speed_mps(), system.force_n(), reach_of(model.damper),
                 [&](double v) { return damper_force(model, v); });
  }
}

TEST(ExportToRadioss, CardsBelongTogether) {
  CrushModel model = syn_a();
  const auto property_of = [&] {
    return Deck(export_model(model, to("radioss", "t-mm-s", 50), kRecord).text, '#', '/').one("/PROP/TYPE4/50");
  };
  const auto property = property_of();
  ASSERT_THAT(property, SizeIs(5));
  EXPECT_NEAR(number(fields_of(property[1], {20, 30, 10, 10, 10})[0]), 1e-3 * 2.582, kPrinted) << "t";
  const auto linear = fields_of(property[2], {20, 20, 20, 20, 20});
  EXPECT_GE(number(linear[0]), 3e3 * 0.9) << "N/mm: not below the steepest slope, which sets the time step";
  EXPECT_THAT(linear, ElementsAre(testing::_, "0", "1", "0", "1")) << "C1, A1 scales the force, B1, D1 the velocity";
  EXPECT_THAT(fields_of(property[3], {10, 10, 10, 10, 10, 10, 20, 20}),
              ElementsAre("50", "0", "0", "0", "51", "", "0", "0"))
      << "and no rupture";
  EXPECT_THAT(fields_of(property[4], {20, 20, 20, 20}), ElementsAre("1", "0", "1", "1")) << "F1, E1, Ascale1, Hscale1";
  const Deck deck(export_model(model, to("radioss", "t-mm-s", 50), kRecord).text, '#', '/');
  EXPECT_EQ(fields_of(deck.one("/PART/50")[1], {10, 10, 10})[0], "50");
  EXPECT_EQ(fields_of(deck.one("/SPRING/50")[0], {10, 10, 10}), (std::vector<std::string>{"50", "50", "51"}));
  EXPECT_THAT(deck.one("/NODE"), SizeIs(2));

  model.unloading = {.kind = UnloadingKind::plastic, .unloading_stiffness_n_per_m = 1e5};
  EXPECT_EQ(fields_of(property_of()[3], {10, 10, 10, 10, 10, 10, 20, 20})[1], "1") << "elasto-plastic";
  EXPECT_EQ(number(fields_of(property_of()[2], {20, 20, 20, 20, 20})[0]), 100.0) << "N/mm";
  EXPECT_THAT(export_model(model, to("radioss"), kRecord).notes,
              Contains(HasSubstr("the unloading stiffness 100000 is below the steepest loading")));
}

TEST(ExportToCards, WhatCannotBeSaidIsNoted) {
  CrushModel model = syn_a();
  model.unloading.bilateral = true;
  EXPECT_THAT(export_model(model, to("radioss"), kRecord).notes, IsEmpty());
  model.extrapolation = Extrapolation::error;
  EXPECT_THAT(export_model(model, to("radioss"), kRecord).notes,
              ElementsAre(HasSubstr("the model ends where a curve's knots end")));
  model.extrapolation = Extrapolation::linear;
  EXPECT_THAT(export_model(model, to("radioss"), kRecord).notes, ElementsAre(HasSubstr("along its parabola")));
  model.extrapolation = Extrapolation::constant;
  model.law = CrushLaw::force;
  model.spring = {{0.0, 0.5}, {2e5, 4e5}};
  const Exported exported = export_model(model, to("lsdyna"), kRecord);
  EXPECT_THAT(exported.notes,
              ElementsAre(HasSubstr("the spring starts with 200000 N at once; the cards reach it within "
                                    "0.5 mm")));
  const Curve curve = lsdyna_curve(Deck(exported.text, '$', '*'), 1);
  EXPECT_EQ(curve.at(0.0), 0.0);
  EXPECT_NEAR(curve.at(-0.25), -3e5, kPrinted * 3e5);
  EXPECT_NEAR(curve.at(0.7), 4e5, kPrinted * 4e5) << "held beyond the last knot";
}

TEST(ExportToCards, ASpringOrADamperAloneIsEnough) {
  CrushModel spring = syn_a(), damper = syn_a();
  spring.damper = {};
  damper.spring = {};
  const Deck one(export_model(spring, to("lsdyna"), kRecord).text, '$', '*');
  EXPECT_THAT(one.all("*DEFINE_CURVE_TITLE"), SizeIs(1));
  EXPECT_THAT(one.one("*ELEMENT_DISCRETE"), SizeIs(1));
  EXPECT_THAT(one.all("*MAT_DAMPER_NONLINEAR_VISCOUS"), IsEmpty());
  const Deck other(export_model(damper, to("radioss"), kRecord).text, '#', '/');
  EXPECT_THAT(other.all("/FUNCT/1"), IsEmpty());
  const auto functions = fields_of(other.one("/PROP/TYPE4/1")[3], {10, 10, 10, 10, 10, 10, 20, 20});
  EXPECT_EQ(functions[0], "0");
  EXPECT_EQ(functions[4], "2");
}

TEST(ExportToCsv, TablesHoldTheForcesAndCoefficients) {
  const CrushModel model = syn_a();
  std::istringstream lines(export_model(model, to("csv"), kRecord).text);
  std::string line;
  while (std::getline(lines, line) && line.starts_with("#")) {
  }
  EXPECT_EQ(line, "crush_m,stiffness_n_per_m,spring_force_n,velocity_mps,damping_ns_per_m,damper_force_n");
  int springs = 0, dampers = 0;
  for (; std::getline(lines, line); ++springs) {
    std::vector<std::string> cells(1);
    for (const char c : line) c == ',' ? cells.emplace_back() : cells.back() += c;
    ASSERT_THAT(cells, SizeIs(6));
    if (!cells[0].empty()) {
      const double x = number(cells[0]);
      EXPECT_EQ(number(cells[2]), spring_force(model, x));
      EXPECT_NEAR(number(cells[1]), evaluate(model.spring, x), kPrinted * 3e6);
    }
    if (cells[3].empty()) continue;
    ++dampers;
    EXPECT_EQ(number(cells[5]), damper_force(model, number(cells[3])));
    EXPECT_NEAR(number(cells[4]), evaluate(model.damper, number(cells[3])), kPrinted * 6e4);
  }
  EXPECT_GT(springs, 7);
  EXPECT_GT(dampers, 7);
}

TEST(Export, CurvesHaveTheKnotsAndEndAsTheModelSays) {
  CrushModel model = syn_a();
  const ForceCurve curve = spring_curve(model);
  for (const double knot : model.spring.knots) EXPECT_THAT(curve.argument, Contains(knot));
  EXPECT_DOUBLE_EQ(curve.argument.back(), 1.5 * 0.7);
  EXPECT_THAT(curve.argument, SizeIs(testing::Lt(400u)));
  model.extrapolation = Extrapolation::error;
  EXPECT_EQ(spring_curve(model).argument.back(), 0.7);
  model.spring = {{0.0}, {5e5}};
  EXPECT_THAT(spring_curve(model).force_n, Not(IsEmpty()));
  model.spring = {};
  EXPECT_THAT(spring_curve(model).argument, IsEmpty());
}

}  // namespace
}  // namespace crashsim
