#include <algorithm>
#include <bit>
#include <charconv>
#include <map>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <crashsim/trace_io.hpp>

#include "support/binout_files.hpp"
#include "support/oracle.hpp"
#include "support/program.hpp"
#include "support/shared_data.hpp"
#include "support/temp_dir.hpp"
#include "support/unit_warnings.hpp"

namespace crashsim {
namespace {

using test::BinoutDatabase;
using test::LsdaWriter;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kSamples[] = {"lsdyna-binout/binout_glstat", "lsdyna-binout/binout_swforc"};

const ReadOptions kSi = {.channels = {}, .columns = "", .units = "kg-m-s"};

const Trace& with_id(const TraceSet& set, const std::string& id) {
  const auto found = std::find_if(set.traces.begin(), set.traces.end(), [&](const Trace& t) { return t.id == id; });
  if (found == set.traces.end()) throw InvalidInput("no channel " + id);
  return *found;
}

std::vector<std::string> ids_of(const TraceSet& set) {
  std::vector<std::string> ids;
  for (const Trace& trace : set.traces) ids.push_back(trace.id);
  return ids;
}

std::vector<double> times_of(const Trace& trace) { return {trace.times().begin(), trace.times().end()}; }

/// Every channel of the data, and no other, with exactly its times and values.
void expect_exactly(const TraceSet& set, const test::BinoutData& data) {
  const auto expected = test::channels_of(data);
  ASSERT_EQ(set.traces.size(), expected.size());
  for (const auto& [id, samples] : expected) {
    const Trace& trace = with_id(set, id);
    EXPECT_EQ(times_of(trace), samples.first) << id;
    EXPECT_EQ(trace.values, samples.second) << id;
  }
}

/// A database of one variable of two nodes, with one value a state.
BinoutDatabase two_nodes(std::vector<double> times, double first_value = 0.0) {
  BinoutDatabase nodes{"nodout", {1, 2}, {"x_velocity"}, std::move(times), {}};
  for (std::size_t i = 0; i < nodes.times.size(); ++i)
    nodes.values.push_back({{first_value + static_cast<double>(i), -first_value - static_cast<double>(i)}});
  return nodes;
}

TEST(LsdynaBinout, ARealRunSaysWhatItIs) {
  const auto path = test::shared_data(kSamples[0]);
  if (!path) GTEST_SKIP() << test::kNoSharedData;
  const TraceSet set = test::without_unit_warnings(read_traces(path->string(), kSi));
  EXPECT_EQ(set.format, "lsdyna_binout");
  EXPECT_EQ(set.title, "Geometric Sphere Impacting a Plate");
  EXPECT_THAT(set.input_files, ElementsAre(path->string()));
  EXPECT_THAT(set.warnings, IsEmpty());
  const std::map<std::string, std::string> said(set.metadata.begin(), set.metadata.end());
  EXPECT_EQ(said.at("version"), "smp s");
  EXPECT_EQ(said.at("revision"), "365");
  EXPECT_EQ(said.at("date"), "08/10/2021");
  EXPECT_EQ(said.at("build_id"), "R13.0_365_f8a97bda2a");
  EXPECT_THAT(said.at("glstat/element_types"), HasSubstr("node,solid,beam,shell"));
  EXPECT_EQ(set.metadata.size(), 5u);
  const Trace& force = with_id(set, "rwforc/1/normal_force");
  EXPECT_EQ(force.dimension, Dimension::force);
  EXPECT_EQ(force.values.size(), 271u);
  const Trace& energy = with_id(set, "glstat/kinetic_energy");
  EXPECT_EQ(energy.dimension, Dimension::energy);
  EXPECT_EQ(energy.name, "kinetic_energy");
  EXPECT_EQ(energy.values.size(), 251u);
}

/// Channels as the independent reader finds them.
std::map<std::string, std::vector<double>> lasso_channels(const std::string& python, const std::string& path) {
  const auto script = std::filesystem::path(test::source_dir()) / "tests/oracles/read_binout.py";
  const test::Finished finished = test::run(python, {script.string(), path});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  std::map<std::string, std::vector<double>> channels;
  constexpr std::size_t kDigits = 16;
  for (std::size_t at = 0; at < finished.out.size();) {
    const std::size_t tab = finished.out.find('\t', at), end = finished.out.find('\n', tab);
    auto& values = channels[finished.out.substr(at, tab - at)];
    for (std::size_t value = tab + 1; value < end; value += kDigits + 1) {
      std::uint64_t bits = 0;
      std::from_chars(finished.out.data() + value, finished.out.data() + value + kDigits, bits, 16);
      values.push_back(std::bit_cast<double>(bits));
    }
    at = end + 1;
  }
  return channels;
}

/// Compares all channels and their times bit for bit.
void expect_as_lasso_reads(const std::string& python, const std::string& path) {
  const TraceSet set = read_traces(path, kSi);
  const auto expected = lasso_channels(python, path);
  std::size_t clocks = 0;
  for (const auto& [id, values] : expected) {
    if (id.ends_with("/time")) {
      ++clocks;
      continue;
    }
    const Trace& trace = with_id(set, id);
    const std::string database = id.substr(0, id.find('/'));
    EXPECT_EQ(trace.values, values) << id;
    EXPECT_EQ(times_of(trace), expected.at(database + "/time")) << id;
  }
  EXPECT_GT(set.traces.size(), 0u);
  EXPECT_EQ(set.traces.size() + clocks, expected.size());
}

TEST(LsdynaBinout, EveryVariableOfRealFilesIsWhatLassoReads) {
  const auto python = test::oracle_python("lasso-python");
  if (!python) GTEST_SKIP() << test::kNoOracle;
  for (const char* sample : kSamples) {
    const auto path = test::shared_data(sample);
    if (!path) GTEST_SKIP() << test::kNoSharedData;
    expect_as_lasso_reads(*python, path->string());
  }
}

TEST(LsdynaBinout, EveryVariableOfWrittenFilesIsWhatLassoReads) {
  const auto python = test::oracle_python("lasso-python");
  if (!python) GTEST_SKIP() << test::kNoOracle;
  const test::TempDir dir;
  test::Random random(1);
  const test::BinoutData data = test::random_binout(random);
  expect_as_lasso_reads(*python, dir.file("little", test::binout_bytes<double>(data)));
  expect_as_lasso_reads(*python, dir.file("big", test::binout_bytes<float>(data, {4, 8, 2, 1, true})));
}

TEST(LsdynaBinout, RandomRunsComeBackExactlyInAnyLayout) {
  const test::TempDir dir;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    test::Random random(seed);
    const test::BinoutData data = test::random_binout(random, 70);
    const auto size = [&](int least) { return 1u << random.whole(least, 3); };
    const test::LsdaFormat format{size(2), size(2), size(0), size(0), random.whole(0, 1) == 1};
    const std::string bytes =
        random.whole(0, 1) == 1 ? test::binout_bytes<double>(data, format) : test::binout_bytes<float>(data, format);
    SCOPED_TRACE(seed);
    const TraceSet set = read_traces(dir.file(fmt::format("run{}", seed), bytes), kSi);
    EXPECT_THAT(set.warnings, IsEmpty());
    expect_exactly(set, data);
  }
}

TEST(LsdynaBinout, IntegersOfAnySizeAreRead) {
  const test::TempDir dir;
  LsdaWriter writer({1, 1, 1, 1, true});
  writer.cd("/a/d1");
  writer.write("time", 0.0f);
  writer.write("i2", std::int16_t{-2});
  writer.write("i8", std::int64_t{-8});
  writer.write("u1", std::uint8_t{200});
  writer.write("u2", std::uint16_t{60000});
  writer.write("u4", std::uint32_t{4000000000});
  writer.write("u8", std::uint64_t{1} << 52);
  writer.save();
  const TraceSet set = read_traces(dir.file("x", writer.bytes()), kSi);
  std::vector<double> values;
  for (const Trace& trace : set.traces) values.push_back(trace.values.at(0));
  EXPECT_THAT(ids_of(set), ElementsAre("a/i2", "a/i8", "a/u1", "a/u2", "a/u4", "a/u8"));
  EXPECT_THAT(values, ElementsAre(-2, -8, 200, 60000, 4e9, 0x1p52));
}

TEST(LsdynaBinout, ContactsHaveTheirSidesAndTitles) {
  const test::TempDir dir;
  LsdaWriter writer;
  writer.cd("/rcforc/metadata");
  writer.write("ids", std::vector<int>{2, 2, 5});
  writer.write("side", std::vector<int>{0, 1, 0});
  writer.write("legend_ids", std::vector<int>{2});
  writer.write("legend", "front bumper", 70);
  writer.cd("../d000001");
  writer.write("time", 0.0);
  writer.write("x_force", std::vector<double>{1, -1, 3});
  writer.save();
  const TraceSet set = read_traces(dir.file("x", writer.bytes()), kSi);
  EXPECT_THAT(ids_of(set), ElementsAre("rcforc/2 slave/x_force", "rcforc/2 master/x_force", "rcforc/5 slave/x_force"));
  EXPECT_EQ(set.traces[1].name, "front bumper master_FX");
  EXPECT_EQ(set.traces[1].location, "front bumper master");
  EXPECT_EQ(set.traces[1].axis, 'X');
  EXPECT_THAT(set.traces[1].values, ElementsAre(-1));
  EXPECT_EQ(set.traces[2].name, "5 slave_FX");
}

TEST(LsdynaBinout, EachVariableTakesTheIdsThatBelongToIt) {
  const test::TempDir dir;
  LsdaWriter writer;
  writer.cd("/spcforc/metadata");
  writer.write("force_ids", std::vector<int>{11, 12});
  writer.write("moment_ids", std::vector<int>{21, 22});
  writer.cd("/spcforc/d000001");
  writer.write("time", 0.0);
  writer.write("x_force", std::vector<double>{1, 2});
  writer.write("x_moment", std::vector<double>{3, 4});
  writer.write("x_resultant", 5.0);
  writer.cd("/elout/solid/d000001");
  writer.write("time", 0.0);
  writer.write("ids", std::vector<int>{7, 7});
  writer.write("sig_xx", std::vector<double>{6, 8});
  writer.write("state", std::vector<double>{6, 8, 9});
  writer.save();
  const TraceSet set = read_traces(dir.file("x", writer.bytes()), kSi);
  EXPECT_THAT(ids_of(set),
              ElementsAre("spcforc/11/x_force", "spcforc/12/x_force", "spcforc/21/x_moment", "spcforc/22/x_moment",
                          "spcforc/x_resultant", "elout/solid/7/sig_xx", "elout/solid/7#2/sig_xx",
                          "elout/solid/#1/state", "elout/solid/#2/state", "elout/solid/#3/state"));
  EXPECT_THAT(set.warnings,
              ElementsAre(HasSubstr("elout/solid: 1 id is there more than once: the later ones are named like 7#2"),
                          HasSubstr("elout/solid: no ids for the values of state: they are numbered by position")));
}

TEST(LsdynaBinout, AListOfIdsIsNotGuessedAmongSeveral) {
  const test::TempDir dir;
  LsdaWriter writer;
  writer.cd("/sbtout/metadata");
  writer.write("belt_ids", std::vector<int>{1, 2});
  writer.write("retractor_ids", std::vector<int>{11, 12});
  writer.write("slipring_ids", std::vector<int>{21, 22});
  writer.cd("/sbtout/d000001");
  writer.write("time", 0.0);
  for (const char* name : {"belt_force", "ring_slip", "payout"}) writer.write(name, std::vector<double>{1, 2});
  writer.save();
  const TraceSet set = read_traces(dir.file("x", writer.bytes()), kSi);
  EXPECT_THAT(ids_of(set), ElementsAre("sbtout/1/belt_force", "sbtout/2/belt_force", "sbtout/21/ring_slip",
                                       "sbtout/22/ring_slip", "sbtout/#1/payout", "sbtout/#2/payout"));
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("sbtout: no ids for the values of payout")));
}

TEST(LsdynaBinout, TotalsBelongToTheModelEvenWithOneEntity) {
  const test::TempDir dir;
  LsdaWriter writer;
  writer.cd("/bndout/metadata");
  writer.write("ids", std::vector<int>{7});
  writer.cd("/bndout/d000001");
  writer.write("time", 0.0);
  for (const char* name : {"x_force", "xtotal", "ytotal", "ztotal", "thick_shell_id", "max_thick_shell_mass"})
    writer.write(name, std::vector<double>{1});
  writer.save();
  EXPECT_THAT(ids_of(read_traces(dir.file("x", writer.bytes()), kSi)),
              ElementsAre("bndout/7/x_force", "bndout/xtotal", "bndout/ytotal", "bndout/ztotal",
                          "bndout/thick_shell_id", "bndout/max_thick_shell_mass"));
}

TEST(LsdynaBinout, EnergiesOfWallsAreNamedAsInTheAsciiFile) {
  const test::TempDir dir;
  for (const std::size_t walls : {1u, 2u}) {
    LsdaWriter writer;
    writer.cd("/glstat/d000001");
    writer.write("time", 0.0);
    writer.write("kinetic_energy", 1.0);
    writer.write("stonewall_energy", std::vector<double>(walls, 2.0));
    writer.save();
    const TraceSet set = read_traces(dir.file("x", writer.bytes()), kSi);
    ASSERT_EQ(set.traces.size(), 1 + walls);
    for (std::size_t wall = 1; wall <= walls; ++wall) {
      EXPECT_EQ(set.traces[wall].id, fmt::format("glstat/{}/stonewall_energy", wall));
      EXPECT_EQ(set.traces[wall].name, fmt::format("wall_{}_stonewall_energy", wall));
    }
    EXPECT_THAT(set.warnings, testing::Each(testing::Not(HasSubstr("no ids"))));
  }
}

TEST(LsdynaBinout, UnitsOfTheDeckBecomeSi) {
  const test::TempDir dir;
  const std::string path = dir.file("x", test::binout_bytes<double>({two_nodes({0, 1, 2}, 15000)}));
  const TraceSet set = read_traces(path, {.channels = {}, .columns = "", .units = "t-mm-s"});
  EXPECT_THAT(with_id(set, "nodout/1/x_velocity").values, ElementsAre(15, 15.001, 15.002));
  EXPECT_THAT(set.warnings, IsEmpty());
  EXPECT_THAT(read_traces(path).warnings, ElementsAre(HasSubstr("channel 1_VX reaches 15002 m/s, too much")));
  const TraceSet ms = read_traces(path, {.channels = {}, .columns = "", .units = "kg-mm-ms"});
  EXPECT_THAT(ms.traces[0].times(), ElementsAre(0, 1e-3, 2e-3));
}

TEST(LsdynaBinout, OnlyTheChannelsAskedForAreRead) {
  const test::TempDir dir;
  test::Random random(5);
  const test::BinoutData data = {test::random_database(random, "nodout", 200, {"x_velocity", "y_velocity"}, 40)};
  const std::string path = dir.file("x", test::binout_bytes<double>(data));
  const auto expected = test::channels_of(data);
  const std::vector<std::string> wanted = {"nodout/100/x_velocity", "nodout/723/x_velocity", "nodout/1493/x_velocity",
                                           "nodout/793/y_velocity"};
  const TraceSet set = read_traces(path, {.channels = wanted, .columns = "", .units = "kg-m-s"});
  EXPECT_EQ(set.traces.size(), 400u);
  std::size_t read = 0;
  for (const Trace& trace : set.traces) {
    if (!trace.has_samples) continue;
    ++read;
    EXPECT_EQ(trace.values, expected.at(trace.id).second) << trace.id;
    EXPECT_EQ(trace.time_s, with_id(set, wanted[0]).time_s);
  }
  EXPECT_EQ(read, wanted.size());
}

}  // namespace
}  // namespace crashsim
