#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <crashsim/error.hpp>
#include <crashsim/trace_io.hpp>

#include "support/shared_data.hpp"
#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

/// What the converter writes for one part, one wall and one node; every value is its column's number, times the row.
std::string converted() {
  std::string names = "\"time\",\"INTERNAL ENERGY\",\"KINETIC ENERGY\",\"X-MOMENTUM\",\"MASS\",\"part1      KE \"";
  std::string rows[2] = {"0", "1"};
  const auto add = [&](const std::string& name) { names += fmt::format(",\"{}\"", name); };
  for (int i = 0; i < 6; ++i) add(fmt::format("TH RWALL      1 Barrier      var {}", 6 + i));
  for (int i = 0; i < 9; ++i) add(fmt::format("outputblock1      250 LEFT_REAR      var {}", 12 + i));
  add("part2      MASS ");
  for (int column = 2; column <= 22; ++column)
    for (int row = 0; row < 2; ++row) rows[row] += fmt::format(",{}", column * row);
  return fmt::format("{}\n{}\n{}\n", names, rows[0], rows[1]);
}

const Trace& named(const TraceSet& set, const std::string& name) {
  return set.traces.at(select_channels(set, name).at(0));
}

TEST(RadiossCsv, NumberedVariablesAreNamedByTheirOrder) {
  const test::TempDir dir;
  const TraceSet set = read_traces(dir.file("t.csv", converted()), {.channels = {}, .columns = "", .units = "t-mm-s"});
  EXPECT_EQ(set.format, "radioss_csv");
  ASSERT_EQ(set.traces.size(), 21u);
  const Trace& wall = named(set, "Barrier_FTX");
  EXPECT_EQ(wall.id, "10");
  EXPECT_EQ(wall.dimension, Dimension::impulse) << "cumulative, as the run writes it";
  EXPECT_THAT(wall.values, ElementsAre(0, DoubleEq(10.0)));
  const Trace& speed = named(set, "LEFT_REAR_VX");
  EXPECT_EQ(speed.dimension, Dimension::speed);
  EXPECT_EQ(speed.axis, 'X');
  EXPECT_EQ(speed.location, "LEFT_REAR");
  EXPECT_THAT(speed.values, ElementsAre(0, DoubleEq(0.016)));
  EXPECT_EQ(named(set, "LEFT_REAR_AZ").dimension, Dimension::acceleration);
  EXPECT_THAT(named(set, "KINETIC ENERGY").values, ElementsAre(0, DoubleEq(0.003)));
  EXPECT_EQ(named(set, "part1_KE").dimension, Dimension::energy);
  EXPECT_THAT(named(set, "MASS").values, ElementsAre(0, DoubleEq(5000.0)));
  EXPECT_THAT(named(set, "part2_MASS").values, ElementsAre(0, DoubleEq(22000.0)));
}

TEST(RadiossCsv, OnlyTheGroupsTitleMakesAWall) {
  const test::TempDir dir;
  const auto read = [&](const std::string& entity, int variables) {
    std::string names = "\"time\",\"INTERNAL ENERGY\",\"KINETIC ENERGY\"", rows[2] = {"0,0,0", "1,1,1"};
    for (int i = 0; i < variables; ++i) names += fmt::format(",\"{} var {}\"", entity, i + 4);
    for (int i = 0; i < variables; ++i)
      for (std::string& row : rows) row += ",0";
    return read_traces(dir.file("t.csv", fmt::format("{}\n{}\n{}\n", names, rows[0], rows[1])));
  };
  const TraceSet nodes = read("outputblock1 250 FIREWALL", 9);
  EXPECT_EQ(nodes.traces[5].name, "FIREWALL_VX");
  EXPECT_EQ(nodes.traces[5].dimension, Dimension::speed);
  const TraceSet node = read("outputblock1 250 FIREWALL", 6);
  EXPECT_EQ(node.traces[2].name, "FIREWALL_var1");
  EXPECT_EQ(node.traces[2].dimension, Dimension::unknown);
  EXPECT_EQ(read("TH RWALL 1 Barrier", 6).traces[2].name, "Barrier_FNX");
}

TEST(RadiossCsv, VariablesNamedByTheRunsTitlesHaveForcesAlready) {
  const test::TempDir dir;
  const TraceSet set =
      read_traces(dir.file("t.csv",
                           "\"time\",\"INTERNAL ENERGY\",\"KINETIC ENERGY\",\"TH RWALL   1 Barrier    FNX \","
                           "\"block   250 LEFT_REAR    VX \"\n0,0,0,0,0\n1e-3,1,2,3000,-4000\n"),
                  {.channels = {}, .columns = "", .units = "t-mm-s"});
  EXPECT_EQ(set.traces[2].dimension, Dimension::force);
  EXPECT_EQ(set.traces[3].dimension, Dimension::speed);
  EXPECT_THAT(set.traces[3].values, ElementsAre(0, DoubleEq(-4.0)));
}

TEST(RadiossCsv, HeadersThatSayTheirUnitsNeedNoSystem) {
  const test::TempDir dir;
  const TraceSet set = read_traces(
      dir.file("t.csv",
               "time_s,mass_Mg,px_Mg.mm/s,IE_N.mm,wall_FNX_N.s,N1_DX,N1_VX,N1_AX\n0,1.19,-13222,0,0,0,-11.1,0\n"
               "1e-4,1.19,-13000,500,-30,-1e-3,-11,9\n"));
  EXPECT_EQ(set.format, "radioss_csv");
  EXPECT_THAT(named(set, "mass").values, ElementsAre(DoubleEq(1190), DoubleEq(1190)));
  EXPECT_THAT(named(set, "px").values, ElementsAre(-13222, -13000));
  EXPECT_EQ(named(set, "IE").dimension, Dimension::energy);
  EXPECT_THAT(named(set, "IE").values, ElementsAre(0, DoubleEq(0.5)));
  EXPECT_EQ(named(set, "wall_FNX").dimension, Dimension::impulse);
  EXPECT_THAT(named(set, "N1_VX").values, ElementsAre(-11.1, -11));
  EXPECT_THAT(set.warnings, IsEmpty());
}

TEST(RadiossCsv, GlobalVariablesThatTheConverterMiscountsAreMended) {
  const test::TempDir dir;
  std::string names = "\"time\",";
  for (const char* name :
       {"INTERNAL ENERGY", "KINETIC ENERGY", "X-MOMENTUM", "Y-MOMENTUM", "Z-MOMENTUM", "MASS", "TIME STEP",
        "ROTATION ENERGY", "EXTERNAL WORK", "SPRING ENERGY", "CONTACT ENERGY", "HOURGLASS ENERGY"})
    names += fmt::format("\"{}\",", name);
  const auto read = [&](const std::string& more_names, int columns) {
    std::string rows[2] = {"0", "1"};
    for (int column = 2; column <= columns; ++column)
      for (int row = 0; row < 2; ++row) rows[row] += fmt::format(",{}", column * row);
    const std::string text = names + more_names + "\"part1      KE \"\n" + rows[0] + "\n" + rows[1] + "\n";
    return read_traces(dir.file("t.csv", text));
  };
  const TraceSet too_few = read("", 18);  // sixteen written, twelve named
  ASSERT_EQ(too_few.traces.size(), 17u);
  EXPECT_EQ(named(too_few, "PLASTIC WORK").values.back(), 17.0);
  EXPECT_EQ(named(too_few, "part1_KE").values.back(), 18.0);
  const TraceSet too_many = read(
      "\"ELASTIC CONTACT ENERGY\",\"FRICTIONAL CONTACT ENERGY\",\"DAMPING CONTACT ENERGY \",\"PLASTIC WORK\",\"ADDED "
      "MASS\",\"PLASTIC WORK\",",
      19);  // one of them twice
  ASSERT_EQ(too_many.traces.size(), 18u);
  EXPECT_EQ(named(too_many, "ADDED MASS").values.back(), 18.0);
  EXPECT_EQ(named(too_many, "part1_KE").values.back(), 19.0);
  EXPECT_THROW(read("", 12), InvalidInput) << "a column of the parts is missing";
}

TEST(RadiossCsv, SizesThatNoVehicleHasInSiAreSaid) {
  const test::TempDir dir;
  const std::string header = "time,N1_DX,N1_VX,N1_AX\n";
  const auto warnings = [&](const std::string& rows, const std::string& units) {
    return read_traces(dir.file("t.csv", header + rows), {.channels = {}, .columns = "", .units = units}).warnings;
  };
  EXPECT_THAT(warnings("0,0,-11111,0\n1,-1,-11000,0\n", ""),
              ElementsAre(HasSubstr("channel N1_VX reaches 11111 m/s, too much for a vehicle: are its units not SI?")));
  EXPECT_THAT(warnings("0,0,-11.1,0\n150,-1,-11,0\n", ""), ElementsAre(HasSubstr("lasts 150 s, too long for a crash")));
  EXPECT_THAT(warnings("0,0,-11111,0\n1,-1,-11000,0\n", "t-mm-s"), IsEmpty());
}

TEST(RadiossCsv, SizesAreJudgedAlsoInUnitsThatWereGiven) {
  const test::TempDir dir;
  const std::string path = dir.file("t.csv", "time,N1_DX,N1_VX,N1_AX\n0,0,-11.1,0\n0.1,-1,-11,0\n");
  EXPECT_THAT(read_traces(path, {.channels = {}, .columns = "", .units = "kg-mm-ms"}).warnings, IsEmpty());
  EXPECT_THAT(read_traces(dir.file("t.csv", "time,N1_DX,N1_VX,N1_AX\n0,0,-11111,0\n1,-1,-11000,0\n"),
                          {.channels = {}, .columns = "", .units = "g-mm-ms"})
                  .warnings,
              ElementsAre(HasSubstr("channel N1_VX reaches 11111 m/s, too much for a vehicle: are its units not "
                                    "g-mm-ms? say others, for example units = kg-m-s")));
}

TEST(RadiossCsv, GravityTellsTheUnitsWhateverWasSaid) {
  const test::TempDir dir;
  const auto warnings = [&](const std::string& accelerations, const std::string& units) {
    return read_traces(dir.file("t.csv", "time,A_VX,A_AZ,B_AZ,C_AZ,A_AX\n0,0," + accelerations + "\n1,0,1,1,1,0\n"),
                       {.channels = {}, .columns = "", .units = units})
        .warnings;
  };
  EXPECT_THAT(warnings("-9810,-9810,3,0", ""),
              ElementsAre(HasSubstr("vertical accelerations start at -9810 m/s^2, which is gravity in other units than "
                                    "kg-m-s: it is 9.81 m/s^2 with units = t-mm-s")));
  EXPECT_THAT(warnings("-9810,-9810,3,0", "kg-mm-ms"),
              ElementsAre(HasSubstr("start at -9.81e+06 m/s^2, which is gravity in other units than kg-mm-ms: it is "
                                    "9.81 m/s^2 with units = t-mm-s")));
  EXPECT_THAT(warnings("9.80665e-3,9.80665e-3,9.80665e-3,0", "t-mm-s"),
              ElementsAre(HasSubstr("it is 9.81 m/s^2 with units = kg-mm-ms or g-mm-ms")));
  EXPECT_THAT(warnings("98.1,98.1,98.1,0", "kg-m-s"), ElementsAre(HasSubstr("no system known makes it 9.81 m/s^2")));
  for (const char* none :
       {"-9.81,-9.81,-9.81,0", "0,0,0,-9810", "-9810,0,0,0", "-9810,-98.1,-0.981,0", "-9310,-9310,-9310,0", ",,,-9810"})
    EXPECT_THAT(warnings(none, ""), IsEmpty()) << none;
  EXPECT_THAT(warnings("-9810,-9810,-9810,0", "t-mm-s"), IsEmpty());
}

TEST(RadiossCsv, AnUnknownSystemOfUnitsIsRefused) {
  const test::TempDir dir;
  const std::string path = dir.file("t.csv", converted());
  EXPECT_THAT([&] { read_traces(path, {.channels = {}, .columns = "", .units = "t-mm-h"}); },
              ThrowsMessage<InvalidInput>(
                  HasSubstr("units = 't-mm-h': unknown system of units; use kg-m-s, t-mm-s, kg-mm-ms, g-mm-ms, Mg-mm-s "
                            "or SI")));
}

TEST(RadiossCsv, ConvertedAndNamedTablesOfOneRunAgree) {
  const auto converted_path = test::shared_data("fe-car/C56/C56T01.csv");
  const auto named_path = test::shared_data("fe-car/C56/C56_named.csv");
  if (!converted_path || !named_path) GTEST_SKIP() << test::kNoSharedData;
  ReadOptions options;
  options.units = "t-mm-s";
  const TraceSet a = read_traces(converted_path->string(), options), b = read_traces(named_path->string(), options);
  ASSERT_EQ(a.traces[0].values.size(), 2000u);
  EXPECT_EQ(*a.traces[0].time_s, *b.traces[0].time_s);
  for (const char* node : {"LEFT_REAR", "RIGHT_MID", "BODY_TOP"})
    for (const char* variable : {"DX", "VX", "AX", "DZ", "VZ", "AZ"}) {
      const std::string name = fmt::format("{}_{}", node, variable);
      EXPECT_EQ(named(a, name).values, named(b, name).values) << name;
    }
  EXPECT_EQ(named(a, "Barrier_FNX").values, named(b, "barrier_impulse_FNX").values);
  EXPECT_EQ(named(a, "KINETIC ENERGY").values, named(b, "KE").values);
}

}  // namespace
}  // namespace crashsim
