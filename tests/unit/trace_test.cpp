#include <crashsim/trace.hpp>

#include <gmock/gmock.h>

namespace crashsim {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

TraceSet four_channels() {
  TraceSet set;
  set.path = "run.csv";
  for (const auto& [id, name] : {std::pair("93", "LEFT REAR X"), std::pair("94", "RIGHT REAR X"),
                                 std::pair("193", "LEFT REAR Z"), std::pair("10SEATLERE00ACXP", "94")}) {
    Trace trace;
    trace.id = id;
    trace.name = name;
    set.traces.push_back(trace);
  }
  return set;
}

TEST(SelectChannels, TakesNumbersNamesCodesAndGlobs) {
  const TraceSet set = four_channels();
  EXPECT_THAT(select_channels(set, "93"), ElementsAre(0));
  EXPECT_THAT(select_channels(set, "093"), ElementsAre(0)) << "as the file of channel 93 is called";
  EXPECT_THAT(select_channels(set, "RIGHT REAR X"), ElementsAre(1));
  EXPECT_THAT(select_channels(set, "10SEATLERE00ACXP"), ElementsAre(3));
  EXPECT_THAT(select_channels(set, "*rear x"), ElementsAre(0, 1));
  EXPECT_THAT(select_channels(set, "10SEAT????00ACX?"), ElementsAre(3));
  EXPECT_THAT(select_channels(set, "9[34]"), ElementsAre(0, 1, 3));
}

TEST(SelectChannels, AnExactIdWinsOverAName) { EXPECT_THAT(select_channels(four_channels(), "94"), ElementsAre(1)); }

TEST(SelectChannels, NamesTheNearestWhenNothingMatches) {
  EXPECT_THAT([] { select_channels(four_channels(), "left rear y"); },
              ThrowsMessage<InvalidInput>(AllOf(HasSubstr("run.csv: no channel 'left rear y' among 4; nearest: "),
                                                HasSubstr("nearest: 93 (LEFT REAR X), 193 (LEFT REAR Z)"))));
}

}  // namespace
}  // namespace crashsim
