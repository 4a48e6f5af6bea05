#include <crashsim/heave_pitch_model.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gmock/gmock.h>

#include <Eigen/Eigenvalues>

namespace crashsim {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::HasSubstr;
using testing::SizeIs;
using testing::ThrowsMessage;

constexpr double kRounding = 1e-12;  // relative, of a few operations on doubles

/// Per-wheel values of the oracle cases P1 and P2.
HeavePitchModel oracle_model() {
  HeavePitchModel model;
  model.mass_kg = 2582.0;
  model.pitch_inertia_kgm2 = 6158.0;
  model.front_axle_m = 1.4;
  model.rear_axle_m = 1.0;
  model.front_stiffness_n_per_m = 30000.0;
  model.rear_stiffness_n_per_m = 20000.0;
  model.front_damping_ns_per_m = 1500.0;
  model.rear_damping_ns_per_m = 3000.0;
  return model;
}

HeavePitchModel random_model(std::mt19937_64& random) {
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  HeavePitchModel model;
  model.mass_kg = between(700.0, 4000.0);
  model.pitch_inertia_kgm2 = between(800.0, 9000.0);
  model.front_axle_m = between(0.8, 2.0);
  model.rear_axle_m = between(0.8, 2.0);
  model.front_stiffness_n_per_m = between(1e4, 2e5);
  model.rear_stiffness_n_per_m = between(1e4, 2e5);
  model.front_damping_ns_per_m = between(0.0, 1e4);
  model.rear_damping_ns_per_m = between(0.0, 1e4);
  return model;
}

/// Potential energy of the springs and dissipation function of the dampers, from their own deflections.
double axle_energy(double front, double rear, const HeavePitchModel& m, double z, double theta) {
  return 0.5 * front * std::pow(z - m.front_axle_m * theta, 2) + 0.5 * rear * std::pow(z + m.rear_axle_m * theta, 2);
}

TEST(HeavePitchModel, DerivedMatricesAreThoseOfTheEnergies) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 100; ++i) {
    const HeavePitchModel m = random_model(random);
    const Eigen::Vector2d q(0.3, -0.7);
    const double potential = axle_energy(m.front_stiffness_n_per_m, m.rear_stiffness_n_per_m, m, q[0], q[1]);
    const double dissipation = axle_energy(m.front_damping_ns_per_m, m.rear_damping_ns_per_m, m, q[0], q[1]);
    EXPECT_NEAR(0.5 * q.dot(stiffness_matrix(m) * q), potential, kRounding * potential);
    EXPECT_NEAR(0.5 * q.dot(damping_matrix(m) * q), dissipation, kRounding * dissipation);
  }
}

TEST(HeavePitchModel, DampingIsSymmetricPositiveSemidefiniteAsDerivedButNotAsPrinted) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 200; ++i) {
    HeavePitchModel model = random_model(random);
    if (i % 4 == 0) model.rear_damping_ns_per_m = 0.0;  // singular: one undamped motion
    const Eigen::Matrix2d derived = damping_matrix(model);
    EXPECT_EQ(derived, derived.transpose());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(derived);
    EXPECT_GE(eigen.eigenvalues()[0], -kRounding * eigen.eigenvalues()[1]);
    EXPECT_TRUE(is_dissipative(model));
  }
  HeavePitchModel printed = oracle_model();
  printed.formulation = PitchFormulation::as_printed;
  const Eigen::Matrix2d damping = damping_matrix(printed);
  EXPECT_NE(damping, damping.transpose());
  EXPECT_EQ(damping(0, 0), 1500.0 * 1.4 + 3000.0 * 1.0);
  EXPECT_EQ(damping(0, 1), 1500.0 + 3000.0);
  // A short wheelbase damped at the rear alone: the printed matrix drives some motion instead of damping it.
  printed.front_damping_ns_per_m = 0.0;
  printed.front_axle_m = 0.8;
  printed.rear_axle_m = 0.8;
  EXPECT_FALSE(is_dissipative(printed));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(
      0.5 * (damping_matrix(printed) + damping_matrix(printed).transpose()));
  EXPECT_LT(eigen.eigenvalues()[0], 0.0);
}

TEST(HeavePitchModel, PerWheelValuesAreDoubled) {
  HeavePitchModel wheel = oracle_model();
  wheel.per_wheel = true;
  const HeavePitchModel axle = with_axle_values(wheel);
  EXPECT_FALSE(axle.per_wheel);
  EXPECT_EQ(axle.front_stiffness_n_per_m, 60000.0);
  EXPECT_EQ(axle.rear_damping_ns_per_m, 6000.0);
  EXPECT_EQ(stiffness_matrix(with_axle_values(axle)), stiffness_matrix(axle));
  EXPECT_EQ(stiffness_matrix(wheel), 2.0 * stiffness_matrix(oracle_model()));
  EXPECT_EQ(damping_matrix(wheel), 2.0 * damping_matrix(oracle_model()));
}

TEST(HeavePitchModel, ModesOfAnUncoupledModelAreHeaveAndPitch) {
  HeavePitchModel model = oracle_model();  // k2 lr = k1 lf and c2 lr = c1 lf
  model.rear_axle_m = 1.4;
  model.rear_stiffness_n_per_m = 30000.0;
  model.rear_damping_ns_per_m = 1500.0;
  const auto found = modes(model);
  ASSERT_THAT(found, SizeIs(2));
  const double heave = std::sqrt(60000.0 / 2582.0);
  const double pitch = std::sqrt(60000.0 * 1.96 / 6158.0);
  EXPECT_NEAR(found[0].frequency_hz, pitch / (2.0 * std::numbers::pi), kRounding);
  EXPECT_NEAR(found[1].frequency_hz, heave / (2.0 * std::numbers::pi), kRounding);
  EXPECT_NEAR(found[0].damping_ratio, 3000.0 * 1.96 / 6158.0 / (2.0 * pitch), kRounding);
  EXPECT_NEAR(found[1].damping_ratio, 3000.0 / 2582.0 / (2.0 * heave), kRounding);
  EXPECT_GT(found[0].pitch_per_heave, 1.0 / kRounding);
  EXPECT_LT(found[1].pitch_per_heave, kRounding);
}

TEST(HeavePitchModel, ModesSolveTheCharacteristicEquation) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 100; ++i) {
    HeavePitchModel model = random_model(random);
    if (i % 3 == 0) model.front_damping_ns_per_m = 1e5;  // overdamped
    for (const Mode& mode : modes(model)) {
      const Eigen::Matrix2cd inertia =
          mode.eigenvalue * mode.eigenvalue * mass_matrix(model).cast<std::complex<double>>();
      const Eigen::Matrix2cd damping = mode.eigenvalue * damping_matrix(model).cast<std::complex<double>>();
      const Eigen::Matrix2cd stiffness = stiffness_matrix(model).cast<std::complex<double>>();
      const double scale = inertia.norm() + damping.norm() + stiffness.norm();
      const Eigen::Matrix2cd dynamic = inertia + damping + stiffness;
      EXPECT_LT(std::abs(dynamic(0, 0) * dynamic(1, 1) - dynamic(0, 1) * dynamic(1, 0)), kRounding * scale * scale);
      EXPECT_LT(mode.eigenvalue.real(), 0.0);
    }
  }
}

TEST(HeavePitchModel, OverdampedModesAreReal) {
  HeavePitchModel model = oracle_model();
  model.front_damping_ns_per_m = 60000.0;
  model.rear_damping_ns_per_m = 60000.0;
  const auto found = modes(model);
  ASSERT_THAT(found, SizeIs(4));
  for (const Mode& mode : found) EXPECT_NEAR(mode.damping_ratio, 1.0, kRounding);
}

TEST(HeavePitchModel, AFreeBodyHasRigidBodyModes) {
  HeavePitchModel model = oracle_model();
  for (const auto member : {&HeavePitchModel::front_stiffness_n_per_m, &HeavePitchModel::rear_stiffness_n_per_m,
                            &HeavePitchModel::front_damping_ns_per_m, &HeavePitchModel::rear_damping_ns_per_m})
    model.*member = 0.0;
  validate(model);
  for (const Mode& mode : modes(model)) {
    EXPECT_EQ(mode.frequency_hz, 0.0);
    EXPECT_TRUE(std::isnan(mode.damping_ratio));
  }
}

TEST(HeavePitchModel, RefusesBadValuesByName) {
  const auto with = [](double HeavePitchModel::*member, double value) {
    HeavePitchModel model = oracle_model();
    model.*member = value;
    return [model] { validate(model); };
  };
  using M = HeavePitchModel;
  EXPECT_NO_THROW(validate(oracle_model()));
  EXPECT_THAT(with(&M::mass_kg, -3.0), ThrowsMessage<InvalidInput>("HeavePitchModel.mass_kg = -3 kg: must be > 0"));
  EXPECT_THAT(with(&M::mass_kg, std::numeric_limits<double>::infinity()),
              ThrowsMessage<InvalidInput>(HasSubstr("HeavePitchModel.mass_kg = inf kg: must be > 0")));
  EXPECT_THAT(with(&M::pitch_inertia_kgm2, 0.0),
              ThrowsMessage<InvalidInput>("HeavePitchModel.pitch_inertia_kgm2 = 0 kg m^2: must be > 0"));
  EXPECT_THAT(with(&M::rear_axle_m, -1.0),
              ThrowsMessage<InvalidInput>("HeavePitchModel.rear_axle_m = -1 m: must be > 0"));
  EXPECT_THAT(with(&M::front_damping_ns_per_m, -0.5),
              ThrowsMessage<InvalidInput>("HeavePitchModel.front_damping_ns_per_m = -0.5 N s/m: must be >= 0"));
  EXPECT_THAT(with(&M::force_height_m, -0.1),
              ThrowsMessage<InvalidInput>("HeavePitchModel.force_height_m = -0.1 m: must be >= 0"));
  EXPECT_THAT(with(&M::rear_stiffness_n_per_m, kUnset),
              ThrowsMessage<InvalidInput>(AllOf(HasSubstr("HeavePitchModel.rear_stiffness_n_per_m is not set"),
                                                HasSubstr("give the suspension stiffness of the rear axle in N/m"))));
}

TEST(HeavePitchModel, TheFieldTableIsComplete) {
  // Every member is described once: numbers, a flag and an enum; a new member must extend the table.
  constexpr std::size_t kNumbers = 11;
  EXPECT_EQ(sizeof(HeavePitchModel), (kNumbers + 2) * sizeof(double));
  EXPECT_EQ(fields<HeavePitchModel>.size(), kNumbers + 2);
}

}  // namespace
}  // namespace crashsim
