/// Phase II against numbers from elsewhere: the oracle cases P1 to P5, an own Runge-Kutta integration of the continuous
/// force, closed forms, and the balances of momentum and energy.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include <crashsim/simulate_pitch.hpp>

#include "support/pitch_cases.hpp"

namespace crashsim {
namespace {

using test::oracle_vehicle;

constexpr double kOracle = 1e-8;      // relative, as asked of the oracle cases
constexpr double kReference = 2e-9;   // relative: the force's own sampling, 0.8 / kIntervals^2, grown in time
constexpr double kBalance = 1e-11;    // relative: quadrature of the applied and axle forces
constexpr double kRounding = 1e-11;   // relative, thousands of steps
constexpr double kManySteps = 1e-10;  // absolute, tens of thousands of steps
constexpr int kIntervals = 40000;
constexpr double kEnd = 0.2;

/// Half a unit of the last decimal an oracle number has, and 1e-8 of it.
double oracle_tolerance(double value, int decimals) {
  return kOracle * std::abs(value) + 0.5 * std::pow(10.0, -decimals);
}

HeavePitchModel axle_vehicle() {  // P3
  HeavePitchModel model = oracle_vehicle();
  model.per_wheel = true;
  model.force_arm_m = 1.4;
  return model;
}

HeavePitchModel free_vehicle() {  // P5
  HeavePitchModel model = axle_vehicle();
  for (const auto member : {&HeavePitchModel::front_stiffness_n_per_m, &HeavePitchModel::rear_stiffness_n_per_m,
                            &HeavePitchModel::front_damping_ns_per_m, &HeavePitchModel::rear_damping_ns_per_m})
    model.*member = 0.0;
  return model;
}

PitchOptions from_impact(double dt = 1e-3) {
  PitchOptions options;
  options.start.rule = PitchStart::impact;
  options.end_time_s = kEnd;
  options.dt_s = dt;
  return options;
}

PitchResponse under_half_sine(const HeavePitchModel& model) {
  PitchForcing forcing;
  forcing.vertical_force_n = test::sampled_half_sine(kIntervals);
  return simulate_pitch(model, forcing, from_impact());
}

std::size_t sample_at(const PitchResponse& r, double t) {
  const auto index = static_cast<std::size_t>(std::lround(t / (r.time_s[1] - r.time_s[0])));
  EXPECT_NEAR(r.time_s[index], t, kRounding);
  return index;
}

#define EXPECT_ORACLE(actual, expected, decimals) EXPECT_NEAR(actual, expected, oracle_tolerance(expected, decimals))

TEST(HeavePitch, P1AsPrinted) {
  HeavePitchModel model = oracle_vehicle();
  model.formulation = PitchFormulation::as_printed;
  const PitchResponse r = under_half_sine(model);
  ASSERT_TRUE(r.usable());
  EXPECT_ORACLE(r.pitch_rad[sample_at(r, 0.08)], 0.019386932, 9);
  EXPECT_ORACLE(r.pitch_rad.back(), 0.068668684, 9);
  EXPECT_ORACLE(r.heave_m.back(), -0.15498745, 8);
  EXPECT_ORACLE(r.heave_velocity_mps.back(), -0.682528185, 9);
  EXPECT_ORACLE(r.heave_velocity_min_mps, -1.10522378, 8);
}

TEST(HeavePitch, P2Derived) {
  const PitchResponse r = under_half_sine(oracle_vehicle());
  EXPECT_ORACLE(r.pitch_rad[sample_at(r, 0.08)], 0.019386301, 9);
  EXPECT_ORACLE(r.pitch_rad.back(), 0.068670848, 9);
  EXPECT_ORACLE(r.heave_m.back(), -0.150557229, 9);
  EXPECT_ORACLE(r.heave_velocity_mps.back(), -0.635509584, 9);
  EXPECT_ORACLE(r.heave_velocity_min_mps, -1.09059659, 8);
}

TEST(HeavePitch, P3DerivedWithAxleValues) {
  const PitchResponse r = under_half_sine(axle_vehicle());
  EXPECT_ORACLE(r.pitch_rad[sample_at(r, 0.08)], 0.026440975, 9);
  EXPECT_ORACLE(r.pitch_rad.back(), 0.083587507, 9);
  EXPECT_ORACLE(r.heave_m.back(), -0.119411136, 9);
  EXPECT_ORACLE(r.heave_velocity_mps.back(), -0.240602426, 9);
}

TEST(HeavePitch, P4WithThePapersInertia) {
  HeavePitchModel model = axle_vehicle();
  model.pitch_inertia_kgm2 = 1400.0;
  const PitchResponse r = under_half_sine(model);
  EXPECT_ORACLE(r.pitch_max_rad, 0.1694203, 7);
  EXPECT_ORACLE(r.pitch_max_time_s, 0.15635, 5);
  EXPECT_ORACLE(r.pitch_rad.back(), 0.151143474, 9);
  EXPECT_ORACLE(r.heave_m.back(), -0.112915801, 9);
}

TEST(HeavePitch, P5FreeBody) {
  const PitchResponse r = under_half_sine(free_vehicle());
  EXPECT_ORACLE(r.pitch_rate_radps.back(), 0.6947198555, 10);
  EXPECT_ORACLE(r.heave_velocity_mps.back(), -1.183491444, 9);
  EXPECT_ORACLE(r.pitch_rad.back(), 0.111155177, 9);
  EXPECT_ORACLE(r.heave_m.back(), -0.189358631, 9);
  // The impulse 2 T F / pi is the whole momentum, l_Q times it the whole angular momentum.
  const double impulse = 2.0 * test::kHalfSineLength * test::kHalfSinePeak / std::numbers::pi;
  EXPECT_NEAR(r.heave_velocity_mps.back(), -impulse / 2582.0, kReference);
  EXPECT_NEAR(r.pitch_rate_radps.back(), 1.4 * impulse / 6158.0, kReference);
}

/// Rates of (z, theta, z', theta') at time t.
using Rates = std::function<std::array<double, 4>(double t, const std::array<double, 4>& y)>;

/// Classical Runge-Kutta from rest.
std::array<double, 4> runge_kutta(const Rates& rates, double from, double to, int steps, std::array<double, 4> y = {}) {
  const double h = (to - from) / steps;
  const auto moved = [](const std::array<double, 4>& a, double s, const std::array<double, 4>& b) {
    return std::array{a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2], a[3] + s * b[3]};
  };
  for (int i = 0; i < steps; ++i) {
    const double t = from + h * i;
    const auto k1 = rates(t, y);
    const auto k2 = rates(t + 0.5 * h, moved(y, 0.5 * h, k1));
    const auto k3 = rates(t + 0.5 * h, moved(y, 0.5 * h, k2));
    const auto k4 = rates(t + h, moved(y, h, k3));
    y = moved(moved(moved(moved(y, h / 6.0, k1), h / 3.0, k2), h / 3.0, k3), h / 6.0, k4);
  }
  return y;
}

void expect_state(const PitchResponse& r, std::size_t i, const std::array<double, 4>& reference, double relative) {
  EXPECT_NEAR(r.heave_m[i], reference[0], relative * std::abs(reference[0]));
  EXPECT_NEAR(r.pitch_rad[i], reference[1], relative * std::abs(reference[1]));
  EXPECT_NEAR(r.heave_velocity_mps[i], reference[2], relative * std::abs(reference[2]));
  EXPECT_NEAR(r.pitch_rate_radps[i], reference[3], relative * std::abs(reference[3]));
}

TEST(HeavePitch, AsPrintedAgreesWithItsOwnIndependentIntegration) {
  const HeavePitchModel m = oracle_vehicle();
  const double k1 = m.front_stiffness_n_per_m, k2 = m.rear_stiffness_n_per_m;
  const double c1 = m.front_damping_ns_per_m, c2 = m.rear_damping_ns_per_m;
  const double lf = m.front_axle_m, lr = m.rear_axle_m;
  const Rates printed = [&](double t, const std::array<double, 4>& y) {
    const auto [z, theta, dz, dtheta] = y;
    const double q = test::half_sine(t);
    const double moment = q - (c1 * lf * lf + c2 * lr * lr) * dtheta - (k1 * lf * lf + k2 * lr * lr) * theta -
                          (c2 * lr - c1 * lf) * dz - (k2 * lr - k1 * lf) * z;
    const double lift =
        -q - (c1 * lf + c2 * lr) * dz - (k1 + k2) * z - (c1 + c2) * dtheta - (k2 * lr - k1 * lf) * theta;
    return std::array{dz, dtheta, lift / m.mass_kg, moment / m.pitch_inertia_kgm2};
  };
  HeavePitchModel model = m;
  model.formulation = PitchFormulation::as_printed;
  const PitchResponse r = under_half_sine(model);
  const auto at_end_of_force = runge_kutta(printed, 0.0, test::kHalfSineLength, 20000);
  expect_state(r, sample_at(r, test::kHalfSineLength), at_end_of_force, kReference);
  expect_state(r, r.time_s.size() - 1, runge_kutta(printed, test::kHalfSineLength, kEnd, 20000, at_end_of_force),
               kReference);
}

TEST(HeavePitch, LongitudinalForceAtAMovingHeightPitchesTheBody) {
  HeavePitchModel m = axle_vehicle();
  m.cg_height_m = 0.6;
  PitchForcing forcing;
  forcing.longitudinal_force_n = {{0.0, 0.03, 0.1, 0.2}, {0.0, 6e5, 2e5, 0.0}};
  forcing.force_height_m = {{0.03, 0.2}, {0.40, 0.57}};  // held before 0.03 s
  const PitchResponse r = simulate_pitch(m, forcing, from_impact());
  const HeavePitchModel axle = with_axle_values(m);
  const auto rates = [&](double f0, double slope_f, double h0, double slope_h) -> Rates {
    return [=](double s, const std::array<double, 4>& y) {
      const auto [z, theta, dz, dtheta] = y;
      const double front = axle.front_stiffness_n_per_m * (z - axle.front_axle_m * theta) +
                           axle.front_damping_ns_per_m * (dz - axle.front_axle_m * dtheta);
      const double rear = axle.rear_stiffness_n_per_m * (z + axle.rear_axle_m * theta) +
                          axle.rear_damping_ns_per_m * (dz + axle.rear_axle_m * dtheta);
      const double moment = (f0 + slope_f * s) * (axle.cg_height_m - h0 - slope_h * s);
      return std::array{dz, dtheta, -(front + rear) / axle.mass_kg,
                        (moment + axle.front_axle_m * front - axle.rear_axle_m * rear) / axle.pitch_inertia_kgm2};
    };
  };
  auto y = runge_kutta(rates(0.0, 6e5 / 0.03, 0.40, 0.0), 0.0, 0.03, 4000);
  y = runge_kutta(rates(6e5, -4e5 / 0.07, 0.40, 1.0), 0.0, 0.07, 4000, y);
  expect_state(r, sample_at(r, 0.1), y, kRounding);
  y = runge_kutta(rates(2e5, -2e5 / 0.1, 0.47, 1.0), 0.0, 0.1, 4000, y);
  expect_state(r, r.time_s.size() - 1, y, kRounding);

  m.force_height_m = 0.40;  // a series wins over the number
  EXPECT_EQ(simulate_pitch(m, forcing, from_impact()).pitch_rad, r.pitch_rad);
}

/// Simpson's rule over an even number of intervals.
double simpson(const std::vector<double>& y, double dt) {
  double sum = 0.0;
  for (std::size_t i = 2; i < y.size(); i += 2) sum += y[i - 2] + 4.0 * y[i - 1] + y[i];
  return sum * dt / 3.0;
}

/// Random forces whose samples lie on every 100th output time, and zero at both ends.
TimeSeries aligned_force(test::Random& random, double dt, double peak) {
  TimeSeries force;
  for (int i = 0; i <= 80; ++i) {
    force.time_s.push_back(100 * i * dt);
    force.values.push_back(i == 0 || i == 80 ? 0.0 : random.between(-peak, peak));
  }
  return force;
}

TEST(HeavePitch, MomentumAndEnergyBalance) {
  constexpr double kDt = 2e-5;
  test::Random random(21);
  for (int i = 0; i < 20; ++i) {
    const HeavePitchModel m = test::random_vehicle(random);
    PitchForcing forcing;
    forcing.vertical_force_n = aligned_force(random, kDt, 6e4);
    forcing.longitudinal_force_n = aligned_force(random, kDt, 3e5);
    PitchOptions options = from_impact(kDt);
    options.heave_m = 0.02;
    options.heave_velocity_mps = -0.4;
    options.pitch_rad = -0.03;
    options.pitch_rate_radps = 0.2;
    const PitchResponse r = simulate_pitch(m, forcing, options);
    const std::size_t count = r.time_s.size();
    std::vector<double> lift(count), moment(count), power(count), dissipated(count);
    for (std::size_t j = 0; j < count; ++j) {
      lift[j] = r.heave_force_n[j] + r.front_axle_force_n[j] + r.rear_axle_force_n[j];
      moment[j] =
          r.pitch_moment_nm[j] - m.front_axle_m * r.front_axle_force_n[j] + m.rear_axle_m * r.rear_axle_force_n[j];
      power[j] = r.heave_force_n[j] * r.heave_velocity_mps[j] + r.pitch_moment_nm[j] * r.pitch_rate_radps[j];
      const double front = r.heave_velocity_mps[j] - m.front_axle_m * r.pitch_rate_radps[j];
      const double rear = r.heave_velocity_mps[j] + m.rear_axle_m * r.pitch_rate_radps[j];
      dissipated[j] = m.front_damping_ns_per_m * front * front + m.rear_damping_ns_per_m * rear * rear;
    }
    const auto energy = [&](std::size_t j) {
      return 0.5 * (m.mass_kg * std::pow(r.heave_velocity_mps[j], 2) +
                    m.pitch_inertia_kgm2 * std::pow(r.pitch_rate_radps[j], 2) +
                    m.front_stiffness_n_per_m * std::pow(r.front_deflection_m[j], 2) +
                    m.rear_stiffness_n_per_m * std::pow(r.rear_deflection_m[j], 2));
    };
    const double impulse_scale = 6e4 * kEnd;
    EXPECT_NEAR(m.mass_kg * (r.heave_velocity_mps.back() - r.heave_velocity_mps[0]), simpson(lift, kDt),
                kBalance * impulse_scale);
    EXPECT_NEAR(m.pitch_inertia_kgm2 * (r.pitch_rate_radps.back() - r.pitch_rate_radps[0]), simpson(moment, kDt),
                kBalance * impulse_scale);
    EXPECT_NEAR(energy(count - 1) - energy(0), simpson(power, kDt) - simpson(dissipated, kDt),
                kBalance * impulse_scale);
    EXPECT_NEAR(m.mass_kg * r.heave_accel_mps2[count / 2], lift[count / 2], kRounding * impulse_scale);
    EXPECT_NEAR(m.pitch_inertia_kgm2 * r.pitch_accel_radps2[count / 2], moment[count / 2], kRounding * impulse_scale);
  }
}

TEST(HeavePitch, PeaksAreThoseOfTheClosedFormWhateverTheOutputInterval) {
  // Alike front and rear: heave is an oscillator of its own, z = v0/wd exp(-zeta w t) sin(wd t).
  HeavePitchModel m = oracle_vehicle();
  m.rear_axle_m = m.front_axle_m;
  m.rear_stiffness_n_per_m = m.front_stiffness_n_per_m;
  m.rear_damping_ns_per_m = m.front_damping_ns_per_m;
  const double w = std::sqrt(2.0 * m.front_stiffness_n_per_m / m.mass_kg);
  const double zeta = m.front_damping_ns_per_m / (m.mass_kg * w);
  const double wd = w * std::sqrt(1.0 - zeta * zeta);
  PitchOptions options = from_impact();
  options.end_time_s = 1.5;
  options.heave_velocity_mps = 0.7;
  for (const double dt : {1e-4, 0.0037, 0.31}) {
    options.dt_s = dt;
    const PitchResponse r = simulate_pitch(m, {}, options);
    // Velocity zero where tan(wd t) = sqrt(1 - zeta^2)/zeta, in its second half wave.
    const double t_lowest = (std::atan2(std::sqrt(1.0 - zeta * zeta), zeta) + std::numbers::pi) / wd;
    const double lowest = 0.7 / w * std::exp(-zeta * w * t_lowest);
    EXPECT_NEAR(r.heave_min_time_s, t_lowest, kRounding) << "dt = " << dt;
    EXPECT_NEAR(r.heave_min_m, -lowest, kRounding);
    // z'' = 0 half way round, at twice the phase angle.
    const double t_fastest = 2.0 * std::atan2(std::sqrt(1.0 - zeta * zeta), zeta) / wd;
    EXPECT_NEAR(r.heave_velocity_min_time_s, t_fastest, kRounding);
    EXPECT_NEAR(r.heave_velocity_min_mps, -0.7 * std::exp(-zeta * w * t_fastest), kRounding);
    EXPECT_EQ(r.pitch_max_rad, 0.0);
  }
}

TEST(HeavePitch, PeaksAreNotBelowAnySample) {
  test::Random random(22);
  for (int i = 0; i < 40; ++i) {
    const HeavePitchModel m = test::random_vehicle(random);
    PitchForcing forcing;
    forcing.vertical_force_n = test::random_series(random, -0.02, 0.25, random.whole(2, 60), -8e4, 8e4);
    PitchOptions options = from_impact(random.between(5e-4, 0.05));
    const PitchResponse coarse = simulate_pitch(m, forcing, options);
    options.dt_s = 1e-5;
    const PitchResponse fine = simulate_pitch(m, forcing, options);
    EXPECT_NEAR(coarse.pitch_max_rad, fine.pitch_max_rad, kManySteps);
    EXPECT_NEAR(coarse.heave_min_m, fine.heave_min_m, kManySteps);
    EXPECT_NEAR(coarse.heave_velocity_min_mps, fine.heave_velocity_min_mps, kManySteps);
    EXPECT_GE(coarse.pitch_max_rad, std::ranges::max(fine.pitch_rad) - kManySteps);
    EXPECT_LE(coarse.heave_min_m, std::ranges::min(fine.heave_m) + kManySteps);
    EXPECT_LE(coarse.heave_velocity_min_mps, std::ranges::min(fine.heave_velocity_mps) + kManySteps);
  }
}

}  // namespace
}  // namespace crashsim
