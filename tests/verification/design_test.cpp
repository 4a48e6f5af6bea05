/// Sensitivities of the coupled model against its closed form: a linear crush spring that also pulls and undamped axles
/// make three modes, and a motion is their sum.

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <Eigen/Dense>

#include <crashsim/design.hpp>
#include <crashsim/units.hpp>

#include "support/coupled_cases.hpp"

namespace crashsim {
namespace {

constexpr double kSlope = 1e-6;       // solver: relative, of an extrapolated difference
constexpr double kNegligible = 1e-9;  // solver: of response / parameter, where a response hardly depends on it
constexpr double kEnd = 0.2, kSpeed = 15.0;

CoupledModel linear_vehicle() {
  CoupledModel model;
  model.crush = test::kelvin_model(1500.0, 1e6, 0.0, kSpeed);
  model.crush.unloading.bilateral = true;
  model.body = test::oracle_vehicle();
  model.body.mass_kg = 1500.0;
  model.body.pitch_inertia_kgm2 = 2400.0;
  model.body.front_stiffness_n_per_m = 40e3;
  model.body.rear_stiffness_n_per_m = 75e3;
  model.body.front_damping_ns_per_m = model.body.rear_damping_ns_per_m = 0.0;
  model.body.cg_height_m = 0.60;
  model.body.force_height_m = 0.52;
  return model;
}

/// q(t) = sum of shape_i a_i sin(w_i t) / w_i over q = (x, z, theta).
class ModalMotion {
 public:
  explicit ModalMotion(const CoupledModel& model) {
    const HeavePitchModel& body = model.body;
    const double h = body.force_height_m - body.cg_height_m;
    const Eigen::Vector3d crush(1.0, 0.0, h), front(0.0, 1.0, -body.front_axle_m), rear(0.0, 1.0, body.rear_axle_m);
    const Eigen::Matrix3d stiffness = model.crush.spring.ordinates[0] * crush * crush.transpose() +
                                      body.front_stiffness_n_per_m * front * front.transpose() +
                                      body.rear_stiffness_n_per_m * rear * rear.transpose();
    const Eigen::Matrix3d mass = Eigen::Vector3d(body.mass_kg, body.mass_kg, body.pitch_inertia_kgm2).asDiagonal();
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> modes(stiffness, mass);
    omega_ = modes.eigenvalues().cwiseSqrt();
    const Eigen::Vector3d share = modes.eigenvectors().transpose() * mass * Eigen::Vector3d(kSpeed, 0.0, 0.0);
    amplitude_ = modes.eigenvectors() * share.asDiagonal();
    crush_ = crush;
  }
  [[nodiscard]] Eigen::Vector3d position(double t) const {
    return amplitude_ * ((omega_ * t).array().sin() / omega_.array()).matrix();
  }
  [[nodiscard]] Eigen::Vector3d rate(double t) const { return amplitude_ * (omega_ * t).array().cos().matrix(); }
  [[nodiscard]] Eigen::Vector3d accel(double t) const {
    return -amplitude_ * ((omega_ * t).array().sin() * omega_.array()).matrix();
  }
  [[nodiscard]] Eigen::Vector3d jerk(double t) const {
    return -amplitude_ * ((omega_ * t).array().cos() * omega_.array().square()).matrix();
  }
  [[nodiscard]] double crush(const Eigen::Vector3d& q) const { return crush_.dot(q); }

 private:
  Eigen::Vector3d omega_, crush_;
  Eigen::Matrix3d amplitude_;
};

/// First root of a function that starts with another sign.
double first_root(const std::function<double(double)>& f) {
  constexpr double kStep = 1e-4;
  const bool positive = f(kStep / 2.0) > 0.0;
  double high = kStep;
  while ((f(high) > 0.0) == positive && high < 1.0) high += kStep;
  double low = high - kStep;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    ((f(middle) > 0.0) == positive ? low : high) = middle;
  }
  return low;
}

/// The largest value of f over the motion: at a root of its derivative, or at the end.
double largest(const std::function<double(double)>& f, const std::function<double(double)>& slope) {
  constexpr int kSteps = 400;
  double best = std::max(f(0.0), f(kEnd));
  for (int i = 0; i < kSteps; ++i) {
    double low = kEnd * i / kSteps, high = kEnd * (i + 1) / kSteps;
    if (!(slope(low) > 0.0 && slope(high) <= 0.0)) continue;
    for (int k = 0; k < 100; ++k) {
      const double middle = 0.5 * (low + high);
      (slope(middle) > 0.0 ? low : high) = middle;
    }
    best = std::max(best, f(low));
  }
  return best;
}

double olc(const ModalMotion& motion) {
  const auto x = [&](double t) { return motion.position(t)[0]; };
  const auto v = [&](double t) { return motion.rate(t)[0]; };
  const double t1 = first_root([&](double t) { return kSpeed * t - x(t) - 0.065; });
  const double t2 =
      t1 + first_root([&](double dt) { return (kSpeed + v(t1 + dt)) / 2.0 * dt - (x(t1 + dt) - x(t1)) - 0.235; });
  return (kSpeed - v(t2)) / (t2 - t1) / 9.81;
}

DesignResponses closed_form(const CoupledModel& model) {
  const ModalMotion motion(model);
  const auto of = [&](Eigen::Vector3d (ModalMotion::*what)(double) const, int i, double sign) {
    return [&motion, what, i, sign](double t) { return sign * (motion.*what)(t)[i]; };
  };
  using Modal = ModalMotion;
  DesignResponses r;
  r.t_m_s = first_root([&](double t) { return motion.crush(motion.rate(t)); });
  r.max_crush_m = motion.crush(motion.position(r.t_m_s));
  r.pitch_max_rad = largest(of(&Modal::position, 2, 1.0), of(&Modal::rate, 2, 1.0));
  r.heave_min_m = -largest(of(&Modal::position, 1, -1.0), of(&Modal::rate, 1, -1.0));
  r.peak_decel_g = largest(of(&Modal::accel, 0, -1.0), of(&Modal::jerk, 0, -1.0)) / kStandardGravity;
  r.olc_g = olc(motion);
  return r;
}

struct Named {
  const char* name;
  double& (*value)(CoupledModel&);
};
constexpr Named kNumbers[] = {
    {"force_height_m", [](CoupledModel& m) -> double& { return m.body.force_height_m; }},
    {"cg_height_m", [](CoupledModel& m) -> double& { return m.body.cg_height_m; }},
    {"pitch_inertia_kgm2", [](CoupledModel& m) -> double& { return m.body.pitch_inertia_kgm2; }},
    {"front_axle_m", [](CoupledModel& m) -> double& { return m.body.front_axle_m; }},
    {"rear_axle_m", [](CoupledModel& m) -> double& { return m.body.rear_axle_m; }},
    {"front_stiffness_n_per_m", [](CoupledModel& m) -> double& { return m.body.front_stiffness_n_per_m; }},
    {"rear_stiffness_n_per_m", [](CoupledModel& m) -> double& { return m.body.rear_stiffness_n_per_m; }},
    {"mass_kg", [](CoupledModel& m) -> double& { return m.body.mass_kg; }},
    {"k1_n_per_m", [](CoupledModel& m) -> double& { return m.crush.spring.ordinates[0]; }},
};

/// Fourth-order difference of the closed form, whose rounding allows small steps.
double closed_slope(const Named& number, double DesignResponses::*response) {
  CoupledModel model = linear_vehicle();
  const double value = number.value(model), step = 1e-3 * value;
  const auto at = [&](double steps) {
    number.value(model) = value + steps * step;
    return closed_form(model).*response;
  };
  return (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * step);
}

TEST(DesignSensitivities, AgreeWithTheModesOfALinearVehicle) {
  DesignOptions options;
  options.minimise = DesignQuantity::none;
  CoupledModel model = linear_vehicle();
  for (const Named& number : kNumbers) {
    options.parameters.emplace_back(number.name);
    options.lower.push_back(format_number(0.9 * number.value(model)));
    options.upper.push_back(format_number(1.1 * number.value(model)));
  }
  CoupledOptions simulation;
  simulation.end_time_s = kEnd;
  const DesignResult result = design(model, options, simulation);
  ASSERT_TRUE(result.usable()) << result.message;
  const DesignResponses exact = closed_form(model);
  for (const auto& response : kDesignResponses)
    EXPECT_NEAR(result.before.*response.member, exact.*response.member, kNegligible * std::fabs(exact.*response.member))
        << response.name;
  auto s = result.sensitivities.begin();
  for (const Named& number : kNumbers)
    for (const auto& response : kDesignResponses) {
      ASSERT_EQ(s->parameter + s->response, std::string(number.name) + std::string(response.name));
      const double expected = closed_slope(number, response.member);
      const double scale = std::fabs(exact.*response.member / number.value(model));
      EXPECT_NEAR(s->derivative, expected, kSlope * std::fabs(expected) + kNegligible * scale)
          << "d " << response.name << " / d " << number.name;
      EXPECT_LE(std::fabs(s->derivative - expected), s->error) << "d " << response.name << " / d " << number.name;
      ++s;
    }
}

}  // namespace
}  // namespace crashsim
