#include "optimize/nlopt_minimize.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>

namespace crashsim {
namespace {

constexpr double kTight = 1e-12;   // ftol_rel
constexpr double kMinimum = 1e-4;  // solver: distance to a minimum where the value changes by kTight
constexpr int kEnough = 1000;

double bowl(std::span<const double> p, std::span<double> gradient) {
  const double centre[] = {0.3, 1.7};  // the second outside the box
  double sum = 0.1;
  for (std::size_t i = 0; i < p.size(); ++i) {
    sum += (p[i] - centre[i]) * (p[i] - centre[i]);
    gradient[i] = 2.0 * (p[i] - centre[i]);
  }
  return sum;
}

const std::vector<double> kStart = {0.9, 0.1};

class Minimise : public testing::TestWithParam<Algorithm> {};

TEST_P(Minimise, FindsTheMinimumInTheBox) {
  const Minimum minimum = minimize_in_unit_box(GetParam(), bowl, kStart, kTight, kEnough);
  EXPECT_NEAR(minimum.point.at(0), 0.3, kMinimum);
  EXPECT_NEAR(minimum.point.at(1), 1.0, kMinimum);
  std::vector<double> gradient(2);
  EXPECT_EQ(minimum.value, bowl(minimum.point, gradient));
  EXPECT_GT(minimum.evaluations, 1);
}

TEST_P(Minimise, PassesOnWhatTheFunctionThrows) {
  int calls = 0;
  const auto thrower = [&](std::span<const double> p, std::span<double> gradient) {
    if (++calls == 3) throw std::out_of_range("third call");
    return bowl(p, gradient);
  };
  try {
    minimize_in_unit_box(GetParam(), thrower, kStart, kTight, kEnough);
    FAIL() << "nothing thrown";
  } catch (const std::out_of_range& error) {
    EXPECT_STREQ(error.what(), "third call");
  }
  EXPECT_EQ(calls, 3);
}

TEST_P(Minimise, StopsAtTheLimitWithTheBestPoint) {
  const auto valley = [](std::span<const double> p, std::span<double> gradient) {  // Rosenbrock's, slow
    const double x = 4.0 * p[0] - 2.0, y = 4.0 * p[1] - 2.0, d = y - x * x;
    gradient[0] = 4.0 * (-400.0 * x * d - 2.0 * (1.0 - x));
    gradient[1] = 4.0 * 200.0 * d;
    return 100.0 * d * d + (1.0 - x) * (1.0 - x);
  };
  constexpr int kLimit = 6, kSlack = 2;  // an algorithm may look once more
  double best = std::numeric_limits<double>::infinity();
  const auto watched = [&](std::span<const double> p, std::span<double> gradient) {
    const double value = valley(p, gradient);
    best = std::min(best, value);
    return value;
  };
  const Minimum minimum = minimize_in_unit_box(GetParam(), watched, {{0.1, 0.6}}, kTight, kLimit);
  EXPECT_LE(minimum.evaluations, kLimit + kSlack);
  EXPECT_EQ(minimum.value, best);
}

TEST_P(Minimise, NeverLeavesTheBox) {
  const auto guarded = [](std::span<const double> p, std::span<double> gradient) {
    for (const double x : p)
      if (!(x >= 0.0 && x <= 1.0)) throw std::logic_error("outside");
    return bowl(p, gradient);
  };
  EXPECT_NO_THROW(minimize_in_unit_box(GetParam(), guarded, kStart, kTight, kEnough));
}

TEST_P(Minimise, SurvivesAFunctionThatFailsInPlaces) {
  const auto partial = [](std::span<const double> p, std::span<double> gradient) {
    const double value = bowl(p, gradient);
    return p[0] < 0.2 ? std::numeric_limits<double>::infinity() : value;
  };
  const Minimum minimum = minimize_in_unit_box(GetParam(), partial, kStart, kTight, kEnough);
  EXPECT_TRUE(std::isfinite(minimum.value));
  int calls = 0;
  const auto never = [&](std::span<const double>, std::span<double> gradient) {
    ++calls;
    std::fill(gradient.begin(), gradient.end(), 0.0);
    return std::numeric_limits<double>::infinity();
  };
  const Minimum failed = minimize_in_unit_box(GetParam(), never, kStart, kTight, kEnough);
  EXPECT_EQ(failed.value, std::numeric_limits<double>::infinity());
  EXPECT_EQ(failed.point, kStart);
  EXPECT_EQ(calls, 1);
}

INSTANTIATE_TEST_SUITE_P(Algorithms, Minimise,
                         testing::Values(Algorithm::lbfgs, Algorithm::slsqp, Algorithm::tnewton, Algorithm::var2),
                         [](const auto& algorithm) { return std::string(name_of(algorithm.param)); });

TEST(MinimiseInUnitBox, RefusesAStartOutsideTheBox) {
  EXPECT_THROW(minimize_in_unit_box(Algorithm::lbfgs, bowl, {{1.5, 0.5}}, kTight, kEnough), NumericalFailure);
}

/// (x - 1)^2 + (y - 1)^2 inside the circle x^2 + y^2 <= 1 / 2, whose nearest point is (1/2, 1/2).
void circle(std::span<const double> p, std::span<double> values, std::span<double> gradients) {
  values[0] = (p[0] - 1.0) * (p[0] - 1.0) + (p[1] - 1.0) * (p[1] - 1.0);
  values[1] = p[0] * p[0] + p[1] * p[1] - 0.5;
  if (gradients.empty()) return;
  for (std::size_t j = 0; j < 2; ++j) {
    gradients[j] = 2.0 * (p[j] - 1.0);
    gradients[2 + j] = 2.0 * p[j];
  }
}

class MinimiseConstrained : public testing::TestWithParam<ConstrainedAlgorithm> {};

TEST_P(MinimiseConstrained, FindsTheMinimumOnTheConstraintAndKeepsIt) {
  const ConstrainedMinimum minimum = minimize_constrained(GetParam(), circle, 1, kStart, kTight, kEnough);
  EXPECT_NEAR(minimum.point.at(0), 0.5, kMinimum);
  EXPECT_NEAR(minimum.point.at(1), 0.5, kMinimum);
  EXPECT_LE(minimum.violation, 0.0);
  EXPECT_GT(minimum.violation, -kMinimum);
  EXPECT_GT(minimum.evaluations, 1);
}

TEST_P(MinimiseConstrained, ComesNearestWhereNothingKeepsTheConstraint) {
  const auto impossible = [](std::span<const double> p, std::span<double> values, std::span<double> gradients) {
    values[0] = p[1];
    values[1] = 0.25 + (p[0] - 0.75) * (p[0] - 0.75) + 0.1 * p[1];
    if (gradients.empty()) return;
    const double rows[] = {0.0, 1.0, 2.0 * (p[0] - 0.75), 0.1};
    std::copy(std::begin(rows), std::end(rows), gradients.begin());
  };
  const ConstrainedMinimum minimum = minimize_constrained(GetParam(), impossible, 1, kStart, kTight, kEnough);
  EXPECT_GT(minimum.violation, 0.25 - kMinimum);
  EXPECT_LT(minimum.violation, 0.26);
}

TEST_P(MinimiseConstrained, PassesOnWhatTheFunctionThrows) {
  const auto thrower = [](std::span<const double> p, std::span<double> values, std::span<double> gradients) {
    if (p[0] < 0.8) throw std::out_of_range("too small");
    circle(p, values, gradients);
  };
  EXPECT_THROW(minimize_constrained(GetParam(), thrower, 1, kStart, kTight, kEnough), std::out_of_range);
}

TEST_P(MinimiseConstrained, PrefersAPointThatCanBeUsed) {
  const auto partial = [](std::span<const double> p, std::span<double> values, std::span<double> gradients) {
    circle(p, values, gradients);
    if (p[0] > 0.8) values[0] = std::numeric_limits<double>::infinity();
  };
  const ConstrainedMinimum minimum = minimize_constrained(GetParam(), partial, 1, {{0.1, 0.2}}, kTight, kEnough);
  EXPECT_NEAR(minimum.point.at(0), 0.5, kMinimum);
}

INSTANTIATE_TEST_SUITE_P(Algorithms, MinimiseConstrained,
                         testing::Values(ConstrainedAlgorithm::slsqp, ConstrainedAlgorithm::cobyla),
                         [](const auto& algorithm) {
                           return algorithm.param == ConstrainedAlgorithm::slsqp ? "slsqp" : "cobyla";
                         });

TEST(MinimiseConstrainedCobyla, ComesNearTheBottomOfAKink) {
  constexpr double kNear = 1e-2;  // solver: COBYLA's simplex shrinks early at a kink
  const auto kinked = [](std::span<const double> p, std::span<double> values, std::span<double>) {
    values[0] = std::fabs(p[0] - 0.3) + (p[1] - 0.6) * (p[1] - 0.6);
  };
  const ConstrainedMinimum minimum =
      minimize_constrained(ConstrainedAlgorithm::cobyla, kinked, 0, kStart, kTight, kEnough);
  EXPECT_LT(minimum.value, kNear);
  EXPECT_EQ(minimum.violation, 0.0);
}

}  // namespace
}  // namespace crashsim
