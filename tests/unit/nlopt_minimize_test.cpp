#include "optimize/nlopt_minimize.hpp"

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

}  // namespace
}  // namespace crashsim
