#include <crashsim/metrics.hpp>

#include <cmath>
#include <vector>

#include <gmock/gmock.h>

namespace crashsim {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kRounding = 1e-12;

TEST(Kw400, OfALinearSpringIsItsStiffness) {
  const std::vector<double> crush{0.0, 0.013, 0.3, 0.51, 0.49};
  std::vector<double> force(crush);
  for (double& value : force) value *= 1.2e6;
  EXPECT_NEAR(kw400(crush, force) / 1.2e6, 1.0, kRounding);
}

TEST(Kw400, OfAConstantForceIsTheClosedForm) {
  // 2 F (0.4 - 0.025) / (0.4^2 - 0.025^2) = 2 F / 0.425
  EXPECT_NEAR(kw400(std::vector{0.0, 0.6}, std::vector{300e3, 300e3}) * 0.425 / 600e3, 1.0, kRounding);
}

TEST(Kw400, EndsWhereCrushFirstReaches400Millimetres) {
  const std::vector<double> crush{0.0, 0.4, 0.5, 0.3, 0.45}, force{1e5, 1e5, 9e9, 9e9, 9e9};
  EXPECT_NEAR(kw400(crush, force) * 0.425 / 2e5, 1.0, kRounding);
}

TEST(Kw400, IsUnsetWhenCrushDoesNotCoverTheRange) {
  EXPECT_TRUE(std::isnan(kw400(std::vector{0.0, 0.399}, std::vector{1.0, 1.0})));
  EXPECT_TRUE(std::isnan(kw400(std::vector{0.03, 0.5}, std::vector{1.0, 1.0})));
}

TEST(Kw400, RefusesUnequalLengths) {
  EXPECT_THAT(
      [] {
        kw400(std::vector{0.0, 1.0}, std::vector{1.0});
      },
      ThrowsMessage<InvalidInput>(HasSubstr("2 crush samples but 1 force samples")));
}

TEST(Ahof400, WeighsHeightsByForce) {
  const std::vector<double> crush{0.0, 0.025, 0.2, 0.2, 0.4}, force{0.0, 1e5, 1e5, 3e5, 3e5};
  const std::vector<double> height{0.9, 0.4, 0.4, 0.5, 0.5};
  EXPECT_NEAR(ahof400(crush, force, height), (0.175 * 0.4 + 3.0 * 0.2 * 0.5) / (0.175 + 3.0 * 0.2), kRounding);
  EXPECT_TRUE(std::isnan(ahof400(std::vector{0.0, 0.3}, std::vector{1.0, 1.0}, std::vector{1.0, 1.0})));
}

TEST(Crash3Stiffness, GivesBackTheEnergyOfTheTest) {
  constexpr double kMass = 1354.0, kSpeed = 15.6464, kCrush = 0.45, kWidth = 1.6;
  const Crash3 c = crash3_stiffness(kMass, kSpeed, kCrush, kWidth);
  const double energy = kWidth * (c.g_n + c.a_n_per_m * kCrush + c.b_n_per_m2 * kCrush * kCrush / 2.0);
  EXPECT_NEAR(energy / (kMass * kSpeed * kSpeed / 2.0), 1.0, kRounding);
  EXPECT_NEAR(energy_equivalent_speed(energy, kMass) / kSpeed, 1.0, kRounding);
  EXPECT_NEAR(c.a_n_per_m / c.b_n_per_m2, 2.2352 * kCrush / (kSpeed - 2.2352), kRounding);
}

TEST(Crash3Stiffness, RefusesImpossibleTests) {
  EXPECT_THAT([] { crash3_stiffness(0.0, 15.0, 0.5, 1.6); },
              ThrowsMessage<InvalidInput>(HasSubstr("mass_kg = 0 kg: must be > 0")));
  EXPECT_THAT([] { crash3_stiffness(1000.0, 2.0, 0.5, 1.6); },
              ThrowsMessage<InvalidInput>(HasSubstr("impact_speed_mps = 2 m/s: must be > no_damage_speed_mps")));
  EXPECT_THAT([] { energy_equivalent_speed(-1.0, 1000.0); },
              ThrowsMessage<InvalidInput>(HasSubstr("energy_j = -1 J: must be >= 0")));
}

}  // namespace
}  // namespace crashsim
