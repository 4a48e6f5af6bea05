#include <crashsim/metrics.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <ostream>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/units.hpp>

namespace crashsim {
namespace {

using testing::HasSubstr;
using testing::IsNan;
using testing::Not;
using testing::ThrowsMessage;

constexpr double kRounding = 1e-12;       // rounding: relative
constexpr double kBetweenSamples = 1e-7;  // solver: relative, a half sine as parabolas of 0.1 ms
constexpr double kStep_s = 1e-4;
constexpr double kMass_kg = 1500.0, kSpeed_mps = 15.0;

/// A motion that owns its samples.
struct Samples {
  std::vector<double> time_s, accel_mps2, velocity_mps, displacement_m;

  [[nodiscard]] Motion motion() const { return {time_s, accel_mps2, velocity_mps, displacement_m}; }
};

/// Constant deceleration `a` up to `stop_s`, then none.
Samples constant_deceleration(double a, double stop_s, double end_s, double begin_s = 0.0) {
  Samples s;
  const auto first = std::lround(begin_s / kStep_s), last = std::lround(end_s / kStep_s);
  for (long i = first; i <= last; ++i) {
    const double t = static_cast<double>(i) * kStep_s, braking = std::clamp(t, 0.0, stop_s);
    s.time_s.push_back(t);
    s.accel_mps2.push_back(t >= 0.0 && t <= stop_s ? -a : 0.0);
    s.velocity_mps.push_back(kSpeed_mps - a * braking);
    s.displacement_m.push_back(kSpeed_mps * t - a * braking * (t - 0.5 * braking));
  }
  return s;
}

Samples half_sine(double peak, double duration_s) {
  Samples s;
  const double w = std::numbers::pi / duration_s;
  for (long i = 0; i <= std::lround(duration_s / kStep_s); ++i) {
    const double t = static_cast<double>(i) * kStep_s;
    s.time_s.push_back(t);
    s.accel_mps2.push_back(-peak * std::sin(w * t));
    s.velocity_mps.push_back(kSpeed_mps - peak / w * (1.0 - std::cos(w * t)));
    s.displacement_m.push_back(kSpeed_mps * t - peak / w * (t - std::sin(w * t) / w));
  }
  return s;
}

void expect_relative(double value, double expected, double tolerance, const char* what) {
  EXPECT_NEAR(value, expected, tolerance * std::fabs(expected)) << what;
}

TEST(Metrics, OfConstantDecelerationAreClosedForms) {
  constexpr double kA = 200.0, kStop_s = 0.08, kEnd_s = 0.1;
  const Metrics m = metrics(constant_deceleration(kA, kStop_s, kEnd_s).motion(), kMass_kg);
  const double t_m = kSpeed_mps / kA, crush = kSpeed_mps * kSpeed_mps / (2.0 * kA), rebound = kSpeed_mps - kA * kStop_s;
  const double a_g = kA / kStandardGravity;
  expect_relative(m.t_m_s, t_m, kRounding, "t_m");
  expect_relative(m.max_crush_m, crush, kRounding, "C");
  expect_relative(m.peak_decel_g, a_g, kRounding, "peak");
  expect_relative(m.mean_decel_g, a_g, kRounding, "mean");
  expect_relative(m.centroid_s, 0.5 * t_m, kRounding, "centroid");
  expect_relative(m.delta_v_mps, kA * kStop_s, kRounding, "delta v");
  expect_relative(m.rebound_velocity_mps, rebound, kRounding, "rebound");
  expect_relative(m.restitution, -rebound / kSpeed_mps, kRounding, "restitution");
  expect_relative(m.static_crush_m, kSpeed_mps * kStop_s - 0.5 * kA * kStop_s * kStop_s, kRounding, "static crush");
  for (const double mean : {m.sm10_g, m.sm25_g, m.sm38_g, m.sm50_g}) expect_relative(mean, a_g, kRounding, "mean");
  expect_relative(m.asi, a_g / 12.0, kRounding, "ASI");
  expect_relative(m.energy_j, 0.5 * kMass_kg * kSpeed_mps * kSpeed_mps, kRounding, "energy");
  expect_relative(m.kw400_n_per_m, 2.0 * kMass_kg * kA * 0.375 / (0.16 - 0.025 * 0.025), kRounding, "KW400");
}

TEST(Metrics, OfAHalfSineAreClosedForms) {
  constexpr double kPeak = 260.0, kDuration_s = 0.1;
  const Metrics m = metrics(half_sine(kPeak, kDuration_s).motion(), kMass_kg);
  const double w = std::numbers::pi / kDuration_s;
  const double t_m = std::acos(1.0 - kSpeed_mps * w / kPeak) / w;
  const double crush = kSpeed_mps * t_m - kPeak / w * (t_m - std::sin(w * t_m) / w);
  expect_relative(m.t_m_s, t_m, kBetweenSamples, "t_m");
  expect_relative(m.max_crush_m, crush, kBetweenSamples, "C");
  expect_relative(m.mean_decel_g, kSpeed_mps / t_m / kStandardGravity, kBetweenSamples, "mean");
  expect_relative(m.centroid_s, crush / kSpeed_mps, kBetweenSamples, "centroid");
  expect_relative(m.peak_decel_g, kPeak / kStandardGravity, kRounding, "peak");
  expect_relative(m.delta_v_mps, 2.0 * kPeak / w, kRounding, "delta v");
  constexpr double kWindow_s = 0.05;  // centred on the peak
  expect_relative(m.sm50_g, 2.0 * kPeak / w * std::sin(0.5 * w * kWindow_s) / kWindow_s / kStandardGravity,
                  kBetweenSamples, "50 ms mean");
}

TEST(Metrics, AreThoseOfTheFunctionsForTheParts) {
  const Samples s = half_sine(260.0, 0.1);
  const Metrics m = metrics(s.motion(), kMass_kg);
  EXPECT_EQ(m.olc_g, occupant_load_criterion(s.time_s, s.velocity_mps, s.displacement_m).olc_g);
  EXPECT_EQ(m.vpi_g, vehicle_pulse_index(s.motion()) / kStandardGravity);
  EXPECT_EQ(m.sm25_g, sliding_mean_peak(s.time_s, s.velocity_mps, 0.025) / kStandardGravity);
}

TEST(Metrics, LeaveOutWhatIsBeforeImpact) {
  const Samples from_impact = constant_deceleration(200.0, 0.08, 0.1);
  const Samples with_rest = constant_deceleration(200.0, 0.08, 0.1, -0.02);
  const Metrics a = metrics(from_impact.motion(), kMass_kg), b = metrics(with_rest.motion(), kMass_kg);
  for (const MetricField& field : kMetricFields) EXPECT_EQ(a.*field.member, b.*field.member) << field.name;
}

TEST(Metrics, WithoutMaximumCrushLeaveUnsetWhatNeedsIt) {
  const Metrics m = metrics(constant_deceleration(100.0, 0.1, 0.12).motion(), kMass_kg);
  for (const double unset : {m.t_m_s, m.max_crush_m, m.static_crush_m, m.mean_decel_g, m.rebound_velocity_mps,
                             m.restitution, m.centroid_s, m.energy_j})
    EXPECT_THAT(unset, IsNan());
  expect_relative(m.delta_v_mps, 10.0, kRounding, "delta v");
  EXPECT_THAT(m.sm50_g, Not(IsNan()));
}

TEST(Metrics, WithoutMassLeaveUnsetWhatNeedsIt) {
  const Metrics m = metrics(constant_deceleration(200.0, 0.08, 0.1).motion());
  EXPECT_THAT(m.kw400_n_per_m, IsNan());
  EXPECT_THAT(m.energy_j, IsNan());
  EXPECT_THAT(m.restitution, Not(IsNan()));
}

TEST(Metrics, OfAMotionThatEndsInReboundLeaveTheReboundUnset) {
  const Metrics m = metrics(constant_deceleration(200.0, 0.1, 0.08).motion(), kMass_kg);
  EXPECT_THAT(m.t_m_s, Not(IsNan()));
  EXPECT_THAT(m.rebound_velocity_mps, IsNan());
  EXPECT_THAT(m.restitution, IsNan());
  EXPECT_THAT(m.static_crush_m, IsNan());
}

TEST(Metrics, OfAShortMotionLeaveTheLongWindowsUnset) {
  const Metrics m = metrics(constant_deceleration(600.0, 0.03, 0.03).motion(), kMass_kg);
  EXPECT_THAT(m.sm25_g, Not(IsNan()));
  EXPECT_THAT(m.sm38_g, IsNan());
  EXPECT_THAT(m.sm50_g, IsNan());
  EXPECT_THAT(m.asi, IsNan());
  EXPECT_THAT(m.kw400_n_per_m, IsNan()) << "crush does not reach 400 mm";
}

struct Spoiled {
  const char* what;
  std::function<void(Samples&)> spoil;
  const char* message;
};
void PrintTo(const Spoiled& s, std::ostream* out) { *out << s.what; }

class BadMotion : public testing::TestWithParam<Spoiled> {};

TEST_P(BadMotion, IsRefused) {
  Samples s = constant_deceleration(200.0, 0.08, 0.1);
  GetParam().spoil(s);
  EXPECT_THAT([&] { static_cast<void>(metrics(s.motion(), kMass_kg)); },
              ThrowsMessage<InvalidInput>(HasSubstr(GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(
    Motions, BadMotion,
    testing::Values(
        Spoiled{"lengths_differ", [](Samples& s) { s.velocity_mps.pop_back(); },
                "velocity_mps: 1001 times but 1000 values: the numbers must be equal"},
        Spoiled{"not_finite", [](Samples& s) { s.displacement_m[2] = kUnset; },
                "displacement_m: sample 3 at 0.0002 s is nan: must be finite"},
        Spoiled{"times_repeat", [](Samples& s) { s.time_s[3] = s.time_s[2]; },
                "accel_mps2: time of sample 4 is 0.0002 s, not after the one before it, 0.0002 s: times must increase"},
        Spoiled{"too_few", [](Samples& s) { s = constant_deceleration(200.0, 0.08, kStep_s, -0.1); },
                "accel_mps2: 2 samples: at least 3 are needed"},
        Spoiled{"nothing_after_impact", [](Samples& s) { s = constant_deceleration(200.0, 0.08, -kStep_s, -0.1); },
                "accel_mps2: 0 samples: at least 3 are needed"},
        Spoiled{"away_from_the_barrier", [](Samples& s) { s.velocity_mps.front() = -1.0; },
                "velocity_mps[0] = -1 m/s: must be > 0, towards the barrier"}));

TEST(BadMotion, MassMustBePositive) {
  const Samples s = constant_deceleration(200.0, 0.08, 0.1);
  EXPECT_THAT([&] { static_cast<void>(metrics(s.motion(), -3.0)); },
              ThrowsMessage<InvalidInput>(HasSubstr("mass_kg = -3 kg: must be > 0")));
}

}  // namespace
}  // namespace crashsim
