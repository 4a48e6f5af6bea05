#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <crashsim/comparison.hpp>
#include <crashsim/error.hpp>
#include <crashsim/files.hpp>
#include <crashsim/iso_mme.hpp>
#include <crashsim/pulse.hpp>
#include <crashsim/signal.hpp>
#include <crashsim/table_io.hpp>
#include <crashsim/trace_io.hpp>

#include "support/oracle.hpp"
#include "support/random.hpp"
#include "support/shared_data.hpp"
#include "support/source_dir.hpp"
#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

using Samples = std::vector<double>;

std::shared_ptr<const Samples> shared(Samples times) { return std::make_shared<const Samples>(std::move(times)); }

/// Times as measurements have them: multiples of 0.1 ms, correctly rounded.
Samples decimal_times(int first, std::size_t count) {
  Samples times;
  for (std::size_t i = 0; i < count; ++i) times.push_back((first + static_cast<double>(i)) / 1e4);
  return times;
}

IsoMmeTest small_test() {
  IsoMmeTest test;
  test.name = "run";
  test.channels = {{"10VEHCCG0000ACX0", "accel", "", Dimension::acceleration, "", shared({0, 1e-3, 2e-3}), {1, 2, 3}}};
  return test;
}

/// What pyisomme reads of a folder or channel file.
nlohmann::json read_by_pyisomme(const std::string& python, const std::string& path) {
  const std::string command =
      python + " " + std::string(test::source_dir()) + "/tests/oracles/read_iso_mme.py " + path + " 2>/dev/null";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(::popen(command.c_str(), "r"), ::pclose);
  std::string text;
  std::array<char, 4096> block{};
  while (const std::size_t got = std::fread(block.data(), 1, block.size(), pipe.get())) text.append(block.data(), got);
  return nlohmann::json::parse(text);
}

TEST(IsoMmeWriter, RandomTestsComeBackBitByBit) {
  test::Random random(5);
  for (int round = 0; round < 20; ++round) {
    IsoMmeTest written;
    written.name = "Run 1";
    written.title = "A title: with a colon";
    written.mass_kg = random.between(900, 2500);
    written.impact_speed_mps = random.between(5, 25);
    for (int c = 0; c < 4; ++c) {
      const auto count = static_cast<std::size_t>(random.whole(2, 200));
      Samples values, times;
      for (std::size_t i = 0; i < count; ++i) {
        values.push_back(random.whole(0, 20) == 0 ? std::nan("")
                                                  : random.between(-1, 1) * std::pow(10, random.whole(-300, 300)));
        times.push_back((times.empty() ? -1.0 : times.back()) + random.between(1e-6, 1e-3));
      }
      if (c % 2 == 0) times = decimal_times(random.whole(-500, 500), count);
      written.channels.push_back({fmt::format("10VEHC{:02}0000ACX0", c), fmt::format("channel {}", c), "",
                                  Dimension::acceleration, "", shared(times), values});
    }
    const test::TempDir dir;
    write_iso_mme(written, dir.path("out"));
    const TraceSet set = read_traces(dir.path("out"));
    EXPECT_EQ(set.title, written.title);
    EXPECT_EQ(set.mass_kg, written.mass_kg);
    EXPECT_EQ(set.impact_speed_mps, written.impact_speed_mps);
    EXPECT_THAT(set.warnings, IsEmpty());
    ASSERT_EQ(set.traces.size(), 6u) << "and two time channels";
    for (std::size_t c = 0; c < 4; ++c) {
      EXPECT_EQ(set.traces[c].id, written.channels[c].code);
      EXPECT_EQ(set.traces[c].name, written.channels[c].name);
      EXPECT_EQ(*set.traces[c].time_s, *written.channels[c].time_s);
      EXPECT_THAT(set.traces[c].values,
                  testing::Pointwise(testing::NanSensitiveDoubleEq(), written.channels[c].values));
      for (std::size_t i = 0; i < set.traces[c].values.size(); ++i)
        EXPECT_TRUE(set.traces[c].values[i] == written.channels[c].values[i] || std::isnan(set.traces[c].values[i]));
    }
  }
}

TEST(IsoMmeWriter, ComputedUniformTimesAreImplicitAndComeBackButForRounding) {
  const Samples times = uniform_times(0.0, 1e-4, 2001);
  IsoMmeTest written = small_test();
  written.channels[0].time_s = shared(times);
  written.channels[0].values = times;
  const test::TempDir dir;
  write_iso_mme(written, dir.path("out"));
  const TraceSet set = read_traces(dir.path("out"));
  ASSERT_EQ(set.traces.size(), 1u);
  EXPECT_EQ(set.traces[0].values, times);
  constexpr double kRounding = 1e-15;  // relative, of a time that is a multiple of the interval
  for (std::size_t i = 0; i < times.size(); ++i)
    EXPECT_NEAR(set.traces[0].times()[i], times[i], kRounding * times.back());
  const std::string header = read_file(dir.path("out/Channel/run.001")).substr(0, 1000);
  EXPECT_THAT(header, AllOf(HasSubstr("Sampling interval           :1e-04\r\n"), HasSubstr(":implicit\r\n")));
}

TEST(IsoMmeWriter, SetsWithTimeChannelsAreWrittenAgain) {
  IsoMmeTest written = small_test();
  written.channels[0].time_s = shared({0, 1e-3, 3e-3});
  written.channels.push_back(written.channels[0]);
  written.channels[1].time_s = shared({0, 1e-3, 4e-3});
  const test::TempDir dir;
  write_iso_mme(written, dir.path("one"));
  write_iso_mme(make_iso_mme_test(read_traces(dir.path("one")), "run"), dir.path("two"));
  const TraceSet set = read_traces(dir.path("two"));
  ASSERT_EQ(set.traces.size(), 6u) << "two channels, their time channels, and those written anew";
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(*set.traces[i].time_s, *written.channels[i].time_s);
    EXPECT_EQ(set.traces[i].values, written.channels[i].values);
  }
}

TEST(IsoMmeWriter, PulsesComeBackAsTheSamePulse) {
  const Samples times = decimal_times(0, 1501);
  Samples accel;
  for (const double t : times) accel.push_back(t < 0.1 ? -250.0 * std::sin(31.4159 * t) : 0.0);
  const Pulse pulse = make_pulse(times, accel, 15.4, 1719.5);
  const test::TempDir dir;
  write_csv(dir.path("pulse.csv"),
            {{"crashsim", "0.1"},
             {"mass_kg", "1719.5"},
             {"impact_speed_mps", "15.4"},
             {"step", "filter: CFC60 (j211), forward and backward"},
             {"record", "{\"a\": 1}"}},
            {{"time_s", pulse.time_s},
             {"accel_mps2", pulse.accel_mps2},
             {"velocity_mps", pulse.velocity_mps},
             {"displacement_m", pulse.displacement_m}});
  write_iso_mme(make_iso_mme_test(read_traces(dir.path("pulse.csv")), "pulse"), dir.path("out"));

  const Pulse written = read_pulse(dir.path("out"));
  EXPECT_EQ(written.accel_mps2, pulse.accel_mps2) << "known as a finished pulse by the names of its channels";
  EXPECT_EQ(written.displacement_m, pulse.displacement_m);
  PulseOptions as_it_is;
  as_it_is.channels = {"10VEHCCG0000ACX?"};
  as_it_is.cfc = 0.0;
  as_it_is.bias.rule = Bias::none;
  const Pulse back = read_pulse(dir.path("out"), as_it_is);
  EXPECT_EQ(back.time_s, pulse.time_s);
  EXPECT_EQ(back.accel_mps2, pulse.accel_mps2);
  EXPECT_EQ(back.velocity_mps, pulse.velocity_mps);
  EXPECT_EQ(back.displacement_m, pulse.displacement_m);
  EXPECT_EQ(back.mass_kg, 1719.5);
  EXPECT_EQ(back.t_m_s, pulse.t_m_s);

  const TraceSet set = read_traces(dir.path("out"));
  EXPECT_THAT(set.compartment_x, ElementsAre("10VEHCCG0000ACXD")) << "filtered with CFC 60";
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("already filtered with CFC 60")));
  EXPECT_THAT(read_file(dir.path("out/pulse.mme")),
              AllOf(HasSubstr("Comments                    :step = filter: CFC60"), testing::Not(HasSubstr("record"))));
  EXPECT_EQ(read_file(dir.path("out/pulse.txt")), "# record = {\"a\": 1}\n");
}

TEST(IsoMmeWriter, HeaveAndPitchAreTurnedToTheSignsOfSaeJ211) {
  const test::TempDir dir;
  const std::string path = dir.file(
      "pitch.csv",
      "# outcome = "
      "completed\ntime_s,heave_m,pitch_rad,pitch_rate_radps,front_axle_force_n,pitch_moment_nm,spring_force_n\n"
      "0,0.25,0.5,1,2,3,4\n0.001,1,1,1,1,1,1\n");
  std::vector<std::string> notes;
  const auto channels = iso_mme_channels(read_traces(path), notes);
  std::vector<std::string> codes;
  Samples first;
  for (const IsoMmeChannel& channel : channels) {
    codes.push_back(channel.code);
    first.push_back(channel.values[0]);
  }
  EXPECT_THAT(codes, ElementsAre("10VEHCCG0000DSZ0", "10VEHCCG0000ANY0", "10VEHCCG0000AVY0", "10AXLEFR0000FOZ0",
                                 "10VEHCCG0000MOY0", "10FREN010000FO00"));
  EXPECT_THAT(first, ElementsAre(-0.25, -0.5, -1, -2, -3, 4));
  EXPECT_THAT(channels[0].comment, HasSubstr("turned to Z down"));
  EXPECT_EQ(channels[0].name, "heave_m (SAE J211 sign)");
  EXPECT_EQ(channels[5].name, "spring_force_n") << "its sign is its own";
  EXPECT_THAT(notes, IsEmpty());
}

TEST(IsoMmeWriter, TurnedChannelsAreNotComparedWithWhatTheyWereMadeFrom) {
  const test::TempDir dir;
  const TraceSet motion = read_traces(dir.file("pitch.csv", "time_s,heave_m,pitch_rad\n0,0,0\n0.001,1,1\n0.002,2,3\n"));
  write_iso_mme(make_iso_mme_test(motion, "T1"), dir.path("T1"));
  const TraceSet turned = read_traces(dir.path("T1"));
  EXPECT_THAT(turned.traces.at(0).values, ElementsAre(0, -1, -2));
  EXPECT_THAT([&] { compare(motion, turned); }, ThrowsMessage<InvalidInput>(HasSubstr("have no channel in common")));

  const IsoMmeTest again = make_iso_mme_test(turned, "T2");
  EXPECT_EQ(again.data_source, "simulation");
  EXPECT_EQ(again.channels.at(0).name, turned.traces[0].name);
  EXPECT_EQ(again.channels.at(0).values, turned.traces[0].values) << "turned once only";
}

TEST(IsoMmeWriter, ForeignChannelsGetACodeByWhatTheyMeasure) {
  const test::TempDir dir;
  std::vector<std::string> notes;
  const TraceSet set = read_traces(dir.file("a.csv", "time_s,left_g,F [kN]\n0,1,2\n1,2,3\n"));
  const auto channels = iso_mme_channels(set, notes);
  EXPECT_EQ(channels[0].code, "100000000100AC00");
  EXPECT_EQ(channels[1].code, "100000000200FO00");
  EXPECT_THAT(notes, IsEmpty());
}

TEST(IsoMmeWriter, ChannelsThatCannotBeWrittenAreLeftOutWithANote) {
  const test::TempDir dir;
  const std::string path = dir.file("a.csv", "time_s,k_n_per_m,left_g,right_g\n0,1,2,3\n1,2,3,4\n");
  const IsoMmeTest test =
      make_iso_mme_test(read_traces(path, {.channels = {"k*", "left*"}, .columns = "", .units = ""}), "run");
  ASSERT_EQ(test.channels.size(), 1u);
  EXPECT_EQ(test.channels[0].name, "left_g");
  EXPECT_THAT(test.notes, ElementsAre("left out: channel 2 k_n_per_m: ISO-MME has no code for stiffness",
                                      "left out: channel 4 right_g: its samples are not there"));
  const TraceSet stiff = read_traces(dir.file("b.csv", "time_s,k_n_per_m\n0,1\n1,2\n"));
  EXPECT_THAT([&] { make_iso_mme_test(stiff, "run"); },
              ThrowsMessage<InvalidInput>(HasSubstr("b.csv: no channel can be written as ISO-MME: channel 2 k_n_per_m: "
                                                    "ISO-MME has no code for stiffness")));
}

TEST(IsoMmeWriter, WhatCannotBeWrittenIsRefused) {
  const auto refusal = [](const auto& change, const std::string& message) {
    IsoMmeTest written = small_test();
    change(written);
    EXPECT_THAT([&] { format_iso_mme(written); }, ThrowsMessage<InvalidInput>(HasSubstr(message)));
  };
  refusal([](IsoMmeTest& t) { t.name = "a/b"; }, "test name 'a/b': must be a file name without folder");
  refusal([](IsoMmeTest& t) { t.name = ""; }, "test name ''");
  refusal([](IsoMmeTest& t) { t.channels.clear(); }, "test run: has no channels to write");
  refusal([](IsoMmeTest& t) { t.channels[0].code = "short"; }, "'short' is no ISO-MME code: 16 letters and digits");
  refusal([](IsoMmeTest& t) { t.channels[0].dimension = Dimension::stiffness; }, "ISO-MME has no unit for stiffness");
  refusal([](IsoMmeTest& t) { t.channels[0].time_s = nullptr; }, "has no times");
  refusal([](IsoMmeTest& t) { t.channels[0].time_s = shared({0, 1e-3, 1e-3}); }, "channel 10VEHCCG0000ACX0 accel");
  refusal([](IsoMmeTest& t) { t.channels[0].values[1] = HUGE_VAL; }, "channel 10VEHCCG0000ACX0 accel");
  refusal([](IsoMmeTest& t) { t.channels[0].values.pop_back(); }, "channel 10VEHCCG0000ACX0 accel");
}

TEST(IsoMmeWriter, FoldersAppearWholeAndLoseNothing) {
  const test::TempDir dir;
  write_iso_mme(small_test(), dir.path("out/"));
  EXPECT_TRUE(std::filesystem::exists(dir.path("out/Channel/run.chn")));
  EXPECT_THAT([&] { write_iso_mme(small_test(), dir.path("out")); },
              ThrowsMessage<InvalidInput>(HasSubstr("out: exists already and is not empty: choose another name")));
  IsoMmeTest changed = small_test();
  changed.channels[0].values = {7, 8, 9};
  write_iso_mme(changed, dir.path("out"), true);
  EXPECT_THAT(read_traces(dir.path("out")).traces.at(0).values, ElementsAre(7, 8, 9));
  dir.file("out/notes.md", "mine");
  EXPECT_THAT([&] { write_iso_mme(changed, dir.path("out"), true); },
              ThrowsMessage<InvalidInput>(HasSubstr("out: holds notes.md too, which would be lost")));
  EXPECT_THAT([&] { write_iso_mme(changed, dir.path("out/run.mme"), true); },
              ThrowsMessage<InvalidInput>(HasSubstr("is a file: name a folder")));
  std::filesystem::create_directory(dir.path("empty"));
  write_iso_mme(changed, dir.path("empty"));
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(dir.path("")))
    names.push_back(entry.path().filename().string());
  EXPECT_THAT(names, testing::UnorderedElementsAre("out", "empty")) << "nothing is left beside";
}

TEST(IsoMmeWriter, AnIndependentReaderReadsTheSameOfARealChannel) {
  const auto python = test::oracle_python("pyisomme");
  if (!python) GTEST_SKIP() << test::kNoOracle;
  const auto path = test::shared_data("iso-mme/Channel/test.001");
  if (!path) GTEST_SKIP() << test::kNoSharedData;
  const auto theirs = read_by_pyisomme(*python, path->string()).at(0);
  const Trace ours = read_traces(path->string()).traces.at(0);
  EXPECT_EQ(theirs["code"], ours.id);
  EXPECT_EQ(theirs["name"], ours.name);
  EXPECT_EQ(theirs["unit"], "N m");
  EXPECT_EQ(theirs["values"].get<Samples>(), ours.values);
  constexpr double kRounding = 1e-15;
  const auto times = theirs["times"].get<Samples>();
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(times[i], ours.times()[i], kRounding);
}

TEST(IsoMmeWriter, AnIndependentReaderReadsWhatIsWritten) {
  const auto python = test::oracle_python("pyisomme");
  if (!python) GTEST_SKIP() << test::kNoOracle;
  test::Random random(6);
  Samples values, uneven;
  for (int i = 0; i < 100; ++i) {
    values.push_back(random.between(-500, 500));
    uneven.push_back((uneven.empty() ? 0.0 : uneven.back()) + random.between(1e-5, 1e-4));
  }
  IsoMmeTest written = small_test();
  const auto even = shared(decimal_times(-20, values.size()));
  written.channels = {{"10VEHCCG0000ACXD", "accel_mps2", "", Dimension::acceleration, "", even, values},
                      {"10VEHCCG0000MOY0", "pitch_moment_nm", "turned", Dimension::moment, "", even, values},
                      {"10VEHCCG0000ANY0", "pitch_rad", "", Dimension::angle, "", shared(uneven), values}};
  const test::TempDir dir;
  write_iso_mme(written, dir.path("out"));
  const auto theirs = read_by_pyisomme(*python, dir.path("out"));
  ASSERT_EQ(theirs.size(), 4u) << "and a time channel";
  const char* const units[] = {"m / s2", "N m", "rad"};
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(theirs[c]["code"], written.channels[c].code);
    EXPECT_EQ(theirs[c]["name"], written.channels[c].name);
    EXPECT_EQ(theirs[c]["unit"], units[c]);
    EXPECT_EQ(theirs[c]["values"].get<Samples>(), values);
  }
  EXPECT_EQ(theirs[2]["times"].get<Samples>(), uneven);
  constexpr double kRounding = 1e-16;
  const auto times = theirs[0]["times"].get<Samples>();
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(times[i], (*even)[i], kRounding);
}

}  // namespace
}  // namespace crashsim
