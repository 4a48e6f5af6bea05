/// The gradient of the objective for every law, kind of curve and free knots, against differences of E from CVODE.

#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <crashsim/simulate.hpp>

#include "optimize/fit_objective.hpp"
#include "support/fit_cases.hpp"

namespace crashsim {
namespace {

constexpr double kValue = 1e-8;       // solver: between the kernel's E and CVODE's
constexpr double kGradient = 3e-5;    // of the largest scaled derivative: CVODE's error over the step, and the step's
constexpr double kNormal = 1e-10;     // rounding: the same derivatives summed in another order
constexpr double kTruncation = 1e-7;  // of the series, whose derivative the Jacobian takes for the acceleration
constexpr double kStep = 1e-4;        // of a parameter's size, for central differences
constexpr double kRtol = 1e-12;
constexpr double kSpeed_mps = 15.0, kMass_kg = 1500.0;

struct Case {
  const char* name;
  CrushLaw law;
  Curve curve;
  bool has_free_knots;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

FitStructure structure_of(const Case& c) {
  FitStructure structure{c.law, uniform_knots(0.7, 6), uniform_knots(c.law == CrushLaw::crush_damping ? 0.7 : 15.0, 5)};
  if (c.law == CrushLaw::rate) structure.damper_knots.clear();
  structure.reference_speed_mps = 0.8;
  structure.curve = c.curve;
  structure.has_free_knots = c.has_free_knots;
  return structure;
}

/// Sizes of the parameters, whose random parts the tests take.
std::vector<double> sizes_of(const FitStructure& structure) {
  const double spring = structure.law == CrushLaw::stiffness ? 6e5 : 3e5;
  const double damper = 1.2e4;
  std::vector<double> sizes(structure.springs(), spring);
  sizes.insert(sizes.end(), structure.dampers(), damper);
  if (structure.has_rate()) sizes.push_back(0.3);
  const Eigen::VectorXd knots = free_knot_ranges(structure);
  sizes.insert(sizes.end(), knots.begin(), knots.end());
  return sizes;
}

std::vector<double> random_parameters(const FitStructure& structure, test::Random& random) {
  std::vector<double> parameters = sizes_of(structure);
  for (double& parameter : parameters) parameter *= random.between(0.3, 0.9);
  return parameters;
}

/// A target that no model of the structures meets.
FitTarget make_target_of(const FitStructure& structure, test::Random& random) {
  CrushModel model = make_model(structure, random_parameters(structure, random), kMass_kg, kSpeed_mps);
  return make_target(test::pulse_of(model, kSpeed_mps, 1e-3).value(), kUnset, {});
}

double error_by_cvode(const FitStructure& structure, const std::vector<double>& parameters, const FitTarget& target) {
  SimulateOptions options;
  options.times_s = target.time_s;
  options.rtol = kRtol;
  const CrushResponse run =
      simulate(make_model(structure, parameters, target.mass_kg, target.impact_speed_mps), options);
  double sum = 0.0;
  for (std::size_t i = 0; i < target.time_s.size(); ++i) {
    const auto add = [&](double value, double data, double scale) {
      sum += scale * (value - data) * scale * (value - data);
    };
    add(run.accel_mps2.at(i), target.accel_mps2[i], target.accel_scale);
    add(run.velocity_mps.at(i), target.velocity_mps[i], target.velocity_scale);
    add(run.displacement_m.at(i), target.displacement_m[i], target.displacement_scale);
  }
  return target.factor * sum;
}

class LawGradient : public testing::TestWithParam<Case> {};

TEST_P(LawGradient, IsThatOfDifferences) {
  const FitStructure structure = structure_of(GetParam());
  test::Random random(21);
  for (int i = 0; i < 3; ++i) {
    const FitTarget target = make_target_of(structure, random);
    std::vector<double> parameters = random_parameters(structure, random);
    const std::vector<double> sizes = sizes_of(structure);
    FitObjective objective(structure, {&target, 1}, Loss::l2, 0.0);
    std::vector<double> gradient(parameters.size());
    const double value = objective.evaluate(parameters, 0.0, gradient);
    EXPECT_NEAR(value, error_by_cvode(structure, parameters, target), kValue * value);
    double worst = 0.0, largest = 0.0;
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      const double step = kStep * sizes[p];
      std::vector<double> up = parameters, down = parameters;
      up[p] += step;
      down[p] -= step;
      const double difference =
          (error_by_cvode(structure, up, target) - error_by_cvode(structure, down, target)) / (2.0 * step);
      worst = std::max(worst, sizes[p] * std::fabs(gradient[p] - difference));
      largest = std::max(largest, sizes[p] * std::fabs(difference));
      EXPECT_LE(sizes[p] * std::fabs(gradient[p] - difference), kGradient * (largest + value)) << "parameter " << p;
    }
    RecordProperty("worst", std::to_string(1e9 * worst / largest) + "e-9");
    EXPECT_GT(largest, 0.0);
  }
}

TEST_P(LawGradient, IsThatOfTheNormalEquationsAndTheJacobian) {
  const FitStructure structure = structure_of(GetParam());
  test::Random random(22);
  const FitTarget target = make_target_of(structure, random);
  const std::vector<double> parameters = random_parameters(structure, random);
  const auto n = static_cast<Eigen::Index>(parameters.size());
  FitObjective objective(structure, {&target, 1}, Loss::l2, 1e-3);
  Eigen::VectorXd gradient(n), other(n);
  Eigen::MatrixXd hessian(n, n);
  const auto view = [](Eigen::VectorXd& v) { return std::span<double>(v.data(), static_cast<std::size_t>(v.size())); };
  const double value = objective.evaluate(parameters, 0.0, view(gradient));
  EXPECT_NEAR(objective.normal_equations(parameters, 0.0, view(other), hessian), value, kNormal * value);
  const std::vector<double> scales = sizes_of(structure);
  const Eigen::VectorXd scale = Eigen::Map<const Eigen::VectorXd>(scales.data(), n);
  gradient = gradient.cwiseProduct(scale);
  other = other.cwiseProduct(scale);
  EXPECT_LE((gradient - other).cwiseAbs().maxCoeff(), kNormal * gradient.cwiseAbs().maxCoeff());
  hessian = scale.asDiagonal() * hessian * scale.asDiagonal();
  Eigen::MatrixXd rows(objective.jacobian(parameters));
  const Eigen::MatrixXd penalties = objective.penalty_rows();
  const Eigen::MatrixXd expected =
      2.0 * scale.asDiagonal() * (rows.transpose() * rows + penalties.transpose() * penalties) * scale.asDiagonal();
  EXPECT_LE((hessian - expected).cwiseAbs().maxCoeff(), kTruncation * expected.cwiseAbs().maxCoeff());
}

INSTANTIATE_TEST_SUITE_P(Structures, LawGradient,
                         testing::Values(Case{"force", CrushLaw::force, Curve::linear, false},
                                         Case{"crush_damping", CrushLaw::crush_damping, Curve::linear, false},
                                         Case{"rate", CrushLaw::rate, Curve::linear, false},
                                         Case{"stiffness_pchip", CrushLaw::stiffness, Curve::pchip, false},
                                         Case{"crush_damping_pchip", CrushLaw::crush_damping, Curve::pchip, false},
                                         Case{"rate_pchip", CrushLaw::rate, Curve::pchip, false},
                                         Case{"stiffness_free", CrushLaw::stiffness, Curve::linear, true},
                                         Case{"crush_damping_free", CrushLaw::crush_damping, Curve::linear, true},
                                         Case{"rate_free", CrushLaw::rate, Curve::linear, true}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace crashsim
