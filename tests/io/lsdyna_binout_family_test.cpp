#include <string>

#include <gmock/gmock.h>

#include <crashsim/trace_io.hpp>

#include "support/binout_files.hpp"
#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

using test::BinoutDatabase;
using test::LsdaWriter;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const ReadOptions kSi = {.channels = {}, .columns = "", .units = "kg-m-s"};

/// A database of the whole model whose energy is `scale` times the time.
BinoutDatabase energy(std::vector<double> times, double scale = 1.0, std::string path = "glstat") {
  BinoutDatabase database{std::move(path), {}, {"kinetic_energy"}, std::move(times), {}};
  for (const double time : database.times) database.values.push_back({{scale * time}});
  return database;
}

/// A part of a run: states numbered from `first_number`, with metadata or as a continuation.
std::string part(const BinoutDatabase& database, std::size_t first_number = 1, bool metadata = true,
                 const std::string& title = "A RUN", const test::LsdaFormat& format = {}) {
  LsdaWriter writer(format);
  if (metadata) write_metadata(writer, database, title);
  for (std::size_t i = 0; i < database.times.size(); ++i) {
    test::write_state<double>(writer, database, i, first_number + i);
    writer.save();
  }
  return writer.bytes();
}

std::vector<double> times_of(const TraceSet& set, std::size_t trace = 0) {
  return {set.traces[trace].times().begin(), set.traces[trace].times().end()};
}

TEST(LsdynaBinoutFamily, AnyPartOfALongFileFindsTheOthers) {
  const test::TempDir dir;
  const std::string parts[] = {dir.file("binout0000", part(energy({0, 1, 2}))),
                               dir.file("binout0000%001", part(energy({3, 4}), 4, false, "", {4, 8, 1, 1, true})),
                               dir.file("binout0000%002", part(energy({5}), 6, false))};
  dir.file("binout0000.txt", "not a part");
  dir.file("other.binout0000%003", part(energy({9})));
  for (const std::string& path : parts) {
    const TraceSet set = read_traces(path, kSi);
    EXPECT_EQ(set.path, path);
    EXPECT_THAT(set.input_files, ElementsAre(parts[0], parts[1], parts[2]));
    EXPECT_THAT(times_of(set), ElementsAre(0, 1, 2, 3, 4, 5));
    EXPECT_THAT(set.traces[0].values, ElementsAre(0, 1, 2, 3, 4, 5));
    EXPECT_THAT(set.warnings, IsEmpty());
  }
}

TEST(LsdynaBinoutFamily, AStateMayContinueInTheNextPart) {
  const test::TempDir dir;
  LsdaWriter first, second;
  first.cd("/glstat/d000001");
  first.write("time", 0.5);
  first.write("kinetic_energy", 1.0);
  first.save();
  second.cd("/glstat/d000001");
  second.write("internal_energy", 2.0);
  second.save();
  const std::string path = dir.file("binout0000", first.bytes());
  dir.file("binout0000%001", second.bytes());
  const TraceSet set = read_traces(path, kSi);
  ASSERT_EQ(set.traces.size(), 2u);
  EXPECT_EQ(set.traces[1].id, "glstat/internal_energy");
  EXPECT_EQ(set.traces[1].time_s, set.traces[0].time_s);
  EXPECT_THAT(set.warnings, IsEmpty());
}

TEST(LsdynaBinoutFamily, ProcessesOfAParallelRunWriteDatabasesOfTheirOwn) {
  const test::TempDir dir;
  const std::string first = dir.file("job.binout0000", part(energy({0, 1})));
  const std::string third = dir.file("job.binout0003", part(energy({0, 1, 2}, 2.0, "sleout")));
  dir.file("job.binout01", part(energy({7})));  // another name's number
  const TraceSet set = read_traces(third, kSi);
  EXPECT_THAT(set.input_files, ElementsAre(first, third));
  ASSERT_EQ(set.traces.size(), 2u);
  EXPECT_EQ(set.traces[0].id, "glstat/kinetic_energy");
  EXPECT_EQ(set.traces[1].id, "sleout/kinetic_energy");
  EXPECT_THAT(times_of(set, 1), ElementsAre(0, 1, 2));
  EXPECT_THAT(set.warnings, IsEmpty());
}

TEST(LsdynaBinoutFamily, ARestartedRunReplacesWhatItComputesAgain) {
  const test::TempDir dir;
  const std::string path = dir.file("binout0000", part(energy({0, 1, 2, 3}, 1.0)));
  for (const char* name : {"binout0000%001", "binout0000_", "binout0001"}) {
    const std::string later = dir.file(name, part(energy({2, 2.5, 3, 3.5}, 10.0)));
    const TraceSet set = read_traces(path, kSi);
    EXPECT_THAT(set.input_files, ElementsAre(path, later));
    EXPECT_THAT(times_of(set), ElementsAre(0, 1, 2, 2.5, 3, 3.5));
    EXPECT_THAT(set.traces[0].values, ElementsAre(0, 1, 20, 25, 30, 35));
    EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("glstat: 2 states from time 2 on written again by a later part")));
    std::filesystem::remove(later);
  }
}

TEST(LsdynaBinoutFamily, ARestartInTheSameFileReplacesItsStates) {
  const test::TempDir dir;
  LsdaWriter writer;
  const BinoutDatabase first = energy({0, 1, 2}), again = energy({1, 2, 3}, 10.0);
  for (std::size_t i = 0; i < 3; ++i) test::write_state<double>(writer, first, i, i + 1);
  for (std::size_t i = 0; i < 3; ++i) test::write_state<double>(writer, again, i, i == 0 ? 3 : i + 2);
  writer.save();
  const TraceSet set = read_traces(dir.file("x", writer.bytes()), kSi);
  EXPECT_THAT(times_of(set), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(set.traces[0].values, ElementsAre(0, 10, 20, 30));
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("glstat: 2 states from time 1 on written again")));
}

TEST(LsdynaBinoutFamily, MissingPartsAreSaid) {
  const test::TempDir dir;
  const std::string last = dir.file("binout0000%003", part(energy({5}), 6, false));
  EXPECT_THAT(read_traces(last, kSi).warnings,
              ElementsAre(HasSubstr("binout0000 is missing, and 2 after it: its part")));
  dir.file("binout0000", part(energy({0, 1})));
  EXPECT_THAT(read_traces(last, kSi).warnings, ElementsAre(HasSubstr("binout0000%001 is missing, and 1 after it")));
  dir.file("binout0000%001", part(energy({2}), 3, false));
  EXPECT_THAT(read_traces(last, kSi).warnings, ElementsAre(HasSubstr("binout0000%002 is missing: its part")));
}

TEST(LsdynaBinoutFamily, WhatDoesNotBelongToTheRunIsSaid) {
  const test::TempDir dir;
  const std::string path = dir.file("binout0000", part(energy({0, 1})));
  dir.file("binout0001", part(energy({0, 1}, 1.0, "sleout"), 1, true, "ANOTHER"));
  dir.file("binout0002", "text");
  const TraceSet set = read_traces(path, kSi);
  EXPECT_EQ(set.traces.size(), 2u);
  EXPECT_EQ(set.title, "A RUN");
  EXPECT_THAT(set.warnings,
              ElementsAre(HasSubstr("binout0002: not an LSDA file; left out, though its name"),
                          HasSubstr("binout0001: sleout has the title 'ANOTHER', the run 'A RUN': is the file of")));
  EXPECT_THAT(set.input_files, ElementsAre(path, dir.path("binout0001")));
}

TEST(LsdynaBinoutFamily, StatesOfOtherEntitiesAreLeftOut) {
  const test::TempDir dir;
  BinoutDatabase nodes{"nodout", {1, 2}, {"x_velocity"}, {0, 1}, {{{1, 2}}, {{3, 4}}}};
  const std::string path = dir.file("binout0000", part(nodes));
  nodes.ids = {1, 3};
  nodes.times = {2, 3};
  dir.file("binout0001", part(nodes, 3));
  const TraceSet set = read_traces(path, kSi);
  EXPECT_THAT(times_of(set), ElementsAre(0, 1));
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("nodout: its ids change at state 3 (d000003): the 2 from there on")));
}

}  // namespace
}  // namespace crashsim
