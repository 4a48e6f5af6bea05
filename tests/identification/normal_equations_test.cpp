/// Gauss-Newton's normal equations of the fit against its gradient and its Jacobian, which are checked elsewhere.

#include <vector>

#include <gtest/gtest.h>

#include "optimize/fit_objective.hpp"
#include "support/fit_cases.hpp"

namespace crashsim {
namespace {

constexpr double kRounding = 1e-11;   // of the largest entry: sums in another order
constexpr double kTruncation = 1e-8;  // of the series, whose derivative the Jacobian takes for the acceleration

struct Fit {
  FitTarget target;
  FitStructure structure;
  std::vector<double> ordinates;
};

Fit make_fit(CrushLaw law) {
  test::Random random(4);
  const CrushModel model = test::random_crush_model(random, law);
  Fit fit{make_target(test::pulse_of(model, model.impact_speed_mps).value(), model.mass_kg, {}),
          {model.law, model.spring.knots, model.damper.knots},
          test::ordinates_of(model)};
  for (double& ordinate : fit.ordinates) ordinate *= 1.3;
  return fit;
}

class NormalEquationsOf : public testing::TestWithParam<CrushLaw> {};
INSTANTIATE_TEST_SUITE_P(Laws, NormalEquationsOf, testing::Values(CrushLaw::stiffness, CrushLaw::force),
                         [](const auto& law) { return std::string(name_of(law.param)); });

TEST_P(NormalEquationsOf, HaveTheValueAndTheGradient) {
  const Fit fit = make_fit(GetParam());
  const auto n = static_cast<Eigen::Index>(fit.ordinates.size());
  for (const Loss loss : {Loss::l1, Loss::l2, Loss::huber}) {
    FitObjective objective(fit.structure, {&fit.target, 1}, loss, 1e-3);
    Eigen::VectorXd gradient(n), other(n);
    Eigen::MatrixXd hessian(n, n);
    const auto view = [](Eigen::VectorXd& v) {
      return std::span<double>(v.data(), static_cast<std::size_t>(v.size()));
    };
    const double value = objective.evaluate(fit.ordinates, 1e-2, view(gradient));
    EXPECT_NEAR(objective.normal_equations(fit.ordinates, 1e-2, view(other), hessian), value, kRounding * value);
    EXPECT_LE((gradient - other).cwiseAbs().maxCoeff(), kRounding * gradient.cwiseAbs().maxCoeff());
    EXPECT_LE((hessian - hessian.transpose()).cwiseAbs().maxCoeff(), kRounding * hessian.cwiseAbs().maxCoeff());
  }
}

TEST_P(NormalEquationsOf, AreTheJacobiansSquareForTheSquaredLoss) {
  const Fit fit = make_fit(GetParam());
  const auto n = static_cast<Eigen::Index>(fit.ordinates.size());
  FitObjective objective(fit.structure, {&fit.target, 1}, Loss::l2, 0.0);
  std::vector<double> gradient(fit.ordinates.size());
  Eigen::MatrixXd hessian(n, n);
  objective.normal_equations(fit.ordinates, 0.0, gradient, hessian);
  const Eigen::MatrixXd jacobian = objective.jacobian(fit.ordinates);
  const Eigen::MatrixXd expected = 2.0 * jacobian.transpose() * jacobian;
  EXPECT_LE((hessian - expected).cwiseAbs().maxCoeff(), kTruncation * expected.cwiseAbs().maxCoeff());
}

}  // namespace
}  // namespace crashsim
