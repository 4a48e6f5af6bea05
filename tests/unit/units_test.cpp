#include <crashsim/units.hpp>

#include <cmath>
#include <limits>
#include <ostream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <crashsim/error.hpp>

namespace crashsim {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

struct Spelling {
  const char* text;
  Dimension dimension;
  double to_si;
};
void PrintTo(const Spelling& s, std::ostream* out) { *out << s.text; }

class FindUnit : public testing::TestWithParam<Spelling> {};

TEST_P(FindUnit, KnowsTheSpelling) {
  const auto unit = find_unit(GetParam().text);
  ASSERT_TRUE(unit.has_value());
  EXPECT_EQ(unit->dimension, GetParam().dimension) << dimension_name(unit->dimension);
  EXPECT_DOUBLE_EQ(unit->to_si, GetParam().to_si);
}

using enum Dimension;
INSTANTIATE_TEST_SUITE_P(
    AsFilesAndPeopleSpell, FindUnit,
    testing::Values(
        Spelling{"s", time, 1}, Spelling{"SEC", time, 1}, Spelling{"ms", time, 1e-3}, Spelling{"us", time, 1e-6},
        Spelling{"m", length, 1}, Spelling{"MM", length, 1e-3}, Spelling{"in", length, 0.0254},
        Spelling{"ft", length, 0.3048}, Spelling{"µm", length, 1e-6}, Spelling{"m/s", speed, 1},
        Spelling{"mm/s", speed, 1e-3}, Spelling{"mm/ms", speed, 1}, Spelling{"km/h", speed, 1 / 3.6},
        Spelling{"KPH", speed, 1 / 3.6}, Spelling{"mph", speed, 0.44704}, Spelling{"m/sec", speed, 1},
        Spelling{"G'S", acceleration, 9.80665}, Spelling{"g", acceleration, 9.80665},
        Spelling{"G", acceleration, 9.80665}, Spelling{"m/s^2", acceleration, 1}, Spelling{"m/s²", acceleration, 1},
        Spelling{"m/(s*s)", acceleration, 1}, Spelling{"m s-2", acceleration, 1}, Spelling{"mps2", acceleration, 1},
        Spelling{"mm/s^2", acceleration, 1e-3}, Spelling{"mm/ms^2", acceleration, 1e3}, Spelling{"kg", mass, 1},
        Spelling{"t", mass, 1e3}, Spelling{"Mg", mass, 1e3}, Spelling{"lb", mass, 0.45359237},
        Spelling{"mg", mass, 1e-6}, Spelling{"N", force, 1}, Spelling{"NWT", force, 1}, Spelling{"kN", force, 1e3},
        Spelling{"KN", force, 1e3}, Spelling{"lbf", force, 4.4482216152605}, Spelling{"N m", moment, 1},
        Spelling{"NWM", moment, 1}, Spelling{"Nm", moment, 1}, Spelling{"N.mm", moment, 1e-3},
        Spelling{"N/m", stiffness, 1}, Spelling{"n_per_m", stiffness, 1}, Spelling{"N/mm", stiffness, 1e3},
        Spelling{"kN/m", stiffness, 1e3}, Spelling{"N s/m", damping, 1}, Spelling{"ns_per_m", damping, 1},
        Spelling{"J", energy, 1}, Spelling{"kJ", energy, 1e3}, Spelling{"N s", impulse, 1}, Spelling{"N.s", impulse, 1},
        Spelling{"Mg.mm/s", impulse, 1}, Spelling{"rad", angle, 1}, Spelling{"°", angle, 0.017453292519943295},
        Spelling{"deg/s", angular_rate, 0.017453292519943295}, Spelling{"DPS", angular_rate, 0.017453292519943295},
        Spelling{"rad/s^2", angular_acceleration, 1}, Spelling{"kg m^2", inertia, 1}, Spelling{"Hz", frequency, 1},
        Spelling{"kHz", frequency, 1e3}, Spelling{"rad/m", angle_per_length, 1},
        Spelling{"deg/m", angle_per_length, 0.017453292519943295}, Spelling{"-", none, 1}, Spelling{"%", none, 0.01}));

TEST(Units, LetterCaseCountsWhereItTellsUnitsApart) {
  EXPECT_FALSE(find_unit("MG").has_value());
  EXPECT_DOUBLE_EQ(find_unit("MN")->to_si, 1e6);
  EXPECT_DOUBLE_EQ(find_unit("mN")->to_si, 1e-3);
  EXPECT_FALSE(find_unit("furlong").has_value());
  EXPECT_FALSE(find_unit("").has_value());
}

TEST(Units, ADimensionTellsUnitsOfOneSpellingApart) {
  EXPECT_EQ(find_unit("g", mass)->to_si, 1e-3);
  EXPECT_EQ(find_unit("Nm", energy)->dimension, energy);
  EXPECT_FALSE(find_unit("N", mass).has_value());
}

TEST(Units, QuantitiesAcceptAUnitAndABareNumberIsSi) {
  EXPECT_DOUBLE_EQ(quantity("56km/h", speed), 56 / 3.6);
  EXPECT_DOUBLE_EQ(quantity(" 35 mph ", speed), 15.6464);
  EXPECT_DOUBLE_EQ(quantity("15.5", speed), 15.5);
  EXPECT_DOUBLE_EQ(quantity("2.58t", mass), 2580);
  EXPECT_DOUBLE_EQ(quantity("500 g", mass), 0.5);
  EXPECT_DOUBLE_EQ(quantity("-20g", acceleration), -196.133);
  EXPECT_DOUBLE_EQ(quantity("120ms", time), 0.12);
  EXPECT_DOUBLE_EQ(quantity("1e3 N/mm", stiffness), 1e6);
  EXPECT_DOUBLE_EQ(quantity("5 N m", energy), 5);
  EXPECT_DOUBLE_EQ(quantity("+7", none), 7);
}

TEST(Units, QuantitiesNameTheValueTheRuleAndTheRemedy) {
  EXPECT_THAT(
      [] { quantity("56kmm/h", speed, "speed"); },
      ThrowsMessage<InvalidInput>(AllOf(HasSubstr("speed = '56kmm/h': unknown unit 'kmm/h'; use one of m/s, mm/s,"),
                                        HasSubstr("mph"), HasSubstr("or a bare number in m/s"))));
  EXPECT_THAT([] { quantity("5 kg", speed, "impact.speed"); },
              ThrowsMessage<InvalidInput>(HasSubstr("impact.speed = '5 kg': 'kg' measures mass, not speed")));
  EXPECT_THAT([] { quantity("fast", speed); }, ThrowsMessage<InvalidInput>(HasSubstr("is not a finite number")));
  EXPECT_THAT([] { quantity("", mass); }, ThrowsMessage<InvalidInput>(HasSubstr("is not a finite number")));
  EXPECT_THAT([] { quantity("nan", mass); }, ThrowsMessage<InvalidInput>(HasSubstr("is not a finite number")));
  EXPECT_THAT([] { quantity("1e999kg", mass); }, ThrowsMessage<InvalidInput>(HasSubstr("is not a finite number")));
  EXPECT_THAT([] { quantity("57,09 km/h", speed); }, ThrowsMessage<InvalidInput>(HasSubstr("the decimal mark is '.'")));
  EXPECT_THAT([] { quantity("7 m", none); }, ThrowsMessage<InvalidInput>(HasSubstr("give a pure number")));
}

TEST(Units, DimensionsAndTheirSymbolsGoBothWays) {
  for (const auto dimension :
       {time, length, speed, acceleration, mass, force, moment, stiffness, damping, energy, impulse, angle,
        angular_rate, angular_acceleration, inertia, frequency, angle_per_length}) {
    EXPECT_EQ(dimension_of(si_symbol(dimension)), dimension);
    EXPECT_DOUBLE_EQ(quantity(fmt::format("1{}", si_symbol(dimension)), dimension), 1.0);
  }
  EXPECT_EQ(dimension_of(""), none);
  EXPECT_EQ(dimension_name(angular_rate), "angular rate");
  EXPECT_THAT([] { dimension_of("parsec"); }, ThrowsMessage<InvalidInput>(HasSubstr("'parsec' is not the symbol")));
}

TEST(Units, NumbersAreReadWholeAndWrittenShortest) {
  EXPECT_EQ(parse_number(" +1.5e-3 "), 1.5e-3);
  EXPECT_EQ(parse_number("1e-400"), 0.0);
  EXPECT_EQ(parse_number("-1e400"), -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(parse_number("NaN").value()));
  for (const char* text : {"", "1,5", "1.5x", "+-1", "--1", "e5", "."}) EXPECT_FALSE(parse_number(text)) << text;
  EXPECT_EQ(format_number(0.1), "0.1");
  EXPECT_EQ(format_number(1719), "1719");
  EXPECT_EQ(parse_number(format_number(1.0 / 3.0)), 1.0 / 3.0);
}

}  // namespace
}  // namespace crashsim
