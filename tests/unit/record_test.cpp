#include <crashsim/record.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/error.hpp>
#include <crashsim/identify.hpp>
#include <crashsim/version.hpp>

#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

Record sample_record(const test::TempDir& dir) {
  const std::vector<ConfigEntry> options = {
      {"", "title", std::string("a \"quoted\" title,\nsecond line"), ""},
      {"", "mass", std::monostate{}, ""},
      {"pulse", "cfc", 60.0, ""},
      {"pulse", "third", 1.0 / 3.0, ""},
      {"pulse", "channel", std::vector<std::string>{"93", "*,x"}, ""},
      {"identify", "seed", (std::int64_t{1} << 62) + 1, ""},
      {"identify", "jobs", std::int64_t{2}, ""},
      {"identify", "knots", std::vector<double>{0.0, 0.1, 5e-324}, ""},
      {"identify", "flag", true, ""},
  };
  return make_record("run", {"case.toml"}, options, {dir.file("t.csv", "abc"), dir.path("t.csv")});
}

TEST(Record, KnowsVersionInputsAndOptionsButNotThreads) {
  const test::TempDir dir;
  const Record record = sample_record(dir);
  EXPECT_EQ(record.version, kVersion);
  EXPECT_THAT(record.inputs,
              ElementsAre(RecordedInput{dir.path("t.csv"),
                                        "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"}));
  for (const ConfigEntry& entry : record.options) EXPECT_NE(entry.key, "jobs");
}

void expect_same(const Record& a, const Record& b) {
  EXPECT_EQ(a.version, b.version);
  EXPECT_EQ(a.command, b.command);
  EXPECT_EQ(a.arguments, b.arguments);
  EXPECT_EQ(a.inputs, b.inputs);
  ASSERT_EQ(a.options.size(), b.options.size());
  for (std::size_t i = 0; i < a.options.size(); ++i) {
    EXPECT_EQ(a.options[i].section, b.options[i].section);
    EXPECT_EQ(a.options[i].key, b.options[i].key);
    EXPECT_EQ(a.options[i].value, b.options[i].value) << a.options[i].key;
  }
}

TEST(Record, ComesBackFromEveryKindOfOutput) {
  const test::TempDir dir;
  const Record record = sample_record(dir);
  const std::string line = to_json(record);
  EXPECT_THAT(line, Not(HasSubstr("\n")));
  for (const std::string& path :
       {dir.file("case.lock.json", line), dir.file("model.json", "{\"a\": 1, \"record\": " + line + "}\n"),
        dir.file("pulse.csv", "# crashsim = 0.1.0\n# record = " + line + "\ntime_s\n0\n"),
        dir.file("crlf.csv", "# record = " + line + "\r\ntime_s\r\n0\r\n")}) {
    const auto found = find_record(path);
    ASSERT_TRUE(found.has_value()) << path;
    expect_same(*found, record);
    EXPECT_EQ(to_json(*found), line);
  }
}

TEST(Record, OfNumbersThatJsonDoesNotKnowIsUnset) {
  const Record record = make_record("pulse", {}, {{"", "mass", kUnset, ""}}, {});
  const test::TempDir dir;
  const auto found = find_record(dir.file("r.json", to_json(record)));
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->options.at(0).value, OptionValue(std::monostate{}));
}

TEST(Record, OfTextThatIsNotUtf8IsJsonAllTheSame) {
  const Record record = make_record("pulse", {"caf\xe9.csv"}, {}, {});
  const test::TempDir dir;
  const auto found = find_record(dir.file("r.json", to_json(record)));
  ASSERT_TRUE(found.has_value());
  EXPECT_THAT(found->arguments, ElementsAre("caf\xef\xbf\xbd.csv"));
}

TEST(FindRecord, OfFilesWithoutOneIsEmpty) {
  const test::TempDir dir;
  for (const std::string& path :
       {dir.file("empty", ""), dir.file("case.toml", "[pulse]\n"), dir.file("trace.csv", "# a = 1\ntime_s,a_g\n0,1\n"),
        dir.file("late.csv", "time_s\n# record = {}\n"),
        dir.file("model.json", "{\"format\": \"crashsim.crush_model\"}"),
        dir.file("other.json", "{\"record\": \"of the year\"}")})
    EXPECT_FALSE(find_record(path).has_value()) << path;
}

TEST(FindRecord, RefusesADamagedOne) {
  const test::TempDir dir;
  EXPECT_THAT([&] { find_record(dir.file("a.csv", "# record = {\"format\"\n")); },
              ThrowsMessage<InvalidInput>(HasSubstr("a.csv:1: is not JSON: ")));
  EXPECT_THAT([&] { find_record(dir.file("b.json", R"({"format": "crashsim.record", "version": 1})")); },
              ThrowsMessage<InvalidInput>(HasSubstr("b.json: its record has no proper 'version'")));
  EXPECT_THAT([&] { find_record(dir.path("none.json")); },
              ThrowsMessage<InvalidInput>(HasSubstr("none.json: no such file")));
}

TEST(VerifyInputs, RefusesChangedAndLostOnes) {
  const test::TempDir dir;
  const Record record = sample_record(dir);
  verify_inputs(record);
  dir.file("t.csv", "abd");
  EXPECT_THAT([&] { verify_inputs(record); },
              ThrowsMessage<InvalidInput>(
                  AllOf(HasSubstr("t.csv: has changed since the record was made"), HasSubstr("ba7816bf8f01.. then"))));
  std::filesystem::remove(dir.path("t.csv"));
  EXPECT_THAT([&] { verify_inputs(record); }, ThrowsMessage<InvalidInput>(HasSubstr("t.csv: no such file")));
}

}  // namespace
}  // namespace crashsim
