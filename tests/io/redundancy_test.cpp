#include <crashsim/redundancy.hpp>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include <gmock/gmock.h>

#include <crashsim/pulse.hpp>
#include <crashsim/trace_io.hpp>

#include "support/nhtsa_files.hpp"
#include "support/shared_data.hpp"

namespace crashsim {
namespace {

using test::NhtsaRecord;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Signal = std::function<double(double)>;

double pulse_g(double t) { return t > 0.0 && t < 0.1 ? -20.0 * std::sin(std::numbers::pi * t / 0.1) : 0.0; }

/// A test with a primary channel and another one of the same place.
class Redundancy : public testing::Test {
 protected:
  NhtsaRecord primary{.curve = 1, .comment = "LEFT REAR X", .first = "-500", .last = "1999"};
  NhtsaRecord redundant{.curve = 2, .comment = "LEFT REAR XR", .first = "-500", .last = "1999", .channel_status = "R"};

  [[nodiscard]] std::string write(const Signal& other, const Signal& first = pulse_g) const {
    dir.file("v01.001", test::sample_rows(primary, first));
    dir.file("v01.002", test::sample_rows(redundant, other));
    return dir.file("v01.EV5", test::header_text({primary, redundant}));
  }
  [[nodiscard]] std::vector<std::string> findings(const Signal& other) const {
    return check_redundant(read_traces(write(other)));
  }

  test::TempDir dir;
};

TEST_F(Redundancy, ChannelsThatAgreeAreNotSpokenOf) {
  EXPECT_THAT(findings(pulse_g), IsEmpty());
  EXPECT_THAT(findings([](double t) { return 1.05 * pulse_g(t); }), IsEmpty());
  EXPECT_THAT(findings([](double t) { return pulse_g(t - 0.0005); }), IsEmpty());
  EXPECT_THAT(findings([](double t) { return pulse_g(t) + 0.3; }), IsEmpty());
}

TEST_F(Redundancy, OppositeSignsAreFound) {
  EXPECT_THAT(findings([](double t) { return -pulse_g(t); }),
              ElementsAre("channel 1 LEFT REAR X and its redundant channel 2 LEFT REAR XR have opposite signs"));
}

TEST_F(Redundancy, OffsetsShiftsAndScalesAreFound) {
  EXPECT_THAT(findings([](double t) { return pulse_g(t) + 1.0; }),
              ElementsAre(HasSubstr("differ by an offset of 5 % of")));
  EXPECT_THAT(findings([](double t) { return pulse_g(t - 0.003); }), Contains(HasSubstr("are 3 ms apart in time")));
  EXPECT_THAT(findings([](double t) { return 1.2 * pulse_g(t); }), ElementsAre(HasSubstr("differ by 20 % (root mean")));
}

TEST_F(Redundancy, ShiftsAreFoundInFastRecordsToo) {
  for (NhtsaRecord* record : {&primary, &redundant}) {
    record->first = "-5000";
    record->last = "12000";
    record->step = "10";
  }
  EXPECT_THAT(findings(pulse_g), IsEmpty());
  EXPECT_THAT(findings([](double t) { return pulse_g(t - 0.003); }), Contains(HasSubstr("are 3 ms apart in time")));
  EXPECT_THAT(findings([](double t) { return -pulse_g(t); }), ElementsAre(HasSubstr("have opposite signs")));
}

TEST_F(Redundancy, OnlyChannelsOfOnePlaceAndGoodOnesAreCompared) {
  const auto far = [](double t) { return 3.0 * pulse_g(t); };
  redundant.attachment = "FLRR";
  EXPECT_THAT(findings(far), IsEmpty());
  redundant.attachment = primary.attachment;
  redundant.axis = "ZG";
  EXPECT_THAT(findings(far), IsEmpty());
  redundant.axis = primary.axis;
  redundant.data_status = "QD";
  EXPECT_THAT(findings(far), IsEmpty());
}

TEST_F(Redundancy, SeveralPrimariesOfOnePlaceAreToldApartByTheirComments) {
  NhtsaRecord other = primary;
  other.curve = 3;
  other.comment = "BOTTOM X";
  const std::string header = write(pulse_g);
  dir.file("v01.003", test::sample_rows(other, [](double t) { return 3.0 * pulse_g(t); }));
  dir.file("v01.EV5", test::header_text({other, primary, redundant}));
  EXPECT_THAT(check_redundant(read_traces(header, {.channels = {"1", "2", "3"}, .columns = "", .units = ""})),
              testing::Not(Contains(HasSubstr("redundant"))));
}

TEST_F(Redundancy, SidesOfTheCompartmentMustLoseTheSameSpeed) {
  redundant.channel_status = "P";
  redundant.attachment = "FLRR";
  redundant.comment = "RIGHT REAR X";
  EXPECT_THAT(findings([](double t) { return 1.04 * pulse_g(t); }), IsEmpty());
  const std::string header = write([](double t) { return 1.2 * pulse_g(t); });
  const auto expected =
      HasSubstr("compartment channels 1 LEFT REAR X and 2 RIGHT REAR X change speed by -12.49 and -14.98");
  EXPECT_THAT(check_redundant(read_traces(header)), ElementsAre(expected));
  EXPECT_THAT(inspect_traces(header).set.warnings, Contains(expected));
  EXPECT_THAT(read_pulse(header).warnings, Contains(expected));
}

TEST_F(Redundancy, TheSidesOfTheCamryAgree) {
  const auto header = test::shared_data("nhtsa-10146/v10146.EV5");
  if (!header) GTEST_SKIP() << test::kNoSharedData;
  EXPECT_THAT(check_redundant(read_traces(header->string())), IsEmpty()) << "17.9 and 18.2 m/s";
}

}  // namespace
}  // namespace crashsim
