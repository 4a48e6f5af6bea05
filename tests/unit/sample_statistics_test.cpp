#include <crashsim/sample_statistics.hpp>

#include <cmath>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/sampling.hpp>

namespace crashsim {
namespace {

using testing::ElementsAre;
using testing::IsNan;

constexpr double kRounding = 1e-14;
const std::vector<double> kX = {3.1, 0.2, 5.5, 2.2, 2.2, 9.0, -1.0, 4.4, 7.3, 0.2, 6.1, 2.2};
const std::vector<double> kY = {1.0, 0.5, 2.0, -1.5, 0.0, 8.0, 0.1, 3.3, 3.2, 0.7, 2.0, 9.9};

TEST(SampleStatistics, AreThoseOfNumPy) {  // NumPy 2.4: mean, std(ddof=1), quantile
  const SampleStatistics s = statistics_of(kX);
  EXPECT_EQ(s.count, 12U);
  EXPECT_NEAR(s.mean, 3.45, kRounding);
  EXPECT_NEAR(s.sd, 3.0672759605522644, kRounding);
  EXPECT_NEAR(s.q05, -0.34, kRounding);
  EXPECT_NEAR(s.q50, 2.65, kRounding);
  EXPECT_NEAR(s.q95, 8.065, kRounding);
  EXPECT_EQ(s.min, -1.0);
  EXPECT_EQ(s.min_at, 6U);
  EXPECT_EQ(s.max, 9.0);
  EXPECT_EQ(s.max_at, 5U);
}

TEST(SampleStatistics, LeaveOutWhatIsUnset) {
  const std::vector<double> some = {kUnset, 2.0, kUnset, 1.0};
  const SampleStatistics s = statistics_of(some);
  EXPECT_EQ(s.count, 2U);
  EXPECT_EQ(s.mean, 1.5);
  EXPECT_EQ(s.min_at, 3U);
  const std::vector<double> one = {kUnset, 2.0};
  EXPECT_THAT(statistics_of(one).sd, IsNan());
  EXPECT_EQ(statistics_of(one).q95, 2.0);
  EXPECT_THAT(statistics_of({}).mean, IsNan());
}

TEST(Correlation, IsThatOfSciPy) {  // SciPy 1.17: pearsonr, rankdata, spearmanr
  EXPECT_NEAR(correlation(kX, kY), 0.477050426812773, kRounding);
  EXPECT_THAT(ranks_of(kX), ElementsAre(7, 2.5, 9, 5, 5, 12, 1, 8, 11, 2.5, 10, 5));
  EXPECT_NEAR(correlation(ranks_of(kX), ranks_of(kY)), 0.6289909725137375, kRounding);
}

TEST(Correlation, WithWhatDoesNotVaryIsUnset) {
  const std::vector<double> same(kX.size(), 0.1);
  EXPECT_THAT(correlation(kX, same), IsNan());
  EXPECT_THAT(correlation(same, kX), IsNan());
  EXPECT_THAT(correlation({}, {}), IsNan());
  EXPECT_THAT(first_order_index(ranks_of(kX), same), IsNan());
  EXPECT_THAT(first_order_index({}, {}), IsNan());
}

/// Ishigami's function with a = 7 and b = 0.1 on the unit cube; its indices are known, T. Ishigami, T. Homma (1990):
///     V = a^2/8 + b pi^4/5 + b^2 pi^8/18 + 1/2,   V_1 = (1 + b pi^4/5)^2 / 2,   V_2 = a^2/8,   V_13 = 8 b^2 pi^8/225
double ishigami(const std::vector<double>& point) {
  const auto angle = [&](std::size_t i) { return std::numbers::pi * (2.0 * point[i] - 1.0); };
  return std::sin(angle(0)) * (1.0 + 0.1 * std::pow(angle(2), 4)) + 7.0 * std::pow(std::sin(angle(1)), 2);
}
constexpr double kFirst[] = {0.31390519, 0.44241114, 0.0}, kTotal[] = {0.55758886, 0.44241114, 0.24368366};

TEST(SobolIndices, OfIshigamisFunctionAreTheAnalyticOnes) {
  const SampleDesign design{SampleMethod::saltelli, 8192, 1, 3};
  std::vector<double> outputs;
  for (std::uint64_t i = 0; i < point_count(design); ++i) outputs.push_back(ishigami(sample_point(design, i)));
  const std::vector<SobolIndices> indices = sobol_indices(outputs, 3);
  constexpr double kSampling = 0.004;  // of Sobol's sequence, measured 0.002; independent points have 0.02
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(indices[i].first_order.value, kFirst[i], kSampling) << i;
    EXPECT_NEAR(indices[i].total.value, kTotal[i], kSampling) << i;
  }
}

TEST(SobolIndices, TheirErrorIsThatOfIndependentPoints) {
  constexpr int kRepetitions = 60, kGroups = 500;
  std::vector<double> values, errors;
  for (std::uint64_t seed = 1; seed <= kRepetitions; ++seed) {
    const SampleDesign points{SampleMethod::random, kGroups, seed, 6};
    std::vector<double> outputs;
    for (std::uint64_t g = 0; g < kGroups; ++g) {
      const std::vector<double> both = sample_point(points, g);
      const std::vector<double> a(both.begin(), both.begin() + 3), b(both.begin() + 3, both.end());
      outputs.insert(outputs.end(), {ishigami(a), ishigami(b)});
      for (std::size_t i = 0; i < 3; ++i) {
        std::vector<double> mixed = a;
        mixed[i] = b[i];
        outputs.push_back(ishigami(mixed));
      }
    }
    const SobolIndex total = sobol_indices(outputs, 3)[0].total;
    values.push_back(total.value);
    errors.push_back(total.error);
  }
  constexpr double kOfTheSpread = 0.3;  // relative: an sd of 60 numbers is known to 9 %
  EXPECT_NEAR(statistics_of(errors).mean / statistics_of(values).sd, 1.0, kOfTheSpread);
}

TEST(SobolIndices, LeaveOutGroupsThatFailed) {
  // f = x + 0 y, groups of a, b, x, y
  const std::vector<double> failed = {1, 2, 2, 1, kUnset, 1, 1, 3, 3, 1, 1, 3, 7, kUnset, 4, 5, 5, 4, 4, 5};
  const std::vector<SobolIndices> indices = sobol_indices(failed, 2);
  const std::vector<double> kept = {1, 2, 2, 1, 3, 1, 1, 3, 5, 4, 4, 5};
  EXPECT_EQ(indices[0].total.value, sobol_indices(kept, 2)[0].total.value);
  EXPECT_EQ(indices[0].first_order.value, 1.0);
  EXPECT_EQ(indices[1].total.value, 0.0);
  EXPECT_THAT(sobol_indices(std::vector<double>(8, 0.1), 2)[0].total.value, IsNan());
  EXPECT_THAT(sobol_indices({}, 2)[1].first_order.error, IsNan());
}

TEST(FirstOrderIndex, OfIshigamisFunctionFollowsFromAnySamples) {
  const SampleDesign design{SampleMethod::sobol, 32768, 1, 3};
  std::vector<std::vector<double>> inputs(3);
  std::vector<double> outputs;
  for (std::uint64_t i = 0; i < point_count(design); ++i) {
    const std::vector<double> point = sample_point(design, i);
    for (std::size_t d = 0; d < 3; ++d) inputs[d].push_back(point[d]);
    outputs.push_back(ishigami(point));
  }
  constexpr double kClasses = 0.01;  // of 32 classes
  for (std::size_t d = 0; d < 3; ++d)
    EXPECT_NEAR(first_order_index(ranks_of(inputs[d]), outputs), kFirst[d], kClasses) << d;
}

}  // namespace
}  // namespace crashsim
