/// Monotone cubics against SciPy's.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "optimize/pchip.hpp"

namespace crashsim {
namespace {

constexpr double kRounding = 1e-12;
constexpr double kDerivative = 1e-7;  // solver: of central differences

const std::vector<double> kKnots = {0.0, 0.1, 0.25, 0.5, 0.8};
const std::vector<double> kOrdinates = {1.0, 3.0, 2.0, 2.5, 7.0};

/// scipy.interpolate.PchipInterpolator(kKnots, kOrdinates)(pchip_knots), every fourth.
TEST(Pchip, IsThatOfSciPy) {
  const PiecewiseLinear table = tabulate_pchip(kKnots, kOrdinates);
  ASSERT_EQ(table.knots.size(), 33U);
  const std::vector<double> scipy = {1.0, 2.3833333333333333, 3.0, 2.5000000000000004, 2.0, 2.142203832752613,
                                     2.5, 4.050946309787774,  7.0};
  for (std::size_t i = 0; i < scipy.size(); ++i) EXPECT_NEAR(table.ordinates[4 * i], scipy[i], kRounding) << i;
}

TEST(Pchip, HasTheDerivativesOfDifferences) {
  constexpr double kStep = 1e-6;
  const PchipTable table = pchip_table(kKnots, kOrdinates);
  for (std::size_t j = 0; j < kOrdinates.size(); ++j) {
    std::vector<double> up = kOrdinates, down = kOrdinates;
    up[j] += kStep;
    down[j] -= kStep;
    const Eigen::VectorXd difference =
        (pchip_table(kKnots, up).ordinates - pchip_table(kKnots, down).ordinates) / (2.0 * kStep);
    EXPECT_LT((table.by_ordinates.col(static_cast<Eigen::Index>(j)) - difference).cwiseAbs().maxCoeff(), kDerivative);
  }
}

TEST(Pchip, StaysBetweenItsOrdinatesAndHasFewKnotsOfItsOwn) {
  const PiecewiseLinear table = tabulate_pchip(kKnots, kOrdinates);
  for (std::size_t i = 0; i + 1 < kKnots.size(); ++i)
    for (std::size_t j = 0; j <= kPchipPieces; ++j) {
      const double y = table.ordinates[i * kPchipPieces + j];
      EXPECT_GE(y, std::min(kOrdinates[i], kOrdinates[i + 1]) - kRounding);
      EXPECT_LE(y, std::max(kOrdinates[i], kOrdinates[i + 1]) + kRounding);
    }
  EXPECT_EQ(tabulate_pchip(std::vector{0.0}, std::vector{4.0}).ordinates, std::vector{4.0});
  EXPECT_EQ(tabulate_pchip(std::vector{0.0, 1.0}, std::vector{1.0, 3.0}).ordinates[4], 2.0);
}

}  // namespace
}  // namespace crashsim
