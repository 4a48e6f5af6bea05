#include <crashsim/piecewise_linear.hpp>

#include <gmock/gmock.h>

#include <crashsim/error.hpp>

namespace crashsim {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const PiecewiseLinear kCurve{{0.0, 1.0, 3.0}, {2.0, 4.0, 0.0}};

TEST(PiecewiseLinear, IsLinearBetweenKnotsAndHoldsTheLastOrdinate) {
  EXPECT_EQ(evaluate(kCurve, 0.0), 2.0);
  EXPECT_EQ(evaluate(kCurve, 0.5), 3.0);
  EXPECT_EQ(evaluate(kCurve, 1.0), 4.0);
  EXPECT_EQ(evaluate(kCurve, 2.0), 2.0);
  EXPECT_EQ(evaluate(kCurve, 7.0), 0.0);
  EXPECT_EQ(evaluate({{0.0}, {5.0}}, 3.0), 5.0);
}

TEST(PiecewiseLinear, SegmentsAreHalfOpenAndTheLastIsOpenToTheRight) {
  EXPECT_EQ(segment_of(kCurve, 0.0), 0u);
  EXPECT_EQ(segment_of(kCurve, 1.0), 1u);
  EXPECT_EQ(segment_of(kCurve, 9.0), 1u);
}

TEST(PiecewiseLinear, RefusesBadCurvesByName) {
  EXPECT_THAT(
      [] {
        validate({{0.0, 1.0, 1.0}, {1, 1, 1}}, "spring");
      },
      ThrowsMessage<InvalidInput>(HasSubstr("spring.knots[2] = 1: must be greater than the knot before it, 1")));
  EXPECT_THAT(
      [] {
        validate({{0.0, 1.0}, {1, -1}}, "spring");
      },
      ThrowsMessage<InvalidInput>(HasSubstr("spring.ordinates[1] = -1: must be >= 0")));
  EXPECT_THAT(
      [] {
        validate({{0.5, 1.0}, {1, 1}}, "damper");
      },
      ThrowsMessage<InvalidInput>(HasSubstr("first knot must be 0")));
  EXPECT_THAT([] { validate({{}, {}}, "damper"); }, ThrowsMessage<InvalidInput>(HasSubstr("at least one is needed")));
}

TEST(PiecewiseLinear, UniformKnotsCoverTheRange) {
  EXPECT_THAT(uniform_knots(3.0, 4), testing::ElementsAre(0.0, 1.0, 2.0, 3.0));
}

}  // namespace
}  // namespace crashsim
