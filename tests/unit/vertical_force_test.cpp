#include <crashsim/vertical_force.hpp>

#include <cmath>

#include <gmock/gmock.h>

#include <crashsim/option_docs.hpp>

#include "support/crush_cases.hpp"

namespace crashsim {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kRounding = 1e-14;

TEST(VerticalForce, TheDefaultLawGivesNone) {
  EXPECT_FALSE(is_active({}));
  EXPECT_EQ(vertical_ratio({}, 0.5), 0.0);
  EXPECT_TRUE(is_active({.angle_rad = -0.1}));
  EXPECT_TRUE(is_active({.angle_rate_rad_per_m = 0.1}));
  EXPECT_FALSE(is_active({.angle_rad = 0.1, .friction = 0.0}));
}

TEST(VerticalForce, TheAngleChangesWithCrushFromItsStart) {
  const VerticalForceLaw law{.angle_rad = 0.1, .angle_rate_rad_per_m = 0.5, .angle_start_m = 0.2};
  EXPECT_NEAR(vertical_ratio(law, -0.1), std::tan(0.1), kRounding);
  EXPECT_NEAR(vertical_ratio(law, 0.2), std::tan(0.1), kRounding);
  EXPECT_NEAR(vertical_ratio(law, 0.6), std::tan(0.3), kRounding);
}

TEST(VerticalForce, FrictionBoundsItToBothSides) {
  VerticalForceLaw law{.angle_rad = 0.1, .angle_rate_rad_per_m = 4.0, .friction = 0.25};
  EXPECT_NEAR(vertical_ratio(law, 0.01), std::tan(0.14), kRounding);
  EXPECT_NEAR(vertical_ratio(law, 0.5), 0.25, kRounding);  // the angle would be 2.1 rad
  law.angle_rate_rad_per_m = -4.0;
  EXPECT_NEAR(vertical_ratio(law, 0.5), -0.25, kRounding);
}

TEST(VerticalForce, ACrushMotionGivesASeries) {
  const CrushResponse crush = simulate(test::syn_a());
  const VerticalForceLaw law{.angle_rad = 0.1, .angle_rate_rad_per_m = 0.5, .angle_start_m = 0.2};
  const TimeSeries force = vertical_force(law, crush);
  ASSERT_EQ(force.values.size(), crush.time_s.size());
  EXPECT_EQ(force.time_s, crush.time_s);
  const std::size_t i = 300;
  EXPECT_NEAR(force.values[i], -2582.0 * crush.accel_mps2[i] * std::tan(0.1 + 0.5 * (crush.displacement_m[i] - 0.2)),
              kRounding * 1e7);
  EXPECT_EQ(force.values.back(), 0.0);  // contact is lost
}

TEST(VerticalForce, RefusesWhatHasNoMeaning) {
  EXPECT_THAT(
      [] { validate(VerticalForceLaw{.angle_rad = 1.6}); },
      ThrowsMessage<InvalidInput>(HasSubstr("VerticalForceLaw.angle_rad = 1.6 rad: must be >= -1.5 and <= 1.5")));
  EXPECT_THAT([] { validate(VerticalForceLaw{.angle_start_m = -0.1}); },
              ThrowsMessage<InvalidInput>(HasSubstr("VerticalForceLaw.angle_start_m = -0.1 m: must be >= 0")));
  EXPECT_THAT([] { validate(VerticalForceLaw{.friction = -0.1}); },
              ThrowsMessage<InvalidInput>(HasSubstr("VerticalForceLaw.friction = -0.1: must be >= 0 and <= 10")));
  EXPECT_THAT([] { (void)vertical_ratio({.angle_rate_rad_per_m = 4.0}, 0.5); },
              ThrowsMessage<InvalidInput>(
                  AllOf(HasSubstr("the angle is 2 rad at a crush of 0.5 m"), HasSubstr("give friction"))));
  EXPECT_THAT([] { (void)vertical_force({.angle_rad = 0.1}, {}); },
              ThrowsMessage<InvalidInput>(HasSubstr("the crush response holds no motion (not_run)")));
}

TEST(VerticalForce, OptionsAreDescribed) {
  for (const Field<VerticalForceLaw>& field : fields<VerticalForceLaw>)
    EXPECT_FALSE(describe_field(field).doc.empty()) << field.name;
  VerticalForceLaw law;
  set_option(law, find_field<VerticalForceLaw>("angle-rate", "test"), std::string("90deg/m"), "angle-rate");
  EXPECT_NEAR(law.angle_rate_rad_per_m, std::acos(0.0), kRounding);
}

}  // namespace
}  // namespace crashsim
