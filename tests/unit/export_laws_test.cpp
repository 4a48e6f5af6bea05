/// Exported models of the laws `crush_damping` and `rate`.

#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/error.hpp>
#include <crashsim/export.hpp>

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
using testing::SizeIs;
using testing::ThrowsMessage;

CrushModel rate_model() {
  CrushModel model = syn_a();
  model.damper = {};
  model.law = CrushLaw::rate;
  model.spring.ordinates = {0.0, 1e5, 2e5, 2e5, 3e5, 3e5, 4e5};
  model.rate_coefficient = 0.12;
  model.reference_speed_mps = 0.05;
  return model;
}

/// Compares a curve with 1 + r ln(1 + |v| / v_ref) less `offset` at random velocities [m/s].
void expect_rate(const Curve& curve, double unit, double offset) {
  test::Random random(12);
  const CrushModel model = rate_model();
  for (int i = 0; i < 1000; ++i) {
    const double v = random.between(-25.0, 25.0);
    const double factor = 1.0 + model.rate_coefficient * std::log1p(std::abs(v) / model.reference_speed_mps);
    ASSERT_NEAR(curve.at(v / unit), factor - offset, kCurveAccuracy * factor) << v;
  }
  EXPECT_NEAR(curve.at(0.0), 1.0 - offset, kPrinted);
}

TEST(ExportToLsdyna, ARateIsAFactorOverVelocity) {
  for (const System& system : kSystems) {
    const Deck deck(export_model(rate_model(), to("lsdyna", system.name, 7), kRecord).text, '$', '*');
    EXPECT_EQ(fields_of(deck.one("*MAT_SPRING_NONLINEAR_ELASTIC")[0], {10, 10, 10}),
              (std::vector<std::string>{"7", "7", "8"}));
    expect_rate(lsdyna_curve(deck, 8), system.speed_mps(), 0.0);
    expect_force(lsdyna_curve(deck, 7), system.length_m, system.force_n(), reach_of(rate_model().spring),
                 [&](double x) { return spring_force(rate_model(), x); });
    EXPECT_THAT(deck.all("*PART"), SizeIs(1)) << "no damper";
  }
  CrushModel model = rate_model();
  model.unloading = {.kind = UnloadingKind::plastic, .restitution = 0.2};
  EXPECT_THAT([&] { export_model(model, to("lsdyna"), kRecord); },
              ThrowsMessage<InvalidInput>(HasSubstr("law rate with plastic unloading has no card there")));
}

TEST(ExportToRadioss, ARateIsAFunctionOfVelocityTimesTheForce) {
  for (const System& system : kSystems) {
    const Deck deck(export_model(rate_model(), to("radioss", system.name, 7), kRecord).text, '#', '/');
    const auto property = deck.one("/PROP/TYPE4/7");
    const auto functions = fields_of(property.at(3), {10, 10, 10, 10, 10, 10, 20, 20});
    EXPECT_EQ(functions[0], "7");
    EXPECT_EQ(functions[2], "8") << "g(d') is fct_ID21";
    EXPECT_EQ(functions[4], "0");
    EXPECT_EQ(number(fields_of(property.at(4), {20, 20, 20, 20})[1]), 1.0) << "E";
    expect_rate(curve_of(deck.one("/FUNCT/8"), 1), system.speed_mps(), 1.0);
  }
  CrushModel model = rate_model();
  model.unloading = {.kind = UnloadingKind::plastic, .restitution = 0.2};
  EXPECT_THAT(export_model(model, to("radioss"), kRecord).notes,
              Contains(HasSubstr("the rate multiplies the force in unloading, too")));
}

CrushModel crush_damping_model() {
  CrushModel model = rate_model();
  model.law = CrushLaw::crush_damping;
  model.rate_coefficient = model.reference_speed_mps = kUnset;
  model.damper = {{0.0, 0.2, 0.5}, {2e3, 9e3, 1e3}};
  return model;
}

TEST(ExportToCards, DampingOverCrushIsRefusedUnlessItIsConstant) {
  CrushModel model = crush_damping_model();
  for (const char* target : {"lsdyna", "radioss"})
    EXPECT_THAT([&] { export_model(model, to(target), kRecord); },
                ThrowsMessage<InvalidInput>(testing::AllOf(
                    HasSubstr(std::string("export to ") + target + ": law crush_damping has no card there"),
                    HasSubstr("Export the curves as csv"))));
  EXPECT_THROW(damper_curve(model), InvalidInput);
  for (const PiecewiseLinear& damper : {PiecewiseLinear{{0.0}, {5e3}}, PiecewiseLinear{{0.0, 0.4}, {5e3, 5e3}}}) {
    model.damper = damper;
    const Deck deck(export_model(model, to("radioss"), kRecord).text, '#', '/');
    expect_force(curve_of(deck.one("/FUNCT/2"), 1), 1.0, 1.0, 1.5, [](double v) { return 5e3 * v; });
  }
}

/// Cells of a table by their columns, and its comments.
struct Csv {
  std::map<std::string, std::vector<std::string>> cells;
  std::string comments;
};
Csv csv_of(const CrushModel& model) {
  std::istringstream lines(export_model(model, to("csv"), kRecord).text);
  Csv csv;
  std::string line;
  while (std::getline(lines, line) && line.starts_with("#")) csv.comments += line + "\n";
  const auto split = [](const std::string& text) {
    std::vector<std::string> cells(1);
    for (const char c : text) c == ',' ? cells.emplace_back() : cells.back() += c;
    return cells;
  };
  const std::vector<std::string> names = split(line);
  while (std::getline(lines, line)) {
    const auto cells = split(line);
    for (std::size_t i = 0; i < names.size(); ++i)
      if (!cells.at(i).empty()) csv.cells[names[i]].push_back(cells[i]);
  }
  return csv;
}

TEST(ExportToCsv, DampingGoesOverCrushByLaw) {
  const CrushModel model = crush_damping_model();
  Csv csv = csv_of(model);
  EXPECT_THAT(csv.comments, HasSubstr("# force = spring_force_n(x) + damping_ns_per_m(x) v\n"));
  EXPECT_THAT(csv.cells["damper_crush_m"], ElementsAre("0", "0.2", "0.5", "0.75"));
  EXPECT_THAT(csv.cells["damping_ns_per_m"], ElementsAre("2000", "9000", "1000", "1000"));
  EXPECT_FALSE(csv.cells.contains("velocity_mps"));
  ASSERT_FALSE(csv.cells["crush_m"].empty());
  for (std::size_t i = 1; i < csv.cells["crush_m"].size(); ++i)
    EXPECT_EQ(number(csv.cells["spring_force_n"][i]), spring_force(model, number(csv.cells["crush_m"][i])));
}

TEST(ExportToCsv, ARateIsAFactor) {
  Csv csv = csv_of(rate_model());
  EXPECT_THAT(csv.comments, HasSubstr("# rate_coefficient = 0.12\n# reference_speed_mps = 0.05\n"));
  Curve factor;
  for (const std::string& cell : csv.cells["velocity_mps"]) factor.x.insert(factor.x.end(), number(cell));
  for (const std::string& cell : csv.cells["rate_factor"]) factor.y.push_back(number(cell));
  ASSERT_EQ(factor.x.size(), factor.y.size());
  for (const double v : {0.01, 0.3, 2.0, 17.0})
    EXPECT_NEAR(factor.at(v), 1.0 + 0.12 * std::log1p(v / 0.05), kCurveAccuracy);
}

}  // namespace
}  // namespace crashsim
