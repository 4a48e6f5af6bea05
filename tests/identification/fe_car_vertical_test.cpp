/// The law of the wall's vertical force on the finite-element car of data/fe-car, whose wall has a friction of 0.3.

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include <crashsim/forcing.hpp>
#include <crashsim/identify_vertical.hpp>
#include <crashsim/trace_io.hpp>

#include "support/source_dir.hpp"

namespace crashsim {
namespace {

class FeCarVertical : public testing::Test {
 protected:
  FeCarVertical() {
    ForcingOptions forces;
    forces.file = std::string(test::source_dir()) + "/data/fe-car/C56.csv";
    forces.vertical_channels = {"barrier_impulse_FTZ"};
    forces.longitudinal_channels = {"barrier_impulse_FNX"};
    const PitchForcing forcing = read_forcing(forces).forcing;
    const TraceSet set = read_traces(forces.file);
    const Trace& left = set.traces.at(select_channels(set, "LEFT_REAR_DX").at(0));
    const Trace& right = set.traces.at(select_channels(set, "RIGHT_REAR_DX").at(0));
    target_ = {forcing.vertical_force_n, forcing.longitudinal_force_n, {}};
    target_.crush_m.time_s.assign(left.times().begin(), left.times().end());
    for (std::size_t i = 0; i < left.values.size(); ++i)
      target_.crush_m.values.push_back(-0.5 * (left.values[i] + right.values[i]));
  }

  VerticalForceTarget target_;
};

/// The wall's friction works in all directions: what of it is vertical stays far below the bound of 0.3.
TEST_F(FeCarVertical, SaysThatTheForceComesNearlyHorizontally) {
  IdentifyVerticalOptions options;
  options.free = {"angle"};
  for (const Loss loss : {Loss::l1, Loss::l2, Loss::huber}) {
    options.loss = loss;
    const VerticalIdentification fit = identify_vertical(target_, {}, options);
    ASSERT_TRUE(fit.usable()) << fit.message;
    EXPECT_TRUE(fit.verdict.identifiable) << fit.verdict.message;
    EXPECT_EQ(fit.starts_at_best, options.starts);
    EXPECT_GT(fit.law.angle_rad, 0.01) << name_of(loss);
    EXPECT_LT(fit.law.angle_rad, 0.02) << name_of(loss);
  }
}

TEST_F(FeCarVertical, DoesNotSayWhatTheFrictionIs) {
  IdentifyVerticalOptions options;
  for (const Loss loss : {Loss::l1, Loss::l2, Loss::huber}) {
    options.loss = loss;
    const VerticalIdentification fit = identify_vertical(target_, {}, options);
    ASSERT_TRUE(fit.usable()) << fit.message;
    EXPECT_FALSE(fit.verdict.identifiable) << name_of(loss);
  }
}

/// Least squares: 1 - E / E of no force at all.
TEST_F(FeCarVertical, ALawOfCrushExplainsAThirdOfTheForce) {
  IdentifyVerticalOptions options;
  options.loss = Loss::l2;
  options.free = {"angle", "angle-rate", "angle-start"};
  const VerticalIdentification fit = identify_vertical(target_, {}, options);
  double sum = 0.0, largest = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < target_.vertical_force_n.values.size(); ++i) {
    const double force = target_.vertical_force_n.values[i];
    sum += force * force;
    largest = std::max(largest, std::fabs(force));
    ++count;
  }
  ASSERT_EQ(count, fit.samples);
  const double explained = 1.0 - fit.error / (sum / count / (largest * largest));
  EXPECT_GT(explained, 0.3);
  EXPECT_LT(explained, 0.4);
}

}  // namespace
}  // namespace crashsim
