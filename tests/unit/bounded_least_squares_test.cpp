#include "optimize/bounded_least_squares.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/QR>

#include "support/random.hpp"

namespace crashsim {
namespace {

constexpr double kStationary = 1e-10;  // rounding: descent of unit columns, relative to |b|

struct Problem {
  Eigen::MatrixXd a;
  Eigen::VectorXd b, upper;
};

Problem random_problem(test::Random& random, int rows, int columns) {
  Problem problem{Eigen::MatrixXd(rows, columns), Eigen::VectorXd(rows), Eigen::VectorXd(columns)};
  for (double& entry : problem.a.reshaped()) entry = random.between(-1.0, 1.0);
  for (double& entry : problem.b) entry = random.between(-1.0, 1.0);
  for (double& entry : problem.upper) entry = random.between(0.01, 0.6);
  return problem;
}

/// Karush-Kuhn-Tucker: no descent inside, none that leads back from a bound.
void expect_optimal(const Problem& problem, const Eigen::VectorXd& p, const std::string& which) {
  const Eigen::VectorXd descent = problem.a.transpose() * (problem.b - problem.a * p);
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    const double tolerance = kStationary * problem.b.norm() * problem.a.col(i).norm();
    EXPECT_GE(p[i], 0.0) << which;
    EXPECT_LE(p[i], problem.upper[i]) << which;
    if (p[i] < problem.upper[i]) {
      EXPECT_LE(descent[i], tolerance) << which << ", " << i;
    }
    if (p[i] > 0.0) {
      EXPECT_GE(descent[i], -tolerance) << which << ", " << i;
    }
  }
}

TEST(BoundedLeastSquares, SatisfiesTheOptimalityConditionsOnRandomProblems) {
  constexpr int kProblems = 2000;
  test::Random random(41);
  for (int i = 0; i < kProblems; ++i) {
    const int columns = random.whole(1, 14);
    const Problem problem = random_problem(random, columns + random.whole(0, 30), columns);
    expect_optimal(problem, bounded_least_squares(problem.a, problem.b, problem.upper), "problem " + std::to_string(i));
  }
}

/// Smallest residual over every choice of free variables and bounds.
double brute_force(const Problem& problem) {
  const Eigen::Index n = problem.a.cols();
  double best = std::numeric_limits<double>::infinity();
  int choices = 1;
  for (Eigen::Index i = 0; i < n; ++i) choices *= 3;
  for (int choice = 0; choice < choices; ++choice) {
    Eigen::VectorXd p = Eigen::VectorXd::Zero(n);
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0, rest = choice; i < n; ++i, rest /= 3) {
      if (rest % 3 == 1) p[i] = problem.upper[i];
      if (rest % 3 == 2) free.push_back(i);
    }
    if (!free.empty()) {
      const Eigen::MatrixXd columns = problem.a(Eigen::all, free);
      const Eigen::VectorXd solution = columns.colPivHouseholderQr().solve(problem.b - problem.a * p);
      for (std::size_t j = 0; j < free.size(); ++j) p[free[j]] = solution[static_cast<Eigen::Index>(j)];
    }
    if ((p.array() < 0.0).any() || (p.array() > problem.upper.array()).any()) continue;
    best = std::min(best, (problem.a * p - problem.b).norm());
  }
  return best;
}

TEST(BoundedLeastSquares, HasTheSmallestResidualOfAllActiveSets) {
  constexpr int kProblems = 100;
  test::Random random(42);
  for (int i = 0; i < kProblems; ++i) {
    const Problem problem = random_problem(random, 8, random.whole(1, 5));
    const Eigen::VectorXd p = bounded_least_squares(problem.a, problem.b, problem.upper);
    const double best = brute_force(problem);
    EXPECT_NEAR((problem.a * p - problem.b).norm(), best, kStationary * best) << "problem " << i;
  }
}

TEST(BoundedLeastSquares, CopesWithNearlyDependentColumnsOfAnySize) {
  constexpr int kProblems = 500;
  test::Random random(43);
  for (int i = 0; i < kProblems; ++i) {
    Problem problem = random_problem(random, 30, 10);
    for (Eigen::Index j = 1; j < 10; j += 2) {
      const double apart = std::pow(10.0, -random.between(6.0, 17.0));
      problem.a.col(j) = problem.a.col(j - 1) + apart * problem.a.col(j);
    }
    for (Eigen::Index j = 0; j < 10; ++j) {
      const double size = std::pow(10.0, random.between(-8.0, 8.0));
      problem.a.col(j) *= size;
      problem.upper[j] /= size;
    }
    const Eigen::VectorXd p = bounded_least_squares(problem.a, problem.b, problem.upper);
    expect_optimal(problem, p, "problem " + std::to_string(i));
  }
}

TEST(BoundedLeastSquares, WithoutActiveBoundsIsLeastSquares) {
  Problem problem{Eigen::MatrixXd(3, 2), Eigen::Vector3d(1.0, 2.0, 3.0), Eigen::Vector2d(10.0, 10.0)};
  problem.a << 1.0, 0.0, 1.0, 1.0, 1.0, 2.0;
  const Eigen::VectorXd p = bounded_least_squares(problem.a, problem.b, problem.upper);
  EXPECT_NEAR(p[0], 1.0, kStationary);
  EXPECT_NEAR(p[1], 1.0, kStationary);
}

TEST(BoundedLeastSquares, LeavesColumnsWithoutEffectAtZero) {
  test::Random random(44);
  Problem problem = random_problem(random, 12, 4);
  problem.a.col(2).setZero();
  const Eigen::VectorXd p = bounded_least_squares(problem.a, problem.b, problem.upper);
  EXPECT_EQ(p[2], 0.0);
  expect_optimal(problem, p, "with a column of zeros");
}

TEST(BoundedLeastSquares, TakesFewerRowsThanColumns) {
  test::Random random(45);
  const Problem problem = random_problem(random, 3, 6);
  expect_optimal(problem, bounded_least_squares(problem.a, problem.b, problem.upper), "three rows");
}

}  // namespace
}  // namespace crashsim
