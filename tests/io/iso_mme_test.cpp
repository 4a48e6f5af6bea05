#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/trace_io.hpp>
#include <crashsim/units.hpp>

#include "support/iso_mme_files.hpp"
#include "support/random.hpp"
#include "support/shared_data.hpp"

namespace crashsim {
namespace {

using test::channel_text;
using test::mme_text;
using test::MmeChannel;
using test::MmeLines;
using test::read_one;
using test::test_lines;
using test::write_mme;
using testing::AllOf;
using testing::Contains;
using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsNan;
using testing::Not;
using testing::Pair;

constexpr const char* kSample = "iso-mme/Channel/test.001";

TEST(IsoMme, TestTellsMassSpeedTitleAndMeaningOfChannels) {
  const test::TempDir dir;
  const std::string path = write_mme(dir, {{}, {.code = "11HEAD0000H3ACXP", .name = "Head", .unit = "g"}});
  const TraceSet set = read_traces(path);
  EXPECT_EQ(set.format, "iso_mme");
  EXPECT_EQ(set.path, path);
  EXPECT_EQ(set.title, "SMALL CAR");
  EXPECT_EQ(set.mass_kg, 1500);
  EXPECT_EQ(set.impact_speed_mps, 15.5);
  EXPECT_THAT(set.compartment_x, ElementsAre("10VEHCCG0000ACXP"));
  EXPECT_THAT(set.input_files, ElementsAre(path, dir.path("Channel/test.chn"), dir.path("Channel/test.001"),
                                           dir.path("Channel/test.002")));
  EXPECT_THAT(set.metadata,
              AllOf(Contains(Pair("MME.Laboratory name", "Lab")), Contains(Pair("CHN.Number of channels", "2")),
                    Contains(Pair("002.Name of the channel", "Head"))));
  EXPECT_THAT(set.warnings, IsEmpty());
  const Trace& trace = set.traces.at(0);
  EXPECT_EQ(trace.id, "10VEHCCG0000ACXP");
  EXPECT_EQ(trace.name, "Centre of gravity X");
  EXPECT_EQ(trace.location, "VEHCCG");
  EXPECT_EQ(trace.axis, 'X');
  EXPECT_EQ(trace.dimension, Dimension::acceleration);
  EXPECT_EQ(trace.source_unit, "m/(s*s)");
  EXPECT_EQ(trace.problem, "");
  EXPECT_THAT(*trace.time_s, ElementsAre(-2e-4, -1e-4, 0.0, 1e-4, 2e-4));
  EXPECT_THAT(trace.values, ElementsAre(0.5, 1.5, -2.5, IsNan(), 4));
  EXPECT_EQ(set.traces[1].time_s, trace.time_s) << "one clock";
  EXPECT_THAT(set.traces[1].values[0], DoubleEq(0.5 * kStandardGravity));
}

TEST(IsoMme, AnyFileOrFolderOfATestLeadsToTheOthers) {
  const test::TempDir dir;
  const std::string path = write_mme(dir, {{}, {.code = "11HEAD0000H3ACXP"}});
  for (const std::string& name : {path, dir.path("Channel/test.chn"), dir.path(""), dir.path("Channel")}) {
    const TraceSet set = read_traces(name);
    EXPECT_EQ(set.traces.size(), 2u) << name;
    EXPECT_EQ(set.mass_kg, 1500) << name;
    EXPECT_EQ(set.path, name);
  }
}

TEST(IsoMme, NamesMayBeInAnyCaseAndChannelsBesideTheTest) {
  const test::TempDir upper;
  std::filesystem::create_directories(upper.path("CHANNEL"));
  upper.file("TEST.MME", mme_text(test_lines()));
  upper.file("CHANNEL/Test.001", channel_text({}));
  EXPECT_EQ(read_traces(upper.path("TEST.MME")).traces.size(), 1u);
  EXPECT_EQ(read_traces(upper.path("CHANNEL/Test.001")).mass_kg, 1500);

  const test::TempDir flat;
  flat.file("test.mme", mme_text(test_lines()));
  flat.file("test.001", channel_text({}));
  EXPECT_EQ(read_traces(flat.path("test.mme")).traces.size(), 1u);
  EXPECT_EQ(read_traces(flat.path("test.001")).mass_kg, 1500);
}

TEST(IsoMme, AChannelFileIsReadAloneAndIsTheOneToUse) {
  const test::TempDir dir;
  write_mme(dir, {{}, {.code = "10ENGN0000??ACXP"}});
  const TraceSet set = read_traces(dir.path("Channel/test.002"));
  ASSERT_EQ(set.traces.size(), 1u);
  EXPECT_EQ(set.traces[0].id, "10ENGN0000??ACXP");
  EXPECT_THAT(set.compartment_x, ElementsAre("10ENGN0000??ACXP"));
  EXPECT_THAT(set.input_files, Not(Contains(dir.path("Channel/test.001"))));
}

TEST(IsoMme, OtherPaddingsBlankLinesLineEndsAndByteOrderMarksAreTolerated) {
  const test::TempDir dir;
  const TraceSet set = read_traces(
      dir.file("t.001",
               "\xef\xbb\xbf"
               "CHANNEL CODE:10VEHCCG0000ACXP\r\n\r\nName  of the channel\t: a: b \r\nSampling interval :1e-3\r\n"
               "Unit:g\r\nTime of first sample:0\r\nNumber of samples:2\r\n  1.0\r\n2.0 \r\n"));
  EXPECT_EQ(set.traces.at(0).name, "a: b");
  EXPECT_THAT(*set.traces[0].time_s, ElementsAre(0.0, 1e-3));
  EXPECT_EQ(set.traces[0].values.size(), 2u);
  EXPECT_EQ(set.traces[0].problem, "");
}

TEST(IsoMme, HeadersBecomeUtf8FromLatin1AndWindows1252) {
  EXPECT_EQ(read_one({.name = "T\xfcr links \x80"}).traces[0].name, "Tür links €");
  EXPECT_EQ(read_one({.name = "Tür links"}).traces[0].name, "Tür links");
  const TraceSet set = read_one({.code = "10DOOR000000DSYP", .unit = "\xb5m", .direction = "Y"});
  EXPECT_EQ(set.traces[0].dimension, Dimension::length);
  EXPECT_THAT(set.traces[0].values[0], DoubleEq(0.5e-6));
}

TEST(IsoMme, TimeChannelsAreFollowed) {
  const test::TempDir dir;
  const MmeChannel times = {.code = "11TIRS000000TIRP",
                            .name = "Time",
                            .unit = "ms",
                            .first = "",
                            .interval = "",
                            .direction = "0",
                            .reference = "NOVALUE",
                            .samples = "0\n1\n2.5\n3\n4\n"};
  const MmeChannel channel = {
      .first = "", .interval = "", .reference = "explicit", .reference_name = "11TIRS000000TIRP"};
  const std::string path = write_mme(dir, {times, channel});
  for (const std::string& name : {path, dir.path("Channel/test.002")}) {
    const TraceSet set = read_traces(name);
    EXPECT_THAT(*set.traces.back().time_s, ElementsAre(0, 1e-3, 2.5e-3, 3e-3, 4e-3));
    EXPECT_EQ(set.traces.back().problem, "");
  }
  const TraceSet set = read_traces(path);
  EXPECT_EQ(*set.traces[0].time_s, set.traces[0].values) << "a time channel over itself";
  std::filesystem::remove(dir.path("Channel/test.001"));
  EXPECT_THAT(read_traces(dir.path("Channel/test.002")).traces[0].problem,
              HasSubstr("test.002: its time channel 11TIRS000000TIRP is not there"));
}

struct Unit {
  const char* code;
  const char* unit;
  Dimension dimension;
  double to_si;
};
void PrintTo(const Unit& u, std::ostream* out) { *out << u.code << ' ' << u.unit; }
class IsoMmeUnit : public testing::TestWithParam<Unit> {};

TEST_P(IsoMmeUnit, IsUnderstoodByWhatTheCodeMeasures) {
  const TraceSet set = read_one({.code = GetParam().code, .unit = GetParam().unit, .direction = ""});
  EXPECT_EQ(set.traces[0].dimension, GetParam().dimension);
  EXPECT_THAT(set.traces[0].values[1], DoubleEq(1.5 * GetParam().to_si));
  EXPECT_THAT(set.warnings, IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Cases, IsoMmeUnit,
                         testing::Values(Unit{"10VEHCCG0000ACXP", "m/(s*s)", Dimension::acceleration, 1},
                                         Unit{"10VEHCCG0000ACXP", "m/s2", Dimension::acceleration, 1},
                                         Unit{"10VEHCCG0000ACXP", "g", Dimension::acceleration, kStandardGravity},
                                         Unit{"10VEHCCG0000MAXP", "g", Dimension::mass, 1e-3},
                                         Unit{"24NECKUP00P2MOZP", "Nm", Dimension::moment, 1},
                                         Unit{"10VEHC000000EN00", "Nm", Dimension::energy, 1},
                                         Unit{"B00000000000FOXP", "kN", Dimension::force, 1e3},
                                         Unit{"10VEHCCG0000AVYP", "deg/s", Dimension::angular_rate,
                                              0.017453292519943295},
                                         Unit{"10VEHCCG0000ANYP", "rad", Dimension::angle, 1},
                                         Unit{"10VEHCCG0000AAYP", "rad/(s*s)", Dimension::angular_acceleration, 1},
                                         Unit{"10VEHCCG0000DSXP", "mm", Dimension::length, 1e-3},
                                         Unit{"10VEHCCG0000IMXP", "kg*m/s", Dimension::impulse, 1},
                                         Unit{"10VEHCCG0000VEXP", "km/h", Dimension::speed, 1 / 3.6},
                                         Unit{"10VEHCCG0000TIXP", "ms", Dimension::time, 1e-3},
                                         Unit{"10VEHCCG000000XP", "1", Dimension::none, 1},
                                         Unit{"10VEHCCG0000VOXP", "V", Dimension::unknown, 1}));

TEST(IsoMme, CompartmentChannelsComeFromTheBestPlaceOfTheFirstVehicle) {
  const auto compartment = [](const std::vector<std::string>& codes) {
    const test::TempDir dir;
    std::vector<MmeChannel> channels;
    for (const std::string& code : codes) channels.push_back({.code = code, .direction = ""});
    return read_traces(write_mme(dir, channels)).compartment_x;
  };
  EXPECT_THAT(compartment({"10VEHCCG00??ACXP", "10SEATLERE00ACXP", "10SEATRIRE00ACXP", "10ENGN0000??ACXP"}),
              ElementsAre("10SEATLERE00ACXP", "10SEATRIRE00ACXP"));
  EXPECT_THAT(compartment({"M0MBARCG0000ACXP", "20VEHCCG0000ACXP", "20SILBLEFR00ACXP", "21HEAD0000E2ACXP"}),
              ElementsAre("20VEHCCG0000ACXP"));
  EXPECT_THAT(compartment({"20VEHCCG0000ACXP", "10BPILLELO00ACXP", "10BPILLEUP00ACXP"}),
              ElementsAre("10BPILLELO00ACXP"));
  EXPECT_THAT(compartment({"10VEHCCG0000ACXD", "10VEHCCG0000ACXP", "10VEHCRD0000ACXP"}),
              ElementsAre("10VEHCCG0000ACXP"));
  EXPECT_THAT(compartment({"10VEHCCG0000ACYP", "10VEHCCG0000VEXP", "M0MBARCG0000ACXP"}), IsEmpty());
  EXPECT_THAT(compartment({"S0SLED000000ACXP"}), ElementsAre("S0SLED000000ACXP"));
}

TEST(IsoMme, AbsentChannelsAreDescribedAndTheirReplacementIsSaid) {
  const test::TempDir dir;
  const std::string path = write_mme(dir, {{.code = "10SEATLERE00ACXP"}, {}});
  std::filesystem::remove(dir.path("Channel/test.001"));
  const TraceSet set = read_traces(path);
  EXPECT_EQ(set.traces[0].problem, "its file .001 is not there");
  EXPECT_EQ(set.traces[0].name, "Centre of gravity X");
  EXPECT_FALSE(set.traces[0].has_samples);
  EXPECT_THAT(set.compartment_x, ElementsAre("10VEHCCG0000ACXP"));
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("compartment channel 10SEATLERE00ACXP has no file here")));
}

TEST(IsoMme, CodesThatRepeatAreToldApart) {
  const test::TempDir dir;
  const TraceSet set = read_traces(write_mme(dir, {{}, {}, {}}));
  EXPECT_EQ(set.traces[1].id, "10VEHCCG0000ACXP#2");
  EXPECT_EQ(set.traces[2].id, "10VEHCCG0000ACXP#3");
  EXPECT_EQ(set.compartment_x.size(), 3u);
  EXPECT_EQ(read_traces(write_mme(dir, {{}, {.code = "10VEHCCG0000ACXP#2"}, {}})).traces[2].id, "10VEHCCG0000ACXP#3");
}

struct Said {
  const char* name;
  const char* value;
  double mass_kg, speed_mps;
  const char* warning;
};
void PrintTo(const Said& s, std::ostream* out) { *out << s.name << " = " << s.value; }
class IsoMmeQuantity : public testing::TestWithParam<Said> {};

TEST_P(IsoMmeQuantity, OfTheTestIsReadInSiOrNotAtAll) {
  const test::TempDir dir;
  const TraceSet set =
      read_traces(write_mme(dir, {{}}, {{"Title", "t"}, {"Regulation", "r"}, {GetParam().name, GetParam().value}}));
  constexpr double kRounding = 1e-15;  // relative, of one conversion
  const auto same = [](double a, double b) { return std::isnan(b) ? std::isnan(a) : std::abs(a - b) <= kRounding * b; };
  EXPECT_TRUE(same(set.mass_kg, GetParam().mass_kg)) << set.mass_kg;
  EXPECT_TRUE(same(set.impact_speed_mps, GetParam().speed_mps)) << set.impact_speed_mps;
  if (GetParam().warning[0] == '\0') {
    EXPECT_THAT(set.warnings, IsEmpty());
  } else {
    EXPECT_THAT(set.warnings, ElementsAre(HasSubstr(GetParam().warning)));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Cases, IsoMmeQuantity,
    testing::Values(Said{"Velocity test object 1", "13.92", kUnset, 13.92, ""},
                    Said{"Velocity test object 1", "-50.4 km/h", kUnset, 14, ""},
                    Said{"Velocity test object 1 lon.", "50.4 km/h", kUnset, 14, ""},
                    Said{"Velocity test object 1", "56.3", kUnset, kUnset, "no vehicle is that fast in m/s"},
                    Said{"Velocity test object 1", "0", kUnset, kUnset, ""},
                    Said{"Velocity test object 1", "NOVALUE", kUnset, kUnset, ""},
                    Said{"Velocity test object 1", "fast", kUnset, kUnset, "not a number and unit"},
                    Said{"Velocity test object 2", "13.92", kUnset, kUnset, ""},
                    Said{"Mass test object 1", "965", 965, kUnset, ""},
                    Said{"Mass test object 1", "1500 Kg", 1500, kUnset, ""},
                    Said{"Mass test object 1", "1.5 t", 1500, kUnset, ""},
                    Said{"Mass test object 1", "0 kg", kUnset, kUnset, ""}));

TEST(IsoMme, MassAndSpeedAreThoseOfTheVehicleThatIsMeasured) {
  const test::TempDir dir;
  const MmeLines lines = {{"Title", "Side"},
                          {"Number of test objects", "2"},
                          {"Mass test object 1", "965"},
                          {"Velocity test object 1", "13.92"},
                          {"Mass test object 2", "1400"}};
  const TraceSet set = read_traces(write_mme(dir, {{.code = "20VEHCCG0000ACXP", .object = "2"}}, lines));
  EXPECT_EQ(set.mass_kg, 1400);
  EXPECT_THAT(set.impact_speed_mps, IsNan());
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("mass and speed are those of test object 2")));
}

TEST(IsoMme, OnlyChannelsAskedForHaveSamples) {
  const test::TempDir dir;
  const std::string path = write_mme(dir, {{}, {.code = "10ENGN0000??ACXP", .samples = "bad\n"}});
  const TraceSet set = read_traces(path, {.channels = {"10VEHC*"}, .columns = "", .units = ""});
  EXPECT_TRUE(set.traces[0].has_samples);
  EXPECT_FALSE(set.traces[1].has_samples);
  EXPECT_EQ(set.traces[1].problem, "");
}

TEST(IsoMme, RandomTestsComeBackExactly) {
  test::Random random(3);
  for (int round = 0; round < 20; ++round) {
    const test::TempDir dir;
    std::vector<MmeChannel> channels(static_cast<std::size_t>(random.whole(1, 6)));
    std::vector<std::vector<double>> values(channels.size());
    for (std::size_t c = 0; c < channels.size(); ++c) {
      channels[c].code = fmt::format("10VEHC{:02}0000ACXP", c);
      channels[c].samples.clear();
      const int count = random.whole(1, 300);
      for (int i = 0; i < count; ++i) {
        values[c].push_back(random.between(-1e3, 1e3) * std::pow(10.0, random.whole(-20, 20)));
        channels[c].samples += format_number(values[c].back()) + (random.whole(0, 1) == 0 ? "\n" : "\r\n");
      }
      channels[c].count = std::to_string(count);
    }
    const TraceSet set = read_traces(write_mme(dir, channels));
    ASSERT_EQ(set.traces.size(), channels.size());
    for (std::size_t c = 0; c < channels.size(); ++c) EXPECT_EQ(set.traces[c].values, values[c]);
    EXPECT_THAT(set.warnings, IsEmpty());
  }
}

TEST(IsoMme, RealChannelIsReadWithWhatItsListCallsIt) {
  const auto path = test::shared_data(kSample);
  if (!path) GTEST_SKIP() << test::kNoSharedData;
  const TraceSet set = read_traces(path->string());
  ASSERT_EQ(set.traces.size(), 1u);
  const Trace& trace = set.traces[0];
  EXPECT_EQ(trace.id, "24NECKUP00P2MOZP");
  EXPECT_EQ(trace.name, "Neck Upper Moment Z, IDN P1.5");
  EXPECT_EQ(trace.dimension, Dimension::moment);
  EXPECT_EQ(trace.axis, 'Z');
  ASSERT_EQ(trace.values.size(), 6000u);
  EXPECT_EQ(trace.times()[0], -0.1);
  EXPECT_EQ(trace.times()[1000], 0.0);
  EXPECT_EQ(trace.values.front(), -6.774550E-4);
  EXPECT_EQ(*std::max_element(trace.values.begin(), trace.values.end()), 2.171756E+0) << "as the header says";
  EXPECT_EQ(*std::min_element(trace.values.begin(), trace.values.end()), -1.540194E+0);
  EXPECT_EQ(trace.values[1000 + 1417], 2.171756E+0) << "at the time that the header says";
  EXPECT_THAT(set.warnings,
              ElementsAre(HasSubstr("calls itself 24NECKUP00P2MOZP, the list of channels calls it M0MBARLEMIUPACXP")));
  const TraceSet all = read_traces(path->parent_path().string());
  EXPECT_EQ(all.traces.size(), 79u);
  EXPECT_THAT(all.traces[1].problem, HasSubstr("its file .002 is not there"));
}

}  // namespace
}  // namespace crashsim
