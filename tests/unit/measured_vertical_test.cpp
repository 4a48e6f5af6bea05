#include <crashsim/measured_vertical.hpp>

#include <string>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <crashsim/vertical_io.hpp>

#include "support/temp_dir.hpp"

namespace crashsim {
namespace {

using testing::Contains;
using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr const char* kTrace =
    "time [s],up [kN],along [kN],left [mm],right [mm],speed [m/s]\n"
    "0,0,0,0,0,10\n0.01,-1,-20,-100,-80,9\n0.02,-2,-30,-150,-130,8\n0.03,-3,-25,-200,-160,7\n";

class MeasuredVerticalFile : public testing::Test {
 protected:
  MeasuredVerticalFile() {
    forces.file = dir.file("trace.csv", kTrace);
    forces.vertical_channels = {"up"};
    forces.vertical_sign = VerticalSign::up;
    forces.longitudinal_channels = {"along"};
    crush.crush_channels = {"left", "right"};
  }

  test::TempDir dir;
  ForcingOptions forces;
  CrushChannelOptions crush;
};

TEST_F(MeasuredVerticalFile, GivesForcesAndCrushWithTheirSigns) {
  const MeasuredVertical measured = read_vertical_target(forces, crush);
  EXPECT_THAT(measured.target.vertical_force_n.values,
              ElementsAre(DoubleEq(0.0), DoubleEq(1e3), DoubleEq(2e3), DoubleEq(3e3)));
  EXPECT_THAT(measured.target.longitudinal_force_n.values,
              ElementsAre(DoubleEq(0.0), DoubleEq(2e4), DoubleEq(3e4), DoubleEq(2.5e4)));
  EXPECT_THAT(measured.target.crush_m.values,
              ElementsAre(DoubleEq(0.0), DoubleEq(0.09), DoubleEq(0.14), DoubleEq(0.18)));
  EXPECT_THAT(measured.steps, Contains(HasSubstr("crush: sign turned")));
  EXPECT_THAT(measured.input_files, ElementsAre(forces.file));
}

TEST_F(MeasuredVerticalFile, IsRefusedWithFileAndChannel) {
  const auto refused = [this](const std::string& message) {
    EXPECT_THAT([this] { static_cast<void>(read_vertical_target(forces, crush)); },
                ThrowsMessage<InvalidInput>(HasSubstr(message)));
  };
  crush.crush_channels = {"speed"};
  refused("speed: measures speed; a displacement is needed");
  crush.crush_channels = {};
  refused("displacement_m");
  forces.longitudinal_channels = {};
  refused("trace.csv: say which channels are the longitudinal force, too (longitudinal); see crashsim info");
  forces.longitudinal_channels = {"along"};
  forces.vertical_channels = {};
  refused("trace.csv: say which channels are the vertical force, too (channel); see crashsim info");
}

TEST(VerticalLawFile, HoldsTheLawAndHowItWasFound) {
  VerticalIdentification fit;
  fit.outcome = IdentifyOutcome::completed;
  fit.error = 0.1;
  fit.samples = 5;
  fit.limited_samples = 2;
  const Record record = make_record("identify-vertical", {"t.csv"}, {}, {});
  const auto law = nlohmann::json::parse(format_vertical_law({0.1, 0.5, 0.2, kUnset}, &fit, &record));
  EXPECT_EQ(law["angle_rad"], 0.1);
  EXPECT_EQ(law["angle_start_m"], 0.2);
  EXPECT_FALSE(law.contains("friction"));
  EXPECT_EQ(law["identification"]["limited_samples"], 2);
  EXPECT_EQ(law["identification"]["outcome"], "completed");
  EXPECT_EQ(law["record"]["command"], "identify-vertical");
  EXPECT_THAT([] { static_cast<void>(format_vertical_law({.friction = -1.0})); },
              ThrowsMessage<InvalidInput>(HasSubstr("VerticalForceLaw.friction = -1")));
}

}  // namespace
}  // namespace crashsim
