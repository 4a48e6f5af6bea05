/// The height at which the wall's force acts on the finite-element car of data/fe-car, from the car's pitch.

#include <gmock/gmock.h>

#include <crashsim/body_motion.hpp>
#include <crashsim/identify_pitch.hpp>
#include <crashsim/signal.hpp>
#include <crashsim/trace_io.hpp>

#include "support/source_dir.hpp"

namespace crashsim {
namespace {

constexpr double kCgHeight = 0.504;  // m

class FeCarPitch : public testing::Test {
 protected:
  FeCarPitch() : set_(read_traces(std::string(test::source_dir()) + "/data/fe-car/C56.csv")) {
    const Trace& normal = named("barrier_impulse_FNX");
    const std::vector<double> times(normal.times().begin(), normal.times().end());
    std::vector<double> along = differentiate(times, normal.values);
    for (double& force : along) force = -force;  // on the car it is positive
    forcing_.longitudinal_force_n = {times, along};
    forcing_.vertical_force_n = {times, differentiate(times, named("barrier_impulse_FTZ").values)};
    model_.mass_kg = set_.mass_kg;
    model_.pitch_inertia_kgm2 = 1876.0;
    model_.front_axle_m = model_.rear_axle_m = 1.2;  // there are no axles
    model_.front_stiffness_n_per_m = model_.rear_stiffness_n_per_m = 0.0;
    model_.front_damping_ns_per_m = model_.rear_damping_ns_per_m = 0.0;
    model_.force_arm_m = 1.6;
    model_.cg_height_m = kCgHeight;
    simulation_.start.rule = PitchStart::impact;
    options_.starts = 5;
  }

  [[nodiscard]] const Trace& named(const std::string& name) const {
    return set_.traces.at(select_channels(set_, name).at(0));
  }
  /// The car travels along -x.
  [[nodiscard]] BodyMotion body(const std::string& what) const {
    const BodyStation front{-2.286, {named("LEFT_MID_" + what), named("RIGHT_MID_" + what)}};
    const BodyStation rear{-3.1327, {named("LEFT_REAR_" + what), named("RIGHT_REAR_" + what)}};
    return body_motion(front, rear, -1.6, VerticalSign::up);
  }
  [[nodiscard]] PitchTarget pitch() const { return {{}, body("DZ").pitch, {}, body("VZ").pitch}; }
  [[nodiscard]] PitchIdentification identified() const {
    return identify_pitch(model_, forcing_, pitch(), simulation_, options_);
  }

  TraceSet set_;
  PitchForcing forcing_;
  HeavePitchModel model_;
  PitchOptions simulation_;
  IdentifyPitchOptions options_;
};

TEST_F(FeCarPitch, SaysTheForceActsALittleBelowTheCentreOfGravity) {
  constexpr double kLosses = 2e-3;  // regression: m, between the losses
  options_.free = {"force_height"};
  const PitchIdentification absolute = identified();
  ASSERT_TRUE(absolute.usable()) << absolute.message;
  EXPECT_TRUE(absolute.verdict.identifiable) << absolute.verdict.message;
  EXPECT_EQ(absolute.starts_at_best, 5);
  EXPECT_GT(absolute.model.force_height_m, 0.4);
  EXPECT_LT(absolute.model.force_height_m, kCgHeight);
  EXPECT_LT(absolute.error.pitch, 0.08);  // the body does not only turn, it bends, and the ground carries it
  EXPECT_LT(absolute.error.pitch_rate, 0.2);
  options_.loss = Loss::l2;
  EXPECT_NEAR(identified().model.force_height_m, absolute.model.force_height_m, kLosses);
}

TEST_F(FeCarPitch, FindsNoSuspensionWhereThereIsNone) {
  options_.free = {"force_height", "front_stiffness", "rear_stiffness", "front_damping", "rear_damping"};
  options_.loss = Loss::l2;
  const PitchIdentification fit = identified();
  ASSERT_TRUE(fit.usable()) << fit.message;
  EXPECT_FALSE(fit.verdict.identifiable) << fit.verdict.message;
  EXPECT_TRUE(fit.parameters[1].at_bound);
  EXPECT_TRUE(fit.parameters[2].at_bound);
  EXPECT_THAT(fit.warnings, testing::Contains(testing::HasSubstr("is at its bound")));
}

}  // namespace
}  // namespace crashsim
