/// OpenRadioss binary time histories: files made to measure, and the real ones against the tables of the same runs.

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <crashsim/error.hpp>
#include <crashsim/files.hpp>
#include <crashsim/forcing.hpp>
#include <crashsim/trace_io.hpp>

#include "support/radioss_t01_files.hpp"
#include "support/shared_data.hpp"
#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;
using testing::ThrowsMessage;

const Trace& named(const TraceSet& set, const std::string& name) {
  return set.traces.at(select_channels(set, name).at(0));
}

ReadOptions in_units(const std::string& units) { return {.channels = {}, .columns = "", .units = units}; }

/// A wall and a node of a deck in t-mm-s; the values are their column, times the state.
test::RadiossT01Deck small_deck() {
  test::RadiossT01Deck deck;
  deck.globals = 2;
  deck.parts = {{"", 0, {"hood"}, {1, 25}, {"IE", "ERODED"}}};
  deck.groups = {{"TH RWALL", 102, {"Barrier"}, {1, 6}, {"FNX", "FTZ"}}, {"out", 0, {"B  PILLAR", ""}, {4}, {"VX"}}};
  return deck;
}
test::RadiossT01File small_file(int states, const test::RadiossT01Deck& deck = small_deck()) {
  test::RadiossT01File file = test::radioss_t01_header(deck);
  for (int state = 0; state < states; ++state) {
    std::vector<float> values = {static_cast<float>(state) * 0.25F};
    while (values.size() <= file.names.size())
      values.push_back(static_cast<float>(state) * static_cast<float>(values.size() + 1));
    test::add_state(deck, values, file);
  }
  return file;
}

class RadiossT01 : public testing::Test {
 protected:
  TraceSet read(const std::string& bytes, const ReadOptions& options = {}) {
    return read_traces(dir_.file("CART01", bytes), options);
  }
  std::string message_of(const std::string& bytes) {
    try {
      read(bytes);
    } catch (const InvalidInput& problem) {
      return problem.what();
    }
    return "read";
  }

 private:
  test::TempDir dir_;
};

TEST_F(RadiossT01, ChannelsAreNamedByTheirCodesAndConvertedByTheUnits) {
  const TraceSet set = read(small_file(3).bytes, in_units("t-mm-s"));
  EXPECT_EQ(set.format, "radioss_t01");
  EXPECT_EQ(set.title, "a run of the car");
  EXPECT_THAT(set.metadata, AllOf(Contains(Pair("DATE", "Sun Nov 22 09:14:56 2026")),
                                  Contains(Pair("PROGRAM", "RADIOSS OpenRadioss, linux64")),
                                  Contains(Pair("FORMAT", "3040")), Contains(Pair("PART[1]", "hood")),
                                  Contains(Pair("MATERIAL[7]", "steel")), Contains(Pair("GROUP[1]", "TH RWALL"))));
  EXPECT_THAT(set.warnings, IsEmpty());
  std::vector<std::string> names;
  for (const Trace& trace : set.traces) names.push_back(trace.name);
  EXPECT_THAT(names, ElementsAre("INTERNAL ENERGY", "KINETIC ENERGY", "hood_IE", "hood_ERODED", "Barrier_FNX",
                                 "Barrier_FTZ", "B PILLAR_VX", "101_VX"));
  const Trace& wall = named(set, "Barrier_FTZ");
  EXPECT_EQ(wall.id, "7") << "the column of the converter's table";
  EXPECT_EQ(wall.dimension, Dimension::impulse) << "cumulative, as the run writes it";
  EXPECT_EQ(wall.axis, 'Z');
  EXPECT_EQ(wall.location, "Barrier");
  EXPECT_THAT(wall.values, ElementsAre(0.0, DoubleEq(7.0), DoubleEq(14.0)));
  EXPECT_THAT(*wall.time_s, ElementsAre(0.0, 0.25, 0.5));
  EXPECT_EQ(wall.time_s, named(set, "hood_IE").time_s) << "one clock";
  EXPECT_THAT(named(set, "B PILLAR_VX").values, ElementsAre(0.0, DoubleEq(8e-3), DoubleEq(16e-3)));
  EXPECT_THAT(named(set, "INTERNAL ENERGY").values, ElementsAre(0.0, DoubleEq(2e-3), DoubleEq(4e-3)));
}

TEST_F(RadiossT01, NewerFilesSayTheirUnits) {
  test::RadiossT01Deck deck = small_deck();
  deck.format = 4021;
  deck.title_length = 100;
  deck.units = {1000.0F, 0.001F, 1.0F};
  const std::string bytes = small_file(2, deck).bytes;
  const TraceSet set = read(bytes);
  EXPECT_THAT(set.metadata, Contains(Pair("UNITS", "1000 kg, 0.001 m, 1 s")));
  EXPECT_EQ(named(set, "B PILLAR_VX").values.back(), 8.0 * 0.001) << "0.001, not its nearest float";
  EXPECT_THAT(set.warnings, IsEmpty());
  const TraceSet asked = read(bytes, in_units("kg-m-s"));
  EXPECT_EQ(named(asked, "B PILLAR_VX").values.back(), 8.0);
  EXPECT_THAT(asked.warnings, ElementsAre(HasSubstr("units = kg-m-s is used, but the file says that its units are 1000 "
                                                    "kg, 0.001 m, 1 s")));
}

TEST_F(RadiossT01, OnlyTheChosenChannelsAreKept) {
  const TraceSet set = read(small_file(3).bytes, {.channels = {"*_VX"}, .columns = "", .units = ""});
  for (const Trace& trace : set.traces) EXPECT_EQ(trace.has_samples, trace.name.ends_with("_VX")) << trace.name;
  EXPECT_THAT(named(set, "101_VX").values, ElementsAre(0.0, 9.0, 18.0));
  EXPECT_THAT(named(set, "hood_IE").values, IsEmpty());
}

TEST_F(RadiossT01, DamageIsSaidWithItsByte) {
  const test::RadiossT01File file = small_file(3);
  EXPECT_THAT(message_of(file.bytes.substr(0, 100)),
              HasSubstr("byte 92: the file ends within its header (date and program)"));
  EXPECT_THAT(message_of(file.bytes.substr(0, file.header_bytes)),
              HasSubstr(fmt::format("byte {}: group 'out': a state of 2 entities with 1 variables is larger than the "
                                    "rest of the file",
                                    file.header_bytes)));
  EXPECT_THAT(
      message_of(file.bytes.substr(0, file.header_bytes + file.state_bytes - 1)),
      HasSubstr(fmt::format("byte {}: no whole state of {} bytes follows", file.header_bytes, file.state_bytes)));
  const auto with = [&](std::size_t at, int value) {
    std::string bytes = file.bytes;
    return bytes.replace(at, 4, test::word(value));
  };
  EXPECT_THAT(message_of(with(184, -1)), HasSubstr("byte 184: counts: a count of -1"));
  EXPECT_THAT(message_of(with(200, 3)),
              HasSubstr("time-history group: a record of 4 bytes where at least 20 are expected"));
  EXPECT_THAT(message_of(with(208, 23)), HasSubstr("byte 180: counts: the lengths around a record of 24 bytes differ"));
  EXPECT_THAT(message_of(with(file.header_bytes + 12, 12)),
              HasSubstr("the first state is not as the header says: no record of 8 bytes for global variables"));
}

TEST_F(RadiossT01, DeclaredCountsAreCheckedBeforeTheyAreUsed) {
  test::RadiossT01Deck deck;
  deck.groups = {{"nodes", 0, std::vector<std::string>(2000, "N"), std::vector<int>(2000, 4), {}}};
  const std::string bytes = test::radioss_t01_header(deck).bytes;  // 4 million values a state
  EXPECT_THAT(message_of(bytes),
              HasSubstr("a state of 2000 entities with 2000 variables is larger than the rest of the file"));
}

TEST_F(RadiossT01, StatesBeforeTheDamageAreKept) {
  const test::RadiossT01File file = small_file(5);
  std::string bytes = file.bytes;
  const std::size_t third = file.header_bytes + 2 * file.state_bytes;
  bytes.replace(third, 4, test::word(5));
  const TraceSet set = read(bytes);
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr(fmt::format(
                                "byte {}: no state where state 3 of about 5 should be: the file is damaged there, and "
                                "its last {} bytes are left out",
                                third, 3 * file.state_bytes))));
  EXPECT_THAT(named(set, "101_VX").values, ElementsAre(0.0, 9.0));
  const TraceSet cut = read(file.bytes.substr(0, third + 20));
  EXPECT_THAT(cut.warnings, ElementsAre(HasSubstr(fmt::format(
                                "byte {}: the file ends within a state: the 2 whole states are kept, 20 of the next "
                                "one's {} bytes are left out",
                                third, file.state_bytes))));
}

TEST_F(RadiossT01, ARestartedRunTakesThePlaceOfWhatItComputesAnew) {
  const test::RadiossT01Deck deck = small_deck();
  test::RadiossT01File file = test::radioss_t01_header(deck);
  for (const float time : {0.0F, 1.0F, 2.0F, 1.0F, 2.0F, 3.0F, std::nanf(""), 4.0F}) {
    std::vector<float> values(file.names.size() + 1, static_cast<float>(file.states.size()));
    values[0] = time;
    test::add_state(deck, values, file);
  }
  const TraceSet set = read(file.bytes);
  EXPECT_THAT(*set.traces[0].time_s, ElementsAre(0.0, 1.0, 2.0, 3.0, 4.0));
  EXPECT_THAT(set.traces[0].values, ElementsAre(0.0, 3.0, 4.0, 5.0, 7.0));
  EXPECT_THAT(set.warnings,
              ElementsAre(HasSubstr(fmt::format("byte {}: the run was restarted: 2 states of an earlier run gave way",
                                                file.header_bytes + 3 * file.state_bytes)),
                          HasSubstr(fmt::format("byte {}: a state with a time that is no number: left out",
                                                file.header_bytes + 6 * file.state_bytes))));
}

TEST_F(RadiossT01, ARestartMayReachFarBack) {
  const test::RadiossT01Deck deck = small_deck();
  test::RadiossT01File file = test::radioss_t01_header(deck);
  constexpr int kBefore = 200, kRestart = 50, kAfter = 100;
  for (int state = 0; state < kBefore + kAfter; ++state) {
    std::vector<float> values(file.names.size() + 1, static_cast<float>(state));
    values[0] = static_cast<float>(state < kBefore ? state : state - kBefore + kRestart);
    test::add_state(deck, values, file);
  }
  const TraceSet set = read(file.bytes);
  for (const Trace& trace : set.traces) {
    ASSERT_EQ(trace.values.size(), static_cast<std::size_t>(kRestart + kAfter));
    ASSERT_EQ(trace.times().size(), trace.values.size());
    EXPECT_EQ(trace.times()[kRestart - 1], kRestart - 1);
    EXPECT_EQ(trace.times()[kRestart], kRestart);
    EXPECT_EQ(trace.times().back(), kRestart + kAfter - 1);
  }
  const Trace& energy = set.traces[0];
  EXPECT_DOUBLE_EQ(energy.values[kRestart - 1], kRestart - 1);
  EXPECT_DOUBLE_EQ(energy.values[kRestart], kBefore);
  EXPECT_DOUBLE_EQ(energy.values.back(), kBefore + kAfter - 1);
}

TEST_F(RadiossT01, MoreChannelsThanFitMemoryAreRefused) {
  test::RadiossT01Deck deck;
  deck.groups = {{"nodes", 0, std::vector<std::string>(500, "N"), std::vector<int>(500, 4), {}}};
  const std::string header = test::radioss_t01_header(deck).bytes;  // 250,000 values a state
  EXPECT_THAT(message_of(header + std::string(1100000, '\0')),
              HasSubstr("group 'nodes': with its 250000 the file has more channels than fit memory"));
}

TEST_F(RadiossT01, OtherFilesAreNotTaken) {
  std::string other = small_file(2).bytes;
  other[3] = 85;
  EXPECT_THAT(message_of(other), HasSubstr("not a trace file: binary data"));
  EXPECT_EQ(read("time_s,accel_g\n0,1\n1e-4,2\n").format, "csv");
}

/// The values of a file are those of the first states of what was written, bit for bit.
void expect_states(const TraceSet& set, const test::RadiossT01File& file, std::size_t states) {
  ASSERT_EQ(set.traces.size(), file.names.size());
  for (std::size_t i = 0; i < set.traces.size(); ++i) {
    ASSERT_EQ(set.traces[i].name, file.names[i]);
    ASSERT_EQ(set.traces[i].values.size(), states) << file.names[i];
    for (std::size_t state = 0; state < states; ++state) {
      ASSERT_EQ(set.traces[i].values[state], file.states[state][i + 1]) << file.names[i];
      ASSERT_EQ(set.traces[i].times()[state], file.states[state][0]);
    }
  }
}

TEST_F(RadiossT01, WhateverIsWrittenComesBack) {
  test::Random random(20261124);
  for (int run = 0; run < 100; ++run) {
    const test::RadiossT01File file = test::random_radioss_t01_file(random);
    const TraceSet set = read(file.bytes);
    expect_states(set, file, file.states.size());
    EXPECT_THAT(set.warnings, IsEmpty());
  }
}

/// Cut at any byte a file is refused, or gives the states before the cut and says what was lost.
void expect_cut_is_told(const std::string& bytes, std::size_t header, std::size_t state, std::size_t cut,
                        const TraceSet& whole, const std::string& path) {
  write_file_atomically(path, std::string_view(bytes).substr(0, cut), true);
  const std::size_t kept = cut < header ? 0 : (cut - header) / state;
  if (kept == 0) {
    EXPECT_THROW(read_traces(path), InvalidInput) << cut;
    return;
  }
  const TraceSet set = read_traces(path);
  ASSERT_EQ(set.traces.size(), whole.traces.size());
  for (std::size_t i = 0; i < set.traces.size(); ++i) {
    ASSERT_EQ(set.traces[i].values.size(), kept);
    ASSERT_TRUE(std::equal(set.traces[i].values.begin(), set.traces[i].values.end(), whole.traces[i].values.begin()));
  }
  const bool is_told = std::any_of(set.warnings.begin(), set.warnings.end(), [](const std::string& warning) {
    return warning.find("the file ends within a state") != std::string::npos;
  });
  EXPECT_EQ(is_told, (cut - header) % state != 0) << cut;
}

TEST_F(RadiossT01, ACutFileLosesOnlyWhatWasCut) {
  test::Random random(7);
  const test::TempDir dir;
  const test::RadiossT01File file = small_file(40);
  const TraceSet whole = read(file.bytes);
  for (int i = 0; i < 200; ++i) {
    const int cut = random.whole(0, static_cast<int>(file.bytes.size()) - 1);
    expect_cut_is_told(file.bytes, file.header_bytes, file.state_bytes, static_cast<std::size_t>(cut), whole,
                       dir.path("CUTT01"));
  }
}

TEST_F(RadiossT01, ACutRealFileLosesOnlyWhatWasCut) {
  const auto path = test::shared_data("fe-car/C56/C56T01");
  if (!path) GTEST_SKIP() << test::kNoSharedData;
  constexpr std::size_t kStates = 2000;
  test::Random random(8);
  const test::TempDir dir;
  const std::string bytes = read_file(path->string());
  const TraceSet whole = read_traces(path->string());
  const std::size_t state = (169 + 1) * 4 + 5 * 8, header = bytes.size() - kStates * state;
  for (int i = 0; i < 200; ++i)
    expect_cut_is_told(bytes, header, state,
                       static_cast<std::size_t>(random.whole(0, static_cast<int>(i < 20 ? header : bytes.size()) - 1)),
                       whole, dir.path("CUTT01"));
}

/// The table has seven digits, and zero for what single precision calls subnormal.
void expect_same_digits(const std::vector<double>& binary, const std::vector<double>& text, const std::string& name) {
  constexpr double kSevenDigits = 5.0000001e-7;  // rounding: relative
  constexpr double kSubnormal = 1.2e-38;
  ASSERT_EQ(binary.size(), text.size()) << name;
  for (std::size_t i = 0; i < binary.size(); ++i)
    ASSERT_LE(std::abs(binary[i] - text[i]), std::max(kSevenDigits * std::abs(binary[i]), kSubnormal)) << name << i;
}

class RadiossT01Run : public testing::TestWithParam<const char*> {};

TEST_P(RadiossT01Run, HoldsWhatTheConvertersTableHolds) {
  const std::string run = GetParam();
  const auto binary_path = test::shared_data(fmt::format("fe-car/{0}/{0}T01", run));
  const auto table_path = test::shared_data(fmt::format("fe-car/{0}/{0}T01.csv", run));
  if (!binary_path || !table_path) GTEST_SKIP() << test::kNoSharedData;
  const TraceSet binary = read_traces(binary_path->string()), table = read_traces(table_path->string());
  ASSERT_EQ(binary.traces.size(), 169u);
  ASSERT_EQ(table.traces.size(), 169u);
  EXPECT_THAT(binary.title, testing::StartsWith(run + " car"));
  expect_same_digits(*binary.traces[0].time_s, *table.traces[0].time_s, "time");
  for (std::size_t i = 0; i < binary.traces.size(); ++i) {
    const Trace &a = binary.traces[i], &b = table.traces[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.location, b.location);
    EXPECT_EQ(a.axis, b.axis) << a.name;
    EXPECT_EQ(a.dimension, b.dimension) << a.name;
    expect_same_digits(a.values, b.values, a.name);
  }
}

TEST_P(RadiossT01Run, HoldsWhatTheNamedTableHolds) {
  const std::string run = GetParam();
  const auto binary_path = test::shared_data(fmt::format("fe-car/{0}/{0}T01", run));
  const auto table_path = test::shared_data(fmt::format("fe-car/{0}/{0}_named.csv", run));
  if (!binary_path || !table_path) GTEST_SKIP() << test::kNoSharedData;
  const TraceSet binary = read_traces(binary_path->string(), in_units("t-mm-s"));
  const TraceSet table = read_traces(table_path->string(), in_units("t-mm-s"));
  const auto other_name = [](std::string name) -> std::string {
    if (name == "mass") return "MASS";
    if (name == "px" || name == "pz") return name == "px" ? "X-MOMENTUM" : "Z-MOMENTUM";
    if (name == "IE" || name == "KE") return name == "IE" ? "INTERNAL ENERGY" : "KINETIC ENERGY";
    for (const auto& [before, after] : {std::pair("barrier_impulse", "Barrier"), std::pair("ground_impulse", "Ground")})
      if (name.starts_with(before)) name.replace(0, std::string(before).size(), after);
    return name;
  };
  for (const Trace& trace : table.traces) {
    const Trace& same = named(binary, other_name(trace.name));
    EXPECT_EQ(same.dimension, trace.dimension) << trace.name;
    expect_same_digits(same.values, trace.values, trace.name);
  }
}

TEST_P(RadiossT01Run, TellsItsUnitsByGravity) {
  const std::string run = GetParam();
  const auto path = test::shared_data(fmt::format("fe-car/{0}/{0}T01", run));
  if (!path) GTEST_SKIP() << test::kNoSharedData;
  EXPECT_THAT(read_traces(path->string(), in_units("t-mm-s")).warnings, IsEmpty());
  for (const char* wrong : {"", "kg-m-s", "kg-mm-ms", "g-mm-ms"})
    EXPECT_THAT(read_traces(path->string(), in_units(wrong)).warnings,
                ElementsAre(HasSubstr("it is 9.81 m/s^2 with units = t-mm-s")))
        << wrong;
}

TEST_P(RadiossT01Run, GivesTheWallForceThatTheTablesGive) {
  constexpr double kDigitsDifferentiated = 1e-3;  // rounding: seven digits of an impulse over 0.1 ms, of the peak force
  const std::string run = GetParam();
  const auto folder = test::shared_data("fe-car/" + run);
  if (!folder) GTEST_SKIP() << test::kNoSharedData;
  const auto force = [&](const std::string& file, const std::string& channel) {
    ForcingOptions options;
    options.file = (*folder / file).string();
    options.vertical_channels = {channel};
    options.units = "t-mm-s";
    return read_forcing(options).forcing.vertical_force_n;
  };
  const TimeSeries binary = force(run + "T01", "Barrier_FTZ");
  const auto [low, high] = std::minmax_element(binary.values.begin(), binary.values.end());
  const double peak = std::max(std::abs(*low), std::abs(*high));
  EXPECT_GT(peak, 1e3);
  for (const auto& [file, channel] :
       {std::pair(run + "T01.csv", "Barrier_FTZ"), std::pair(run + "_named.csv", "barrier_impulse_FTZ")}) {
    const TimeSeries table = force(file, channel);
    ASSERT_EQ(table.values.size(), binary.values.size());
    for (std::size_t i = 0; i < table.values.size(); ++i)
      ASSERT_NEAR(table.values[i], binary.values[i], kDigitsDifferentiated * peak) << file << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Runs, RadiossT01Run, testing::Values("C40", "C56"),
                         [](const auto& instance) { return std::string(instance.param); });

}  // namespace
}  // namespace crashsim
