#include "optimize/gauss_newton.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gmock/gmock.h>

namespace crashsim {
namespace {

constexpr double kRounding = 1e-9;  // of a point: the square root of what the value can tell

/// Sum of squares of residuals r(p) with Jacobian J(p).
template <class Residuals>
NormalEquations squares(Residuals residuals) {
  return [residuals](std::span<const double> point, std::span<double> gradient, Eigen::MatrixXd& hessian) {
    const Eigen::Map<const Eigen::VectorXd> p(point.data(), static_cast<Eigen::Index>(point.size()));
    const auto [r, jacobian] = residuals(p);
    const Eigen::VectorXd g = 2.0 * jacobian.transpose() * r;
    std::copy(g.begin(), g.end(), gradient.begin());
    hessian = 2.0 * jacobian.transpose() * jacobian;
    return r.squaredNorm();
  };
}

struct Linearised {
  Eigen::VectorXd r;
  Eigen::MatrixXd jacobian;
};

/// Rosenbrock's valley with its bottom at (0.6, 0.36).
Linearised rosenbrock(const Eigen::VectorXd& p) {
  Linearised out{Eigen::VectorXd(2), Eigen::MatrixXd(2, 2)};
  out.r << 10.0 * (p[1] - p[0] * p[0]), 0.6 - p[0];
  out.jacobian << -20.0 * p[0], 10.0, -1.0, 0.0;
  return out;
}

TEST(GaussNewton, FollowsACurvedValley) {
  const Minimum found = minimize_by_gauss_newton(squares(rosenbrock), std::vector{0.0, 1.0}, 1e-14, 200);
  EXPECT_NEAR(found.point[0], 0.6, 1e-6);
  EXPECT_NEAR(found.point[1], 0.36, 1e-6);
  EXPECT_LT(found.evaluations, 60);
}

TEST(GaussNewton, EndsAtTheBoundsWhereTheMinimumIsOutside) {
  // |A (p - (1.4, -0.3))|^2; on the box p0 = 1, and with it 1.25 (p1 + 0.3) = 0.44.
  const auto linear = [](const Eigen::VectorXd& p) {
    Linearised out{Eigen::VectorXd(2), Eigen::MatrixXd(2, 2)};
    out.jacobian << 2.0, 0.5, 0.1, 1.0;
    out.r = out.jacobian * (p - Eigen::Vector2d(1.4, -0.3));
    return out;
  };
  const Minimum found = minimize_by_gauss_newton(squares(linear), std::vector{0.5, 0.5}, 1e-14, 100);
  EXPECT_EQ(found.point[0], 1.0);
  EXPECT_NEAR(found.point[1], 0.052, kRounding);
}

TEST(GaussNewton, LeavesABoundThatHoldsNothingBack) {
  const Minimum found = minimize_by_gauss_newton(squares(rosenbrock), std::vector{0.0, 0.0}, 1e-14, 200);
  EXPECT_NEAR(found.point[0], 0.6, 1e-6);
}

TEST(GaussNewton, LeavesAloneWhatNothingDependsOn) {
  const auto first_only = [](const Eigen::VectorXd& p) {
    Linearised out{Eigen::VectorXd(1), Eigen::MatrixXd(1, 2)};
    out.r << p[0] - 0.25;
    out.jacobian << 1.0, 0.0;
    return out;
  };
  const Minimum found = minimize_by_gauss_newton(squares(first_only), std::vector{0.9, 0.7}, 1e-14, 100);
  EXPECT_NEAR(found.point[0], 0.25, 1e-6);
  EXPECT_EQ(found.point[1], 0.7);
}

TEST(GaussNewton, GivesUpWhereTheStartHasNoValue) {
  const NormalEquations nowhere = [](std::span<const double>, std::span<double>, Eigen::MatrixXd&) {
    return std::numeric_limits<double>::infinity();
  };
  const Minimum found = minimize_by_gauss_newton(nowhere, std::vector{0.3}, 1e-6, 100);
  EXPECT_TRUE(std::isinf(found.value));
  EXPECT_EQ(found.evaluations, 1);
  EXPECT_THAT(found.point, testing::ElementsAre(0.3));
}

TEST(GaussNewton, StepsBackFromWhereThereIsNoValue) {
  // A start from which the full step leads to where the function has no value.
  const NormalEquations walled = [](std::span<const double> p, std::span<double> gradient, Eigen::MatrixXd& hessian) {
    if (p[0] > 0.6) return std::numeric_limits<double>::infinity();
    gradient[0] = 2.0 * (p[0] - 0.55) * 0.2;
    hessian(0, 0) = 0.1;
    return 0.2 * (p[0] - 0.55) * (p[0] - 0.55);
  };
  const Minimum found = minimize_by_gauss_newton(walled, std::vector{0.0}, 1e-12, 100);
  EXPECT_NEAR(found.point[0], 0.55, 1e-4);
}

}  // namespace
}  // namespace crashsim
