/// NHTSA test 10146, 2018 Toyota Camry at 57.09 km/h into a rigid load-cell wall: crush, time, peak and restitution of
/// the rear seat cross-member, offset by the mean before impact, CFC60.

#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/pulse.hpp>
#include <crashsim/units.hpp>

#include "support/shared_data.hpp"

namespace crashsim {
namespace {

/// A number and half of the last digit it is known to (kind: regression).
struct Known {
  double value, half_digit;
};

struct Row {
  std::vector<std::string> channels;
  Known crush_m, t_m_s, peak_g, restitution;
};
void PrintTo(const Row& row, std::ostream* out) {
  *out << "channels";
  for (const auto& channel : row.channels) *out << "_" << channel;
}

void expect(double value, const Known& known, const char* what) {
  EXPECT_NEAR(value, known.value, known.half_digit) << what;
}

class Camry : public testing::TestWithParam<Row> {};

TEST_P(Camry, CrushesAsPublished) {
  const auto path = test::shared_data("nhtsa-10146/v10146.EV5");
  if (!path) GTEST_SKIP() << test::kNoSharedData;
  PulseOptions options;
  options.channels = GetParam().channels;
  const Pulse pulse = read_pulse(path->string(), options);
  EXPECT_EQ(pulse.mass_kg, 1719);
  const auto smallest = [](const std::vector<double>& values) {
    return *std::min_element(values.begin(), values.end());
  };
  expect(pulse.max_crush_m, GetParam().crush_m, "maximum crush");
  expect(pulse.t_m_s, GetParam().t_m_s, "time of maximum crush");
  expect(-smallest(pulse.accel_mps2) / kStandardGravity, GetParam().peak_g, "peak deceleration");
  expect(-smallest(pulse.velocity_mps) / pulse.impact_speed_mps, GetParam().restitution, "restitution");
  EXPECT_THAT(pulse.warnings, testing::IsEmpty());
}

constexpr Known kMeanCrush{0.7460, 5e-5}, kMeanTime{0.073963, 5e-7}, kMeanPeak{40.937, 5e-4},
    kMeanRestitution{0.164, 5e-4};
INSTANTIATE_TEST_SUITE_P(
    Channels, Camry,
    testing::Values(Row{{"93"}, {0.75055, 5e-6}, {0.074205, 5e-7}, {45.419, 5e-4}, {0.15799, 5e-6}},
                    Row{{"94"}, {0.7415, 5e-5}, {0.0737, 5e-5}, {39.6, 0.05}, {0.171, 5e-4}},
                    Row{{"93", "94"}, kMeanCrush, kMeanTime, kMeanPeak, kMeanRestitution},
                    Row{{}, kMeanCrush, kMeanTime, kMeanPeak, kMeanRestitution}));

}  // namespace
}  // namespace crashsim
