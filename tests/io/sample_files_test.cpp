/// Real files of LS-DYNA, whole and cut off: every number that stands in the text is in a channel, and of a cut file
/// the whole states are read, or it is refused.
#include <algorithm>
#include <cstdlib>
#include <regex>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <crashsim/error.hpp>
#include <crashsim/files.hpp>
#include <crashsim/trace_io.hpp>

#include "support/random.hpp"
#include "support/shared_data.hpp"
#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

const ReadOptions kSi = {.channels = {}, .columns = "", .units = "kg-m-s"};

struct Sample {
  const char* path;
  const char* value;  ///< What a value in the text looks like, with what stands before it; times are none.
};
void PrintTo(const Sample& sample, std::ostream* out) { *out << sample.path; }

class SampleFile : public testing::TestWithParam<Sample> {
 protected:
  void SetUp() override {
    const auto path = test::shared_data(GetParam().path);
    if (!path) GTEST_SKIP() << test::kNoSharedData;
    path_ = path->string();
  }
  std::string path_;
};

TEST_P(SampleFile, EveryNumberOfItsTextIsInAChannel) {
  const std::string text = read_file(path_);
  const std::regex value(GetParam().value);
  std::vector<double> printed, read;
  for (std::sregex_iterator at(text.begin(), text.end(), value), end; at != end; ++at)
    printed.push_back(std::strtod((*at)[1].str().c_str(), nullptr));
  for (const Trace& trace : read_traces(path_, kSi).traces)
    read.insert(read.end(), trace.values.begin(), trace.values.end());
  std::sort(printed.begin(), printed.end());
  std::sort(read.begin(), read.end());
  ASSERT_GT(printed.size(), 1000u);
  EXPECT_TRUE(read == printed) << read.size() << " values of " << printed.size();
}

TEST_P(SampleFile, CutAnywhereItGivesWholeStatesOrIsRefused) {
  const test::TempDir dir;
  const std::string text = read_file(path_);
  const TraceSet whole = read_traces(path_, kSi);
  test::Random random(5);
  for (int i = 0; i < 200; ++i) {
    const auto cut = static_cast<std::size_t>(random.between(1.0, static_cast<double>(text.size())));
    SCOPED_TRACE(fmt::format("cut at byte {} of {}", cut, text.size()));
    TraceSet part;
    try {
      part = read_traces(dir.file("cut", text.substr(0, cut)), kSi);
    } catch (const InvalidInput& refusal) {
      EXPECT_THAT(refusal.what(), testing::HasSubstr("cut"));
      continue;
    }
    for (const Trace& trace : part.traces) {
      const auto same_id = [&](const Trace& other) { return other.id == trace.id; };
      const auto full = std::find_if(whole.traces.begin(), whole.traces.end(), same_id);
      ASSERT_NE(full, whole.traces.end()) << trace.id;
      ASSERT_LE(trace.values.size(), full->values.size());
      EXPECT_TRUE(std::equal(trace.values.begin(), trace.values.end(), full->values.begin())) << trace.id;
      EXPECT_TRUE(std::equal(trace.times().begin(), trace.times().end(), full->times().begin())) << trace.id;
    }
    const std::string last_line = text.substr(text.rfind('\n', cut - 1) + 1, cut - text.rfind('\n', cut - 1) - 1);
    const bool is_cut_in_values = std::regex_search(last_line, std::regex(R"(\.\.|=|\d\.\d)"));
    EXPECT_TRUE(!is_cut_in_values || !part.warnings.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(
    LsdynaAscii, SampleFile,
    testing::Values(Sample{"lsdyna-ascii/glstat", R"(\n (?!time\.\.)[^\n]*?\.+ +(-?[\d.]+(?:E[-+]\d+)?)(?=\n))"},
                    Sample{"lsdyna-ascii/rcforc", R"(\b(?:[xyz]|mass|m[xyz])\s+(-?\d\.\d+E[-+]\d+))"},
                    Sample{"lsdyna-ascii/matsum", R"((?:en|ie|ke|mom|rbv|eng)=\s*(-?\d\.\d+E[-+]\d+))"}));

}  // namespace
}  // namespace crashsim
