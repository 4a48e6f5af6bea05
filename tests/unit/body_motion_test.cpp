#include <crashsim/body_motion.hpp>

#include <cmath>
#include <functional>
#include <memory>
#include <ostream>

#include <gmock/gmock.h>

namespace crashsim {
namespace {

constexpr double kRounding = 1e-13;                                       // of a few operations on numbers of size one
constexpr double kCg = 2.0, kFront = 3.4, kRear = 0.4, kHalfTrack = 0.7;  // m, from the rear bumper

Trace trace(std::vector<double> values, Dimension dimension = Dimension::length) {
  std::vector<double> times;
  for (std::size_t i = 0; i < values.size(); ++i) times.push_back(0.01 * static_cast<double>(i));
  Trace made;
  made.id = "7";
  made.name = "Z";
  made.dimension = dimension;
  made.time_s = std::make_shared<const std::vector<double>>(times);
  made.values = std::move(values);
  return made;
}

/// A rigid body whose centre of gravity rises by heave(t) while it turns nose down by pitch(t) and rolls a little.
struct RigidBody {
  std::vector<double> heave, pitch;

  RigidBody() {
    for (int i = 0; i <= 20; ++i) {
      heave.push_back(0.1 * std::sin(0.3 * i));
      pitch.push_back(0.05 * std::sin(0.2 * i));
    }
  }
  /// Left and right sensor at a place; up positive.
  [[nodiscard]] BodyStation station(double position_m, double sign = 1.0) const {
    std::vector<double> left, right;
    for (std::size_t i = 0; i < heave.size(); ++i) {
      const double z = heave[i] - (position_m - kCg) * std::sin(pitch[i]);
      const double roll = 0.02 * kHalfTrack * static_cast<double>(i);
      left.push_back(sign * (z + roll));
      right.push_back(sign * (z - roll));
    }
    return {position_m, {trace(left), trace(right)}};
  }
};

TEST(BodyMotion, OfARigidBodyIsItsHeaveAndPitch) {
  const RigidBody body;
  const BodyMotion motion = body_motion(body.station(kFront), body.station(kRear), kCg, VerticalSign::up);
  ASSERT_EQ(motion.heave.time_s.size(), 21U);
  EXPECT_EQ(motion.pitch.time_s, motion.heave.time_s);
  for (std::size_t i = 0; i < body.heave.size(); ++i) {
    EXPECT_NEAR(motion.heave.values[i], body.heave[i], kRounding);
    EXPECT_NEAR(motion.pitch.values[i], std::sin(body.pitch[i]), kRounding);  // small angles
  }
}

TEST(BodyMotion, TurnsTheSignOfVehicleAxesThatPointDown) {
  const RigidBody body;
  const BodyMotion up = body_motion(body.station(kFront), body.station(kRear), kCg, VerticalSign::up);
  const BodyMotion down = body_motion(body.station(kFront, -1.0), body.station(kRear, -1.0), kCg, VerticalSign::down);
  EXPECT_EQ(up.heave.values, down.heave.values);
  EXPECT_EQ(up.pitch.values, down.pitch.values);
}

TEST(BodyMotion, ExtrapolatesToACentreOfGravityAheadOfBothStations) {
  const RigidBody body;
  const BodyMotion motion = body_motion(body.station(1.1), body.station(kRear), kCg, VerticalSign::up);
  for (std::size_t i = 0; i < body.heave.size(); ++i) EXPECT_NEAR(motion.heave.values[i], body.heave[i], kRounding);
}

TEST(BodyMotion, OfVelocitiesIsRates) {
  BodyStation front{1.5, {trace({-1.0, -2.0}, Dimension::speed)}}, rear{-0.5, {trace({1.0, 0.0}, Dimension::speed)}};
  const BodyMotion motion = body_motion(front, rear, 0.0, VerticalSign::up);
  EXPECT_THAT(motion.pitch.values, testing::ElementsAre(1.0, 1.0));  // nose down is positive
  EXPECT_THAT(motion.heave.values, testing::ElementsAre(0.5, -0.5));
}

struct BadInput {
  const char* name;
  std::function<void(BodyStation& front, BodyStation& rear, double& cg)> spoil;
  const char* message;
};
void PrintTo(const BadInput& bad, std::ostream* out) { *out << bad.name; }

class BodyMotionRefused : public testing::TestWithParam<BadInput> {};

TEST_P(BodyMotionRefused, SaysWhy) {
  const RigidBody body;
  BodyStation front = body.station(kFront), rear = body.station(kRear);
  double cg = kCg;
  GetParam().spoil(front, rear, cg);
  try {
    body_motion(front, rear, cg, VerticalSign::up);
    FAIL() << "accepted";
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), testing::StartsWith(GetParam().message));
  }
}

const BadInput kBadInputs[] = {
    {"no_trace", [](BodyStation&, BodyStation& rear, double&) { rear.traces.clear(); },
     "BodyStation rear: no trace given"},
    {"no_position", [](BodyStation& front, BodyStation&, double&) { front.position_m = kUnset; },
     "BodyStation front: position_m = nan m: must be finite"},
    {"no_centre_of_gravity", [](BodyStation&, BodyStation&, double& cg) { cg = kUnset; },
     "body_motion: cg_position_m = nan m: must be finite"},
    {"front_behind_rear", [](BodyStation& front, BodyStation&, double&) { front.position_m = 0.4; },
     "BodyStation front: position_m = 0.4 m: must be ahead of the rear one's 0.4 m"},
    {"two_dimensions", [](BodyStation&, BodyStation& rear, double&) { rear.traces[1].dimension = Dimension::speed; },
     "BodyStation rear: channel 7 Z is speed but channel 7 Z is length: give displacements, velocities or "
     "accelerations"},
    {"two_clocks",
     [](BodyStation&, BodyStation& rear, double&) {
       std::vector<double> times(*rear.traces[0].time_s);
       times.back() += 1e-3;
       rear.traces[0].time_s = std::make_shared<const std::vector<double>>(times);
     },
     "BodyStation rear: channel 7 Z has other times than channel 7 Z: resample them to one clock"},
    {"lengths_differ", [](BodyStation& front, BodyStation&, double&) { front.traces[0].values.pop_back(); },
     "BodyStation front: channel 7 Z"},
};
INSTANTIATE_TEST_SUITE_P(Inputs, BodyMotionRefused, testing::ValuesIn(kBadInputs),
                         [](const auto& bad) { return std::string(bad.param.name); });

}  // namespace
}  // namespace crashsim
