/// The coupled model against what must hold: balances of momentum and energy, the two-phase result where nothing
/// couples back, the matrix exponential where everything is linear, and closed forms of the kinks.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <unsupported/Eigen/MatrixFunctions>

#include <crashsim/coupled_columns.hpp>
#include <crashsim/simulate.hpp>
#include <crashsim/simulate_pitch.hpp>
#include <crashsim/units.hpp>

#include "support/coupled_cases.hpp"

namespace crashsim {
namespace {

constexpr double kAgreement = 1e-8;  // relative to each channel's largest value, as asked
constexpr double kRtol = 1e-10;
constexpr double kBalance = 1e-7;         // relative: Simpson's rule across kinks
constexpr double kEnergy = 1e-8;          // relative to the initial energy
constexpr double kClosedForm = 1e-9;      // relative
constexpr double kBetweenSamples = 1e-7;  // [m] what a peak between samples is higher

CoupledOptions to(double end_s, double dt_s) {
  CoupledOptions options;
  options.end_time_s = end_s;
  options.dt_s = dt_s;
  options.rtol = kRtol;
  return options;
}

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double v : values) most = std::max(most, std::abs(v));
  return most;
}

void expect_same(const std::vector<double>& a, const std::vector<double>& b, const char* channel) {
  ASSERT_EQ(a.size(), b.size()) << channel;
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  EXPECT_LE(most, kAgreement * largest(b)) << channel;
}

double initial_energy(const CoupledModel& model) {
  return 0.5 * model.crush.mass_kg * std::pow(model.crush.impact_speed_mps, 2);
}

/// Simpson's rule over an even number of intervals.
double simpson(const std::vector<double>& y, double dt) {
  double sum = 0.0;
  for (std::size_t i = 2; i < y.size(); i += 2) sum += y[i - 2] + 4.0 * y[i - 1] + y[i];
  return sum * dt / 3.0;
}

TEST(Coupled, ForcesAndMotionBalanceInMomentumAndEnergy) {
  constexpr double kDt = 2e-6;
  test::Random random(51);
  for (int i = 0; i < 30; ++i) {
    SCOPED_TRACE(i);
    CoupledModel model = test::random_coupled_model(random);
    model.crush.law = CrushLaw::stiffness;  // no jump of the force
    if (model.crush.spring.knots.empty()) model.crush.spring = {{0.0}, {1e6}};
    const CoupledResponse r = simulate_coupled(model, to(0.15, kDt));
    const HeavePitchModel& b = model.body;
    const double m = model.crush.mass_kg, lf = b.front_axle_m, lr = b.rear_axle_m;
    const double front_static = m * kStandardGravity * lr / (lf + lr),
                 rear_static = m * kStandardGravity - front_static;
    std::vector<double> lift(r.time_s.size()), moment(lift), apart(lift);
    for (std::size_t j = 0; j < lift.size(); ++j) {
      const double front = r.front_axle_load_n[j] - front_static, rear = r.rear_axle_load_n[j] - rear_static;
      lift[j] = front + rear - r.vertical_force_n[j];
      moment[j] = r.longitudinal_force_n[j] * (b.cg_height_m - b.force_height_m) +
                  r.vertical_force_n[j] * b.force_arm_m - lf * front + lr * rear;
      apart[j] = r.displacement_m[j] + (b.force_height_m - b.cg_height_m) * r.pitch_rad[j] - r.crush_m[j];
    }
    EXPECT_LT(largest(apart), kClosedForm);
    const double impulse = m * model.crush.impact_speed_mps;
    EXPECT_NEAR(m * (model.crush.impact_speed_mps - r.velocity_mps.back()), simpson(r.longitudinal_force_n, kDt),
                kBalance * impulse);
    EXPECT_NEAR(m * r.heave_velocity_mps.back(), simpson(lift, kDt), kBalance * impulse);
    EXPECT_NEAR(b.pitch_inertia_kgm2 * r.pitch_rate_radps.back(), simpson(moment, kDt), kBalance * impulse);
    EXPECT_LT(largest(r.energy_residual_j), kEnergy * initial_energy(model));
    EXPECT_NEAR(
        r.kinetic_energy_j + r.crush_energy_j + r.suspension_energy_j + r.suspension_dissipated_j + r.vertical_work_j,
        initial_energy(model), kEnergy * initial_energy(model));
    EXPECT_GE(r.suspension_dissipated_j, 0.0);
    EXPECT_GE(r.suspension_energy_j, 0.0);
  }
}

/// Crush by itself, then heave and pitch from impact under its force.
struct TwoPhases {
  CrushResponse crush;
  PitchResponse pitch;
};
TwoPhases two_phases(const CoupledModel& model, const TimeSeries& vertical_force_n, const CoupledOptions& options) {
  SimulateOptions crush_options;
  crush_options.end_time_s = options.end_time_s;
  crush_options.dt_s = options.dt_s;
  crush_options.rtol = kRtol;
  TwoPhases out{.crush = simulate(model.crush, crush_options), .pitch = {}};
  PitchForcing forcing;
  forcing.vertical_force_n = vertical_force_n.empty() ? vertical_force(model.vertical, out.crush) : vertical_force_n;
  PitchOptions pitch_options;
  pitch_options.start.rule = PitchStart::impact;
  pitch_options.end_time_s = options.end_time_s;
  pitch_options.dt_s = options.dt_s;
  out.pitch = simulate_pitch(model.body, forcing, pitch_options);
  return out;
}

void expect_two_phases(const CoupledModel& model, const TimeSeries& force, const CoupledOptions& options) {
  const CoupledResponse r = simulate_coupled(model, options, force);
  ASSERT_TRUE(r.usable()) << r.message;
  const TwoPhases apart = two_phases(model, force, options);
  expect_same(r.displacement_m, apart.crush.displacement_m, "x");
  expect_same(r.velocity_mps, apart.crush.velocity_mps, "v");
  expect_same(r.accel_mps2, apart.crush.accel_mps2, "a");
  expect_same(r.heave_m, apart.pitch.heave_m, "z");
  expect_same(r.heave_velocity_mps, apart.pitch.heave_velocity_mps, "z'");
  expect_same(r.pitch_rad, apart.pitch.pitch_rad, "theta");
  expect_same(r.pitch_rate_radps, apart.pitch.pitch_rate_radps, "theta'");
  EXPECT_NEAR(r.t_m_s, apart.crush.t_m_s, kAgreement);
  EXPECT_NEAR(r.max_crush_m, apart.crush.max_crush_m, kAgreement);
  EXPECT_NEAR(r.separation_s, apart.crush.separation_s, kAgreement);
  EXPECT_NEAR(r.rebound_velocity_mps, apart.crush.rebound_velocity_mps, kAgreement * r.impact_speed_mps);
  EXPECT_NEAR(r.pitch_max_rad, apart.pitch.pitch_max_rad, kAgreement);
  EXPECT_NEAR(r.heave_min_m, apart.pitch.heave_min_m, kAgreement);
  EXPECT_NEAR(r.heave_velocity_min_mps, apart.pitch.heave_velocity_min_mps, kAgreement);
}

TEST(Coupled, WithTheForceAtTheHeightOfTheCentreOfGravityAGivenForceMakesItTheTwoPhases) {
  CoupledModel model = test::coupled_vehicle();
  model.body.force_height_m = model.body.cg_height_m;
  expect_two_phases(model, test::sampled_half_sine(200), to(0.2, 1e-4));
}

TEST(Coupled, WithTheForceAtTheHeightOfTheCentreOfGravityALawMakesItTheTwoPhases) {
  CoupledModel model = test::coupled_vehicle();
  model.body.force_height_m = model.body.cg_height_m;
  model.vertical = {.angle_rad = 0.05, .angle_rate_rad_per_m = 0.3, .angle_start_m = 0.2, .friction = 0.12};
  expect_two_phases(model, {}, to(0.2, 4e-6));  // the two phases hand over samples
}

TEST(Coupled, AHugePitchInertiaLeavesCrushAlone) {
  CoupledModel model = test::coupled_vehicle();
  model.body.pitch_inertia_kgm2 = 1e16;
  const CoupledResponse r = simulate_coupled(model, to(0.2, 1e-4));
  const CrushResponse alone = two_phases(model, {{0.0, 1.0}, {0.0, 0.0}}, to(0.2, 1e-4)).crush;
  expect_same(r.displacement_m, alone.displacement_m, "x");
  expect_same(r.velocity_mps, alone.velocity_mps, "v");
  EXPECT_LT(largest(r.pitch_rad), kClosedForm);
  EXPECT_LT(largest(r.heave_m), kClosedForm);
}

TEST(Coupled, ALowForcePitchesTheNoseDownAndGoesDeeper) {
  CoupledModel model = test::coupled_vehicle();
  const CoupledResponse low = simulate_coupled(model, to(0.2, 1e-4));
  model.body.force_height_m = model.body.cg_height_m;
  const CoupledResponse level = simulate_coupled(model, to(0.2, 1e-4));
  EXPECT_GT(low.pitch_max_rad, 0.01);
  EXPECT_EQ(level.pitch_max_rad, 0.0);
  EXPECT_GT(low.front_axle_load_max_n, low.front_axle_load_n.front());
  EXPECT_LT(low.rear_axle_load_min_n, low.rear_axle_load_n.front());
  EXPECT_GT(low.displacement_max_m, level.displacement_max_m);  // the body rolls over its own force
}

/// Constant stiffness and damping, a barrier that also pulls, a constant angle, no lift-off: y' = A y.
Eigen::Matrix<double, 6, 6> linear_rates(const CoupledModel& model) {
  const HeavePitchModel& b = model.body;
  const double k = model.crush.spring.ordinates[0], c = model.crush.damper.ordinates[0];
  const double tangent = std::tan(model.vertical.angle_rad);
  const Eigen::Vector3d crush(1.0, 0.0, b.force_height_m - b.cg_height_m);
  const Eigen::Vector3d front(0.0, 1.0, -b.front_axle_m), rear(0.0, 1.0, b.rear_axle_m);
  const Eigen::Vector3d push = -crush + tangent * Eigen::Vector3d(0.0, -1.0, b.force_arm_m);  // of a unit of F_x
  const auto force = [&](double of_crush, double of_front, double of_rear) -> Eigen::Matrix3d {
    return of_crush * push * crush.transpose() - of_front * front * front.transpose() -
           of_rear * rear * rear.transpose();
  };
  const Eigen::Vector3d mass(model.crush.mass_kg, model.crush.mass_kg, b.pitch_inertia_kgm2);
  Eigen::Matrix<double, 6, 6> a = Eigen::Matrix<double, 6, 6>::Zero();
  a.topRightCorner<3, 3>().setIdentity();
  a.bottomLeftCorner<3, 3>() =
      mass.cwiseInverse().asDiagonal() * force(k, b.front_stiffness_n_per_m, b.rear_stiffness_n_per_m);
  a.bottomRightCorner<3, 3>() =
      mass.cwiseInverse().asDiagonal() * force(c, b.front_damping_ns_per_m, b.rear_damping_ns_per_m);
  return a;
}

TEST(Coupled, ALinearModelIsTheMatrixExponential) {
  test::Random random(52);
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    CoupledModel model = test::random_coupled_model(random);
    const double speed = model.crush.impact_speed_mps, mass = model.crush.mass_kg;
    const double w = random.between(15.0, 50.0);
    model.crush = test::kelvin_model(mass, mass * w * w, 2.0 * random.between(0.0, 0.6) * mass * w, speed);
    model.crush.unloading.bilateral = true;
    model.vertical = {.angle_rad = random.between(-0.3, 0.3)};
    model.ground = {};
    const CoupledResponse r = simulate_coupled(model, to(0.3, 0.01));
    ASSERT_TRUE(r.usable()) << r.message;
    std::vector<std::vector<double>> exact(6);
    for (const double t : r.time_s) {
      Eigen::Matrix<double, 6, 1> initial = Eigen::Matrix<double, 6, 1>::Zero();
      initial[3] = speed;
      const Eigen::Matrix<double, 6, 1> y = (linear_rates(model) * t).exp() * initial;
      for (std::size_t j = 0; j < 6; ++j) exact[j].push_back(y[static_cast<Eigen::Index>(j)]);
    }
    expect_same(r.displacement_m, exact[0], "x");
    expect_same(r.heave_m, exact[1], "z");
    expect_same(r.pitch_rad, exact[2], "theta");
    expect_same(r.velocity_mps, exact[3], "v");
    expect_same(r.heave_velocity_mps, exact[4], "z'");
    expect_same(r.pitch_rate_radps, exact[5], "theta'");
    EXPECT_LT(largest(r.energy_residual_j), kEnergy * initial_energy(model));
  }
}

/// Alike front and rear, undamped, force at the height of the centre of gravity and through it: pure heave.
CoupledModel pure_heave() {
  CoupledModel model = test::coupled_vehicle();
  model.body.per_wheel = false;
  model.body.rear_axle_m = model.body.front_axle_m;
  model.body.front_stiffness_n_per_m = model.body.rear_stiffness_n_per_m = 50e3;
  model.body.front_damping_ns_per_m = model.body.rear_damping_ns_per_m = 0.0;
  model.body.force_height_m = model.body.cg_height_m;
  model.body.force_arm_m = 0.0;
  return model;
}

TEST(Coupled, ABumpStopEndsADropWhereTheEnergiesSay) {
  CoupledModel model = pure_heave();
  model.ground.front_bump_gap_m = model.ground.rear_bump_gap_m = 0.04;
  model.ground.front_bump_stiffness_n_per_m = model.ground.rear_bump_stiffness_n_per_m = 400e3;
  const double force = 8000.0;
  const CoupledResponse r = simulate_coupled(model, to(0.6, 1e-3), {{0.0, 1.0}, {force, force}});
  // F d = k d^2 + kb (d - gap)^2 at the lowest point.
  const double k = 50e3, kb = 400e3, gap = 0.04;
  const double half = (2.0 * kb * gap + force) / (2.0 * (k + kb));
  const double lowest = half + std::sqrt(half * half - kb * gap * gap / (k + kb));
  EXPECT_NEAR(r.heave_min_m, -lowest, kClosedForm * lowest);
  EXPECT_LT(largest(r.pitch_rad), kClosedForm);
  EXPECT_NEAR(r.front_axle_load_max_n, 0.5 * model.body.mass_kg * kStandardGravity + k * lowest + kb * (lowest - gap),
              kClosedForm * 1e5);
  EXPECT_LT(largest(r.energy_residual_j), kEnergy * initial_energy(model));
}

TEST(Coupled, WheelsThatLeaveTheGroundLeaveTheBodyInFreeFall) {
  CoupledModel model = pure_heave();
  model.ground.lift_off = true;
  const double weight = model.body.mass_kg * kStandardGravity, droop = 0.5 * weight / 50e3;
  const double force = 0.7 * weight;
  const CoupledResponse r = simulate_coupled(model, to(3.0, 1e-4), {{0.0, 4.0}, {-force, -force}});
  // F d = m g d_0 / 2 + m g (d - d_0) at the highest point.
  const double highest = 0.5 * weight * droop / (weight - force);
  ASSERT_GT(highest, droop);
  EXPECT_NEAR(std::ranges::max(r.heave_m), highest, kBetweenSamples);
  std::size_t flying = 0;
  for (std::size_t i = 0; i < r.time_s.size(); ++i) {
    if (r.heave_m[i] <= droop) continue;
    ++flying;
    EXPECT_EQ(r.front_axle_load_n[i], 0.0);
    EXPECT_NEAR(r.heave_accel_mps2[i], -kStandardGravity * 0.3, kClosedForm);
  }
  EXPECT_GT(flying, 1000U);
  // z = d_0 in (1 - cos(w t)) F / 2 k, before the first flight.
  const double w = std::sqrt(100e3 / model.body.mass_kg);
  EXPECT_NEAR(r.front_lift_off_s, std::acos(1.0 - droop * 100e3 / force) / w, kClosedForm);
  EXPECT_NEAR(r.rear_lift_off_s, r.front_lift_off_s, kClosedForm);
  EXPECT_LT(largest(r.energy_residual_j), kEnergy * initial_energy(model));
}

}  // namespace
}  // namespace crashsim
