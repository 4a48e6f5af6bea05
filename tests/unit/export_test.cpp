/// Exported cards read back by their columns: their curves are the model's forces, their references hold, their signs
/// and units are the solver's.

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <crashsim/error.hpp>
#include <crashsim/export.hpp>
#include <crashsim/model_io.hpp>
#include <crashsim/simulate.hpp>
#include <crashsim/units.hpp>

#include "support/random.hpp"
#include "support/source_dir.hpp"

namespace crashsim {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using testing::ThrowsMessage;

constexpr double kPrinted = 1e-9;     // rounding: numbers have twelve digits
constexpr double kShortField = 1e-3;  // rounding: what is left in ten columns

const Record kRecord = {"0.0.0", "export", {"model.json"}, {}, {}};

struct System {
  const char* name;
  double mass_kg, length_m, time_s;
  [[nodiscard]] double force_n() const { return mass_kg * length_m / (time_s * time_s); }
  [[nodiscard]] double speed_mps() const { return length_m / time_s; }
};
constexpr System kSystems[] = {
    {"kg-m-s", 1, 1, 1}, {"t-mm-s", 1e3, 1e-3, 1}, {"kg-mm-ms", 1, 1e-3, 1e-3}, {"g-mm-ms", 1e-3, 1e-3, 1e-3}};

/// Fields of a line by their widths.
std::vector<std::string> fields_of(const std::string& line, const std::vector<std::size_t>& widths) {
  std::vector<std::string> fields;
  std::size_t at = 0;
  for (const std::size_t width : widths) {
    const std::string field = at < line.size() ? line.substr(at, width) : "";
    const std::size_t first = field.find_first_not_of(' '), last = field.find_last_not_of(' ');
    fields.push_back(first == std::string::npos ? "" : field.substr(first, last - first + 1));
    at += width;
  }
  EXPECT_LE(line.size(), at) << line;
  return fields;
}

double number(const std::string& field) {
  const auto value = parse_number(field);
  EXPECT_TRUE(value.has_value()) << "'" << field << "'";
  return value.value_or(std::nan(""));
}

/// Data lines below each keyword, without comments; "*PART" may come twice.
class Deck {
 public:
  Deck(const std::string& text, char comment, char keyword) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with(comment)) continue;
      if (line.starts_with(keyword))
        blocks_.push_back({line, {}});
      else if (!blocks_.empty())
        blocks_.back().second.push_back(line);
      else
        ADD_FAILURE() << "before any keyword: " << line;
    }
  }
  [[nodiscard]] std::vector<std::vector<std::string>> all(const std::string& keyword) const {
    std::vector<std::vector<std::string>> found;
    for (const auto& [name, lines] : blocks_)
      if (name == keyword) found.push_back(lines);
    return found;
  }
  [[nodiscard]] std::vector<std::string> one(const std::string& keyword) const {
    const auto found = all(keyword);
    EXPECT_THAT(found, SizeIs(1)) << keyword;
    return found.empty() ? std::vector<std::string>{"", "", "", ""} : found.front();
  }

 private:
  std::vector<std::pair<std::string, std::vector<std::string>>> blocks_;
};

struct Curve {
  std::vector<double> x, y;
  [[nodiscard]] double at(double s) const {
    const auto above = std::clamp(std::upper_bound(x.begin(), x.end(), s), x.begin() + 1, x.end() - 1) - x.begin();
    const auto i = static_cast<std::size_t>(above);
    return y[i - 1] + (y[i] - y[i - 1]) * (s - x[i - 1]) / (x[i] - x[i - 1]);
  }
};

Curve curve_of(const std::vector<std::string>& lines, std::size_t first) {
  Curve curve;
  for (std::size_t i = first; i < lines.size(); ++i) {
    const auto fields = fields_of(lines[i], {20, 20});
    curve.x.push_back(number(fields[0]));
    curve.y.push_back(number(fields[1]));
  }
  EXPECT_TRUE(std::is_sorted(curve.x.begin(), curve.x.end(), std::less_equal<>())) << "increasing strictly";
  return curve;
}

/// The curve of LS-DYNA with this number.
Curve lsdyna_curve(const Deck& deck, int id) {
  for (const auto& lines : deck.all("*DEFINE_CURVE_TITLE")) {
    const auto fields = fields_of(lines.at(1), {10, 10, 10, 10, 10, 10, 10, 10});
    if (fields[0] == std::to_string(id)) return curve_of(lines, 2);
  }
  ADD_FAILURE() << "no curve " << id;
  return {{0, 1}, {0, 0}};
}

/// Compares a curve of the deck with a force of the model at random places on both sides.
template <class Force>
void expect_force(const Curve& curve, double unit, double force_unit, double reach, const Force& force) {
  test::Random random(11);
  double peak = 0.0;
  for (int i = 0; i <= 1000; ++i) peak = std::max(peak, std::abs(force(reach * i / 1000.0)));
  for (int i = 0; i < 1000; ++i) {
    const double s = random.between(-reach, reach);
    ASSERT_NEAR(curve.at(s / unit) * force_unit, force(s), kCurveAccuracy * peak) << s;
  }
  EXPECT_NEAR(curve.at(0.0), 0.0, kPrinted * peak / force_unit);
  EXPECT_NEAR(curve.x.front(), -curve.x.back(), kPrinted * curve.x.back()) << "both quadrants";
}

CrushModel syn_a() { return read_model(std::string(test::source_dir()) + "/data/syn-a/model.json"); }

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

double reach_of(const PiecewiseLinear& law) { return 1.5 * (law.knots.size() == 1 ? 1.0 : law.knots.back()); }

ExportOptions to(const std::string& target, const std::string& units = "kg-m-s", int id = 1) {
  return {.to = target, .units = units, .first_id = id};
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
