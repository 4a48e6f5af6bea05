#include <crashsim/config.hpp>

#include <ostream>
#include <string>
#include <variant>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/error.hpp>
#include <crashsim/identify.hpp>
#include <crashsim/pulse.hpp>

#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

std::vector<std::string> names_of(const std::vector<ConfigEntry>& entries) {
  std::vector<std::string> names;
  for (const ConfigEntry& entry : entries) names.push_back(entry.section + ":" + entry.key);
  return names;
}

TEST(ReadConfig, KeepsTheOrderOfTheFileAndTellsLines) {
  const test::TempDir dir;
  const std::string path = dir.file("a.toml", "z = 1\na = 2\n\n[second]\ny = 3\n# no\nb = 4\n[first]\nx = 5\n");
  const std::vector<ConfigEntry> entries = read_config(path);
  EXPECT_THAT(names_of(entries), ElementsAre(":z", ":a", "second:y", "second:b", "first:x"));
  EXPECT_EQ(entries[0].where, path + ":1");
  EXPECT_EQ(entries[3].where, path + ":7");
}

TEST(ReadConfig, JoinsKeysOfInlineAndDottedTables) {
  const test::TempDir dir;
  const std::vector<ConfigEntry> entries =
      read_config(dir.file("a.toml", "pulse.cfc = 60\n[pitch]\nforce = {file = \"f.csv\", channel = 2}\na.b = 1\n"));
  EXPECT_THAT(names_of(entries), ElementsAre("pulse:cfc", "pitch:force.file", "pitch:force.channel", "pitch:a.b"));
}

TEST(ReadConfig, TellsKindsOfValuesApart) {
  const test::TempDir dir;
  const std::vector<ConfigEntry> entries = read_config(
      dir.file("a.toml",
               "a = true\nb = 9223372036854775807\nc = 2.5\nd = \"56 km/h\"\ne = [1, 2.5]\nf = [\"x\", 93]\ng = []\n"));
  const std::vector<OptionValue> expected = {true,
                                             std::int64_t{9223372036854775807},
                                             2.5,
                                             std::string("56 km/h"),
                                             std::vector<double>{1.0, 2.5},
                                             std::vector<std::string>{"x", "93"},
                                             std::vector<std::string>{}};
  ASSERT_EQ(entries.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(entries[i].value, expected[i]) << entries[i].key;
}

TEST(ReadConfig, OfAnEmptyFileIsEmpty) {
  const test::TempDir dir;
  EXPECT_THAT(read_config(dir.file("a.toml", "# nothing\n[pulse]\n")), testing::IsEmpty());
}

struct Bad {
  const char* what;
  const char* text;
  const char* message;
};
void PrintTo(const Bad& b, std::ostream* out) { *out << b.what; }

class BadToml : public testing::TestWithParam<Bad> {};

TEST_P(BadToml, IsRefusedWithFileAndLine) {
  const test::TempDir dir;
  const std::string path = dir.file("bad.toml", GetParam().text);
  EXPECT_THAT([&] { read_config(path); },
              ThrowsMessage<InvalidInput>(AllOf(HasSubstr("bad.toml:"), HasSubstr(GetParam().message))));
}

INSTANTIATE_TEST_SUITE_P(
    Texts, BadToml,
    testing::Values(Bad{"no_value", "\na =\n", "bad.toml:2: is not TOML: "},
                    Bad{"key_twice", "a = 1\na = 2\n", "bad.toml:2: is not TOML: "},
                    Bad{"not_utf8", "a = \"\xe9\"\n", "bad.toml:1: is not TOML: "},
                    Bad{"date", "a = 1\nb = 2020-01-01\n", "bad.toml:2: b: must be a number, a text, true or false"},
                    Bad{"list_of_lists", "[x]\na = [[1]]\n", "bad.toml:2: a: a list must hold numbers or texts"},
                    Bad{"list_of_flags", "a = [true]\n", "bad.toml:1: a: a list must hold numbers or texts"},
                    Bad{"list_of_tables", "[[a]]\nb = 1\n", "a: a list must hold numbers or texts"}));

TEST(SetFrom, NamesPlaceKeyValueAndRule) {
  IdentifyOptions options;
  set_from(options, {"identify", "spring_knots", std::int64_t{5}, "case.toml:3"});
  set_from(options, {"identify", "spring-upper", std::string("2e6"), "case.toml:4"});
  EXPECT_EQ(options.spring_knots, 5);
  EXPECT_EQ(options.spring_upper, 2e6);
  EXPECT_THAT(
      [&] {
        set_from(options, {"identify", "starts", std::int64_t{0}, "case.toml:5"});
      },
      ThrowsMessage<InvalidInput>(HasSubstr("case.toml:5: starts = 0: must be >= 1")));
  EXPECT_THAT(
      [&] {
        set_from(options, {"identify", "start", std::int64_t{5}, "case.toml:6"});
      },
      ThrowsMessage<InvalidInput>(HasSubstr("case.toml:6: start: unknown name 'start', did you mean 'starts'?")));
}

/// Every digit of a whole number counts, also above 2^53 where doubles skip some.
TEST(SetFrom, KeepsLargeSeeds) {
  constexpr std::uint64_t kOdd = (std::uint64_t{1} << 62) + 1;
  IdentifyOptions options;
  set_from(options, {"", "seed", std::to_string(kOdd), "--seed"});
  EXPECT_EQ(options.seed, kOdd);
  EXPECT_THAT(
      [&] {
        set_from(options, {"", "seed", std::string("1e19"), "--seed"});
      },
      ThrowsMessage<InvalidInput>(HasSubstr("seed = 1e+19: is too large for a whole number")));
}

TEST(EntriesOf, ReadBackGiveTheSameOptions) {
  IdentifyOptions options;
  options.mass_kg = 0.1 + 0.2;
  options.seed = (std::uint64_t{1} << 62) + 1;
  options.loss = Loss::huber;
  options.weights = {Weights::given, {1.0, 1.0 / 3.0, 1e-300}};
  options.knots = {KnotPlacement::given, {0.0, 0.25, 0.75}};
  options.spring_upper = 2e6;
  IdentifyOptions back;
  for (const ConfigEntry& entry : entries_of(options, "identify")) {
    EXPECT_EQ(entry.section, "identify");
    set_from(back, entry);
  }
  back.damper_upper = options.damper_upper = back.rate_upper = options.rate_upper =
      1.0;  // unset ones are NaN, which equals nothing
  EXPECT_EQ(back, options);
}

}  // namespace
}  // namespace crashsim
