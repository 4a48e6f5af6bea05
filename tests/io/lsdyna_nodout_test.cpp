#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <crashsim/error.hpp>
#include <crashsim/files.hpp>
#include <crashsim/trace_io.hpp>

#include "support/lsdyna_files.hpp"
#include "support/shared_data.hpp"
#include "support/temp_dir.hpp"
#include "support/unit_warnings.hpp"

namespace crashsim {
namespace {

using test::LsdynaRun;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const ReadOptions kSi = {.channels = {}, .columns = "", .units = "kg-m-s"};

TraceSet read(const std::string& text, const ReadOptions& options = kSi) {
  const test::TempDir dir;
  TraceSet set = read_traces(dir.file("nodout", text), options);
  return options.units.empty() ? std::move(set) : test::without_unit_warnings(std::move(set));
}

const Trace& with_id(const TraceSet& set, const std::string& id) {
  return set.traces.at(select_channels(set, id).at(0));
}

/// What a nodout says, by slicing its lines at fixed columns, independent of the reader.
struct Sliced {
  std::vector<double> times;
  std::vector<std::size_t> state_ends;
  std::map<std::string, std::vector<double>> values;
};

Sliced slice(const std::string& text) {
  const std::vector<std::string> kinds[2] = {{"displacement", "velocity", "acceleration", "coordinate"},
                                             {"displacement", "velocity", "acceleration"}};
  Sliced sliced;
  bool rotation = false;
  for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
    const std::string line = text.substr(at, text.find('\n', at) - at);
    const std::size_t time = line.find("( at time");
    if (time != std::string::npos) {
      const double t = std::strtod(line.substr(time + 9, 14).c_str(), nullptr);
      if (sliced.times.empty() || t != sliced.times.back()) sliced.times.push_back(t);
    } else if (line.starts_with(" nodal point")) {
      rotation = line.find("x-rot") != std::string::npos;
    } else if (line.size() > 100 && line.find_first_not_of(" 0123456789") > 9) {
      const std::string node = std::to_string(std::strtol(line.substr(0, 9).c_str(), nullptr, 10));
      std::size_t column = 10;
      for (const std::string& kind : kinds[rotation])
        for (const char axis : {'x', 'y', 'z'}) {
          const std::string id = fmt::format("nodout/{}/{}{}_{}", node, rotation ? "r" : "", axis, kind);
          sliced.values[id].push_back(std::strtod(line.substr(column, 12).c_str(), nullptr));
          column += 12;
        }
      EXPECT_EQ(column, line.size());
      if (rotation) {
        sliced.state_ends.resize(sliced.times.size());
        sliced.state_ends.back() = at + line.size() + 1;
      }
    }
  }
  return sliced;
}

TEST(LsdynaNodout, EveryValueOfARealRunIsThatOfItsColumns) {
  const auto path = test::shared_data("lsdyna-ascii/nodout");
  if (!path) GTEST_SKIP() << test::kNoSharedData;
  const Sliced sliced = slice(read_file(path->string()));
  const TraceSet set = read_traces(path->string(), kSi);
  EXPECT_THAT(set.warnings, IsEmpty());
  EXPECT_EQ(set.title, "Bolted Connection Type b");
  ASSERT_EQ(set.traces.size(), 42u);
  ASSERT_EQ(sliced.values.size(), 42u);
  for (const Trace& trace : set.traces) {
    EXPECT_EQ(trace.values, sliced.values.at(trace.id)) << trace.id;
    EXPECT_EQ(*trace.time_s, sliced.times);
  }
  EXPECT_EQ(set.traces[0].time_s, set.traces[41].time_s) << "one clock";
  const Trace& touching = with_id(set, "nodout/1200000/x_velocity");
  EXPECT_EQ(touching.values.size(), 1001u);
  EXPECT_EQ(touching.values[1], 3.14790E-08);
  EXPECT_EQ(with_id(set, "nodout/1100002/z_displacement").values[1], 4.61685E-14);
  EXPECT_EQ(with_id(set, "nodout/1200000/rz_acceleration").values.front(), 0.0);
  EXPECT_EQ(with_id(set, "nodout/1200000/rz_acceleration").values.back(), 3.15672E-01);
}

TEST(LsdynaNodout, ARealRunCutAnywhereKeepsItsWholeStates) {
  const auto path = test::shared_data("lsdyna-ascii/nodout");
  if (!path) GTEST_SKIP() << test::kNoSharedData;
  const std::string text = read_file(path->string());
  const Sliced sliced = slice(text);
  constexpr int kCuts = 200;
  test::Random random(1);
  for (int i = 0; i < kCuts; ++i) {
    const auto cut =
        static_cast<std::size_t>(random.whole(static_cast<int>(sliced.state_ends[0]), static_cast<int>(text.size())));
    const auto whole = static_cast<std::size_t>(
        std::upper_bound(sliced.state_ends.begin(), sliced.state_ends.end(), cut) - sliced.state_ends.begin());
    const TraceSet set = read(text.substr(0, cut));
    for (const Trace& trace : set.traces) {
      ASSERT_EQ(trace.values.size(), whole) << "cut at byte " << cut;
      EXPECT_TRUE(std::equal(trace.values.begin(), trace.values.end(), sliced.values.at(trace.id).begin()));
    }
    const std::string lost = text.substr(sliced.state_ends[whole - 1], cut - sliced.state_ends[whole - 1]);
    EXPECT_EQ(lost.find_first_not_of(" \n") != std::string::npos || whole == 1, !set.warnings.empty())
        << "cut at byte " << cut;
  }
}

/// A state of the generated run, as text.
std::string state_of(const LsdynaRun& run, std::size_t state) {
  const std::size_t from = state == 0 ? run.states_at : run.state_ends[state - 1];
  return run.text.substr(from, run.state_ends[state] - from);
}

TEST(LsdynaNodout, NodesMayComeInAnotherOrder) {
  LsdynaRun run = test::nodout_run({});
  std::string state = state_of(run, 4);
  const std::size_t first = state.find("\n       17 ") + 1, second = state.find('\n', first) + 1;
  const std::size_t third = state.find('\n', second) + 1;
  state = state.substr(0, first) + state.substr(second, third - second) + state.substr(first, second - first) +
          state.substr(third);
  run.text.replace(run.state_ends[3], state.size(), state);
  const TraceSet set = read(run.text);
  EXPECT_THAT(set.warnings, IsEmpty());
  for (const auto& [id, values] : run.values) EXPECT_EQ(with_id(set, id).values, values) << id;
}

/// The run with the field of the first node's y velocity in state 4 replaced.
TraceSet with_field(const std::string& field) {
  LsdynaRun run = test::nodout_run({});
  const std::size_t row = run.text.find("\n       17 ", run.state_ends[3]) + 1;
  run.text.replace(row + 10 + 4 * 12, 12, field);
  return read(run.text);
}

TEST(LsdynaNodout, AnOverflowedFieldIsMissing) {
  const TraceSet set = with_field("************");
  const Trace& trace = with_id(set, "nodout/17/y_velocity");
  EXPECT_EQ(trace.values.size(), 12u);
  EXPECT_TRUE(std::isnan(trace.values[4]));
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("one value missing (nan, overflowed or not written), the first of "
                                                  "channel LEFT REAR, at 3_VY at time 0.004")));
}

TEST(LsdynaNodout, AnExponentOfThreeDigitsHasNoRoomForItsLetter) {
  EXPECT_EQ(with_id(with_field("-7.66720-110"), "nodout/17/y_velocity").values[4], -7.66720e-110);
  EXPECT_EQ(with_id(with_field(" 7.66720+110"), "nodout/17/y_velocity").values[4], 7.66720e110);
}

TEST(LsdynaNodout, AStateWithADamagedNumberIsLeftOut) {
  const TraceSet set = with_field(" 1.23x56E+00");
  EXPECT_EQ(with_id(set, "nodout/17/y_velocity").values.size(), 11u);
  EXPECT_THAT(set.warnings, ElementsAre(testing::AllOf(
                                HasSubstr("one state not whole and left out, the first of time 0.004 in bytes "),
                                HasSubstr("the row of node 17 at byte "), HasSubstr(" is damaged"))));
}

TEST(LsdynaNodout, ValuesOfAStateThatIsLeftOutAreNotCountedAsMissing) {
  LsdynaRun run = test::nodout_run({});
  const std::size_t first = run.text.find("\n       17 ", run.state_ends[3]) + 1;
  const std::size_t second = run.text.find('\n', first) + 1;
  run.text.replace(first + 10 + 4 * 12, 12, "************");
  run.text.replace(second + 10 + 4 * 12, 12, " 1.23x56E+00");
  EXPECT_THAT(read(run.text).warnings, ElementsAre(HasSubstr("one state not whole and left out, the first of time")));
}

TEST(LsdynaNodout, AnOverflowedFieldOfAStateInAnotherOrderIsCountedOnce) {
  LsdynaRun run = test::nodout_run({.seed = 1, .states = 12, .first_state = 0, .entities = 3, .line_end = "\n"});
  const std::size_t first = run.text.find("\n       17 ", run.state_ends[3]) + 1;
  const std::size_t second = run.text.find('\n', first) + 1, third = run.text.find('\n', second) + 1;
  const std::size_t end = run.text.find('\n', third) + 1;
  run.text.replace(first + 10 + 4 * 12, 12, "************");
  run.text = run.text.substr(0, second) + run.text.substr(third, end - third) +
             run.text.substr(second, third - second) + run.text.substr(end);
  EXPECT_THAT(read(run.text).warnings, ElementsAre(HasSubstr("one value missing (nan, overflowed or not written)")));
}

TEST(LsdynaNodout, RotationsMayBeAbsent) {
  std::string text = test::nodout_head(1, " 0.0000000E+00") + "\n\n" + test::kTranslations + "\n";
  const std::string row =
      "        7  1.00000E+00 2.00000E+00 3.00000E+00-4.00000E+00-5.00000E+00 6.00000E+00 7.00000E+00"
      " 8.00000E+00 9.00000E+00 1.00000E+01 1.10000E+01 1.20000E+01\n";
  text += row + "\n\n\n" + test::nodout_head(2, " 1.0000000E-03") + "\n\n" + test::kTranslations + "\n" + row;
  const TraceSet set = read(text);
  ASSERT_EQ(set.traces.size(), 12u);
  EXPECT_THAT(with_id(set, "nodout/7/y_velocity").values, ElementsAre(-5.0, -5.0));
  EXPECT_THAT(with_id(set, "nodout/7/z_coordinate").values, ElementsAre(12.0, 12.0));
  EXPECT_THAT(set.warnings, IsEmpty());
}

TEST(LsdynaNodout, ABlockWithoutRowsIsNoPartOfAState) {
  const auto state = [](const char* time) {
    const std::string head = test::nodout_head(1, time) + "\n\n";
    return head + test::kTranslations +
           "\n        7  1.00000E+00 2.00000E+00 3.00000E+00-4.00000E+00-5.00000E+00 6.00000E+00 7.00000E+00"
           " 8.00000E+00 9.00000E+00 1.00000E+01 1.10000E+01 1.20000E+01\n" +
           head + test::kRotations + "\n\n";
  };
  std::string text = state(" 0.0000000E+00") + state(" 1.0000000E-03");
  text.erase(text.rfind(" n o d a l"));
  const TraceSet set = read(text);
  ASSERT_EQ(set.traces.size(), 12u);
  EXPECT_THAT(with_id(set, "nodout/7/x_velocity").values, ElementsAre(-4.0, -4.0));
}

TEST(LsdynaNodout, ColumnsMayBeWiderAndHaveOtherNames) {
  const auto state = [](const char* time, double x) {
    return fmt::format("{}\n\n nodal point   x-disp       y-disp      temperature\n{:20d}{:15.7E}{:15.7E}{:15.7E}\n\n",
                       test::nodout_head(1, time), 12345678901234567, x, -x, 293.15);
  };
  const TraceSet set = read(state(" 0.0000000E+00", 1.2345678) + state(" 1.0000000E-03", -2.5));
  EXPECT_THAT(with_id(set, "nodout/12345678901234567/x_displacement").values, ElementsAre(1.2345678, -2.5));
  EXPECT_THAT(with_id(set, "nodout/12345678901234567/temperature").values, ElementsAre(293.15, 293.15));
}

TEST(LsdynaNodout, NodesThatAppearLaterAreSaid) {
  LsdynaRun run = test::nodout_run({});
  const std::size_t row = run.text.find("\n       17 ", run.state_ends[3]) + 1;
  std::string copy = run.text.substr(row, run.text.find('\n', row) + 1 - row);
  copy.replace(0, 10, "       99 ");
  run.text.insert(row, copy);
  const TraceSet set = read(run.text);
  for (const auto& [id, values] : run.values) EXPECT_EQ(with_id(set, id).values, values) << id;
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("1 rows are of nodes that the first state has not and were not "
                                                  "read, the first of node 99")));
}

TEST(LsdynaNodout, TheFileOfHighFrequenciesKeepsItsName) {
  const test::TempDir dir;
  const TraceSet set = read_traces(dir.file("nodouthf", test::nodout_run({}).text), kSi);
  EXPECT_EQ(set.traces[0].id, "nodouthf/17/x_displacement");
}

}  // namespace
}  // namespace crashsim
