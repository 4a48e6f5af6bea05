#include <crashsim/sampling.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <vector>

#include <gmock/gmock.h>

#include <crashsim/error.hpp>

namespace crashsim {
namespace {

using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::SizeIs;
using testing::ThrowsMessage;

/// Coordinates of Sobol's sequence at the dimensions 1, 2, 3, 6, 11, 21, 40, 64, 101 and 128:
/// scipy.stats.qmc.Sobol(128, scramble=False).random(5000), SciPy 1.17.
constexpr std::size_t kDimensions[] = {0, 1, 2, 5, 10, 20, 39, 63, 100, 127};
struct SobolRow {
  std::uint64_t index;
  std::vector<double> coordinates;
};
const SobolRow kSobolRows[] = {
    {0, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0}},
    {1, {0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5}},
    {2, {0.75, 0.25, 0.25, 0.75, 0.75, 0.25, 0.25, 0.75, 0.25, 0.25}},
    {3, {0.25, 0.75, 0.75, 0.25, 0.25, 0.75, 0.75, 0.25, 0.75, 0.75}},
    {7, {0.125, 0.625, 0.375, 0.375, 0.625, 0.875, 0.125, 0.375, 0.375, 0.375}},
    {100,
     {0.4140625, 0.2578125, 0.7734375, 0.7421875, 0.4609375, 0.7578125, 0.1328125, 0.6484375, 0.0390625, 0.4609375}},
    {1023,
     {0.0009765625, 0.7529296875, 0.6123046875, 0.4384765625, 0.6787109375, 0.8662109375, 0.6982421875, 0.0400390625,
      0.2373046875, 0.7001953125}},
    {4097,
     {0.5003662109375, 0.9705810546875, 0.3358154296875, 0.0428466796875, 0.3450927734375, 0.1724853515625,
      0.2017822265625, 0.9456787109375, 0.7669677734375, 0.5137939453125}},
    {4999,
     {0.1341552734375, 0.6981201171875, 0.6531982421875, 0.7996826171875, 0.2952880859375, 0.1090087890625,
      0.7320556640625, 0.3372802734375, 0.3538818359375, 0.1827392578125}},
};

TEST(Sobol, ThePointsAreThoseOfSciPy) {
  for (const SobolRow& row : kSobolRows) {
    const std::vector<double> point = sobol_point(row.index, kMostSobolDimensions);
    ASSERT_THAT(point, SizeIs(kMostSobolDimensions));
    std::vector<double> some;
    for (const std::size_t dimension : kDimensions) some.push_back(point[dimension]);
    EXPECT_THAT(some, ElementsAreArray(row.coordinates)) << "point " << row.index;
  }
}

TEST(Sobol, EveryDimensionFillsItsSlices) {
  constexpr std::size_t kCount = 256;
  std::vector<std::set<double>> seen(kMostSobolDimensions);
  for (std::size_t i = 0; i < kCount; ++i) {
    const std::vector<double> point = sobol_point(i, kMostSobolDimensions);
    for (std::size_t d = 0; d < seen.size(); ++d) seen[d].insert(std::floor(point[d] * kCount));
  }
  for (const auto& slices : seen) EXPECT_THAT(slices, SizeIs(kCount));
}

TEST(Sobol, RefusesWhatItHasNot) {
  EXPECT_THAT([] { sobol_point(0, 129); },
              ThrowsMessage<InvalidInput>(HasSubstr("has 128 dimensions here, 129 are needed: use latin_hypercube")));
  EXPECT_THAT([] { sobol_point(std::uint64_t{1} << 32, 1); }, ThrowsMessage<InvalidInput>(HasSubstr("2^32 points")));
  const SampleDesign wide{SampleMethod::saltelli, 4, 1, 65};
  EXPECT_THAT([&] { sample_point(wide, 0); }, ThrowsMessage<InvalidInput>(HasSubstr("130 are needed")));
}

TEST(Permuted, IsAPermutation) {
  for (const std::uint64_t count : {1U, 2U, 3U, 4U, 5U, 16U, 17U, 1000U, 4097U}) {
    std::set<std::uint64_t> seen;
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t to = permuted(i, count, 7, count);
      EXPECT_LT(to, count);
      seen.insert(to);
    }
    EXPECT_THAT(seen, SizeIs(count));
  }
}

TEST(Permuted, OfThreeGivesAllOrdersAboutEquallyOften) {
  constexpr int kTrials = 6000;
  constexpr double kFiveSigma = 5.0 * 28.9;  // of a binomial number of mean 1000
  std::map<std::vector<std::uint64_t>, int> orders;
  for (std::uint64_t seed = 0; seed < kTrials; ++seed)
    ++orders[{permuted(0, 3, seed, 0), permuted(1, 3, seed, 0), permuted(2, 3, seed, 0)}];
  ASSERT_THAT(orders, SizeIs(6));
  for (const auto& [order, times] : orders) EXPECT_NEAR(times, kTrials / 6.0, kFiveSigma);
}

std::vector<std::vector<double>> points_of(const SampleDesign& design) {
  std::vector<std::vector<double>> points;
  for (std::uint64_t i = 0; i < point_count(design); ++i) points.push_back(sample_point(design, i));
  return points;
}

class EveryMethod : public testing::TestWithParam<SampleMethod> {};
INSTANTIATE_TEST_SUITE_P(Methods, EveryMethod,
                         testing::Values(SampleMethod::random, SampleMethod::latin_hypercube, SampleMethod::sobol,
                                         SampleMethod::saltelli),
                         [](const auto& method) { return std::string(name_of(method.param)); });

TEST_P(EveryMethod, APointDependsOnSeedAndIndexOnly) {
  const SampleDesign design{GetParam(), 100, 3, 5};
  const SampleDesign other{GetParam(), 100, 4, 5};
  EXPECT_EQ(sample_point(design, 42), points_of(design)[42]);
  EXPECT_NE(sample_point(design, 42), sample_point(other, 42));
}

TEST_P(EveryMethod, CoordinatesAreUniformInside) {
  constexpr int kSamples = 4096;
  constexpr double kFiveSigma = 5.0 * 0.2887 / 64.0;  // of the mean of independent numbers
  const SampleDesign design{GetParam(), kSamples, 1, 3};
  const auto points = points_of(design);
  for (std::size_t d = 0; d < 3; ++d) {
    double sum = 0.0, squares = 0.0;
    for (const auto& point : points) {
      ASSERT_GT(point[d], 0.0);
      ASSERT_LT(point[d], 1.0);
      sum += point[d];
      squares += point[d] * point[d];
    }
    const auto count = static_cast<double>(points.size());
    EXPECT_NEAR(sum / count, 0.5, kFiveSigma);
    EXPECT_NEAR(squares / count, 1.0 / 3.0, kFiveSigma);
  }
}

TEST(LatinHypercube, HasOnePointInEachSlice) {
  const SampleDesign design{SampleMethod::latin_hypercube, 37, 5, 4};
  const auto points = points_of(design);
  std::set<std::vector<double>> orders;
  for (std::size_t d = 0; d < 4; ++d) {
    std::vector<double> slices;
    for (const auto& point : points) slices.push_back(std::floor(point[d] * 37.0));
    orders.insert(slices);
    std::sort(slices.begin(), slices.end());
    for (std::size_t i = 0; i < slices.size(); ++i) EXPECT_EQ(slices[i], static_cast<double>(i));
  }
  EXPECT_THAT(orders, SizeIs(4));  // another order in each dimension
}

TEST(SobolDesign, KeepsTheNetWhenShifted) {
  const SampleDesign design{SampleMethod::sobol, 64, 9, 2};
  std::set<std::pair<double, double>> boxes;
  for (const auto& point : points_of(design)) boxes.emplace(std::floor(point[0] * 8.0), std::floor(point[1] * 8.0));
  EXPECT_THAT(boxes, SizeIs(64));
}

TEST(Saltelli, AGroupExchangesOneCoordinateAtATime) {
  const SampleDesign design{SampleMethod::saltelli, 10, 2, 3};
  ASSERT_EQ(point_count(design), 50U);
  const auto points = points_of(design);
  const auto *a = &points[15], *b = &points[16];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t d = 0; d < 3; ++d) EXPECT_EQ(points[17 + i][d], (d == i ? *b : *a)[d]);
  EXPECT_THAT([&] { sample_point(design, 50); },
              ThrowsMessage<InvalidInput>(HasSubstr("there are 50 samples: there is no sample 50")));
}

}  // namespace
}  // namespace crashsim
