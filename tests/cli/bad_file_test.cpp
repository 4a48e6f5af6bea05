/// Traces that cannot be used, as the command line tells of them.

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "support/nhtsa_files.hpp"
#include "support/refusal.hpp"

namespace crashsim {
namespace {

using test::Refusal;

/// `pulse` of a file `t.csv` with the given text.
Refusal pulse_of(const char* what, std::string text, std::vector<std::string> message,
                 const std::vector<std::string>& options = {}) {
  Refusal refusal{what, {{"t.csv", std::move(text)}}, {"pulse", "t.csv", "-o", "out"}, std::move(message)};
  refusal.arguments.insert(refusal.arguments.end(), options.begin(), options.end());
  return refusal;
}

/// The half-sine trace with one line changed, counted from 1.
std::string trace_with_line(int number, const std::string& line) {
  std::string text = test::half_sine_trace();
  std::size_t from = 0;
  for (int i = 1; i < number; ++i) from = text.find('\n', from) + 1;
  return text.replace(from, text.find('\n', from) - from, line);
}

/// `pulse` of a small NHTSA test with one channel file.
Refusal nhtsa(const char* what, const test::NhtsaRecord& record, const std::string& samples,
              std::vector<std::string> message) {
  Refusal refusal{what,
                  {{"v1.EV5", test::header_text({record})}},
                  {"pulse", "v1.EV5", "--channel", "1", "-o", "out"},
                  std::move(message)};
  if (!samples.empty()) refusal.files.emplace_back("v1.001", samples);
  return refusal;
}

std::string compared(double from_s) {
  return fmt::format("time_s,accel_g\n{},0\n{},1\n{},2\n", from_s, from_s + 0.1, from_s + 0.2);
}

class BadFile : public testing::TestWithParam<Refusal> {};

TEST_P(BadFile, IsRefused) { test::expect_refused(GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    NotTraces, BadFile,
    testing::Values(Refusal{"missing", {}, {"pulse", "none.csv", "-o", "out"}, {"none.csv: no such file"}},
                    Refusal{"missing_for_info", {}, {"info", "none.csv"}, {"none.csv: no such file"}},
                    Refusal{"folder", {}, {"pulse", ".", "-o", "out"}, {".: not a trace file: a folder"}},
                    pulse_of("empty", "", {"t.csv: not a trace file: the file is empty. Formats known: "}),
                    pulse_of("binary", std::string("\x01\0\x02\0a,b\n0,1\n", 12),
                             {"t.csv: not a trace file: binary data"}),
                    pulse_of("prose", "The car hit the wall.\nTwice.\n",
                             {"t.csv: not a trace file: text without a table of numbers"}),
                    pulse_of("json", "{\"a\": [1, 2]}", {"t.csv: not a trace file: JSON"}),
                    Refusal{"model_as_trace",
                            {},
                            {"pulse", "data/syn-a/model.json", "-o", "out"},
                            {"data/syn-a/model.json: not a trace file: JSON"}},
                    pulse_of("gzip", "\x1f\x8b\x08 1 2", {"t.csv: not a trace file: gzip: unpack it first"}),
                    pulse_of("zip", "PK\x03\x04 1 2", {"t.csv: not a trace file: a zip archive or a spreadsheet"}),
                    pulse_of("utf16", std::string("\xff\xfet\0i\0", 6),
                             {"t.csv: not a trace file: UTF-16 text: save it as UTF-8"})));

INSTANTIATE_TEST_SUITE_P(
    Tables, BadFile,
    testing::Values(
        pulse_of("cut_row", "time_s,a_g,b_g\n0,1,2\n1,2,3\n2,4",
                 {"t.csv:4: 2 cells, but the rows before have 3: the row is ragged or the file truncated"}),
        pulse_of("not_a_number", trace_with_line(9, "-0.0095,high"), {"t.csv:9: column 2: 'high' is not a number"}),
        pulse_of("sample_is_nan", trace_with_line(9, "-0.0095,nan"),
                 {"t.csv: channel 2 accel_g: sample 6 at -0.0095 s is nan: must be finite"}),
        pulse_of("sample_is_missing", trace_with_line(9, "-0.0095,"),
                 {"t.csv: channel 2 accel_g: sample 6 at -0.0095 s is nan: must be finite"}),
        pulse_of("time_goes_back", trace_with_line(9, "-0.0099,0"),
                 {"t.csv:9: time -0.0099 is not after the one before it, -0.0096: times must increase"}),
        pulse_of("time_repeats", trace_with_line(9, "-0.0096,0"),
                 {"t.csv:9: time -0.0096 is not after the one before it, -0.0096: times must increase"}),
        pulse_of("no_header", "0,1\n1,2\n",
                 {"t.csv: no header: name the 2 columns, for example columns = time:s,accel:g"}),
        pulse_of("no_time_column", "a_g,b_g\n0,1\n1,2\n", {"t.csv: no time column: call one 'time_s'"}),
        pulse_of("time_in_kilograms", "time_kg,b_g\n0,1\n1,2\n",
                 {"t.csv: time column 'time_kg': 'kg' measures mass, not time"}),
        pulse_of("unit_unknown", "time_s,accel\n0,1\n1,2\n", {"t.csv: channel 2 accel: its unit is unknown; say it"}),
        pulse_of("unit_named_is_unknown", "0,1\n1,2\n", {"t.csv: columns = 'time:s,a:gees': unknown unit 'gees'"},
                 {"--columns", "time:s,a:gees"}),
        pulse_of("too_few_columns_named", "0,1,2\n1,2,3\n",
                 {"t.csv: has 3 columns, but columns = 'time:s,a:g' names 2"}, {"--columns", "time:s,a:g"}),
        pulse_of("too_few_samples", "time_s,accel_g\n0,1\n0.1,2\n",
                 {"t.csv: channel 2 accel_g: 2 samples: at least 10 are needed"})));

INSTANTIATE_TEST_SUITE_P(
    Channels, BadFile,
    testing::Values(
        pulse_of("no_such_channel", test::half_sine_trace(),
                 {"t.csv: no channel 'acel_g' among 1; nearest: 2 (accel_g)"}, {"--channel", "acel_g"}),
        pulse_of("which_of_two", "time_s,a_g,b_g\n0,1,2\n1,2,3\n",
                 {"t.csv: say which channels measure the vehicle's longitudinal motion (--channel)",
                  "2 (a_g), 3 (b_g)"}),
        pulse_of("not_a_motion", "time_s,wall_kn\n0,1\n1,2\n",
                 {"t.csv: channel 2 wall_kn: measures force; a pulse is made from acceleration or velocity"}),
        pulse_of("of_two_kinds",
                 "time_s,a_g,b_mps\n" + test::half_sine_trace().substr(0, 0) +
                     "0,1,2\n0.1,2,3\n0.2,1,1\n0.3,1,1\n0.4,1,1\n0.5,1,1\n0.6,1,1\n0.7,1,1\n0.8,1,"
                     "1\n0.9,1,1\n",
                 {"t.csv: channel 2 a_g measures acceleration, channel 3 b_mps speed: average channels of one kind"},
                 {"--channel", "2", "--channel", "3"}),
        nhtsa("flagged_bad", {.data_status = "CF"}, test::kFiveSamples,
              {"v1.EV5: channel 1 LEFT REAR SEAT CROSSMEMBER X: its source says that the channel failed (DASTAT CF); "
               "choose others with --channel: "}),
        nhtsa("says_it_has_no_data", {.data_status = "NO"}, test::kFiveSamples,
              {"v1.EV5: channel 1 LEFT REAR SEAT CROSSMEMBER X: no data were recorded (DASTAT NO)"}),
        nhtsa("file_absent", {}, "", {"channel 1 LEFT REAR SEAT CROSSMEMBER X: ", "v1.001"}),
        nhtsa("file_cut", {.first = "-2", .last = "20"}, test::kFiveSamples,
              {"channel 1 LEFT REAR SEAT CROSSMEMBER X: "}),
        Refusal{"header_cut",
                {{"v1.EV5", "----- EV5 -----\n----- TEST -----\n"}},
                {"pulse", "v1.EV5", "-o", "out"},
                {"v1.EV5: no INSTRUMENTATION records: the header is truncated"}}));

INSTANTIATE_TEST_SUITE_P(
    Steps, BadFile,
    testing::Values(
        pulse_of("no_speed", "time_s,accel_g\n" + test::half_sine_trace().substr(test::half_sine_trace().find("-0.01")),
                 {"t.csv: ", "speed"}),
        pulse_of("rate_too_low_for_the_filter", test::half_sine_trace(16.5, 0.002),
                 {"t.csv: channel 2 accel_g: sampling rate 500 Hz is too low for CFC60: at least 10 x 60 = 600 Hz are "
                  "needed; choose a lower class or finer samples"}),
        pulse_of("filter_too_high", test::half_sine_trace(), {"sampling rate 10000 Hz is too low for CFC2000"},
                 {"--cfc", "2000"}),
        pulse_of("time_zero_before_the_trace", test::half_sine_trace(),
                 {"t.csv: time zero -1 s is outside the trace, -0.01 to 0.12 s; say when the impact is (--t0)"},
                 {"--t0", "-1"}),
        pulse_of("time_zero_after_the_trace", test::half_sine_trace(), {"t.csv: time zero 1 s is outside the trace"},
                 {"--t0", "1s"}),
        pulse_of("time_zero_at_the_end", test::half_sine_trace(),
                 {"samples from time zero 0.1199 s on: at least 10 are needed"}, {"--t0", "119.9ms"}),
        pulse_of("time_zero_not_found",
                 "time_s,accel_g\n" + test::half_sine_trace(0.1).substr(test::half_sine_trace().find("-0.01")),
                 {"time zero cannot be found: the acceleration never reaches 5 g; give the time of impact"},
                 {"--t0", "auto", "--speed", "15"}),
        pulse_of("bias_window_outside", test::half_sine_trace(),
                 {"t.csv: channel 2 accel_g: no samples with 5 s <= time < 6 s: the trace covers -0.01 to 0.12 s"},
                 {"--bias", "5,6"}),
        pulse_of("bias_is_one_number", test::half_sine_trace(),
                 {"bias: 1 numbers given: a window needs two times in s"}, {"--bias", "0.1"})));

INSTANTIATE_TEST_SUITE_P(
    Pairs, BadFile,
    testing::Values(
        Refusal{"no_channel_in_common",
                {{"a.csv", "time_s,accel_g\n0,1\n1,2\n"}, {"b.csv", "time_s,speed_mps\n0,1\n1,2\n"}},
                {"compare", "a.csv", "b.csv", "-o", "out"},
                {"a.csv and b.csv have no channel in common: accel_g against speed_mps"}},
        Refusal{"no_time_in_common",
                {{"a.csv", compared(0.0)}, {"b.csv", compared(5.0)}},
                {"compare", "a.csv", "b.csv", "-o", "out"},
                {"accel_g: 0 samples between 5 and 0.2 s", "at least 2 are needed"}},
        Refusal{"window_outside",
                {{"a.csv", compared(0.0)}},
                {"compare", "a.csv", "a.csv", "--start", "1", "-o", "out"},
                {"accel_g: 0 samples between 1 and 0.2 s, where both have samples and the comparison was asked for"}},
        Refusal{"channel_not_there",
                {{"a.csv", compared(0.0)}},
                {"compare", "a.csv", "a.csv", "--channel", "acel_g", "-o", "out"},
                {"a.csv: no channel 'acel_g' among 1; nearest: 2 (accel_g)"}},
        Refusal{"sample_missing",
                {{"a.csv", compared(0.0)}, {"b.csv", "time_s,accel_g\n0,1\n0.1,\n0.2,3\n"}},
                {"compare", "a.csv", "b.csv", "-o", "out"},
                {"accel_g: sample 2 at 0.1 s is nan: must be finite"}}));

/// A trace whose vehicle never stops is written for whoever wants to see it, but is no success.
TEST(APulseWithoutEnd, IsWrittenAndTold) {
  const test::Workspace workspace;
  workspace.file("weak.csv", test::half_sine_trace(10.0));
  const test::Finished finished = workspace.run({"pulse", "weak.csv", "-o", "pulse.csv"});
  EXPECT_EQ(finished.exit_code, test::kNumbersFailed);
  EXPECT_THAT(finished.err, testing::HasSubstr("warning: velocity does not reach zero within 0.12 s, so there is no "
                                               "time of maximum crush: check channel, units, speed"));
  EXPECT_TRUE(workspace.has("pulse.csv"));
}

TEST(APulseWithoutEnd, HasNoModel) {
  const test::Workspace workspace;
  workspace.file("weak.csv", test::half_sine_trace(10.0));
  const test::Finished finished = workspace.run({"identify", "weak.csv", "-o", "model.json"});
  EXPECT_EQ(finished.exit_code, test::kNumbersFailed);
  EXPECT_THAT(finished.err, testing::HasSubstr("its velocity (5 m/s at 0.12 s) never reaches zero"));
  EXPECT_THAT(workspace.names(), testing::ElementsAre("weak.csv"));
}

}  // namespace
}  // namespace crashsim
