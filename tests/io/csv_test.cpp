#include <cmath>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <crashsim/error.hpp>
#include <crashsim/files.hpp>
#include <crashsim/table_io.hpp>
#include <crashsim/trace_io.hpp>

#include "support/random.hpp"
#include "support/source_dir.hpp"
#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsNan;
using testing::Pair;
using testing::ThrowsMessage;

struct Foreign {
  const char* what;
  const char* text;
  const char* columns = "";
};
void PrintTo(const Foreign& f, std::ostream* out) { *out << f.what; }

class ForeignCsv : public testing::TestWithParam<Foreign> {};

/// Each text holds t = 0, 1, 2 ms and a = 0, -1.5, -30 g.
TEST_P(ForeignCsv, IsReadIntoSi) {
  const test::TempDir dir;
  ReadOptions options;
  options.columns = GetParam().columns;
  const TraceSet set = read_traces(dir.file("a.csv", GetParam().text), options);
  EXPECT_EQ(set.format, "csv");
  ASSERT_EQ(set.traces.size(), 1u);
  const Trace& trace = set.traces[0];
  EXPECT_EQ(trace.id, "2");
  EXPECT_EQ(trace.dimension, Dimension::acceleration);
  EXPECT_THAT(*trace.time_s, ElementsAre(0.0, DoubleEq(0.001), DoubleEq(0.002)));
  EXPECT_THAT(trace.values, ElementsAre(0.0, DoubleEq(-14.709975), DoubleEq(-294.1995)));
}

INSTANTIATE_TEST_SUITE_P(
    Styles, ForeignCsv,
    testing::Values(
        Foreign{"comma", "time_s,accel_g\n0,0\n0.001,-1.5\n0.002,-30\n"},
        Foreign{"tab", "time_ms\taccel_g\n0\t0\n1\t-1.5\n2\t-30\n"},
        Foreign{"blanks", "  time_ms   accel_g\n  0      0\n  1   -1.5\n  2.   -3e1\n"},
        Foreign{"semicolon_decimal_comma", "time [ms];accel [g]\n0,0;0,0\n1,0;-1,5\n2,0;-30,0\n"},
        Foreign{"tab_decimal_comma", "time [ms]\taccel [g]\n0\t0\n1,0\t-1,5\n2,0\t-30\n"},
        Foreign{"byte_order_mark_crlf", "\xef\xbb\xbftime [s],accel [G'S]\r\n0,0\r\n0.001,-1.5\r\n0.002,-30\r\n\r\n"},
        Foreign{"quoted", "\"time (s)\",\"accel, rear (g)\"\n\"0\",\"0\"\n\"0.001\",\"-1.5\"\n0.002,-30\n"},
        Foreign{"comments", "# test 1\n% more\ntime_s,accel_g\n0,0\n# in between\n0.001,-1.5\n\n0.002,-30\n"},
        Foreign{"header_in_comment", "# made by numpy\n# time_s accel_g\n0 0\n0.001 -1.5\n0.002 -30\n"},
        Foreign{"row_of_units", "time,accel\nms,g\n0,0\n1,-1.5\n2,-30\n"},
        Foreign{"row_of_bracketed_units", "time;accel\n[ms];[g]\n0;0\n1;-1,5\n2;-30\n"},
        Foreign{"preamble", "Test 10146\nDate;2017\ntime_ms;accel_g\n0;0\n1;-1.5\n2;-30\n"},
        Foreign{"no_header", "0 0\n1 -1.5\n2 -30", "time:ms,accel:g"},
        Foreign{"header_corrected", "time_s,accel\n0,0\n1,-1.5\n2,-30\n", "time:ms,accel:g"},
        Foreign{"trailing_separator", "time_ms,accel_g\n0,0,\n1,-1.5,\n2,-30,\n"},
        Foreign{"abaqus_report",
                "\n\n               X      A1 PI: CAR-1 N: 101 \n\n           0.              0.     \n"
                "        1.E-03          -1.5     \n        2.E-03         -30.E+00  \n\n\n",
                "time:s,accel:g"},
        Foreign{"pam_crash_curve",
                "# PAM-VIEW\n# NODE 101 X-ACCELERATION\n  0.0000000E+00   0.0000000E+00\n"
                "  1.0000000E-03  -1.5000000E+00\n  2.0000000E-03  -3.0000000E+01\n",
                "time:s,accel:g"},
        Foreign{"ls_prepost_curve",
                "Curveplot\nLS-DYNA keyword deck by LS-PrePost\nTime\nX-acceleration\nA   101 #pts=3\n"
                "* Minval=  -30.000000 at time=   2.000000\n* Maxval=    0.000000 at time=   0.000000\n"
                "   0.0000000e+00   0.0000000e+00\n   1.0000000e+00  -1.5000000e+00\n   2.0000000e+00  -3.0000000e+01\n"
                "endcurve\n",
                "time:ms,accel:g"},
        Foreign{"no_newline_at_end", "time_s,accel_g\n0,0\n0.001,-1.5\n0.002,-30"}));

TEST(Csv, UnitsInBracketsAreNotPartOfTheNameSuffixesAre) {
  const test::TempDir dir;
  const TraceSet set =
      read_traces(dir.file("a.csv", "t [s],a x [g],force_z_n,speed_kmh,note\n0,1,2,36,5\n1,1,2,36,5\n"));
  ASSERT_EQ(set.traces.size(), 4u);
  EXPECT_EQ(set.traces[0].name, "a x");
  EXPECT_EQ(set.traces[0].source_unit, "g");
  EXPECT_EQ(set.traces[1].name, "force_z_n");
  EXPECT_EQ(set.traces[1].dimension, Dimension::force);
  EXPECT_THAT(set.traces[2].values, ElementsAre(DoubleEq(10), DoubleEq(10)));
  EXPECT_EQ(set.traces[3].dimension, Dimension::unknown);
  EXPECT_EQ(set.traces[3].source_unit, "");
}

/// Rows of a load-cell wall are called A, B, .. K: row K in newtons is not in kilonewtons.
TEST(Csv, MoreColumnsThanFitMemoryAreRefused) {
  const test::TempDir dir;
  constexpr int kColumns = 200000;
  std::string names = "time", row = "0";
  for (int column = 1; column < kColumns; ++column) {
    names += ",a";
    row += ",1";
  }
  EXPECT_THAT([&] { read_traces(dir.file("a.csv", names + "\n" + row + "\n")); },
              ThrowsMessage<InvalidInput>(AllOf(HasSubstr("a.csv:2: a row of more than "),
                                                HasSubstr(" cells, more channels than fit memory"))));
}

TEST(Csv, ALetterBeforeTheUnitIsNoPartOfIt) {
  const test::TempDir dir;
  const TraceSet set = read_traces(dir.file(
      "a.csv", "time_s,row_A_N,row_G_N,row_I_N,row_K_N,push_N_s,k_n_per_m,a_m_s2\n0,1,1,1,1,1,1,1\n1,1,1,1,1,1,1,1\n"));
  const std::vector<Dimension> expected = {Dimension::force,       Dimension::force,   Dimension::force,
                                           Dimension::force,       Dimension::impulse, Dimension::stiffness,
                                           Dimension::acceleration};
  ASSERT_EQ(set.traces.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(set.traces[i].dimension, expected[i]) << set.traces[i].name;
    EXPECT_EQ(set.traces[i].values.front(), 1.0) << set.traces[i].name;
  }
}

TEST(Csv, OurOwnTablesComeBackBitForBit) {
  const test::TempDir dir;
  const std::vector<double> t = {0.0, 0.1, 0.3}, v = {1.0 / 3.0, -1e-300, std::nan("")};
  write_csv(dir.path("a.csv"), {{"mass_kg", "1719"}, {"impact_speed_mps", "15.86"}, {"title", "a test"}},
            {{"time_s", t}, {"velocity_mps", v}});
  const TraceSet set = read_traces(dir.path("a.csv"));
  EXPECT_EQ(set.mass_kg, 1719.0);
  EXPECT_EQ(set.impact_speed_mps, 15.86);
  EXPECT_EQ(set.title, "a test");
  EXPECT_THAT(set.metadata, Contains(Pair("mass_kg", "1719")));
  EXPECT_THAT(set.input_files, ElementsAre(dir.path("a.csv")));
  EXPECT_EQ(*set.traces[0].time_s, t);
  EXPECT_THAT(set.traces[0].values, ElementsAre(v[0], v[1], IsNan()));
}

TEST(Csv, ReadsOnlyTheChannelsAskedFor) {
  const test::TempDir dir;
  const TraceSet set = read_traces(dir.file("a.csv", "time_s,a_g,b_g,c_m\n0,1,2,3\n1,1,overflow,4\n"),
                                   {.channels = {"c_m"}, .columns = "", .units = ""});
  ASSERT_EQ(set.traces.size(), 3u);
  EXPECT_FALSE(set.traces[1].has_samples);
  EXPECT_TRUE(set.traces[1].values.empty());
  EXPECT_TRUE(set.traces[2].has_samples);
  EXPECT_THAT(set.traces[2].values, ElementsAre(3, 4));
}

TEST(Csv, TimeWithoutAUnitIsSecondsWithAWarning) {
  const test::TempDir dir;
  const TraceSet set = read_traces(dir.file("a.csv", "time,accel_g\n0,1\n0.1,2\n"));
  EXPECT_THAT(set.warnings, ElementsAre(HasSubstr("time column 'time' has no unit: taken as seconds")));
}

/// Of a file cut off at any byte there is an error, or whole rows; the last number may be cut, and then it is said.
void expect_honest_when_cut(const std::string& path, const std::string& text) {
  const test::TempDir dir;
  const TraceSet whole = read_traces(path);
  const std::vector<double>& whole_last = whole.traces.back().values;
  test::Random random(7);
  for (int i = 0; i < 200; ++i) {
    const auto at = static_cast<std::size_t>(random.between(0.0, static_cast<double>(text.size())));
    const std::string cut = dir.file("cut.csv", text.substr(0, at));
    SCOPED_TRACE(at);
    TraceSet set;
    try {
      set = read_traces(cut);
    } catch (const InvalidInput& error) {
      EXPECT_THAT(error.what(), HasSubstr("cut.csv"));
      continue;
    }
    ASSERT_EQ(set.traces.size(), whole.traces.size());
    const std::vector<double>& last = set.traces.back().values;
    ASSERT_LE(last.size(), whole_last.size());
    for (std::size_t k = 0; k + 1 < last.size(); ++k) ASSERT_EQ(last[k], whole_last[k]);
    if (!last.empty() && last.back() != whole_last[last.size() - 1]) {
      EXPECT_THAT(set.warnings, testing::Contains(HasSubstr("the last line has no end")));
    }
  }
}

TEST(Csv, AFileCutOffIsRefusedOrSaysThatItsLastNumberMayBeCut) {
  const test::TempDir dir;
  std::string text = "time_s,a_mps2,b_m\n";
  test::Random random(3);
  for (int i = 0; i < 100; ++i)
    text += fmt::format("{},{},{}\n", 1e-3 * i, random.between(-300, 300), random.between(-1, 1));
  expect_honest_when_cut(dir.file("a.csv", text), text);
}

TEST(Csv, AnFeRunsTableCutOffIsRefusedOrSaysThatItsLastNumberMayBeCut) {
  const std::string path = std::string(test::source_dir()) + "/data/fe-car/C56.csv";
  expect_honest_when_cut(path, read_file(path));
}

struct Bad {
  const char* what;
  const char* text;
  const char* message;
  const char* columns = "";
};
void PrintTo(const Bad& b, std::ostream* out) { *out << b.what; }

class BadCsv : public testing::TestWithParam<Bad> {};

TEST_P(BadCsv, IsRefusedWithFileLineAndReason) {
  const test::TempDir dir;
  const std::string path = dir.file("bad.csv", GetParam().text);
  EXPECT_THAT([&] { read_traces(path, {.channels = {}, .columns = GetParam().columns, .units = ""}); },
              ThrowsMessage<InvalidInput>(AllOf(HasSubstr("bad.csv"), HasSubstr(GetParam().message))));
}

INSTANTIATE_TEST_SUITE_P(
    Cases, BadCsv,
    testing::Values(
        Bad{"too_few_cells", "time_s,a_g\n0,1\n1\n2,3\n", "bad.csv:3: 1 cells, but the rows before have 2"},
        Bad{"too_many_cells", "time_s,a_g\n0,1\n1,2,3\n", "bad.csv:3: 3 cells, but the rows before have 2"},
        Bad{"truncated", "time_s,a_g,b_g\n0,1,2\n1,2,3\n2,4", "bad.csv:4: 2 cells, but the rows before have 3"},
        Bad{"not_a_number", "time_s,a_g\n0,1\n1,high\n", "bad.csv:3: column 2: 'high' is not a number"},
        Bad{"decimal_comma_and_comma", "time_s,a_g\n0,1\n0,1,2,5\n", "bad.csv:3: 4 cells"},
        Bad{"time_goes_back", "time_s,a_g\n0,1\n2,1\n\n1,1\n", "bad.csv:5: time 1 is not after the one before it, 2"},
        Bad{"time_repeats", "time_s,a_g\n0,1\n1,1\n1,1\n", "bad.csv:4: time 1 is not after the one before it, 1"},
        Bad{"time_is_nan", "time_s,a_g\n0,1\nnan,1\n", "bad.csv:3: time is nan: must be a finite number"},
        Bad{"time_is_empty", "time_s,a_g\n0,1\n,1\n", "bad.csv:3: time is nan"},
        Bad{"two_curves", "Curveplot\n0 1\n1 2\nendcurve\nB 2 #pts=2\n0 1\n1 2\nendcurve\n",
            "bad.csv:5: a second curve begins: save each to a file of its own", "time:s,accel:g"},
        Bad{"no_header", "0,1\n1,2\n", "no header: name the 2 columns, for example columns = time:s,accel:g"},
        Bad{"header_does_not_fit", "time_s,a_g,b_g\n0,1\n1,2\n",
            "bad.csv:1: this line before the numbers is no header"},
        Bad{"no_time_column", "a_g,b_g\n0,1\n1,2\n", "no time column: call one 'time_s'"},
        Bad{"time_in_wrong_unit", "time_kg,b_g\n0,1\n1,2\n", "time column 'time_kg': 'kg' measures mass, not time"},
        Bad{"time_too_long_for_seconds", "time,a_g\n0,1\n150,2\n", "has no unit and spans 150: too long to be seconds"},
        Bad{"too_few_columns_named", "time_s,a_g,b_g\n0,1,2\n", "has 3 columns, but columns = 'time:s,a:g' names 2",
            "time:s,a:g"},
        Bad{"unknown_unit_named", "0,1\n1,2\n", "unknown unit 'gees'", "time:s,a:gees"}));

INSTANTIATE_TEST_SUITE_P(NotTraces, BadCsv,
                         testing::Values(Bad{"empty", "", "not a trace file: the file is empty. Formats known: "},
                                         Bad{"blank", " \n\n", "not a trace file: the file is empty"},
                                         Bad{"prose", "The car hit the wall.\nTwice.\n",
                                             "not a trace file: text without a table of numbers"},
                                         Bad{"header_only", "time_s,a_g\n", "text without a table of numbers"},
                                         Bad{"json", "{\"a\": [1, 2,\n3, 4,\n5]}", "not a trace file: JSON"},
                                         Bad{"html", "<html>\n404, 1\n1, 2\n</html>", "not a trace file: HTML or XML"},
                                         Bad{"gzip", "\x1f\x8b\x08 1 2", "not a trace file: gzip: unpack it first"},
                                         Bad{"zip", "PK\x03\x04 1 2",
                                             "not a trace file: a zip archive or a spreadsheet"},
                                         Bad{"utf16",
                                             "\xff\xfe"
                                             "t i m e",
                                             "not a trace file: UTF-16 text: save it as UTF-8"}));

TEST(BadCsv, BinaryAndFoldersAndMissingFilesAreNamed) {
  const test::TempDir dir;
  const std::string binary = dir.file("a.bin", std::string_view("\x01\0\x02\0time_s,a\n0,1\n1,2\n", 21));
  EXPECT_THAT([&] { read_traces(binary); },
              ThrowsMessage<InvalidInput>(HasSubstr("a.bin: not a trace file: binary data")));
  EXPECT_THAT([&] { read_traces(dir.path("")); },
              ThrowsMessage<InvalidInput>(HasSubstr("not a trace file: a folder without trace files")));
  EXPECT_THAT([&] { read_traces(dir.path("none.csv")); },
              ThrowsMessage<InvalidInput>(HasSubstr("none.csv: no such file")));
}

TEST(InspectTraces, DescribesChannelsWithoutKeepingSamples) {
  const test::TempDir dir;
  const TraceFileInfo info = inspect_traces(dir.file("a.csv", "time_s,a_g,b\n0,1,5\n0.001,,6\n0.003,-2,7\n"));
  EXPECT_TRUE(info.set.traces.empty());
  ASSERT_EQ(info.channels.size(), 2u);
  const ChannelInfo& a = info.channels[0];
  EXPECT_EQ(a.id, "2");
  EXPECT_EQ(a.unit, "m/s^2");
  EXPECT_EQ(a.samples, 3u);
  EXPECT_EQ(a.first_s, 0.0);
  EXPECT_EQ(a.last_s, 0.003);
  EXPECT_DOUBLE_EQ(a.rate_hz, 2 / 0.003);
  EXPECT_FALSE(a.uniform);
  EXPECT_DOUBLE_EQ(a.min, -2 * kStandardGravity);
  EXPECT_DOUBLE_EQ(a.max, kStandardGravity);
  EXPECT_EQ(a.status, "1 of 3 samples are missing");
  EXPECT_EQ(info.channels[1].status, "ok");
  EXPECT_EQ(info.channels[1].unit, "");
}

}  // namespace
}  // namespace crashsim
