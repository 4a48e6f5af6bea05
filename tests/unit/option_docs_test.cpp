#include <crashsim/option_docs.hpp>

#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/identify.hpp>
#include <crashsim/pulse.hpp>
#include <crashsim/simulate.hpp>

namespace crashsim {
namespace {

using testing::IsEmpty;
using testing::Not;

template <class S>
FieldDescription described(std::string_view name) {
  return describe_field(find_field<S>(name, "test"));
}

TEST(TextOf, AnOptionReadsBackAsTheSameValue) {
  EXPECT_EQ(text_of(OptionValue()), "");
  EXPECT_EQ(text_of(OptionValue(true)), "true");
  EXPECT_EQ(text_of(OptionValue(std::int64_t{1} << 62)), "4611686018427387904");
  EXPECT_EQ(text_of(OptionValue(60.0)), "60");
  EXPECT_EQ(std::stod(text_of(OptionValue(0.1 + 0.2))), 0.1 + 0.2);
  EXPECT_EQ(text_of(OptionValue(std::string("56 km/h"))), "56 km/h");
  EXPECT_EQ(text_of(OptionValue(std::vector<double>{0.0, 0.25, 1.0})), "0,0.25,1");
  EXPECT_EQ(text_of(OptionValue(std::vector<std::string>{"93", "94"})), "93,94");
  EXPECT_EQ(text_of(OptionValue(std::vector<std::string>{})), "");
}

TEST(TextOf, ARangeIsARule) {
  EXPECT_EQ(text_of(any_number()), "");
  EXPECT_EQ(text_of(positive()), "> 0");
  EXPECT_EQ(text_of(at_least(2.5)), ">= 2.5");
  EXPECT_EQ(text_of(between(1, 100)), ">= 1 and <= 100");
  EXPECT_EQ(text_of(Range{.max = 3.0}), "<= 3");
}

TEST(DescribeField, TellsUnitDefaultRangeAndChoices) {
  const FieldDescription cfc = described<PulseOptions>("cfc");
  EXPECT_EQ(cfc.unit, "Hz");
  EXPECT_EQ(cfc.default_value, "60");
  EXPECT_EQ(cfc.range, ">= 0");
  EXPECT_EQ(described<IdentifyOptions>("loss").choices, "l1, l2, huber");
  EXPECT_EQ(described<IdentifyOptions>("loss").default_value, "l1");
  EXPECT_EQ(described<IdentifyOptions>("knots").choices, "uniform, quantile, free, or numbers");
  EXPECT_EQ(described<IdentifyOptions>("mass").default_value, "");
  EXPECT_EQ(described<SimulateOptions>("to-max-crush").default_value, "false");
}

TEST(DescribeField, GivesTheDefaultsAskedFor) {
  IdentifyOptions options;
  options.starts = 5;
  EXPECT_EQ(describe_field(find_field<IdentifyOptions>("starts", "test"), options).default_value, "5");
}

template <class S>
void expect_documented() {
  for (const Field<S>& field : fields<S>) {
    EXPECT_THAT(describe_field(field).doc, Not(IsEmpty())) << field.name;
    EXPECT_EQ(field.flag.find('_'), std::string_view::npos) << field.flag;
  }
}

TEST(DescribeField, EveryOptionHasWordsAndAFlagOfTheShell) {
  expect_documented<PulseOptions>();
  expect_documented<IdentifyOptions>();
  expect_documented<SimulateOptions>();
}

}  // namespace
}  // namespace crashsim
