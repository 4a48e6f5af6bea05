#include <crashsim/distribution.hpp>

#include <cmath>
#include <vector>

#include <gmock/gmock.h>

namespace crashsim {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kRounding = 4e-15;  // of quantiles, relative or absolute below 1
constexpr double kOther = 1e-12;     // of SciPy's quantiles, relative

struct Pair {
  double p, value;
};

TEST(NormalQuantile, IsThatOfFortyDigits) {
  // mpmath 1.4 with 40 digits: the root of log(erfc(-x / sqrt(2)) / 2) = log(p)
  constexpr Pair kPairs[] = {
      {1e-300, -37.047096299361199},     {1e-20, -9.2623400897984076},
      {2.5e-10, -6.2191045740435},       {0.001, -3.0902323061678135},
      {0.02425, -1.9729610513118848},    {0.1, -1.2815515655446004},
      {0.3, -0.52440051270804082},       {0.5, 0.0},
      {0.4999, -0.00025066283008800749}, {0.75, 0.67448975019608174},
      {0.975, 1.9599639845400539},       {0.999999, 4.7534243088170878},
  };
  for (const auto& [p, value] : kPairs)
    EXPECT_NEAR(normal_quantile(p), value, kRounding * std::fmax(1.0, std::fabs(value))) << p;
}

void expect_quantiles(const Distribution& distribution, const std::vector<Pair>& pairs) {
  for (const auto& [p, value] : pairs) EXPECT_NEAR(quantile(distribution, p), value, kOther * std::fabs(value)) << p;
}

TEST(Quantile, IsThatOfSciPy) {  // SciPy 1.17
  using enum DistributionKind;
  expect_quantiles({normal, {1719.0, 30.0}}, {{0.5, 1719.0}, {0.975, 1719.0 + 30.0 * 1.9599639845400539}});
  // truncnorm(-1.5, 2, 1719, 30); truncnorm(4, 6)
  expect_quantiles(
      {normal, {1719.0, 30.0}, {}, 1674.0, 1779.0},
      {{0.01, 1676.0063694575772}, {0.3, 1706.6211935323436}, {0.5, 1720.657363110504}, {0.99, 1774.6263009972456}});
  expect_quantiles({normal, {0.0, 1.0}, {}, 4.0, 6.0},
                   {{0.01, 4.002377723712478}, {0.5, 4.16109716567986}, {0.99, 4.980141413960941}});
  // lognorm(sqrt(v), scale=exp(log(1e6) - v / 2)), v = log1p(0.2^2)
  expect_quantiles({lognormal, {1e6, 2e5}}, {{0.001, 531736.73967908},
                                             {0.05, 707964.8819726271},
                                             {0.5, 980580.67569092},
                                             {0.95, 1358172.5393769436},
                                             {0.999, 1808297.9598490414}});
  // triang(2/7, 10, 7)
  expect_quantiles(
      {triangular, {10.0, 12.0, 17.0}},
      {{0.001, 10.118321595661993}, {0.2857, 11.999949999374984}, {0.3, 12.050252531694166}, {0.9, 15.12917130661303}});
  expect_quantiles({uniform, {0.8, 1.2}}, {{0.25, 0.9}, {0.75, 1.1}});
}

TEST(Quantile, CutOffNumbersStayInside) {
  const Distribution cut{DistributionKind::lognormal, {1.0, 0.5}, {}, 0.5, 1.5};
  EXPECT_GE(quantile(cut, 0x1.0p-54), 0.5);
  EXPECT_LE(quantile(cut, 1.0 - 0x1.0p-53), 1.5);
  const Distribution below{DistributionKind::lognormal, {1.0, 0.5}, {}, -3.0, kUnset};  // cuts nothing off
  EXPECT_EQ(quantile(below, 0.3), quantile({DistributionKind::lognormal, {1.0, 0.5}}, 0.3));
}

TEST(Quantile, ATableGivesEachNumberItsWeight) {
  const Distribution fair{DistributionKind::table, {3.0, 1.0, 2.0}};
  EXPECT_EQ(quantile(fair, 0.1), 3.0);
  EXPECT_EQ(quantile(fair, 0.5), 1.0);
  EXPECT_EQ(quantile(fair, 0.999), 2.0);
  const Distribution weighted{DistributionKind::table, {3.0, 1.0, 2.0}, {1.0, 3.0, 0.0}};
  EXPECT_EQ(quantile(weighted, 0.24), 3.0);
  EXPECT_EQ(quantile(weighted, 0.26), 1.0);
  EXPECT_EQ(quantile(weighted, 1.0 - 0x1.0p-53), 1.0);
}

void expect_refused(const Distribution& distribution, const char* why) {
  EXPECT_THAT([&] { validate(distribution, "mass"); }, ThrowsMessage<InvalidInput>(HasSubstr(why)));
}

TEST(Distribution, SaysWhatItNeeds) {
  using enum DistributionKind;
  expect_refused({normal, {1719.0}}, "mass: normal [1719]: needs a mean and a standard deviation");
  expect_refused({normal, {1719.0, 0.0}}, "mass: normal [1719, 0]: the standard deviation must be > 0");
  expect_refused({normal, {1719.0, INFINITY}}, "numbers must be finite");
  expect_refused({lognormal, {-1.0, 2.0}}, "the mean must be > 0");
  expect_refused({uniform, {2.0, 1.0}}, "mass: uniform [2, 1]: the least number must be below the largest");
  expect_refused({triangular, {1.0, 4.0, 3.0}}, "the most likely number must be between");
  expect_refused({table, {}}, "needs at least one number");
  expect_refused({table, {1.0, 2.0}, {1.0}}, "has 1 weights for 2 numbers");
  expect_refused({table, {1.0, 2.0}, {0.0, 0.0}}, "weights must be >= 0, one of them > 0");
  expect_refused({normal, {1.0, 2.0}, {1.0, 1.0}}, "weights go with table");
  expect_refused({uniform, {1.0, 2.0}, {}, 1.5, kUnset}, "lower and upper go with normal and lognormal");
  expect_refused({normal, {1.0, 2.0}, {}, 3.0, 2.0}, "lower = 3 must be below upper = 2");
  expect_refused({lognormal, {1.0, 2.0}, {}, kUnset, -2.0}, "upper = -2 must be > 0");
  expect_refused({normal, {0.0, 1.0}, {}, 50.0, kUnset}, "has no probability between lower and upper");
  validate({normal, {0.0, 1.0}, {}, 30.0, kUnset}, "mass");  // 5e-198 is some
}

}  // namespace
}  // namespace crashsim
