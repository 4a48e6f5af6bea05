/// Smoothing chosen from the data: closed form, SciPy's minima, and plain search over dense algebra.

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "optimize/bounded_least_squares.hpp"
#include "optimize/smoothing_choice.hpp"

namespace crashsim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kAtMinimum = 1e-5;  // solver: a minimum's place, its value known to rounding
constexpr double kValue = 1e-9;      // solver: a smooth function near its minimum
constexpr double kCurvature = 1e-6;  // regression: from differences in 40 digits

VectorXd generous(Index count) { return VectorXd::Constant(count, 1e3); }

MatrixXd second_differences(Index count) {
  MatrixXd rows = MatrixXd::Zero(count - 2, count);
  for (Index i = 0; i + 2 < count; ++i) {
    rows(i, i) = rows(i, i + 2) = 1.0;
    rows(i, i + 1) = -2.0;
  }
  return rows;
}

/// Hats on 0..1 at 24 places that show a curve with waves that no 7 hats can follow.
EquationErrorSystem wavy(const std::function<double(double)>& curve) {
  constexpr Index kSamples = 24, kKnots = 7;
  EquationErrorSystem system{MatrixXd::Zero(kSamples, kKnots), VectorXd(kSamples), second_differences(kKnots)};
  for (Index i = 0; i < kSamples; ++i) {
    const double x = static_cast<double>(i) / (kSamples - 1);
    for (Index j = 0; j < kKnots; ++j)
      system.rows(i, j) = std::max(0.0, 1.0 - std::fabs(x * (kKnots - 1) - static_cast<double>(j)));
    system.rhs[i] = curve(x);
  }
  return system;
}

EquationErrorSystem wavy() {
  return wavy([](double x) { return 2.0 + std::sin(3.0 * x) + 0.1 * std::cos(40.0 * x) + 0.05 * std::sin(71.0 * x); });
}

/// The ordinates at a weight.
VectorXd ordinates_at(const EquationErrorSystem& system, const VectorXd& upper, double smooth) {
  MatrixXd a(system.rows.rows() + system.roughness.rows(), system.rows.cols());
  a << system.rows, std::sqrt(smooth) * system.roughness;
  VectorXd b = VectorXd::Zero(a.rows());
  b.head(system.rhs.size()) = system.rhs;
  return bounded_least_squares(a, b, upper);
}

/// Score of cross-validation by dense algebra, ordinates at bounds left out of the trace.
double plain_gcv(const EquationErrorSystem& system, const VectorXd& upper, double smooth) {
  const VectorXd p = ordinates_at(system, upper, smooth);
  std::vector<Index> free;
  for (Index i = 0; i < p.size(); ++i)
    if (p[i] > 0.0 && p[i] < upper[i]) free.push_back(i);
  const MatrixXd a = system.rows(Eigen::all, free), r = system.roughness(Eigen::all, free);
  const MatrixXd normal = a.transpose() * a + smooth * r.transpose() * r;
  const double trace = (normal.fullPivLu().solve(a.transpose() * a)).trace();
  const auto n = static_cast<double>(a.rows());
  return n * (system.rows * p - system.rhs).squaredNorm() / ((n - trace) * (n - trace));
}

/// The least of a function of the weight over a fine grid.
double least_over_grid(const std::function<double(double)>& score) {
  double least = std::numeric_limits<double>::infinity();
  for (double exponent = -8.0; exponent <= 6.0; exponent += 0.01)
    least = std::min(least, score(std::pow(10.0, exponent)));
  return least;
}

/// rows = [1; 0], roughness = 1: with f = 1/(1+s) the least of n ((1-f)^2 B1 + B2) / (n - p f)^2 is at
/// f = 1 - p B2 / ((n - p) B1), B1 and B2 the squares that the ordinates can and cannot follow.
TEST(SmoothingChoice, ByCrossValidationIsTheClosedForm) {
  constexpr Index kOrdinates = 3, kSamples = 8;
  EquationErrorSystem system{MatrixXd::Identity(kSamples, kOrdinates), VectorXd(kSamples),
                             MatrixXd::Identity(kOrdinates, kOrdinates)};
  system.rhs << 3.0, 2.0, 4.0, 1.0, -0.5, 1.5, 0.3, -1.0;
  const double followed = system.rhs.head(kOrdinates).squaredNorm(), rest = system.rhs.tail(5).squaredNorm();
  const double f = 1.0 - 3.0 * rest / (5.0 * followed);
  const SmoothingChoice choice = choose_smoothing(system, generous(kOrdinates), Smoothing::gcv);
  EXPECT_NEAR(choice.smooth, 1.0 / f - 1.0, kAtMinimum * choice.smooth);
  EXPECT_NEAR(choice.freedom, 3.0 * f, kAtMinimum);
  EXPECT_NEAR(choice.criterion, 8.0 * ((1.0 - f) * (1.0 - f) * followed + rest) / std::pow(8.0 - 3.0 * f, 2.0), kValue);
  EXPECT_FALSE(choice.at_edge);
}

struct Recorded {
  double smooth, criterion, residual, roughness, freedom;
};
void expect_recorded(const SmoothingChoice& choice, const Recorded& recorded, double criterion_tolerance) {
  EXPECT_NEAR(choice.smooth, recorded.smooth, kAtMinimum * recorded.smooth);
  EXPECT_NEAR(choice.criterion, recorded.criterion, criterion_tolerance * recorded.criterion);
  EXPECT_NEAR(choice.residual, recorded.residual, kAtMinimum * recorded.residual);
  EXPECT_NEAR(choice.roughness, recorded.roughness, kAtMinimum * recorded.roughness);
  EXPECT_NEAR(choice.freedom, recorded.freedom, kAtMinimum * recorded.freedom);
  EXPECT_FALSE(choice.at_edge);
}

TEST(SmoothingChoice, ByCrossValidationIsSciPys) {
  expect_recorded(choose_smoothing(wavy(), generous(7), Smoothing::gcv),
                  {0.6260005316, 0.00858749466259, 0.137457537788, 0.165557431605, 4.39997339114}, kValue);
}

TEST(SmoothingChoice, OfCorrelatedSamplesIsSciPys) {
  expect_recorded(choose_smoothing(wavy(), generous(7), Smoothing::gcv, 2.0),
                  {1.030136313, 0.0138015302007, 0.146160143669, 0.155000001347, 4.02874897637}, kValue);
}

TEST(SmoothingChoice, ByTheLCurveIsWhatFortyDigitsGive) {
  expect_recorded(choose_smoothing(wavy(), generous(7), Smoothing::l_curve),
                  {0.134542708452, 6.3510392523536, 0.131887454909, 0.180590059559, 5.62771801818}, kCurvature);
}

/// Data that ask for negative ordinates, and for some above their bound.
TEST(SmoothingChoice, WithBoundsIsWhatPlainSearchFinds) {
  const EquationErrorSystem system =
      wavy([](double x) { return 1.5 * std::sin(7.0 * x) + 0.3 * std::cos(40.0 * x) + 0.2 * std::sin(71.0 * x); });
  const VectorXd upper = VectorXd::Constant(7, 1.2);
  const SmoothingChoice choice = choose_smoothing(system, upper, Smoothing::gcv);
  const VectorXd p = ordinates_at(system, upper, choice.smooth);
  ASSERT_EQ(p.minCoeff(), 0.0);
  ASSERT_EQ(p.maxCoeff(), 1.2);
  EXPECT_NEAR(choice.criterion, plain_gcv(system, upper, choice.smooth), kValue * choice.criterion);
  EXPECT_NEAR(choice.residual, (system.rows * p - system.rhs).squaredNorm(), kValue * choice.residual);
  EXPECT_NEAR(choice.roughness, (system.roughness * p).squaredNorm(), kValue * choice.roughness);
  const double least = least_over_grid([&](double smooth) { return plain_gcv(system, upper, smooth); });
  EXPECT_LE(choice.criterion, least * (1.0 + kValue));
}

/// An ordinate that no sample touches is held by the roughness alone.
TEST(SmoothingChoice, WithAnUntouchedOrdinateIsWhatPlainSearchFinds) {
  EquationErrorSystem system = wavy();
  const std::vector<Index> seen = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  system.rows = MatrixXd(system.rows(seen, Eigen::all));
  system.rhs = VectorXd(system.rhs(seen));
  ASSERT_EQ(system.rows.col(6).norm(), 0.0);
  const SmoothingChoice choice = choose_smoothing(system, generous(7), Smoothing::gcv);
  const double least = least_over_grid([&](double smooth) { return plain_gcv(system, generous(7), smooth); });
  EXPECT_LE(choice.criterion, least * (1.0 + kValue));
  EXPECT_NEAR(choice.criterion, plain_gcv(system, generous(7), choice.smooth), kValue * choice.criterion);
}

TEST(SmoothingChoice, OfAStraightCurveWithWavesIsTheLargest) {
  const EquationErrorSystem system = wavy([](double x) { return 1.0 + x + 0.1 * std::cos(37.0 * x); });
  const SmoothingChoice choice = choose_smoothing(system, generous(7), Smoothing::gcv);
  EXPECT_TRUE(choice.at_edge);
  constexpr double kStraight = 2.0,
                   kNearly = 5e-2;  // solver: five directions, a hundredth of each at the largest weight
  EXPECT_NEAR(choice.freedom, kStraight, kNearly);
}

TEST(SmoothingChoice, WithoutRoughnessIsNone) {
  EquationErrorSystem system = wavy();
  system.roughness = MatrixXd(0, 7);
  const SmoothingChoice choice = choose_smoothing(system, generous(7), Smoothing::l_curve);
  EXPECT_EQ(choice.smooth, 0.0);
  EXPECT_NEAR(choice.freedom, 7.0, kValue);
  EXPECT_TRUE(std::isnan(choice.criterion));
}

}  // namespace
}  // namespace crashsim
