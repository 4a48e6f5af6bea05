#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <crashsim/error.hpp>
#include <crashsim/files.hpp>
#include <crashsim/trace_io.hpp>

#include "support/lsdyna_files.hpp"
#include "support/shared_data.hpp"
#include "support/temp_dir.hpp"
#include "support/unit_warnings.hpp"

namespace crashsim {
namespace {

using test::LsdynaPlan;
using test::LsdynaRun;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::NanSensitiveDoubleEq;
using testing::Pair;
using testing::ThrowsMessage;

/// Each database, by what makes its files.
struct Database {
  const char* name;
  LsdynaRun (*run)(const LsdynaPlan&);
};
void PrintTo(const Database& database, std::ostream* out) { *out << database.name; }

constexpr Database kDatabases[] = {{"nodout", test::nodout_run}, {"rcforc", test::rcforc_run},
                                   {"rwforc", test::rwforc_run}, {"secforc", test::secforc_run},
                                   {"rbdout", test::rbdout_run}, {"glstat", test::glstat_run},
                                   {"matsum", test::matsum_run}};

TraceSet read(const std::string& text,
              const ReadOptions& options = {.channels = {}, .columns = "", .units = "kg-m-s"}) {
  const test::TempDir dir;
  TraceSet set = read_traces(dir.file("file", text), options);
  return options.units.empty() ? std::move(set) : test::without_unit_warnings(std::move(set));
}

const Trace& with_id(const TraceSet& set, const std::string& id) {
  const auto found = std::find_if(set.traces.begin(), set.traces.end(), [&](const Trace& t) { return t.id == id; });
  if (found == set.traces.end()) throw std::out_of_range("no channel " + id);
  return *found;
}

bool same(const std::vector<double>& a, const std::vector<double>& b) {
  const auto equal = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), equal);
}

/// Every channel has its first `states` states as the run says them.
void expect_states(const TraceSet& set, const LsdynaRun& run, std::size_t states) {
  const auto first = [states](const std::vector<double>& all) {
    return std::vector<double>(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(states));
  };
  EXPECT_EQ(set.traces.size(), run.values.size());
  for (const auto& [id, values] : run.values) {
    const Trace& trace = with_id(set, id);
    EXPECT_TRUE(same(*trace.time_s, first(run.times))) << id;
    EXPECT_TRUE(same(trace.values, first(values))) << id;
  }
}

class LsdynaAscii : public testing::TestWithParam<Database> {};
INSTANTIATE_TEST_SUITE_P(Databases, LsdynaAscii, testing::ValuesIn(kDatabases),
                         [](const auto& param) { return std::string(param.param.name); });

TEST_P(LsdynaAscii, RandomTracesComeBackExactly) {
  constexpr int kRuns = 20;
  for (int i = 1; i <= kRuns; ++i) {
    const LsdynaRun run = GetParam().run({.seed = static_cast<std::uint64_t>(i),
                                          .states = 2 + i,
                                          .first_state = 0,
                                          .entities = 1 + i % 5,
                                          .line_end = i % 3 == 0 ? "\r\n" : "\n"});
    const TraceSet set = read(run.text);
    EXPECT_EQ(set.format, "lsdyna_ascii");
    EXPECT_THAT(set.warnings, IsEmpty());
    expect_states(set, run, run.times.size());
    EXPECT_EQ(set.title, "A run of 3 parts, 12 7");
    EXPECT_THAT(set.metadata,
                ElementsAre(Pair("database", GetParam().name), Pair("version", "ls-dyna smp d R13 R13.1.1_27_8731a0"),
                            Pair("date", "07/28/2023")));
  }
}

TEST_P(LsdynaAscii, OnlyChosenChannelsHaveSamples) {
  const LsdynaRun run = GetParam().run({});
  const auto chosen = std::next(run.values.begin(), static_cast<std::ptrdiff_t>(run.values.size() / 2));
  const TraceSet set = read(run.text, {.channels = {chosen->first}, .columns = "", .units = "kg-m-s"});
  for (const Trace& trace : set.traces) {
    EXPECT_EQ(trace.has_samples, trace.id == chosen->first) << trace.id;
    EXPECT_EQ(trace.values.empty(), trace.id != chosen->first) << trace.id;
  }
  EXPECT_TRUE(same(with_id(set, chosen->first).values, chosen->second));
}

/// Whether a file cut at an offset ends in the middle of a line.
bool ends_in_line(const std::string& text, std::size_t cut) {
  const std::size_t line = text.rfind('\n', cut - 1) + 1;
  return text.substr(line, cut - line).find_first_not_of(' ') != std::string::npos;
}

/// A file cut at an offset: its whole states, and a warning when more was there.
void expect_whole_states(const LsdynaRun& run, std::size_t cut) {
  SCOPED_TRACE(fmt::format("cut at byte {} of {}", cut, run.text.size()));
  const auto whole = static_cast<std::size_t>(std::upper_bound(run.state_ends.begin(), run.state_ends.end(), cut) -
                                              run.state_ends.begin());
  try {
    const TraceSet set = read(run.text.substr(0, cut));
    if (whole > 0) {
      expect_states(set, run, whole);
      const bool is_said = !set.warnings.empty();
      EXPECT_TRUE(is_said || !ends_in_line(run.text, cut));
      EXPECT_FALSE(is_said && whole > 1 && cut == run.state_ends[whole - 1]);
      return;
    }
    EXPECT_THAT(set.warnings, Contains(HasSubstr("has one state only, which may be cut short")));
    for (const Trace& trace : set.traces) {
      EXPECT_THAT(trace.values, ElementsAre(run.values.at(trace.id).at(0))) << trace.id;
      EXPECT_THAT(*trace.time_s, ElementsAre(run.times.at(0)));
    }
  } catch (const InvalidInput& refusal) {
    EXPECT_EQ(whole, 0u) << refusal.what();
  }
}

TEST_P(LsdynaAscii, AFileCutAnywhereKeepsItsWholeStates) {
  constexpr int kCuts = 200;
  const LsdynaRun run = GetParam().run({.seed = 3, .states = 9, .first_state = 0, .entities = 3, .line_end = "\n"});
  test::Random random(7);
  for (int i = 0; i < kCuts; ++i)
    expect_whole_states(run, static_cast<std::size_t>(random.whole(0, static_cast<int>(run.text.size()))));
  for (const std::size_t end : run.state_ends) expect_whole_states(run, end);
}

TEST_P(LsdynaAscii, WhatACutFileLostIsSaid) {
  const LsdynaRun run = GetParam().run({});
  const TraceSet set = read(run.text.substr(0, run.state_ends[6] - 1));
  expect_states(set, run, 6);
  ASSERT_EQ(set.warnings.size(), 1u);
  EXPECT_THAT(set.warnings[0], AllOf(HasSubstr("ends in the middle of a state: left out that of time 0.006"),
                                     HasSubstr("bytes from byte ")));
}

TEST_P(LsdynaAscii, ARestartedRunTakesThePlaceOfWhatItComputesAnew) {
  constexpr int kRestarts = 40;
  test::Random random(11);
  for (int i = 0; i < kRestarts; ++i) {
    const LsdynaRun before = GetParam().run({.seed = 5, .states = 9});
    const LsdynaRun after = GetParam().run({.seed = 6, .states = 7, .first_state = random.whole(3, 9)});
    const auto cut = static_cast<std::size_t>(
        random.whole(static_cast<int>(before.state_ends[1]), static_cast<int>(before.text.size())));
    LsdynaRun joined = before;
    joined.text = before.text.substr(0, cut) + after.text;
    const auto cut_state = std::upper_bound(before.state_ends.begin(), before.state_ends.end(), cut);
    const auto earlier = std::lower_bound(before.times.begin(), before.times.end(), after.times[0]);
    const auto kept = std::min(cut_state - before.state_ends.begin(), earlier - before.times.begin());
    const auto join = [&](std::vector<double>& all, const std::vector<double>& later) {
      all.resize(static_cast<std::size_t>(kept));
      all.insert(all.end(), later.begin(), later.end());
    };
    join(joined.times, after.times);
    for (auto& [id, values] : joined.values) join(values, after.values.at(id));
    const TraceSet set = read(joined.text);
    expect_states(set, joined, joined.times.size());
    if (cut_state - before.state_ends.begin() > kept) {
      EXPECT_THAT(set.warnings, Contains(testing::AnyOf(HasSubstr("the run was restarted: "),
                                                        HasSubstr("the same time as the next"))));
    }
  }
}

TEST_P(LsdynaAscii, UnitsAreThoseOfTheDeck) {
  const LsdynaRun run = GetParam().run({.seed = 2, .states = 3});
  const TraceSet set = read(run.text, {.channels = {}, .columns = "", .units = "t-mm-s"});
  for (const Trace& trace : set.traces) {
    const double unit = trace.dimension == Dimension::length || trace.dimension == Dimension::speed    ? 1e-3
                        : trace.dimension == Dimension::acceleration                                   ? 1e-3
                        : trace.dimension == Dimension::energy || trace.dimension == Dimension::moment ? 1e-3
                        : trace.dimension == Dimension::mass                                           ? 1e3
                                                                                                       : 1.0;
    for (std::size_t i = 0; i < trace.values.size(); ++i)
      EXPECT_DOUBLE_EQ(trace.values[i], unit * run.values.at(trace.id)[i]) << trace.id;
  }
}

/// The numbers after a label in the lines of a text, from a column counted from the label.
std::vector<double> after_label(const std::string& text, const std::string& label, std::size_t column) {
  std::vector<double> numbers;
  for (std::size_t at = text.find(label); at != std::string::npos; at = text.find(label, at + 1))
    numbers.push_back(std::strtod(text.c_str() + at + column, nullptr));
  return numbers;
}

TEST(LsdynaAsciiFiles, ValuesOfARealRunStandInItsColumns) {
  const auto path = [](const std::string& name) { return test::shared_data("lsdyna-ascii/" + name); };
  if (!path("glstat") || !path("rcforc") || !path("matsum")) GTEST_SKIP() << test::kNoSharedData;
  const auto text = [&](const char* name) { return read_file(path(name)->string()); };
  const auto set = [&](const char* name) { return read(text(name)); };

  const TraceSet glstat = set("glstat");
  EXPECT_EQ(glstat.traces.size(), 18u);
  EXPECT_EQ(*glstat.traces[0].time_s, after_label(text("glstat"), " time....", 32));
  EXPECT_EQ(with_id(glstat, "glstat/kinetic_energy").values, after_label(text("glstat"), "\n kinetic energy.", 33));
  EXPECT_EQ(with_id(glstat, "glstat/energy_ratio").values, after_label(text("glstat"), "/ initial energy..", 18));

  const TraceSet rcforc = set("rcforc");
  EXPECT_EQ(rcforc.traces.size(), 14u);
  EXPECT_EQ(*rcforc.traces[0].time_s, after_label(text("rcforc"), "  slave           2 time", 24));
  EXPECT_EQ(with_id(rcforc, "rcforc/2 master/x_force").values,
            after_label(text("rcforc"), "  master          2 time", 40));
  EXPECT_EQ(with_id(rcforc, "rcforc/2 slave/z_moment").values,
            after_label(text("rcforc"), "  slave           2 time", 141));

  const TraceSet matsum = set("matsum");
  EXPECT_EQ(matsum.traces.size(), 77u);
  EXPECT_EQ(*matsum.traces[0].time_s, after_label(text("matsum"), " time =", 7));
  EXPECT_EQ(with_id(matsum, "matsum/100/internal_energy").values, after_label(text("matsum"), " mat.#=  100 ", 31));
  EXPECT_EQ(with_id(matsum, "matsum/310/kinetic_energy").values, after_label(text("matsum"), " mat.#=  310 ", 55));
  for (const TraceSet* each : {&glstat, &rcforc, &matsum}) EXPECT_THAT(each->warnings, IsEmpty());
}

TEST(LsdynaAsciiFiles, EntitiesHaveTheirTitles) {
  EXPECT_EQ(with_id(read(test::nodout_run({}).text), "nodout/17/x_velocity").name, "LEFT REAR, at 3_VX");
  EXPECT_EQ(with_id(read(test::nodout_run({}).text), "nodout/17/ry_displacement").dimension, Dimension::angle);
  EXPECT_EQ(with_id(read(test::rcforc_run({}).text), "rcforc/2 master/x_force").name, "Front to barrier master_FX");
  EXPECT_EQ(with_id(read(test::rwforc_run({}).text), "rwforc/1/normal_force").location, "Barrier");
  EXPECT_EQ(with_id(read(test::secforc_run({}).text), "secforc/1/x_moment").name, "Section 7 left rail_MX");
  EXPECT_EQ(with_id(read(test::matsum_run({}).text), "matsum/1/internal_energy").location, "Plate 1");
  EXPECT_EQ(with_id(read(test::glstat_run({}).text), "glstat/2/stonewall_energy").location, "wall_2");
}

TEST(LsdynaAsciiFiles, EnergiesOfWallsAreNamedByTheirNumbers) {
  EXPECT_EQ(with_id(read(test::glstat_run({}).text), "glstat/1/stonewall_energy").name, "wall_1_stonewall_energy");
}

TEST(LsdynaAsciiFiles, ALegendMayStartWithoutItsBrace) {
  LsdynaRun run = test::rcforc_run({});
  run.text.erase(run.text.find("{BEGIN LEGEND}") + 13, 1);
  const TraceSet set = read(run.text);
  EXPECT_EQ(with_id(set, "rcforc/2 master/x_force").name, "Front to barrier master_FX");
  expect_states(set, run, run.times.size());
}

TEST(LsdynaAsciiFiles, LegendsWithoutAnEndAreSearchedOnce) {
  constexpr int kLegends = 200000;  // each to the file's end would take minutes
  LsdynaRun run = test::rcforc_run({});
  for (int i = 0; i < kLegends; ++i) run.text += "{BEGIN LEGEND\n";
  expect_states(read(run.text), run, run.times.size());
}

TEST(LsdynaAsciiFiles, ACountMayTouchTheDotsOfItsLabel) {
  LsdynaRun run = test::glstat_run({});
  constexpr std::string_view kLabel = "reached the minimum time step..    0";
  for (std::size_t at = run.text.find(kLabel); at != std::string::npos; at = run.text.find(kLabel, at))
    run.text.replace(at, kLabel.size(), "reached the minimum time step..12345");
  const TraceSet set = read(run.text);
  EXPECT_THAT(with_id(set, "glstat/num_bad_shells").values, testing::Each(12345.0));
  EXPECT_THAT(set.warnings, IsEmpty());
}

TEST(LsdynaAsciiFiles, AnEntityThatStandsTwiceInAStateIsReadOnce) {
  std::string text;
  for (const auto& [time, force] : {std::pair("0.00000E+00", 1), std::pair("1.00000E-01", 2)})
    for (const auto& [contact, add] : {std::pair(2, 0), std::pair(5, 10), std::pair(5, 20), std::pair(7, 30)})
      text += fmt::format("  slave  {:10d} time {}  x {:12.5E}  y  0.00000E+00  z  0.00000E+00\n", contact, time,
                          1.0 * (force + add));
  const TraceSet set = read(text);
  EXPECT_EQ(set.traces.size(), 9u);
  EXPECT_THAT(with_id(set, "rcforc/2 slave/x_force").values, ElementsAre(1.0, 2.0));
  EXPECT_THAT(with_id(set, "rcforc/5 slave/x_force").values, ElementsAre(11.0, 12.0));
  EXPECT_THAT(with_id(set, "rcforc/7 slave/x_force").values, ElementsAre(31.0, 32.0));
  EXPECT_THAT(set.warnings, ElementsAre(AllOf(HasSubstr("6 values stand twice in a state, the first slave"),
                                              HasSubstr("5 x at time 0: the first of each is kept"))));
}

TEST(LsdynaAsciiFiles, MoreValuesThanFitMemoryAreRefused) {
  std::string matsum = " time =   0.0000E+00\n";
  for (int part = 0; part < 100000; ++part) matsum += fmt::format(" mat.#= {} inten= 1 kinen= 1\n", part);
  EXPECT_THAT([&] { read(matsum); }, ThrowsMessage<InvalidInput>(HasSubstr("more channels than fit memory")));
  std::string nodout = test::nodout_head(1, " 0.0000000E+00") + "\n\n" + test::kTranslations + "\n";
  std::string row;
  for (int column = 0; column < 12; ++column) row += " 0.00000E+00";
  for (int node = 1; node <= 20000; ++node) nodout += fmt::format("{:9d}{}\n", node, row);
  EXPECT_THAT([&] { read(nodout); }, ThrowsMessage<InvalidInput>(HasSubstr("more channels than fit memory")));
}

TEST(LsdynaAsciiFiles, NewNamesOfTheSurfacesMeanTheSame) {
  LsdynaRun run = test::rcforc_run({});
  for (const auto& [old_name, new_name] : {std::pair("slave ", "SURFA "), std::pair("master", "SURFB ")})
    for (std::size_t at = run.text.find(old_name); at != std::string::npos; at = run.text.find(old_name, at))
      run.text.replace(at, 6, new_name);
  expect_states(read(run.text), run, run.times.size());
}

TEST(LsdynaAsciiFiles, AnEntityThatVanishesIsMissingFromThenOn) {
  LsdynaRun run = test::rbdout_run({.seed = 1, .states = 4, .first_state = 0, .entities = 2});
  const std::size_t second = run.text.find(" nodal rigid body", run.state_ends[0]);
  run.text.erase(second, run.state_ends[1] - second);
  const TraceSet set = read(run.text);
  EXPECT_TRUE(same(with_id(set, "rbdout/1/global_vx").values, run.values.at("rbdout/1/global_vx")));
  std::vector<double> expected = run.values.at("rbdout/2/global_vx");
  expected[1] = std::nan("");
  EXPECT_TRUE(same(with_id(set, "rbdout/2/global_vx").values, expected));
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("48 values missing (nan, overflowed or not written), the first of "
                                                  "channel 2_global_x at time ")));
}

TEST(LsdynaAsciiFiles, TransducersOfAWallAreNotTakenForWalls) {
  const std::string walls = "    time       wall#   normal-force    x-force        y-force        z-force\n";
  const auto state = [&](const char* time) {
    return fmt::format(
        "{0}\n\n{1}{0}       1   1.000000E+00   2.000000E+00   3.000000E+00   4.000000E+00\n\n\n\n"
        "r i g i d   w a l l   n o d e   s e t   f o r c e   s u m m a t i o n s\n"
        "f o r   t i m e   s t e p         1   ( at time {0} )\n\n"
        "    time       wall #   transducer node set #    x-force      y-force      z-force\n"
        "{0}          1          5         12  9.00000E+00  9.00000E+00  9.00000E+00\n\n\n",
        time, walls);
  };
  const TraceSet set = read(walls + state(" 0.00000E+00") + state(" 1.00000E-03"));
  ASSERT_EQ(set.traces.size(), 4u);
  EXPECT_THAT(with_id(set, "rwforc/1/normal_force").values, ElementsAre(1.0, 1.0));
  EXPECT_THAT(set.warnings, IsEmpty());
}

TEST(LsdynaAsciiFiles, StatesWithOneTimePrintedGiveWayToTheLast) {
  const auto line = [](const char* time, double force) {
    return fmt::format("  slave           2 time {}  x {:12.5E}  y  0.00000E+00  z  0.00000E+00 mass  1.00000E+00\n",
                       time, force);
  };
  const TraceSet set =
      read(line("0.00000E+00", 1.0) + line("1.00000E-01", 2.0) + line("1.00000E-01", 3.0) + line("2.00000E-01", 4.0));
  EXPECT_THAT(with_id(set, "rcforc/2 slave/x_force").values, ElementsAre(1.0, 3.0, 4.0));
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("one state has the same time as the next, the first 0.1")));
}

TEST(LsdynaAsciiFiles, OverflowedNumbersAreMissing) {
  LsdynaRun run = test::matsum_run({});
  const std::size_t at = run.text.find("kinen=", run.state_ends[2]) + 6;
  run.text.replace(at, 13, " ************");
  const TraceSet set = read(run.text);
  EXPECT_THAT(with_id(set, "matsum/1/kinetic_energy").values[3], NanSensitiveDoubleEq(std::nan("")));
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("one value missing (nan, overflowed or not written), the first of "
                                                  "channel Plate 1_kinetic_energy at time 0.00303")));
}

TEST(LsdynaAsciiFiles, SizesThatNoVehicleHasAreSaidWhenUnitsAreNotGiven) {
  const auto node = [](const char* time) {
    return test::nodout_head(1, time) + "\n\n" + test::kTranslations +
           "\n        1  0.00000E+00 0.00000E+00 0.00000E+00-1.50000E+04 0.00000E+00 0.00000E+00 0.00000E+00 "
           "0.00000E+00"
           " 0.00000E+00 0.00000E+00 0.00000E+00 0.00000E+00\n";
  };
  const std::string text = node(" 0.0000000E+00") + node(" 1.0000000E-03");
  EXPECT_THAT(read(text, {}).warnings,
              ElementsAre(HasSubstr("channel 1_VX reaches 15000 m/s, too much for a vehicle")));
  EXPECT_THAT(read(text, {.channels = {}, .columns = "", .units = "t-mm-s"}).warnings, IsEmpty());
}

TEST(LsdynaAsciiFiles, OtherDatabasesAndEmptyOnesAreRefused) {
  const std::string preamble = " A run\n                    ls-dyna smp d R13 date 07/28/2023\n\n";
  const auto refusal = ThrowsMessage<InvalidInput>(
      HasSubstr("an LS-DYNA file without states, or of a database that is not read; those that are: nodout, rcforc, "
                "rwforc, secforc, rbdout, glstat, matsum"));
  EXPECT_THAT([&] { read(preamble); }, refusal);
  EXPECT_THAT([&] { read(preamble + "{BEGIN LEGEND}\n Entity #        Title\n   1   2\n   3   4\n"); }, refusal);
  EXPECT_THAT([&] { read(preamble + " output at time =   0.00000E+00\n node=       1 local x,y,z forces =  1 2 3\n"); },
              refusal);
  EXPECT_THAT([&] { read(test::nodout_head(1, " 0.0000000E+00") + "\n\n"); },
              ThrowsMessage<InvalidInput>(HasSubstr("no whole state")));
}

TEST(LsdynaAsciiFiles, TablesOfOthersAreNotClaimed) {
  EXPECT_EQ(read("time_s,kinetic energy\n0,1\n1,2\n").format, "csv");
  EXPECT_EQ(read("# exported from ls-dyna, date 2024\ntime_s,x_force\n0,1\n1,2\n").format, "csv");
}

}  // namespace
}  // namespace crashsim
