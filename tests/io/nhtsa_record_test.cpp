/// What an NHTSA test says beside its samples, and what its files may look like.

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/error.hpp>
#include <crashsim/pulse.hpp>
#include <crashsim/trace_io.hpp>

#include "support/nhtsa_files.hpp"
#include "support/random.hpp"
#include "support/shared_data.hpp"

namespace crashsim {
namespace {

using test::header_text;
using test::kFiveSamples;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::Pair;

std::string value_of(const TraceSet& set, const std::string& key) {
  const auto found =
      std::find_if(set.metadata.begin(), set.metadata.end(), [&](const auto& m) { return m.first == key; });
  return found == set.metadata.end() ? "(absent)" : found->second;
}

TEST(NhtsaRecord, EveryFieldHasItsName) {
  const test::TempDir dir;
  const std::string occupant = "----- OCCUPANT -----\n1|01|H3||M\n----- RESTRAINT -----\n1|01|2|FRT|SW|DP|BAG\n";
  std::string text = header_text({{.comment = "A|B"}});
  text.insert(text.find("----- INSTR"), occupant);
  const TraceSet set = read_traces(dir.file("v01.EV5", text));
  EXPECT_EQ(value_of(set, "TEST.VERNO"), "V5");
  EXPECT_EQ(value_of(set, "TEST.TOTCRV"), "1");
  EXPECT_EQ(value_of(set, "TEST.TSTCOM"), "(absent)") << "empty fields are left out";
  EXPECT_EQ(value_of(set, "VEHICLE[1].VEHTWT"), "1500");
  EXPECT_EQ(value_of(set, "VEHICLE[1].BX21"), "0");
  EXPECT_EQ(value_of(set, "VEHICLE[1].VEHSPD"), "57.6");
  EXPECT_EQ(value_of(set, "VEHICLE[1].VEHCOM"), "0");
  EXPECT_EQ(value_of(set, "BARRIER.BARSHP"), "LCB");
  EXPECT_EQ(value_of(set, "OCCUPANT[1,01].OCCTYP"), "H3");
  EXPECT_EQ(value_of(set, "OCCUPANT[1,01].OCCAGE"), "(absent)");
  EXPECT_EQ(value_of(set, "RESTRAINT[1,01,2].RSTCOM"), "BAG");
  EXPECT_EQ(value_of(set, "INSTRUMENTATION[1].INSMAN"), "ACME");
  EXPECT_EQ(value_of(set, "INSTRUMENTATION[1].CHSTAT"), "P");
  EXPECT_EQ(value_of(set, "INSTRUMENTATION[1].FIELD21"), "B") << "beyond the guide";
  EXPECT_EQ(value_of(set, "INSTRUMENTATION[1].YUNITS"), "(absent)") << "the trace has it";
}

TEST(NhtsaRecord, TheCamryTestIsReadWhole) {
  const auto path = test::shared_data("nhtsa-10146/v10146.EV5");
  if (!path) GTEST_SKIP() << test::kNoSharedData;
  const TraceFileInfo info = inspect_traces(path->string());
  const TraceSet& set = info.set;
  EXPECT_EQ(value_of(set, "TEST.TSTDAT"), "03/OCT/2017");
  EXPECT_EQ(value_of(set, "VEHICLE[1].VIN"), "JTNB11HK8J3028996");
  EXPECT_EQ(value_of(set, "VEHICLE[1].VEHTWT"), "1719");
  EXPECT_EQ(value_of(set, "VEHICLE[1].VEHSPD"), "57.09");
  EXPECT_EQ(value_of(set, "VEHICLE[1].DPD6"), "370");
  EXPECT_EQ(value_of(set, "VEHICLE[1].VDI"), "12FDEW2");
  EXPECT_EQ(value_of(set, "VEHICLE[1].AX21"), "510");
  EXPECT_EQ(value_of(set, "OCCUPANT[1,01].DUMSIZ"), "50");
  EXPECT_EQ(value_of(set, "OCCUPANT[1,02].HIC"), "335");
  EXPECT_EQ(value_of(set, "OCCUPANT[1,01].RFEM"), "-2345");
  EXPECT_EQ(value_of(set, "OCCUPANT[1,01].OCCCOM"), "HEAD TO HEADREST");
  EXPECT_EQ(value_of(set, "RESTRAINT[1,02,3].RSTTYP"), "KNE");
  EXPECT_EQ(value_of(set, "INSTRUMENTATION[93].PREFIL"), "2800");
  EXPECT_EQ(value_of(set, "INSTRUMENTATION[634].INSRAT"), "14025");
  EXPECT_THAT(set.metadata, Not(Contains(Pair(HasSubstr("FIELD"), testing::_))));
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("channel 109 'BARRIER K-01 Mz' has AXIS XG")))
      << "and neither 93 nor 94 differ by more than 5 % in their change of speed";
}

TEST(NhtsaRecord, ATotalThatIsNotTheNumberOfChannelsIsSaid) {
  const test::TempDir dir;
  std::string text = header_text({{}});
  text.replace(text.find("|0|1|\n"), 6, "|0|634|\n");
  EXPECT_THAT(read_traces(dir.file("v01.EV5", text)).warnings,
              ElementsAre(HasSubstr("TOTCRV promises 634 channels, the header describes 1")));
}

TEST(NhtsaRecord, AllStatusWordsAreUnderstood) {
  const test::TempDir dir;
  const auto read = [&](const std::string& status) {
    return read_traces(dir.file("v01.EV5", header_text({{.data_status = status}})));
  };
  for (const char* good : {"AM", "CM", "COMPUTED", ""})
    EXPECT_THAT(read(good).traces[0].problem, HasSubstr("not beside")) << good;
  for (const char* bad : {"CF", "NO", "QD", "ML", "SF", "CQ", "CHANNEL FAILED", "Meaningless"})
    EXPECT_THAT(read(bad).traces[0].problem, HasSubstr(fmt::format("(DASTAT {})", bad))) << bad;
  EXPECT_THAT(read("ZZ").warnings, ElementsAre(HasSubstr("channel 1: DASTAT ZZ is not known")));
}

TEST(NhtsaRecord, SensorPlacesMayBeLongerThanFourLetters) {
  const test::TempDir dir;
  EXPECT_EQ(read_traces(dir.file("v01.EV5", header_text({{.attachment = "LC1101"}}))).traces[0].location, "LC1101");
}

TEST(NhtsaRecord, MoreSamplesThanDeclaredAreSaid) {
  const test::TempDir dir;
  dir.file("v01.001", kFiveSamples);
  const TraceSet set = read_traces(dir.file("v01.EV5", header_text({{.last = "1"}})));
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("v01.001: 5 samples, 1 more than its header declares")));
  EXPECT_EQ(set.traces[0].values.size(), 5u);
}

/// A test of one channel in NWT, whose file has some lines and then one without end.
class LastLine : public testing::Test {
 protected:
  [[nodiscard]] TraceSet read(const std::string& line, const std::string& last, int lines = 20) const {
    std::string samples;
    for (int i = 0; i < lines; ++i) samples += line;
    dir.file("v01.001", samples + last);
    return read_traces(
        dir.file("v01.EV5", header_text({{.unit = "NWT", .first = "0", .last = std::to_string(lines)}})));
  }
  test::TempDir dir;
};

TEST_F(LastLine, IsTakenOnlyWhenItIsSurelyWhole) {
  EXPECT_EQ(read("1.25\n", "3.25").traces[0].values.back(), 3.25);
  EXPECT_THAT(read("1.25\n", "3.25").warnings, testing::IsEmpty());
  EXPECT_EQ(read("1.25E+01\n", "3.25E+02").traces[0].values.size(), 21u);
  for (const char* cut : {"3.2", "3.", "3", "-"}) {
    const TraceSet set = read("1.25\n", cut);
    EXPECT_EQ(set.traces[0].values.size(), 20u) << cut;
    EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("v01.001: its last line has no end and may be cut short"))) << cut;
    EXPECT_EQ(set.traces[0].problem, "") << cut;
  }
  EXPECT_THAT(read("1.25\n", "2.2", 1).traces[0].values, ElementsAre(1.25));
}

TEST_F(LastLine, IsInDoubtWhereItsFormProvesNothing) {
  EXPECT_EQ(read("12\n", "13").traces[0].values.size(), 20u) << "may be 13 of 135";
  EXPECT_EQ(read("1.25E+01\n", "3.25E+0").traces[0].values.size(), 20u) << "E+0 of E+02";
  EXPECT_EQ(read("1.25E5\n", "3.25E1").traces[0].values.size(), 20u) << "E1 of E10";
  EXPECT_EQ(read("1.25\n", "3.25", 19).traces[0].values.size(), 19u) << "too few lines to know their form";
  dir.file("v01.001", "1.125\n2.25\n3.25");
  EXPECT_THAT(read_traces(dir.path("v01.EV5")).traces[0].values, ElementsAre(1.125, 2.25)) << "as short as they can be";
}

TEST_F(LastLine, OfTimesAndValuesIsJudgedByItsValue) {
  const test::NhtsaRecord record{.first = "-10", .last = "20"};
  const std::string rows = test::sample_rows(record, [](double t) { return 1e3 * t; }),
                    header = dir.file("v01.EV5", header_text({record}));
  const auto samples = [&](std::size_t cut) {
    dir.file("v01.001", "TIME (SEC)\tX (G'S)\n" + rows.substr(0, rows.size() - cut));
    return read_traces(header).traces[0].values.size();
  };
  EXPECT_EQ(samples(1), 31u);
  EXPECT_EQ(samples(2), 30u);
  EXPECT_EQ(samples(12), 30u) << "only its time is left";
}

TEST(NhtsaRecord, TimesOfAFileMustIncrease) {
  const test::TempDir dir;
  dir.file("v01.001", "0\t1\n0.001\t1\n0.001\t1\n0.002\t1\n0.003\t1\n");
  EXPECT_THAT(read_traces(dir.file("v01.EV5", header_text({{}}))).traces[0].problem,
              HasSubstr("time does not increase after sample 2, 0.001 s"));
}

TEST(NhtsaRecord, ATabSeparatedExportFindsItsHeader) {
  const test::TempDir dir;
  const std::string header = dir.file("v01.EV5", header_text({{}}));
  const std::string file = dir.file("v01tsv.001", std::string("TIME (SEC)\tLEFT REAR X (G'S)\n") + kFiveSamples);
  EXPECT_THAT(read_traces(file).traces.at(0).values.size(), 5u);
  EXPECT_THAT(read_traces(header).traces.at(0).values.size(), 5u) << "and the header finds it";
  EXPECT_EQ(read_traces(header).traces.at(0).problem, "");
}

TEST(NhtsaRecord, AWholeTestAsOneTableIsRead) {
  const test::TempDir dir;
  const TraceSet set = read_traces(dir.file("v01.tsv", "TIME (SEC)\t093 (G'S)\t107 (NWT)\n0.0\t1.0\t5\n0.1\t2.0\t6\n"));
  EXPECT_EQ(set.format, "csv");
  EXPECT_THAT(set.traces.at(0).values, ElementsAre(9.80665, 19.6133));
  EXPECT_THAT(set.traces.at(1).values, ElementsAre(5, 6));
}

constexpr int kCuts = 200;

/// Of a shortened file: nothing at all with a message, or what stands before the cut with a warning.
void expect_part_of(const TraceSet& whole, const std::string& path, std::size_t cut) {
  TraceSet part;
  try {
    part = read_traces(path);
  } catch (const InvalidInput& refused) {
    EXPECT_STRNE(refused.what(), "");
    return;
  }
  if (part.format != "nhtsa_ev5") return;
  ASSERT_LE(part.traces.size(), whole.traces.size()) << cut;
  EXPECT_EQ(part.mass_kg, whole.mass_kg) << cut;
  std::size_t lost = whole.traces.size() - part.traces.size();
  for (std::size_t i = 0; i < part.traces.size(); ++i) {
    const auto& a = part.traces[i].values;
    const auto& b = whole.traces[i].values;
    EXPECT_EQ(part.traces[i].id, whole.traces[i].id);
    EXPECT_EQ(part.traces[i].name, whole.traces[i].name) << cut;
    ASSERT_LE(a.size(), b.size()) << cut;
    EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin())) << cut;
    if (a.size() < b.size() && part.traces[i].problem.empty()) ++lost;
  }
  if (lost > 0) {
    EXPECT_THAT(part.warnings, Contains(HasSubstr("cut short"))) << cut;
  }
}

TEST(NhtsaRecord, AHeaderCutAnywhereIsRefusedOrReadBeforeTheCut) {
  const test::TempDir dir;
  for (int i = 1; i <= 6; ++i) dir.file(fmt::format("v01.{:03}", i), kFiveSamples);
  std::vector<test::NhtsaRecord> records;
  for (int i = 1; i <= 6; ++i) records.push_back({.curve = i, .comment = fmt::format("CHANNEL {}", i)});
  const std::string text = header_text(records);
  const TraceSet whole = read_traces(dir.file("v01.EV5", text));
  test::Random random(1);
  for (int i = 0; i < kCuts; ++i) {
    const auto cut = static_cast<std::size_t>(random.whole(0, static_cast<int>(text.size()) - 1));
    expect_part_of(whole, dir.file("v01.EV5", text.substr(0, cut)), cut);
  }
}

TEST(NhtsaRecord, AChannelFileCutAnywhereGivesWhatIsBeforeTheCut) {
  const test::TempDir dir;
  test::Random random(2);
  const test::NhtsaRecord record{.first = "-50", .last = "249"};
  const std::string text = test::sample_rows(record, [&](double) { return random.between(-40.0, 40.0); });
  const std::string header = dir.file("v01.EV5", header_text({record}));
  dir.file("v01.001", text);
  const TraceSet whole = read_traces(header);
  ASSERT_EQ(whole.traces[0].values.size(), 300u);
  for (int i = 0; i < kCuts; ++i) {
    const auto cut = static_cast<std::size_t>(random.whole(0, static_cast<int>(text.size()) - 1));
    dir.file("v01.001", text.substr(0, cut));
    expect_part_of(whole, header, cut);
  }
}

TEST(NhtsaRecord, TheCamryFilesCutAnywhereGiveWhatIsBeforeTheCut) {
  const auto header = test::shared_data("nhtsa-10146/v10146.EV5"),
             channel = test::shared_data("nhtsa-10146/v10146.093");
  if (!header || !channel) GTEST_SKIP() << test::kNoSharedData;
  const test::TempDir dir;
  const std::string head = read_file(header->string()), body = read_file(channel->string());
  const std::string path = dir.file("v10146.EV5", head);
  dir.file("v10146.093", body);
  const TraceSet whole = read_traces(path);
  test::Random random(3);
  for (int i = 0; i < kCuts; ++i) {
    const auto cut = static_cast<std::size_t>(random.whole(0, static_cast<int>(body.size()) - 1));
    dir.file("v10146.093", body.substr(0, cut));
    expect_part_of(whole, path, cut);
  }
  dir.file("v10146.093", body);
  for (int i = 0; i < kCuts; ++i) {
    const auto cut = static_cast<std::size_t>(random.whole(0, static_cast<int>(head.size()) - 1));
    expect_part_of(whole, dir.file("v10146.EV5", head.substr(0, cut)), cut);
  }
}

}  // namespace
}  // namespace crashsim
