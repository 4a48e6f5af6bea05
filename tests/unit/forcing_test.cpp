#include <crashsim/forcing.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <crashsim/error.hpp>
#include <crashsim/option_values.hpp>
#include <crashsim/outputs.hpp>

#include "support/shared_data.hpp"
#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

constexpr double kPeak = 50e3, kDuration = 0.1;  // [N], [s]

double half_sine(double t) { return t < kDuration ? kPeak * std::sin(std::numbers::pi * t / kDuration) : 0.0; }
double its_impulse(double t) {
  const double reach = std::min(t, kDuration);
  return kPeak * kDuration / std::numbers::pi * (1.0 - std::cos(std::numbers::pi * reach / kDuration));
}

/// A table of columns that are functions of time, 0 to 0.15 s.
std::string table(std::string_view header, const std::vector<std::function<double(double)>>& columns) {
  constexpr int kSamples = 1501;
  std::string text = fmt::format("time_s,{}\n", header);
  for (int i = 0; i < kSamples; ++i) {
    const double t = 1e-4 * i;
    text += fmt::format("{:.4f}", t);
    for (const auto& column : columns) text += fmt::format(",{:.12g}", column(t));
    text += '\n';
  }
  return text;
}

using Names = std::vector<std::string>;
using Given = std::vector<std::pair<const char*, OptionValue>>;

class Forcing : public testing::Test {
 protected:
  [[nodiscard]] MeasuredForcing read(const std::string& text, const Given& given) const {
    ForcingOptions options;
    for (const auto& [flag, value] : given)
      set_option(options, find_field<ForcingOptions>(flag, "forcing"), value, flag);
    options.file = dir.file("force.csv", text);
    return read_forcing(options);
  }

  test::TempDir dir;
};

double value_at(const TimeSeries& series, double t) {
  const auto i = static_cast<std::size_t>(std::lower_bound(series.time_s.begin(), series.time_s.end(), t - 1e-9) -
                                          series.time_s.begin());
  return series.values.at(i);
}

TEST_F(Forcing, AnImpulseIsDifferentiated) {
  const std::string text = table("FTZ [N s]", {its_impulse});
  const MeasuredForcing plain = read(text, {{"channel", Names{"FTZ"}}, {"cfc", 0.0}});
  const MeasuredForcing filtered = read(text, {{"channel", Names{"FTZ"}}});
  EXPECT_THAT(plain.forcing.longitudinal_force_n.time_s, IsEmpty());
  for (const double t : {0.01, 0.03, 0.05, 0.08}) {
    EXPECT_NEAR(value_at(plain.forcing.vertical_force_n, t), half_sine(t), 2e-6 * kPeak) << t;  // pi^2 dt^2 / 6 / T^2
    EXPECT_NEAR(value_at(filtered.forcing.vertical_force_n, t), half_sine(t), 1e-2 * kPeak) << t;
  }
  EXPECT_THAT(plain.steps, ElementsAre("channel FTZ: impulse differentiated"));
  EXPECT_THAT(filtered.steps, ElementsAre("channel FTZ: impulse differentiated, filtered by CFC60"));
}

TEST_F(Forcing, ForcesAddUpUnfilteredAndMayPointUp) {
  const std::string text = table("A_N,B_kN", {half_sine, [](double t) { return half_sine(t) / 2000.0; }});
  const MeasuredForcing down = read(text, {{"channel", Names{"?_*N", "A_N"}}});
  const MeasuredForcing up = read(text, {{"channel", Names{"A_N", "B_kN"}}, {"vertical-sign", "up"}});
  for (const double t : {0.01, 0.05}) {
    EXPECT_NEAR(value_at(down.forcing.vertical_force_n, t), 1.5 * half_sine(t), 1e-9 * kPeak);
    EXPECT_NEAR(value_at(up.forcing.vertical_force_n, t), -1.5 * half_sine(t), 1e-9 * kPeak);
  }
}

TEST_F(Forcing, TheLongitudinalForceStopsTheVehicleWhateverItsSign) {
  const std::string text = table("F_N", {[](double t) { return -half_sine(t); }});
  const MeasuredForcing measured = read(text, {{"longitudinal", Names{"F_N"}}});
  EXPECT_NEAR(value_at(measured.forcing.longitudinal_force_n, 0.05), kPeak, 1e-9 * kPeak);
  EXPECT_THAT(measured.steps, testing::Contains(HasSubstr("sign turned")));
}

TEST_F(Forcing, RowsGiveTheHeightOfTheForce) {
  const auto upper = [](double t) { return half_sine(t) * t / kDuration; };
  const auto lower = [](double t) { return half_sine(t) * (1.0 - t / kDuration); };
  const MeasuredForcing measured =
      read(table("upper_N,lower_N", {upper, lower}),
           {{"longitudinal", Names{"upper_N", "lower_N"}}, {"row-heights", std::vector{0.8, 0.3}}});
  EXPECT_NEAR(value_at(measured.forcing.longitudinal_force_n, 0.05), kPeak, 1e-9 * kPeak);
  for (const double t : {0.02, 0.05, 0.09})
    EXPECT_NEAR(value_at(measured.forcing.force_height_m, t), 0.3 + 0.5 * t / kDuration, 1e-9) << t;
  EXPECT_GT(measured.forcing.force_height_m.time_s.front(), 0.0);  // not where the force is noise
}

TEST_F(Forcing, TheTimeOfMaximumCrushIsWhereTheVelocityEnds) {
  const std::string text = table("F_N,VX [mm/s]", {half_sine, [](double t) { return -15e3 + 200e3 * t; }});
  EXPECT_NEAR(read(text, {{"channel", Names{"F_N"}}, {"velocity", Names{"VX"}}}).forcing.t_m_s, 0.075, 1e-9);
  EXPECT_TRUE(std::isnan(read(text, {{"channel", Names{"F_N"}}}).forcing.t_m_s));
  EXPECT_EQ(read(text, {{"channel", Names{"F_N"}}, {"t-m", 0.06}, {"velocity", Names{"VX"}}}).forcing.t_m_s, 0.06);
}

TEST_F(Forcing, OfAResponseFileIsThatOfTheResponse) {
  CrushModel model;
  model.mass_kg = 1500.0;
  model.spring = {{0.0, 1.0}, {1e6, 2e6}};
  model.damper = {{0.0, 20.0}, {1e3, 2e3}};
  SimulateOptions options;
  options.impact_speed_mps = 15.0;
  const CrushResponse response = simulate(model, options);
  const PitchForcing direct = forcing_of(response);
  const MeasuredForcing read_back = read(format_response(response, model.mass_kg, Record{}), {});
  ASSERT_EQ(read_back.forcing.longitudinal_force_n.values.size(), direct.longitudinal_force_n.values.size());
  for (std::size_t i = 0; i < direct.longitudinal_force_n.values.size(); i += 100)
    EXPECT_NEAR(read_back.forcing.longitudinal_force_n.values[i], direct.longitudinal_force_n.values[i], 1e-6);
  EXPECT_NEAR(read_back.forcing.t_m_s, response.t_m_s, 1e-6);
  EXPECT_EQ(direct.t_m_s, response.t_m_s);
}

TEST_F(Forcing, OfALoadCellWallMovesUpAsTheRowsSay) {
  const auto rows = test::shared_data("nhtsa-10146/barrier_rows_cfc60.csv");
  if (!rows) GTEST_SKIP() << test::kNoSharedData;
  constexpr double kCell = 0.125;  // [m]
  constexpr int kRows = 11;
  ForcingOptions options;
  options.file = rows->string();
  options.longitudinal_channels = {"row_*"};
  for (int i = 0; i < kRows; ++i) options.row_heights_m.push_back(kCell * (kRows - i - 0.5));  // row A is on top
  const PitchForcing forcing = read_forcing(options).forcing;
  constexpr double kHeightAt20ms = 0.385, kHeightAt65ms = 0.449, kDigits = 0.002;
  EXPECT_NEAR(value_at(forcing.force_height_m, 0.020), kHeightAt20ms, kDigits);
  EXPECT_NEAR(value_at(forcing.force_height_m, 0.065), kHeightAt65ms, kDigits);
}

TEST_F(Forcing, WhatCannotBeUsedIsRefusedWithFileAndChannel) {
  const std::string text = table("F_N,h_m,v_mps", {half_sine, [](double) { return 0.4; }, half_sine});
  const auto refused = [&](const Given& given, const std::string& message) {
    EXPECT_THAT([&] { static_cast<void>(read(text, given)); }, ThrowsMessage<InvalidInput>(HasSubstr(message)));
  };
  refused({}, "force.csv: say which channels are the vertical force (channel) or the longitudinal force");
  refused({{"channel", Names{"h_m"}}}, "channel 3 h_m: measures length; a force or an impulse is needed");
  refused({{"channel", Names{"G_N"}}}, "G_N");
  refused({{"longitudinal", Names{"F_N"}}, {"height", Names{"v_mps"}}},
          "channel 4 v_mps: measures speed; a height in m is needed");
  refused({{"longitudinal", Names{"F_N"}}, {"row-heights", std::vector{0.1, 0.2}}},
          "row_heights_m has 2 heights for 1 longitudinal channels");
  refused({{"longitudinal", Names{"F_N"}}, {"row-heights", std::vector{0.1}}, {"height", Names{"h_m"}}}, "given twice");
  refused({{"channel", Names{"F_N"}}, {"velocity", Names{"h_m"}}}, "measures length; a velocity is needed");
  refused({{"channel", Names{"F_N"}}, {"cfc", -1.0}}, "cfc = -1 Hz: must be >= 0");
  refused({{"channel", Names{"F_N"}}, {"cfc", 1500.0}}, "channel 2 F_N: ");
}

}  // namespace
}  // namespace crashsim
