#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/error.hpp>
#include <crashsim/pulse.hpp>
#include <crashsim/trace_io.hpp>

#include "support/nhtsa_files.hpp"
#include "support/shared_data.hpp"

namespace crashsim {
namespace {

using test::header_text;
using test::kFiveSamples;
using test::NhtsaRecord;
using testing::AllOf;
using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsNan;
using testing::ThrowsMessage;

TEST(Nhtsa, HeaderTellsMassSpeedAndMeaningOfChannels) {
  const test::TempDir dir;
  dir.file("v01.001", kFiveSamples);
  const TraceSet set = read_traces(dir.file("v01.EV5", header_text({{}})));
  EXPECT_EQ(set.format, "nhtsa_ev5");
  EXPECT_EQ(set.title, "SMALL CAR");
  EXPECT_EQ(set.mass_kg, 1500);
  EXPECT_DOUBLE_EQ(set.impact_speed_mps, 16);
  EXPECT_THAT(set.compartment_x, ElementsAre("1"));
  EXPECT_THAT(set.input_files, ElementsAre(dir.path("v01.EV5"), dir.path("v01.001")));
  const Trace& trace = set.traces.at(0);
  EXPECT_EQ(trace.id, "1");
  EXPECT_EQ(trace.name, "LEFT REAR SEAT CROSSMEMBER X");
  EXPECT_EQ(trace.location, "FLLR");
  EXPECT_EQ(trace.axis, 'X');
  EXPECT_EQ(trace.source_unit, "G'S");
  EXPECT_EQ(trace.problem, "");
  EXPECT_THAT(*trace.time_s, ElementsAre(-2e-4, -1e-4, 0.0, 1e-4, 2e-4));
  EXPECT_THAT(trace.values, ElementsAre(0, 0, DoubleEq(4.903325), DoubleEq(-9.80665), DoubleEq(-19.6133)));
}

TEST(Nhtsa, OneValueALineTakesItsTimesFromTheHeader) {
  const test::TempDir dir;
  dir.file("v01.001", "1.0\r\n2.0\r\n3.0\r\n4.0\r\n5.0\r\n");
  const TraceSet set =
      read_traces(dir.file("v01.ev5", header_text({{.unit = "MM", .first = "-1", .last = "3", .step = "80"}})));
  EXPECT_THAT(*set.traces[0].time_s, ElementsAre(-8e-5, 0.0, 8e-5, 16e-5, 24e-5));
  EXPECT_THAT(set.traces[0].values, ElementsAre(0.001, 0.002, 0.003, 0.004, 0.005));
  EXPECT_THAT(set.compartment_x, IsEmpty()) << "it measures a length";
}

TEST(Nhtsa, ChannelsOfOneClockShareTheirTimes) {
  const test::TempDir dir;
  dir.file("v01.001", kFiveSamples);
  dir.file("V01.002", kFiveSamples);
  const TraceSet set = read_traces(dir.file("v01.EV5", header_text({{.curve = 1}, {.curve = 2}})));
  EXPECT_EQ(set.traces[0].time_s, set.traces[1].time_s);
}

TEST(Nhtsa, AChannelFileFindsItsHeader) {
  const test::TempDir dir;
  dir.file("v01.EV5", header_text({{.curve = 1}, {.curve = 12, .attachment = "ENGN", .comment = "ENGINE X"}}));
  dir.file("v01.001", kFiveSamples);
  const TraceSet set = read_traces(dir.file("v01.012", kFiveSamples));
  ASSERT_EQ(set.traces.size(), 1u);
  EXPECT_EQ(set.path, dir.path("v01.012"));
  EXPECT_EQ(set.traces[0].id, "12");
  EXPECT_EQ(set.mass_kg, 1500);
  EXPECT_THAT(set.compartment_x, ElementsAre("12")) << "the user named it";
  EXPECT_THAT([&] { read_traces(dir.file("v01.013", kFiveSamples)); },
              ThrowsMessage<InvalidInput>(AllOf(HasSubstr("v01.013: its header"), HasSubstr("lists no channel 13"))));
}

TEST(Nhtsa, OnlyChannelsAskedForAreOpened) {
  const test::TempDir dir;
  dir.file("v01.001", kFiveSamples);
  dir.file("v01.002", "<html>not found</html>");
  const TraceSet set = read_traces(dir.file("v01.EV5", header_text({{.curve = 1}, {.curve = 2}})),
                                   {.channels = {"001"}, .columns = "", .units = ""});
  EXPECT_EQ(set.input_files.size(), 2u);
  EXPECT_TRUE(set.traces[0].has_samples);
  EXPECT_FALSE(set.traces[1].has_samples);
  EXPECT_EQ(set.traces[1].problem, "");
}

struct BadChannel {
  const char* what;
  NhtsaRecord record;
  const char* samples;  ///< nullptr: no file.
  const char* problem;
  bool has_samples;
};
void PrintTo(const BadChannel& b, std::ostream* out) { *out << b.what; }

class BadNhtsaChannel : public testing::TestWithParam<BadChannel> {};

TEST_P(BadNhtsaChannel, IsKnownAsSuchAndRefusedForAPulse) {
  const auto& p = GetParam();
  const test::TempDir dir;
  if (p.samples != nullptr) dir.file("v01.001", p.samples);
  const std::string path = dir.file("v01.EV5", header_text({p.record}));
  const TraceSet set = read_traces(path);
  EXPECT_THAT(set.traces[0].problem, HasSubstr(p.problem));
  EXPECT_EQ(set.traces[0].has_samples, p.has_samples);
  PulseOptions options;
  options.channels = {"1"};
  EXPECT_THAT([&] { read_pulse(path, options); },
              ThrowsMessage<InvalidInput>(AllOf(HasSubstr("v01.EV5: channel 1 LEFT REAR SEAT CROSSMEMBER X: "),
                                                HasSubstr(p.problem), HasSubstr("choose others with --channel"))));
}

INSTANTIATE_TEST_SUITE_P(
    Cases, BadNhtsaChannel,
    testing::Values(
        BadChannel{"failed", {.data_status = "CF"}, kFiveSamples, "the channel failed (DASTAT CF)", true},
        BadChannel{"questionable", {.data_status = "QD"}, kFiveSamples, "the data are questionable (DASTAT QD)", true},
        BadChannel{"not_recorded", {.data_status = "NO"}, nullptr, "no data were recorded (DASTAT NO)", false},
        BadChannel{"over_a_length", {.x_unit = "MM"}, kFiveSamples, "its x is in MM, not a time", true},
        BadChannel{"absent", {}, nullptr, "its file v01.001 is not beside the header", false},
        BadChannel{"truncated", {.last = "7"}, kFiveSamples, "truncated: 5 of the 10 samples", true},
        BadChannel{"empty", {}, "", "v01.001: the file is empty", false},
        BadChannel{"html", {}, "<html>404</html>", "v01.001:1: '<html>404</html>' is not a sample", false},
        BadChannel{"text_inside", {}, "0\t1\n1e-4\tbad\n", "v01.001:2: 'bad' is not a sample", false},
        BadChannel{"three_numbers", {}, "0\t1\t2\n", "v01.001:1: '2' is not a sample", false},
        BadChannel{"row_cut_short", {}, "0\t1\n1e-4\n", "v01.001:2: '' is not a sample", false}));

TEST(Nhtsa, TimesThatContradictTheHeaderAreKeptWithAWarning) {
  const test::TempDir dir;
  dir.file("v01.001", "0\t1\n0.001\t1\n0.002\t1\n0.003\t1\n0.004\t1\n");
  const TraceSet set = read_traces(dir.file("v01.EV5", header_text({{}})));
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("times in the file differ from those of its header")));
  EXPECT_EQ(set.traces[0].time_s->back(), 0.004);
}

TEST(Nhtsa, CompartmentChannelsAreTheBestPlaceThatHasGoodOnes) {
  const test::TempDir dir;
  std::vector<NhtsaRecord> records = {
      {.curve = 1, .attachment = "HDCG", .comment = "DRIVER HEAD X", .occupant = "01", .axis = "XL"},
      {.curve = 2, .attachment = "ENGN", .comment = "TOP OF ENGINE X"},
      {.curve = 3, .attachment = "VECG", .comment = "VEHICLE CG X"},
      {.curve = 4, .attachment = "FLRR", .comment = "RIGHT REAR", .channel_status = "R"},
      {.curve = 5, .attachment = "FLRR", .comment = "RIGHT REAR", .data_status = "CF"},
      {.curve = 6, .attachment = "OTHR", .comment = "Left rear seat crossmember X"},
      {.curve = 7, .attachment = "FLLR", .comment = "LEFT REAR Z", .axis = "ZG"},
      {.curve = 8, .attachment = "DPLC", .comment = "DASH PANEL CENTER X"},
      {.curve = 9, .attachment = "BRCL", .comment = "LEFT FRONT BRAKE CALIPER X"}};
  for (const auto& r : records) dir.file(fmt::format("v01.{:03}", r.curve), kFiveSamples);
  const auto compartment = [&] { return read_traces(dir.file("v01.EV5", header_text(records))).compartment_x; };
  EXPECT_THAT(compartment(), ElementsAre("6"));
  records.erase(records.begin() + 5);
  EXPECT_THAT(compartment(), ElementsAre("4")) << "redundant, but in the best place";
  records.erase(records.begin() + 3);
  EXPECT_THAT(compartment(), ElementsAre("3"));
  records.erase(records.begin() + 2);
  EXPECT_THAT(compartment(), IsEmpty());
}

TEST(Nhtsa, AHeaderAloneNamesTheCompartmentChannels) {
  const test::TempDir dir;
  const std::string header = dir.file("v01.EV5", header_text({{}, {.curve = 2, .attachment = "FLRR"}}));
  const TraceSet set = read_traces(header);
  EXPECT_EQ(set.mass_kg, 1500);
  EXPECT_THAT(set.compartment_x, ElementsAre("1", "2"));
  EXPECT_THAT([&] { read_pulse(header); },
              ThrowsMessage<InvalidInput>(HasSubstr("its file v01.001 is not beside the header")));
}

TEST(Nhtsa, OneOfTwoCompartmentChannelsIsUsedWithAWarning) {
  const test::TempDir dir;
  dir.file("v01.002", kFiveSamples);
  const TraceSet set = read_traces(dir.file("v01.EV5", header_text({{}, {.curve = 2, .attachment = "FLRR"}})));
  EXPECT_THAT(set.compartment_x, ElementsAre("2"));
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("compartment channel 1 has no file here")));
}

TEST(Nhtsa, SpeedComesFromTheChannelOrTheClosingSpeedWhenTheVehicleHasNone) {
  const test::TempDir dir;
  dir.file("v01.001", kFiveSamples);
  const auto speed_kmh = [&](const std::string& vehicle_speed, const std::string& channel_speed) {
    return 3.6 * read_traces(dir.file("v01.EV5", header_text({{.initial_speed = channel_speed}},
                                                             test::vehicle_line(1, "1500", vehicle_speed))))
                     .impact_speed_mps;
  };
  EXPECT_DOUBLE_EQ(speed_kmh("57.6", "50"), 57.6);
  EXPECT_DOUBLE_EQ(speed_kmh("0", "50"), 50);
  EXPECT_DOUBLE_EQ(speed_kmh("", "0.0"), 60);
}

TEST(Nhtsa, WhatIsNotAFullFrontalRigidWallTestIsSaid) {
  const test::TempDir dir;
  const TraceSet set = read_traces(dir.file("v01.EV5", header_text({{}}, test::vehicle_line(1) + test::vehicle_line(2),
                                                                   "D|MDB|0|0|MOVING BARRIER", "30|500")));
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("2 vehicles: mass and speed are those of vehicle 1"),
                                        HasSubstr("the barrier is deformable"), HasSubstr("impact angle 30 degrees"),
                                        HasSubstr("offset 500 mm")));
}

TEST(Nhtsa, OddRecordsAreToleratedOrRefusedByLine) {
  const test::TempDir dir;
  EXPECT_EQ(read_traces(dir.file("v01.EV5", header_text({{.comment = "LEFT|REAR"}}))).traces[0].name, "LEFT|REAR");
  EXPECT_THAT(read_traces(dir.file("v01.EV5", header_text({{}}, "1|TOY|CAR\n"))).mass_kg, IsNan());
  const auto refuses = [&](const NhtsaRecord& record, const char* message) {
    EXPECT_THAT([&] { read_traces(dir.file("v01.EV5", header_text({record}))); },
                ThrowsMessage<InvalidInput>(AllOf(HasSubstr("v01.EV5:10: "), HasSubstr(message))));
  };
  refuses({.step = "0"}, "DELT = '0': must be > 0");
  refuses({.step = "fast"}, "DELT = 'fast' is not a number");
  refuses({.first = "1.5"}, "NFP = '1.5': must be a whole number");
  refuses({.last = ""}, "NLP = '': must be a whole number");
  refuses({.last = "1e300"}, "NLP = '1e300': must be a whole number");
}

TEST(Nhtsa, ATruncatedHeaderIsRefused) {
  const test::TempDir dir;
  const std::string text = header_text({{}});
  EXPECT_THAT([&] { read_traces(dir.file("v01.EV5", text.substr(0, text.find("----- INSTR")))); },
              ThrowsMessage<InvalidInput>(HasSubstr("v01.EV5: no INSTRUMENTATION records: the header is truncated")));
  EXPECT_THAT([&] { read_traces(dir.file("v01.EV5", text.substr(0, text.find("|ACME")))); },
              ThrowsMessage<InvalidInput>(HasSubstr("no INSTRUMENTATION records")));
  EXPECT_THAT([&] { read_traces(dir.file("v01.EV5", text.substr(0, text.find("|ACME")) + "\n----- END -----\n")); },
              ThrowsMessage<InvalidInput>(HasSubstr("9 fields in an INSTRUMENTATION record: 20 are expected")));
}

TEST(Nhtsa, AChannelFileWithoutHeaderNeedsItsColumnsNamed) {
  const test::TempDir dir;
  const std::string path = dir.file("v01.001", kFiveSamples);
  EXPECT_THAT([&] { read_traces(path); }, ThrowsMessage<InvalidInput>(HasSubstr("no header: name the 2 columns")));
  EXPECT_EQ(read_traces(path, {.channels = {}, .columns = "time:s,accel:g", .units = ""}).traces.size(), 1u);
}

TEST(Nhtsa, TheCamryTestIsUnderstoodFromItsHeader) {
  const auto path = test::shared_data("nhtsa-10146/v10146.EV5");
  if (!path) GTEST_SKIP() << test::kNoSharedData;
  const TraceFileInfo info = inspect_traces(path->string());
  EXPECT_EQ(info.channels.size(), 634u);
  EXPECT_EQ(info.set.title, "NCAP - 2018 TOYOTA CAMRY LE 4-DOOR SEDAN");
  EXPECT_EQ(info.set.mass_kg, 1719);
  EXPECT_DOUBLE_EQ(info.set.impact_speed_mps, 57.09 / 3.6);
  EXPECT_THAT(info.set.compartment_x, ElementsAre("93", "94"));
  EXPECT_EQ(info.set.input_files.size(), 9u);
  const auto& bad = info.channels.at(95);
  EXPECT_EQ(bad.id, "96");
  EXPECT_EQ(bad.samples, 1170u);
  EXPECT_THAT(bad.status, HasSubstr("DASTAT CF"));
  EXPECT_EQ(info.channels.at(108).unit, "N m") << "a moment, though its axis says X";
}

}  // namespace
}  // namespace crashsim
