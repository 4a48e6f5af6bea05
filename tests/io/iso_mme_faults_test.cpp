#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/error.hpp>
#include <crashsim/files.hpp>
#include <crashsim/pulse.hpp>
#include <crashsim/trace_io.hpp>

#include "support/iso_mme_files.hpp"
#include "support/random.hpp"
#include "support/shared_data.hpp"

namespace crashsim {
namespace {

using test::channel_text;
using test::mme_text;
using test::MmeChannel;
using test::read_one;
using test::test_lines;
using test::write_mme;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsNan;
using testing::Not;
using testing::ThrowsMessage;

constexpr const char* kSample = "iso-mme/Channel/test.001";

struct BadChannel {
  const char* what;
  MmeChannel channel;
  const char* problem;
  std::size_t samples;
};
void PrintTo(const BadChannel& b, std::ostream* out) { *out << b.what; }
class BadIsoMmeChannel : public testing::TestWithParam<BadChannel> {};

TEST_P(BadIsoMmeChannel, IsKnownAsSuchAndRefusedForAPulse) {
  const auto& p = GetParam();
  const test::TempDir dir;
  write_mme(dir, {p.channel});
  const TraceSet set = read_traces(dir.path("test.mme"));
  EXPECT_THAT(set.traces[0].problem, HasSubstr(p.problem));
  EXPECT_EQ(set.traces[0].values.size(), p.samples);
  PulseOptions options;
  options.channels = {"*ACXP"};
  EXPECT_THAT(
      [&] { read_pulse(dir.path("test.mme"), options); },
      ThrowsMessage<InvalidInput>(AllOf(HasSubstr("test.mme: channel 10VEHCCG0000ACXP"), HasSubstr(p.problem))));
}

INSTANTIATE_TEST_SUITE_P(
    Cases, BadIsoMmeChannel,
    testing::Values(
        BadChannel{"failed", {.status = "channel failed"}, "its source says: channel failed (Data status)", 5},
        BadChannel{"questionable", {.status = "questionable data"}, "its source says: questionable data", 5},
        BadChannel{"truncated", {.count = "9"}, "test.001: truncated: 5 of the 9 samples that its header declares", 5},
        BadChannel{"empty", {.samples = ""}, "test.001: truncated: no samples follow its header", 0},
        BadChannel{"text", {.samples = "1\n2\nabc\n4\n5\n"}, "test.001:16: 'abc' is not a sample", 0},
        BadChannel{"two a line", {.samples = "1 2\n3 4\n"}, "truncated: no samples", 0},
        BadChannel{"decimal comma", {.samples = "1\n2,5\n3\n4\n5\n"}, "test.001:15: '2,5' is not a sample", 0},
        BadChannel{
            "no interval", {.interval = ""}, "its header says neither a sampling interval nor a time channel", 0},
        BadChannel{"interval 0", {.interval = "0"}, "Sampling interval = 0 s: must be > 0", 0},
        BadChannel{"interval text", {.interval = "fast"}, "Sampling interval = 'fast': is not a finite number", 0},
        BadChannel{"interval unit", {.interval = "0.1 mm"}, "'mm' measures length, not time", 0},
        BadChannel{"interval tiny", {.first = "1", .interval = "1e-30"}, "too small to tell samples apart", 0},
        BadChannel{
            "explicit without name", {.reference = "explicit"}, "its time channel has no name and is not there", 0},
        BadChannel{"its own time",
                   {.reference = "explicit", .reference_name = "10VEHCCG0000ACXP"},
                   "its unit 'm/(s*s)' is none of time",
                   0}));

TEST(IsoMmeFaults, MoreSamplesThanDeclaredAndNoDeclarationAreSaid) {
  const TraceSet more = read_one({.count = "3"});
  EXPECT_EQ(more.traces[0].values.size(), 5u);
  EXPECT_EQ(more.traces[0].problem, "");
  EXPECT_THAT(more.warnings, ElementsAre(HasSubstr("test.001: 5 samples, but its header declares 3: all are kept")));
  EXPECT_THAT(read_one({.count = ""}).warnings,
              ElementsAre(HasSubstr("its header does not say the number of samples")));
}

TEST(IsoMmeFaults, ALastLineWithoutEndCountsOnlyWhereItMustBeWhole) {
  MmeChannel channel{.count = "31", .samples = ""};
  for (int i = 0; i < 30; ++i) channel.samples += "1.234567E-01\n";
  const std::string before = channel.samples;
  const auto last = [&](const std::string& text) {
    channel.samples = before + text;
    return read_one(channel);
  };
  EXPECT_EQ(last("2.345678E-02").traces[0].values.size(), 31u);
  EXPECT_THAT(last("2.345678E-02").warnings, IsEmpty());
  EXPECT_EQ(last("2.345678E-02\r").traces[0].values.size(), 31u);
  for (const char* cut : {"2.345678E-0", "2.345678E-", "2.345678", "2.34", "2", "-", "NOVALU", "NOVALUE"}) {
    const TraceSet set = last(cut);
    EXPECT_EQ(set.traces[0].values.size(), 30u) << cut;
    EXPECT_EQ(set.traces[0].problem, "") << cut;
    EXPECT_THAT(set.warnings,
                ElementsAre(HasSubstr("the last line has no end: sample 31 may be cut short and is left out")));
  }
  EXPECT_EQ(read_one({.samples = "1\n2\n3\n4\n5"}).traces[0].values.size(), 4u) << "5 may be 50";
}

TEST(IsoMmeFaults, WhatDisagreesIsSaid) {
  EXPECT_THAT(read_one({.unit = "kN"}).warnings,
              ElementsAre(HasSubstr("its unit 'kN' measures force, its code 10VEHCCG0000ACXP says acceleration")));
  EXPECT_THAT(read_one({.direction = "Y"}).warnings,
              ElementsAre(HasSubstr("its header says direction Y, its code 10VEHCCG0000ACXP says X")));
  EXPECT_THAT(read_one({.code = "10VEHCCG0000AC1P"}).warnings,
              ElementsAre(HasSubstr("the sign of 10VEHCCG0000AC1P is not that of SAE J211")));
  EXPECT_THAT(read_one({.code = "10VEHCCG0000ACXD"}).warnings,
              ElementsAre(HasSubstr("already filtered with CFC 60 by their codes: 10VEHCCG0000ACXD")));
  EXPECT_THAT(read_one({.interval = "0.1"}).warnings, ElementsAre(HasSubstr("is it in s?")));
  EXPECT_THAT(read_one({.first = ""}).warnings, ElementsAre(HasSubstr("the time of the first sample: taken as 0")));
}

TEST(IsoMmeFaults, ANumberThatTheEndOfTheTestFileCutsIsNotTaken) {
  const test::TempDir dir;
  write_mme(dir, {{}});
  const std::string text = mme_text(test_lines());
  const std::string cut = text.substr(0, text.find(":1500 kg") + 3);  // ":15"
  const TraceSet set = read_traces(dir.file("test.mme", cut));
  EXPECT_THAT(set.mass_kg, IsNan());
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("Mass test object 1 = '15' is not taken: the file ends within it")));
}

TEST(IsoMmeFaults, FoldersWithSeveralTestsAndTestsWithoutChannelsAreRefused) {
  const test::TempDir dir;
  dir.file("a.mme", mme_text(test_lines()));
  EXPECT_THAT([&] { read_traces(dir.path("a.mme")); },
              ThrowsMessage<InvalidInput>(HasSubstr("a.mme: no channel files")));
  dir.file("b.mme", mme_text(test_lines()));
  EXPECT_THAT([&] { read_traces(dir.path("")); },
              ThrowsMessage<InvalidInput>(AllOf(HasSubstr("holds several tests: name one of"), HasSubstr("b.mme"))));
}

TEST(IsoMmeFaults, OtherFormatsAndArchivesAreNotTaken) {
  const test::TempDir dir;
  EXPECT_EQ(read_traces(dir.file("t.csv", "time_s,accel_g\n0,1\n1,2\n")).format, "csv");
  EXPECT_THAT(
      [&] { read_traces(dir.file("t.zip", "PK\x03\x04 test/Channel/test.001")); },
      ThrowsMessage<InvalidInput>(HasSubstr("a zip archive of an ISO-MME test: unpack it and name its folder")));
  EXPECT_THAT([&] { read_traces(dir.file("t.7z", "7z\xbc\xaf\x27\x1c")); },
              ThrowsMessage<InvalidInput>(HasSubstr("a 7z archive: unpack it")));
  EXPECT_THAT([&] { read_traces(dir.file("t.mme", "\xff\xfeT")); },
              ThrowsMessage<InvalidInput>(HasSubstr("UTF-16 text")));
  EXPECT_THAT([&] { read_traces(dir.path("")); }, ThrowsMessage<InvalidInput>(HasSubstr("UTF-16 text")));
}

/// The traces of a truncated file are whole, or the file is refused; what is lost is said.
void expect_a_whole_part(const std::string& path, const Trace& whole, const std::string& what) {
  try {
    const TraceSet set = read_traces(path);
    ASSERT_EQ(set.traces.size(), 1u) << what;
    const Trace& part = set.traces[0];
    ASSERT_LE(part.values.size(), whole.values.size()) << what;
    EXPECT_TRUE(std::equal(part.values.begin(), part.values.end(), whole.values.begin(), [](double a, double b) {
      return a == b || (std::isnan(a) && std::isnan(b));
    })) << what;
    if (part.values.size() < whole.values.size()) {
      EXPECT_THAT(set.warnings, Not(IsEmpty())) << what;
    }
    const auto times = part.times();
    EXPECT_TRUE(std::equal(times.begin(), times.end(), whole.time_s->begin())) << what;
  } catch (const InvalidInput&) {
  }
}

void truncate_at_random(const std::string& text, std::uint64_t seed) {
  const test::TempDir dir;
  const Trace whole = read_traces(dir.file("t.001", text)).traces.at(0);
  test::Random random(seed);
  for (int i = 0; i < 200; ++i) {
    const auto size = static_cast<std::size_t>(random.whole(0, static_cast<int>(text.size())));
    expect_a_whole_part(dir.file("t.001", text.substr(0, size)), whole, std::to_string(size));
  }
  for (std::size_t cut = 0; cut < 40; ++cut)
    expect_a_whole_part(dir.file("t.001", text.substr(0, text.size() - cut)), whole, std::to_string(cut));
}

TEST(IsoMmeFaults, TruncatedFilesGiveWhatIsWhole) {
  test::Random random(1);
  for (const char* format : {"{:.6E}", "{:.3f}", "{}"}) {
    MmeChannel channel{.count = "500", .samples = ""};
    for (int i = 0; i < 500; ++i)
      channel.samples +=
          random.whole(0, 9) == 0 ? "NOVALUE\n" : fmt::format(fmt::runtime(format), random.between(-9, 9)) + "\n";
    truncate_at_random(channel_text(channel), 2);
  }
}

TEST(IsoMmeFaults, SpoiltFilesAreReadOrRefused) {
  test::Random random(7);
  const test::TempDir dir;
  const std::string whole = channel_text({});
  for (int i = 0; i < 500; ++i) {
    std::string text = whole;
    for (int spoilt = random.whole(1, 8); spoilt > 0; --spoilt)
      text[static_cast<std::size_t>(random.whole(0, static_cast<int>(text.size()) - 1))] =
          static_cast<char>(random.whole(-128, 127));
    const std::string path = dir.file("t.001", text);
    try {
      const TraceSet set = read_traces(path);
      for (const Trace& trace : set.traces) EXPECT_EQ(trace.values.size(), trace.times().size());
    } catch (const InvalidInput& error) {
      EXPECT_THAT(error.what(), HasSubstr("t.001"));
    }
  }
}

TEST(IsoMmeFaults, TheRealChannelTruncatedGivesWhatIsWhole) {
  const auto path = test::shared_data(kSample);
  if (!path) GTEST_SKIP() << test::kNoSharedData;
  truncate_at_random(read_file(path->string()), 4);
}

}  // namespace
}  // namespace crashsim
