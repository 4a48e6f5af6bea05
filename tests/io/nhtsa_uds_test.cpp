#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/error.hpp>
#include <crashsim/pulse.hpp>
#include <crashsim/trace_io.hpp>

#include "support/random.hpp"
#include "support/temp_dir.hpp"
#include "support/uds_writer.hpp"

namespace crashsim {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;
using testing::ThrowsMessage;

constexpr double kG = 9.80665;

std::vector<float> random_values(test::Random& random, std::size_t count) {
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(static_cast<float>(random.between(-60.0, 60.0)));
  return values;
}

class UdsFile : public testing::Test {
 protected:
  test::TempDir dir;
};
class Uds : public UdsFile, public testing::WithParamInterface<const char*> {};

TEST_P(Uds, WhatIsWrittenComesBackExactly) {
  test::Random random(1);
  for (const std::size_t count : {1U, 124U, 125U, 126U, 1000U}) {
    const std::vector<float> values = random_values(random, count);
    const std::string path = dir.file("v07201_001aa0.uds", test::UdsWriter(GetParam())
                                                               .header()
                                                               .curve(93, -20, static_cast<int>(count) - 21)
                                                               .data("Y DATA", values)
                                                               .file());
    const TraceSet set = read_traces(path);
    const Trace& trace = set.traces.at(0);
    EXPECT_EQ(set.format, "nhtsa_uds");
    EXPECT_EQ(set.title, "SMALL CAR");
    EXPECT_FLOAT_EQ(static_cast<float>(set.mass_kg), 1500.0F);
    EXPECT_NEAR(set.impact_speed_mps, 16.0, 1e-6);
    EXPECT_THAT(set.compartment_x, ElementsAre("93"));
    EXPECT_EQ(trace.id, "93");
    EXPECT_EQ(trace.name, "LEFT REAR SEAT X");
    EXPECT_EQ(trace.location, "FLOORPAN - LEFT REAR");
    EXPECT_EQ(trace.axis, 'X');
    EXPECT_EQ(trace.problem, "");
    ASSERT_EQ(trace.values.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(trace.values[i], static_cast<double>(values[i]) * kG);
      EXPECT_EQ(trace.times()[i], static_cast<double>(0.0001F) * (static_cast<double>(i) - 20.0));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, Uds, testing::Values("IEEE", "SUN", "VAX"));

TEST_F(UdsFile, HeaderFieldsArePartOfTheMetadata) {
  const TraceSet set = read_traces(dir.file("a.uds", test::UdsWriter("IEEE")
                                                         .header()
                                                         .text("CMP-2 HDR", 12)
                                                         .component(2)
                                                         .end()
                                                         .curve(7, 0, 0)
                                                         .data("Y DATA", {1})
                                                         .file()));
  EXPECT_THAT(set.metadata, Contains(Pair("TEST.TSTNO", "7201")));
  EXPECT_THAT(set.metadata, Contains(Pair("COMPONENT[1].MODEL", "CAMRY")));
  EXPECT_THAT(set.metadata, Contains(Pair("COMPONENT[2].VEHTWT", "1500")));
  EXPECT_THAT(set.metadata, Contains(Pair("INJURY.HIC", "120")));
  EXPECT_THAT(set.metadata, Contains(Pair("INSTRUMENTATION[7].PREF", "1650")));
}

TEST_F(UdsFile, PairsHaveTheirOwnTimes) {
  const auto read = [&](const std::vector<float>& x) {
    return read_traces(dir.file(
        "a.uds",
        test::UdsWriter("IEEE").header().curve(7, 1, 3, "X-Y").data("Y DATA", {1, 2, 3}).data("X DATA", x).file()));
  };
  EXPECT_THAT(*read({0.0F, 0.5F, 1.5F}).traces[0].time_s, ElementsAre(0.0, 0.5, 1.5));
  EXPECT_THAT(read({0.0F, 0.5F, 0.5F}).traces[0].problem, HasSubstr("time does not increase after sample 2"));
}

TEST_F(UdsFile, ChannelsFollowOneAnother) {
  const std::string file = test::UdsWriter("SUN")
                               .header(2)
                               .curve(7, 0, 1)
                               .data("Y DATA", {1, 2})
                               .curve(8, 0, 1, "Y", "NEWTON-METERS")
                               .data("Y DATA", {3, 4})
                               .file();
  const TraceSet set = read_traces(dir.file("a.uds", file), {.channels = {"8"}, .columns = "", .units = ""});
  EXPECT_FALSE(set.traces.at(0).has_samples);
  EXPECT_THAT(set.traces.at(1).values, ElementsAre(3, 4));
  EXPECT_EQ(set.traces[1].dimension, Dimension::moment);
  EXPECT_THAT(set.warnings, testing::IsEmpty());
}

TEST_F(UdsFile, OfSeveralLongitudinalChannelsNoneIsTakenForTheCompartments) {
  const std::string path = dir.file("a.uds", test::UdsWriter("IEEE")
                                                 .header(2)
                                                 .curve(7, 0, 1)
                                                 .data("Y DATA", {1, 2})
                                                 .curve(8, 0, 1)
                                                 .data("Y DATA", {3, 4})
                                                 .file());
  EXPECT_THAT(read_traces(path).compartment_x, testing::IsEmpty());
  EXPECT_THAT([&] { read_pulse(path); },
              ThrowsMessage<InvalidInput>(HasSubstr("say which channels measure the vehicle's longitudinal motion")));
}

TEST_F(UdsFile, WhatCannotBeTakenAsTimeHistorySaysWhy) {
  const auto problem = [&](test::UdsWriter writer) {
    return read_traces(dir.file("a.uds", writer.file())).traces[0].problem;
  };
  EXPECT_THAT(
      problem(test::UdsWriter("IEEE").header().curve(7, 0, 0, "Y", "G'S", "CHANNEL FAILED").data("Y DATA", {1})),
      HasSubstr("the channel failed (STATUS CHANNEL FAILED)"));
  EXPECT_THAT(problem(test::UdsWriter("IEEE").header().curve(7, 0, 0, "X-Y", "NEWTONS", "", "MILLIMETERS")),
              HasSubstr("its x is in MILLIMETERS, not a time"));
  EXPECT_THAT(problem(test::UdsWriter("IEEE").header().curve(7, 5, 4)), HasSubstr("NFP = 5 is above NLP = 4"));
  EXPECT_THAT(problem(test::UdsWriter("IEEE").header().curve(7, -2000000000, 2000000000).data("Y DATA", {1})),
              HasSubstr("125 of 4000000001 samples are there"));
}

TEST_F(UdsFile, OtherVersionsAndFormatsAreRefused) {
  const auto refuses = [&](test::UdsWriter writer, const char* message) {
    EXPECT_THAT([&] { read_traces(dir.file("a.uds", writer.file())); },
                ThrowsMessage<InvalidInput>(HasSubstr(message)));
  };
  refuses(test::UdsWriter("IEEE").header(1, "UDS-1991"), "download the EV5 or ASCII version");
  refuses(test::UdsWriter("CRAY").header(), "byte 26: NUMFORM = 'CRAY': must be IEEE, SUN or VAX");
  refuses(test::UdsWriter("IEEE").header(), "no curve header");
  refuses(test::UdsWriter("IEEE").header().text("W DATA", 12).end(), "byte 512: 'W DATA' is no record of a UDS file");
}

TEST_F(UdsFile, AFileCutAnywhereGivesWhatIsBeforeTheCut) {
  test::Random random(5);
  const std::string file = test::UdsWriter("IEEE")
                               .header(2)
                               .curve(7, 0, 299)
                               .data("Y DATA", random_values(random, 300))
                               .curve(8, 0, 299)
                               .data("Y DATA", random_values(random, 300))
                               .file();
  const TraceSet whole = read_traces(dir.file("a.uds", file));
  for (int i = 0; i < 200; ++i) {
    const auto cut = static_cast<std::size_t>(random.whole(0, static_cast<int>(file.size()) - 1));
    TraceSet part;
    try {
      part = read_traces(dir.file("a.uds", file.substr(0, cut)));
    } catch (const InvalidInput&) {
      continue;
    }
    std::size_t samples = 0;
    for (std::size_t k = 0; k < part.traces.size(); ++k) {
      const auto& values = part.traces[k].values;
      ASSERT_TRUE(std::equal(values.begin(), values.end(), whole.traces[k].values.begin())) << cut;
      samples += values.size();
    }
    EXPECT_EQ(samples == 600, part.warnings.empty()) << cut;
  }
}

}  // namespace
}  // namespace crashsim
