#include <crashsim/heave_pitch_model.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <crashsim/option_values.hpp>

namespace crashsim {
namespace {

constexpr std::string_view kWhat = "HeavePitchModel";

/// The form of [Noorsumar2021] that stiffness and damping share: front and rear elements at -lf and +lr.
Eigen::Matrix2d axle_matrix(double front, double rear, double lf, double lr) {
  const double coupling = rear * lr - front * lf;
  return (Eigen::Matrix2d() << front + rear, coupling, coupling, front * lf * lf + rear * lr * lr).finished();
}

}  // namespace

void validate(const HeavePitchModel& model) {
  validate_options(model, kWhat);
  using M = HeavePitchModel;
  for (const auto member :
       {&M::mass_kg, &M::pitch_inertia_kgm2, &M::front_axle_m, &M::rear_axle_m, &M::front_stiffness_n_per_m,
        &M::rear_stiffness_n_per_m, &M::front_damping_ns_per_m, &M::rear_damping_ns_per_m})
    require_set(model, member, kWhat);
}

HeavePitchModel with_axle_values(const HeavePitchModel& model) {
  HeavePitchModel axle = model;
  if (!model.per_wheel) return axle;
  using M = HeavePitchModel;
  for (const auto member :
       {&M::front_stiffness_n_per_m, &M::rear_stiffness_n_per_m, &M::front_damping_ns_per_m, &M::rear_damping_ns_per_m})
    axle.*member *= 2.0;
  axle.per_wheel = false;
  return axle;
}

Eigen::Matrix2d mass_matrix(const HeavePitchModel& model) {
  return Eigen::Vector2d(model.mass_kg, model.pitch_inertia_kgm2).asDiagonal();
}

Eigen::Matrix2d damping_matrix(const HeavePitchModel& model) {
  const HeavePitchModel axle = with_axle_values(model);
  const double c1 = axle.front_damping_ns_per_m, c2 = axle.rear_damping_ns_per_m;
  const double lf = axle.front_axle_m, lr = axle.rear_axle_m;
  Eigen::Matrix2d damping = axle_matrix(c1, c2, lf, lr);
  if (model.formulation == PitchFormulation::as_printed) damping.row(0) << c1 * lf + c2 * lr, c1 + c2;
  return damping;
}

Eigen::Matrix2d stiffness_matrix(const HeavePitchModel& model) {
  const HeavePitchModel axle = with_axle_values(model);
  return axle_matrix(axle.front_stiffness_n_per_m, axle.rear_stiffness_n_per_m, axle.front_axle_m, axle.rear_axle_m);
}

bool is_dissipative(const HeavePitchModel& model) {
  const Eigen::Matrix2d damping = damping_matrix(model);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> symmetric(0.5 * (damping + damping.transpose()),
                                                                 Eigen::EigenvaluesOnly);
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * damping.norm();
  return symmetric.eigenvalues().minCoeff() >= -rounding;
}

std::vector<Mode> modes(const HeavePitchModel& model) {
  const Eigen::Matrix2d per_mass = mass_matrix(model).inverse();
  Eigen::Matrix4d free_motion = Eigen::Matrix4d::Zero();
  free_motion.topRightCorner<2, 2>().setIdentity();
  free_motion.bottomRows<2>() << -per_mass * stiffness_matrix(model), -per_mass * damping_matrix(model);
  const Eigen::EigenSolver<Eigen::Matrix4d> eigen(free_motion);
  std::vector<Mode> found;
  for (int i = 0; i < 4; ++i) {
    const std::complex<double> lambda = eigen.eigenvalues()[i];
    if (lambda.imag() < 0.0) continue;
    Mode mode{.eigenvalue = lambda, .frequency_hz = std::abs(lambda) / (2.0 * std::numbers::pi)};
    if (lambda != 0.0) mode.damping_ratio = -lambda.real() / std::abs(lambda);
    mode.pitch_per_heave = std::abs(eigen.eigenvectors()(1, i)) / std::abs(eigen.eigenvectors()(0, i));
    found.push_back(mode);
  }
  std::ranges::sort(found, {}, [](const Mode& m) { return std::pair(m.frequency_hz, m.eigenvalue.real()); });
  return found;
}

}  // namespace crashsim
