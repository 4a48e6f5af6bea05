#include <algorithm>
#include <functional>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <crashsim/files.hpp>
#include <crashsim/trace_io.hpp>

#include "support/binout_files.hpp"
#include "support/shared_data.hpp"
#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

using test::LsdaWriter;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

const ReadOptions kSi = {.channels = {}, .columns = "", .units = "kg-m-s"};

TraceSet read_bytes(const std::string& bytes, const std::string& name = "binout0000") {
  const test::TempDir dir;
  return read_traces(dir.file(name, bytes), kSi);
}

/// The message with which bytes are refused.
std::string refusal(const std::string& bytes, const std::string& name = "binout0000") {
  try {
    read_bytes(bytes, name);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "not refused";
}

/// Three states of a database of two nodes, and what to do with each before it is saved.
LsdaWriter three_states(const std::function<void(LsdaWriter&, int)>& add = [](LsdaWriter&, int) {}) {
  LsdaWriter writer;
  writer.cd("/nodout/metadata");
  writer.write("ids", std::vector<int>{1, 2});
  for (int state = 1; state <= 3; ++state) {
    writer.cd(fmt::format("/nodout/d{:06}", state));
    writer.write("time", 0.5 * state);
    writer.write("x_velocity", std::vector<double>{1.0 * state, 2.0 * state});
    add(writer, state);
    writer.save();
  }
  return writer;
}

TEST(LsdynaBinoutFault, AHeaderThatIsNoneIsSaid) {
  const std::string good = three_states().bytes();
  const auto with = [&](std::size_t at, char value) {
    std::string bytes = good;
    bytes[at] = value;
    return refusal(bytes);
  };
  EXPECT_THAT(with(1, 3),
              HasSubstr("binout0000: not an LSDA file (binout): header: length fields of 3 bytes: must be"));
  EXPECT_THAT(with(2, 0), HasSubstr("header: offset fields of 0 bytes"));
  EXPECT_THAT(with(3, 16), HasSubstr("header: command fields of 16 bytes"));
  EXPECT_THAT(with(4, -1), HasSubstr("header: type fields of 255 bytes"));
  EXPECT_THAT(with(5, 2), HasSubstr("order of bytes 2: must be 0 (big-endian) or 1"));
  EXPECT_THAT(with(6, 1), HasSubstr("format of floating-point numbers 1: must be 0 (IEEE)"));
  EXPECT_THAT(with(16, 4), HasSubstr("byte 8: the first record does not lead to a symbol table"));
  EXPECT_THAT(refusal(good.substr(0, 5)), HasSubstr("has 5 bytes, fewer than the header's 8"));
  EXPECT_THAT(refusal(good.substr(0, 20)), HasSubstr("ends at byte 20, in its first record"));
}

TEST(LsdynaBinoutFault, TheNameAloneMakesNoBinout) {
  std::string bytes = three_states().bytes();
  bytes[1] = 3;
  EXPECT_THAT(refusal(bytes, "results"), HasSubstr("results: not a trace file: binary data"));
  EXPECT_THAT(refusal("", "binout0000"), HasSubstr("the file is empty"));
  EXPECT_EQ(read_bytes("time_s,accel_g\n0,1\n1,2\n", "binout0000").format, "csv");
}

/// What follows a wrong record is lost, and said.
void expect_two_states(const std::string& bytes, const std::string& warning) {
  const TraceSet set = read_bytes(bytes);
  ASSERT_EQ(set.traces.size(), 2u);
  EXPECT_THAT(set.traces[1].values, ElementsAre(2, 4));
  EXPECT_THAT(set.traces[1].times(), ElementsAre(0.5, 1));
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr(warning)));
}

TEST(LsdynaBinoutFault, WrongLengthsAndCommandsEndTheFile) {
  const std::string bytes = three_states().bytes();
  const std::size_t third = bytes.find("/nodout/d000003") - 9;
  const auto with = [&](std::size_t at, const std::string& value) {
    return std::string(bytes).replace(at, value.size(), value);
  };
  const std::string begin = fmt::format("byte {}: a record of ", third);
  expect_two_states(with(third, std::string(8, '\xff')), begin + "18446744073709551615 bytes where the file has");
  expect_two_states(with(third, std::string("\0\0\0\0\0\0\0\x80", 8)), begin + "9223372036854775808 bytes where");
  expect_two_states(with(third, std::string(8, '\0')), begin + "0 bytes: the file is cut or its run was killed");
  expect_two_states(with(third + 8, "\x4d"), begin + "command 77, which LSDA has not");
  expect_two_states(with(third + 8, "\x04"), begin + "command 4 outside of a symbol table");
}

/// A record that makes no sense is left out, the rest read.
void expect_fault(const std::function<void(LsdaWriter&, int)>& add, const std::string& warning) {
  const TraceSet set = read_bytes(three_states(add).bytes());
  ASSERT_EQ(set.traces.size(), 2u);
  EXPECT_THAT(set.traces[1].values, ElementsAre(2, 4, 6));
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr(warning)));
}

TEST(LsdynaBinoutFault, VariablesThatAreNoneAreLeftOut) {
  const auto record = [](const std::string& body) {
    return [body](LsdaWriter& writer, int state) {
      if (state > 1) writer.write_record(3, body);
    };
  };
  expect_fault(record(""), "2 records without sense left out; the first: byte ");
  expect_fault(record(std::string("\x0a\0", 2)), "a variable without a name");
  expect_fault(record("\x0a\x05"
                      "abc"),
               "a variable's name longer than its record");
  expect_fault(record("\x0a\x02"
                      "a/12345678"),
               "a variable's name is no text");
  expect_fault(record("\x63\x02"
                      "ab12345678"),
               "variable ab of type 99, which LSDA has not");
  expect_fault(record("\x0a\x02"
                      "ab1234567"),
               "variable ab of 7 bytes, no whole number of values");
}

TEST(LsdynaBinoutFault, VariablesThatComeAndGoHaveTimesOfTheirOwn) {
  const TraceSet set = read_bytes(three_states([](LsdaWriter& writer, int state) {
                                    if (state != 2) writer.write("added", 1.0 * state);
                                  }).bytes());
  ASSERT_EQ(set.traces.size(), 3u);
  EXPECT_THAT(set.traces[2].values, ElementsAre(1, 3));
  EXPECT_THAT(set.traces[2].times(), ElementsAre(0.5, 1.5));
  EXPECT_THAT(
      set.warnings,
      ElementsAre(HasSubstr("nodout: variables that some states lack, with times of their own: added (in 2 of 3)")));
}

TEST(LsdynaBinoutFault, StatesWithAnotherNumberOfValuesAreLeftOutOfTheVariable) {
  const TraceSet set = read_bytes(three_states([](LsdaWriter& writer, int state) {
                                    writer.write("y_velocity", std::vector<double>(state == 2 ? 3 : 2, 1.0 * state));
                                  }).bytes());
  ASSERT_EQ(set.traces.size(), 4u);
  EXPECT_THAT(set.traces[3].values, ElementsAre(1, 3));
  EXPECT_THAT(set.traces[3].times(), ElementsAre(0.5, 1.5));
  EXPECT_THAT(set.warnings,
              ElementsAre(HasSubstr("y_velocity (in 2 of 3)"),
                          HasSubstr("variables with another number of values in some states, which are left out: "
                                    "y_velocity (1)")));
}

TEST(LsdynaBinoutFault, MoreDatabasesThanAnyRunWritesAreRefused) {
  LsdaWriter writer;
  for (int i = 0; i < 50000; ++i) {
    writer.cd(fmt::format("/b{}/d1", i));
    writer.write("x", 1.0);
  }
  writer.save();
  EXPECT_THAT(refusal(writer.bytes()),
              testing::ContainsRegex("binout0000: binout of [0-9]+ bytes: more and smaller variables than any"));
}

TEST(LsdynaBinoutFault, WithoutIdsValuesAreNumberedByPosition) {
  LsdaWriter writer;
  writer.cd("/nodout/d000001");
  writer.write("time", 0.0);
  writer.write("x_velocity", std::vector<double>{1, 2});
  writer.save();
  const TraceSet set = read_bytes(writer.bytes());
  EXPECT_EQ(set.traces[1].id, "nodout/#2/x_velocity");
  EXPECT_THAT(set.warnings,
              ElementsAre(HasSubstr("nodout: no ids for the values of x_velocity: they are numbered by")));
}

TEST(LsdynaBinoutFault, IdsThatChangeInTheStatesEndTheDatabase) {
  LsdaWriter writer;
  for (int state = 1; state <= 3; ++state) {
    writer.cd(fmt::format("/elout/shell/d{:06}", state));
    writer.write("time", 1.0 * state);
    writer.write("ids", std::vector<int>{1, state < 3 ? 2 : 4});
    writer.write("sig_xx", std::vector<double>{1, 2});
    writer.save();
  }
  const TraceSet set = read_bytes(writer.bytes());
  EXPECT_THAT(set.traces[0].times(), ElementsAre(1, 2));
  EXPECT_THAT(set.warnings,
              ElementsAre(HasSubstr("elout/shell: its ids change at state 3 (d000003): the 1 from there")));
}

TEST(LsdynaBinoutFault, StatesWithoutATimeAreLeftOut) {
  const auto database = [](bool time) {
    LsdaWriter writer;
    for (int state = 1; state <= 3; ++state) {
      writer.cd(fmt::format("/ssd/d{:06}", state));
      if (time && state != 2) writer.write("time", 1.0 * state);
      writer.write("amplitude", 2.0 * state);
      writer.save();
    }
    return writer.bytes();
  };
  const TraceSet set = read_bytes(database(true));
  EXPECT_THAT(set.traces[0].values, ElementsAre(2, 6));
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("ssd: 1 state without a time left out")));
  EXPECT_THAT(refusal(database(false)), HasSubstr("binout0000: a binout without time histories"));
}

bool is_prefix(std::span<const double> part, std::span<const double> whole) {
  return part.size() <= whole.size() && std::equal(part.begin(), part.end(), whole.begin());
}

/// At any cut a file is refused, or holds the beginnings of the complete file's channels and says that it is cut.
void expect_safe_when_cut(const std::string& bytes, std::uint64_t seed) {
  const test::TempDir dir;
  const TraceSet whole = read_traces(dir.file("whole", bytes), kSi);
  test::Random random(seed);
  std::size_t used = 0;
  for (int i = 0; i < 200; ++i) {
    const auto cut = static_cast<std::size_t>(random.between(0.0, static_cast<double>(bytes.size())));
    const std::string path = dir.file(fmt::format("cut{}", i), bytes.substr(0, cut));
    SCOPED_TRACE(cut);
    try {
      const TraceSet part = read_traces(path, kSi);
      ++used;
      EXPECT_THAT(part.warnings, testing::Contains(HasSubstr("the file is cut or its run was killed")));
      for (const Trace& trace : part.traces) {
        const auto found =
            std::find_if(whole.traces.begin(), whole.traces.end(), [&](const Trace& t) { return t.id == trace.id; });
        ASSERT_NE(found, whole.traces.end()) << trace.id;
        EXPECT_TRUE(is_prefix(trace.values, found->values)) << trace.id;
        EXPECT_TRUE(is_prefix(trace.times(), found->times())) << trace.id;
      }
    } catch (const InvalidInput&) {
    }
    std::filesystem::remove(path);
  }
  EXPECT_GT(used, 100u);
}

TEST(LsdynaBinoutFault, ACutFileIsReadUpToItsLastWholeState) {
  test::Random random(3);
  expect_safe_when_cut(test::binout_bytes<double>(test::random_binout(random, 30)), 4);
  expect_safe_when_cut(test::binout_bytes<float>(test::random_binout(random, 30), {4, 4, 1, 1, true}), 5);
}

TEST(LsdynaBinoutFault, ACutRealFileIsReadUpToItsLastWholeState) {
  for (const char* sample : {"lsdyna-binout/binout_glstat", "lsdyna-binout/binout_swforc"}) {
    const auto path = test::shared_data(sample);
    if (!path) GTEST_SKIP() << test::kNoSharedData;
    expect_safe_when_cut(read_file(path->string()), 6);
  }
}

TEST(LsdynaBinoutFault, ACutLosesOnlyTheStateThatWasBeingWritten) {
  const std::string bytes = three_states().bytes();
  const std::size_t third = bytes.find("/nodout/d000003");
  for (const std::size_t cut :
       {third - 9, third + 4, third + 15, bytes.find("x_velocity", third), bytes.find("time", third) + 20}) {
    SCOPED_TRACE(cut);
    expect_two_states(bytes.substr(0, cut), "the file is cut or its run was killed");
  }
  EXPECT_THAT(read_bytes(bytes.substr(0, third + 20)).warnings,
              ElementsAre(testing::AllOf(HasSubstr(fmt::format("ends at byte {}, in a record", third + 20)),
                                         HasSubstr("; 5 bytes are lost"))));
  const std::size_t inside = bytes.find("x_velocity", third) + 20;
  EXPECT_THAT(read_bytes(bytes.substr(0, inside)).warnings,
              ElementsAre(HasSubstr("and the states they leave incomplete: nodout/d000003")));
}

TEST(LsdynaBinoutFault, ACutInTheFirstStateLeavesNothing) {
  const LsdaWriter writer = three_states([](LsdaWriter& w, int) { w.write("y_velocity", std::vector<double>{3, 4}); });
  EXPECT_THAT(refusal(writer.bytes().substr(0, writer.bytes().find("y_velocity") + 12)),
              testing::AllOf(HasSubstr("a binout without time histories"),
                             HasSubstr("and the states they leave incomplete: nodout/d000001")));
}

TEST(LsdynaBinoutFault, DamagedBytesAreRefusedOrSaid) {
  test::Random random(8);
  const std::string bytes = test::binout_bytes<double>(test::random_binout(random, 5), {2, 4, 1, 1, false});
  const test::TempDir dir;
  for (int i = 0; i < 300; ++i) {
    std::string damaged = bytes;
    for (int k = random.whole(1, 4); k-- > 0;)
      damaged[static_cast<std::size_t>(random.whole(0, static_cast<int>(bytes.size()) - 1))] =
          static_cast<char>(random.whole(0, 255));
    const std::string path = dir.file("binout", damaged);
    try {
      for (const Trace& trace : read_traces(path, kSi).traces) {
        EXPECT_EQ(trace.values.size(), trace.times().size());
        EXPECT_TRUE(std::is_sorted(trace.times().begin(), trace.times().end()));
      }
    } catch (const InvalidInput&) {
    }
  }
}

}  // namespace
}  // namespace crashsim
