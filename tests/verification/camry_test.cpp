/// NHTSA test 10146, 2018 Toyota Camry at 57.09 km/h into a rigid load-cell wall: crush, time, peak, restitution and
/// pulse indices of the rear seat cross-member, offset by the mean before impact, CFC60.

#include <algorithm>
#include <functional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/pulse.hpp>
#include <crashsim/signal.hpp>
#include <crashsim/summary.hpp>
#include <crashsim/trace_io.hpp>
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
  Known crush_m, t_m_s, peak_g, restitution, olc_g, sm25_g, vpi_g;
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

TEST_P(Camry, HasThePublishedIndices) {
  const auto path = test::shared_data("nhtsa-10146/v10146.EV5");
  if (!path) GTEST_SKIP() << test::kNoSharedData;
  PulseOptions options;
  options.channels = GetParam().channels;
  const Pulse pulse = read_pulse(path->string(), options);
  const Metrics m = metrics_of(pulse);
  expect(m.olc_g, GetParam().olc_g, "OLC");
  expect(m.sm25_g, GetParam().sm25_g, "SM25");
  expect(m.vpi_g, GetParam().vpi_g, "VPI");
  expect(m.restitution, GetParam().restitution, "restitution");
  expect(m.peak_decel_g, GetParam().peak_g, "peak deceleration");
  EXPECT_EQ(m.max_crush_m, pulse.max_crush_m);
  EXPECT_EQ(m.t_m_s, pulse.t_m_s);
  constexpr double kRounding = 1e-12;  // rounding: relative
  EXPECT_NEAR(m.centroid_s * pulse.impact_speed_mps, pulse.max_crush_m, kRounding * pulse.max_crush_m);
}

constexpr Known kMeanCrush{0.7460, 5e-5}, kMeanTime{0.073963, 5e-7}, kMeanPeak{40.937, 5e-4},
    kMeanRestitution{0.164, 5e-4}, kMeanOlc{29.41, 5e-3}, kMeanSm25{34.40, 5e-3}, kMeanVpi{59.90, 5e-3};
INSTANTIATE_TEST_SUITE_P(
    Channels, Camry,
    testing::Values(
        Row{{"93"},
            {0.75055, 5e-6},
            {0.074205, 5e-7},
            {45.419, 5e-4},
            {0.15799, 5e-6},
            {29.25, 5e-3},
            {34.72, 5e-3},
            {59.74, 5e-3}},
        Row{{"94"},
            {0.7415, 5e-5},
            {0.0737, 5e-5},
            {39.6, 0.05},
            {0.171, 5e-4},
            {29.57, 5e-3},
            {34.08, 5e-3},
            {60.06, 5e-3}},
        Row{{"93", "94"}, kMeanCrush, kMeanTime, kMeanPeak, kMeanRestitution, kMeanOlc, kMeanSm25, kMeanVpi},
        Row{{}, kMeanCrush, kMeanTime, kMeanPeak, kMeanRestitution, kMeanOlc, kMeanSm25, kMeanVpi}));

/// Force on the car [N] at the times of a pulse: the sum of the wall's rows of cells, which count it negative.
std::vector<double> wall_force(const TraceSet& rows, const Pulse& pulse) {
  std::vector<double> force(pulse.time_s.size(), 0.0);
  for (const Trace& row : rows.traces) {
    const std::vector<double> at = resample(row.times(), row.values, pulse.time_s);
    std::transform(force.begin(), force.end(), at.begin(), force.begin(), std::minus<>());
  }
  return force;
}

TEST(CamryWall, HasThePublishedImpulse) {
  const auto header = test::shared_data("nhtsa-10146/v10146.EV5");
  const auto rows = test::shared_data("nhtsa-10146/barrier_rows_cfc60.csv");
  if (!header || !rows) GTEST_SKIP() << test::kNoSharedData;
  const Pulse pulse = read_pulse(header->string());
  const TraceSet wall = read_traces(rows->string());
  ASSERT_EQ(wall.traces.size(), 11u);
  const std::vector<double> force = wall_force(wall, pulse);
  const auto end = std::upper_bound(pulse.time_s.begin(), pulse.time_s.end(), 0.15) - pulse.time_s.begin();
  const auto impulse = integrate(std::span(pulse.time_s).first(static_cast<std::size_t>(end)),
                                 std::span(force).first(static_cast<std::size_t>(end)), 0.0);
  expect(impulse.back(), {32807, 0.5}, "impulse over 150 ms [N s]");
}

}  // namespace
}  // namespace crashsim
